"""Which layer is posed, which are chosen beside it, and what of the layers is looked at."""

from app.editor.actions import posing
from app.editor.project import Project
from app.editor.session import Session, with_project


@with_project
def set_active_layer(session: Session, project: Project, identity: int) -> None:
    """Let a layer be the one whose handles and keys are shown and changed, and no other."""
    project.other_selected_layers = frozenset()
    if identity == project.active:
        return
    posing.release_drag(session)
    project.lingering |= {project.active}
    project.active = identity
    project.selected_handles = project.selected_frames = frozenset()
    project.selected_track = None
    project.meshing = project.previewed_limits = None
    session.hovered = None


@with_project
def select_layers(session: Session, project: Project, *identities: int) -> None:
    """Choose layers together; the one that is posed goes on if it is among them."""
    if project.active not in identities:
        set_active_layer(session, identities[0])
    project.other_selected_layers = frozenset(identities) - {project.active}


@with_project
def toggle_layers_selected(session: Session, project: Project, *identities: int) -> None:
    """Choose layers beside those that are chosen, or no more where all of them are."""
    chosen = frozenset(project.selected_layers)
    left = chosen - set(identities) if chosen.issuperset(identities) else chosen | set(identities)
    if left:
        ordered = [each for each in project.document.layers[::-1] if each.id in left]
        select_layers(session, *(each.id for each in ordered))


@with_project
def select_layers_up_to(session: Session, project: Project, identity: int) -> None:
    """Choose the layers that are listed from the one that is posed to another one."""
    listed = [row.layer.id for row in project.tree if row.layer is not None]
    ends = sorted((listed.index(project.active), listed.index(identity)))
    select_layers(session, *listed[ends[0] : ends[1] + 1])


@with_project
def toggle_tree_row(_: Session, project: Project, row: str) -> None:
    """Open a row of the tree of layers, or close it again."""
    project.toggled_rows ^= {row}
    project.lingering = frozenset()


@with_project
def reset_tree_rows(_: Session, project: Project) -> None:
    """List only the layers of open rows again, and the one that is posed."""
    project.lingering = frozenset()


@with_project
def solo_layers(_: Session, project: Project, *identities: int) -> None:
    """Show some layers alone while the person works, or all again; exports do not heed it."""
    project.solo = frozenset() if project.solo == set(identities) else frozenset(identities)
