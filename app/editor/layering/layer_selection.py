"""The active layer, the selected layers, and soloed layers."""

from app.editor.project import Project
from app.editor.session import Session, with_project


@with_project
def set_active_layer(session: Session, project: Project, identity: int) -> None:
    """Make a layer active: its handles and keys are shown and edited.

    A member is selected in the list, and the deform group that bends it is active.
    """
    before = project.selection.active
    bent = project.document.deform_layer(project.document.layer(identity)).id
    if bent != before:
        project.history.interrupt()
        project.layer_list.linger(before)
        project.layer_setup.forget_previews()
        session.tools.hover(None)
    project.selection.activate_layer(bent, None if bent == identity else identity)


@with_project
def select_layers(session: Session, project: Project, *identities: int) -> None:
    """Select layers; the listed layer stays active if it is among them."""
    if project.selection.listed not in identities:
        set_active_layer(session, identities[0])
    project.selection.select_other_layers(frozenset(identities))


@with_project
def toggle_layers_selected(session: Session, project: Project, *identities: int) -> None:
    """Add layers to the selection, or remove them if all are selected."""
    chosen = frozenset(project.selected_layers)
    left = chosen - set(identities) if chosen.issuperset(identities) else chosen | set(identities)
    if left:
        ordered = [each for each in project.document.layers[::-1] if each.id in left]
        select_layers(session, *(each.id for each in ordered))


@with_project
def select_layers_up_to(session: Session, project: Project, identity: int) -> None:
    """Select the listed layers from the active one to another one."""
    listed = [row.layer.id for row in project.tree if row.layer is not None]
    ends = sorted((listed.index(project.selection.listed), listed.index(identity)))
    select_layers(session, *listed[ends[0] : ends[1] + 1])


@with_project
def toggle_tree_row(_: Session, project: Project, row: str) -> None:
    """Open or close a row of the layer tree."""
    project.layer_list.toggle_row(row)


@with_project
def rest_on_folded_row(session: Session, project: Project, row: str) -> None:
    """Note that the pointer drags over a folded row in this frame; after a while, the row opens."""
    if project.layer_list.rest_on_row(row, session.clock()):
        project.layer_list.toggle_row(row)


@with_project
def reset_tree_rows(_: Session, project: Project) -> None:
    """List only the layers of open rows, and the active layer."""
    project.layer_list.drop_lingering()


@with_project
def solo_layers(_: Session, project: Project, *identities: int) -> None:
    """Show only these layers while editing, or all again; exports ignore solo.

    A deform group is shown by its members, and goes with them.
    """
    document, shown = project.document, set(identities)
    for each in identities:
        shown |= {member.id for member in document.deform_members(each)}
        shown.add(document.deform_layer(document.layer(each)).id)
    project.layer_list.toggle_solo(frozenset(shown))
