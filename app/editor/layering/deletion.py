"""Deleting layers: children attach to the remaining ancestors."""

from collections.abc import Iterable, Sequence

from app.document import Command, Document, combine_commands, layer_commands
from app.editor import pending_changes
from app.editor.action import do
from app.editor.actions import editing, playback
from app.editor.layering.layer_selection import set_active_layer
from app.editor.layering.parenting import ATTACHING, reparent_child_command
from app.editor.project import Project
from app.editor.session import Session, with_project
from app.motion import ParentTransforms
from app.texts import _, ngettext


@with_project
def delete_layers(session: Session, project: Project, *identities: int) -> None:
    """Delete layers; their children attach to their parents, and nothing moves now."""
    layers = project.document.layers
    identities = _with_deform_groups(project.document, identities)
    gone = set(identities)
    if len(gone) == len(layers):
        text = _("A scene needs at least one layer. Add another layer first.")
        session.notices.show(text, tone="error")
    elif any(joint.parent in gone for layer in layers for joint in layer.attachments):
        pending_changes.run_when_idle(
            session, do(_reparent_children, *identities), _("Delete layer")
        )
    else:
        _delete(session, identities, [])


@with_project
def _reparent_children(session: Session, project: Project, *identities: int) -> None:
    """Find new parents for the children of deleted layers, and delete the layers."""
    document, siblings = project.document, project.samplers
    frame = playback.current_frame(session, project)

    def find() -> list[Command]:
        joints = ParentTransforms(document, siblings)
        layers = [layer.id for layer in document.layers if layer.id not in identities]
        return [reparent_child_command(joints, child, identities, frame) for child in layers]

    def done(inherited: list[Command]) -> None:
        if project.document is document:
            _delete(session, identities, inherited)
        else:
            text = _("Nothing was deleted: the project changed meanwhile. Try again.")
            session.notices.show(text)

    pending_changes.begin_pending_change(session, project, ATTACHING, find, done)


@with_project
def _delete(
    session: Session, project: Project, identities: Sequence[int], inherited: Sequence[Command]
) -> None:
    order = [layer.id for layer in project.document.layers]
    # Members go with their deform group.
    removals = [
        layer_commands.remove_layer(identity)
        for identity in identities
        if project.document.layer(identity).deform_group not in identities
    ]
    count = len(identities)
    label = ngettext("Delete layer", "Delete {count} layers", count).format(count=count)
    was_active, index = (
        project.selection.active in identities,
        order.index(project.selection.active),
    )
    editing.edit_document(session, combine_commands(label, [*inherited, *removals]))
    if was_active:
        near = [*order[:index][::-1], *order[index + 1 :]]
        set_active_layer(session, next(each for each in near if each not in identities))


def _with_deform_groups(document: Document, identities: Iterable[int]) -> tuple[int, ...]:
    """Return layers with the members of deform groups, and groups without other members."""
    whole = dict.fromkeys(identities)
    for each in tuple(whole):
        whole |= dict.fromkeys(member.id for member in document.deform_members(each))
    for each in tuple(whole):
        group = document.layer(each).deform_group
        if group is not None and all(
            member.id in whole for member in document.deform_members(group)
        ):
            whole[group] = None
    return tuple(whole)
