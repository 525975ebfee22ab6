"""Partners, locks, groups and depth of handles."""

from itertools import count

from app.document import (
    DEPTH,
    Channel,
    Handle,
    frames_in,
    handle_commands,
    layer_commands,
    mirrored_handles_by_name,
)
from app.editor.actions.action_spec import UNLESS_HANDLES, named_action, unless
from app.editor.actions.editing import edit_layer, select_handles
from app.editor.actions.timing import channel_keys
from app.editor.project import Project
from app.editor.session import Session, with_project
from app.texts import _


@named_action(
    _("Select partners"),
    "Shift+M",
    icon="RIGHT_LEFT",
    hint=_("Select the handles with the same names on the other side"),
    why_disabled=UNLESS_HANDLES,
)
@with_project
def select_mirrored(session: Session, project: Project) -> None:
    """Select the handles on the other side whose names match the selected ones."""
    pairs = mirrored_handles_by_name(project.layer.handles, project.document.pairs)
    partners = frozenset(pairs[handle] for handle in project.selection.handles if handle in pairs)
    if partners:
        select_handles(session, partners)
    else:
        session.notices.show(
            _(
                "No handle with a matching name was found. Name the two sides “hand.L” and "
                "“hand.R”, “foot_l” and “foot_r”, or “left ear” and “right ear”."
            )
        )


def _are_all_locked(session: Session) -> bool:
    project = session.project
    selected = project.selection.handles if project else frozenset[int]()
    return bool(project and selected and all(map(project.layer.is_locked, selected)))


@named_action(
    _("Lock"),
    "Shift+L",
    icon="LOCK",
    hint=_("Locked handles keep their places and cannot be dragged"),
    why_disabled=UNLESS_HANDLES,
    active=_are_all_locked,
)
@with_project
def toggle_handles_locked(session: Session, project: Project) -> None:
    """Lock the selected handles, or unlock them if all are locked."""
    if project.selection.handles:
        chosen = [
            handle for handle in project.layer.handles if handle.id in project.selection.handles
        ]
        locked = not all(handle.locked for handle in chosen)
        edit_layer(session, handle_commands.lock_handles, project.selection.handles, locked=locked)


@named_action(
    _("Group"),
    "Ctrl+G",
    icon="OBJECT_GROUP",
    hint=_("Select and drag these handles together"),
    why_disabled=unless(
        lambda _, project: len(project.selection.handles) > 1, _("Select several handles first.")
    ),
)
@with_project
def group_handles(session: Session, project: Project) -> None:
    if len(project.selection.handles) > 1:
        taken = {handle.group for handle in project.layer.handles}
        names = (_("group {number}").format(number=number) for number in count(1))
        name = next(each for each in names if each not in taken)
        edit_layer(session, handle_commands.group_handles, project.selection.handles, name)


@named_action(
    _("Ungroup"),
    "Ctrl+Shift+G",
    icon="OBJECT_UNGROUP",
    hint=_("Stop selecting and dragging these handles together"),
    why_disabled=unless(
        lambda _, project: any(
            handle.group
            for handle in project.layer.handles
            if handle.id in project.selection.handles
        ),
        _("Select a handle of a group first."),
    ),
)
@with_project
def ungroup_handles(session: Session, project: Project) -> None:
    """Dissolve the groups of the selected handles."""
    fellows = frozenset[int]().union(*map(project.layer.grouped_handles, project.selection.handles))
    edit_layer(session, handle_commands.group_handles, fellows, "")


def depth_channel(project: Project, handle: Handle) -> Channel[float]:
    """Return the channel of a handle's depth in the active layer."""
    return Channel(DEPTH, project.selection.active, handle.id)


@with_project
def set_depth(session: Session, project: Project, identity: int, front: float) -> None:
    """Set the depth of a handle: by a key if it has keys, or else for all frames."""
    handle = project.layer.handle(identity)
    channel = depth_channel(project, handle)
    if frames_in(project.document, channel):
        channel_keys.set_channel_value(session, channel, front)
    else:
        edit_layer(session, layer_commands.set_depth, identity, front, handle.extent)
