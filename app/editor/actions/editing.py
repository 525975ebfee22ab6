"""Changes of the document: commands, undo and the selection."""

from collections.abc import Callable
from typing import Concatenate, ParamSpec

from app.document import (
    POSE,
    Command,
    Document,
    FrameRange,
    KeysByChannel,
    PreviewPose,
    all_keys,
    changed_ranges,
    channel_commands,
    frames_in,
    pose_channel,
)
from app.editor import pending_changes
from app.editor.actions import playback
from app.editor.actions.action_spec import named_action, unless
from app.editor.actions.layer_setup.layer_runtimes import update_layer_runtimes
from app.editor.actions.posing.handles import remove_handles
from app.editor.actions.posing.motion_presets import apply_motion, joint_placement
from app.editor.actions.posing.pose_commit import drop_drag
from app.editor.actions.posing.pose_drag import revert_drag
from app.editor.project import Project
from app.editor.session import Session, with_project
from app.texts import N_, _

Arguments = ParamSpec("Arguments")
FIRST_KEY_STAYS = N_("The first key of {layers} was not deleted. A layer needs at least one key.")
UNDONE, REDONE = _("Undone: {step}"), _("Redone: {step}")


@with_project
def edit_document(
    session: Session, project: Project, command: Command, *, gesture: object = None
) -> None:
    """Run a command; it is a preview until the end of a gesture, by default one use of a widget."""
    widget = session.tools.widget_gesture
    if gesture is None and not session.tools.is_widget_pressed:
        project.history.do(command, gesture=widget)
    else:
        project.history.preview(command, gesture or widget)
    _forget_what_is_gone(project)


@with_project
def edit_layer(
    session: Session,
    project: Project,
    /,
    command: Callable[Concatenate[int, Arguments], Command],
    *args: Arguments.args,
    **kwargs: Arguments.kwargs,
) -> None:
    """Run a command on the active layer."""
    edit_document(session, command(project.selection.active, *args, **kwargs))


def _undo_text(session: Session, project: Project) -> str:
    step = project.history.undo_label
    draft = session.tools.motion_setup
    if draft is not None and draft.past:
        step = _("Move a joint")
    elif project.motion_job is not None:
        step = _("Apply motion preset")
    return "" if step is None else _("Undo “{step}”").format(step=step)


@named_action(
    _("Undo"),
    "Ctrl+Z",
    detail=_undo_text,
    why_disabled=unless(_undo_text, _("There is nothing to undo.")),
    repeats_while_held=True,
)
@with_project
def undo(session: Session, project: Project) -> None:
    """Undo the last step; a change that the hand holds, or a drag without a pose, is cancelled.

    A pending action that was asked for last is cancelled first; so is a pending motion. While a
    motion is drafted, undo changes only its joints.
    """
    draft = session.tools.motion_setup
    if draft is not None and draft.past:
        session.tools.select(draft.undone)
        return
    if project.motion_job is not None:
        apply_motion.cancel_motion_job(session)
        _show_step_notice(session, UNDONE, _("Apply motion preset"))
        return
    drag, history = project.drag, project.history
    is_held = history.is_held or session.tools.active_tool is not None
    waiting = None if is_held else pending_changes.cancel_deferred_action(project)
    if waiting is not None:
        _show_step_notice(session, UNDONE, waiting)
        return
    before, unkeyed = project.document, history.preview_pose
    if is_held or (drag is not None and drag.start is None):
        cancel_change(session)
    else:
        position = history.position
        history.commit()
        # A drag that fails leaves no step to undo.
        if history.position == position:
            _show_step_notice(session, UNDONE, history.undo_label)
            history.undo()
    _forget_what_is_gone(project)
    _go_to_change(session, project, before, unkeyed)


@named_action(
    _("Cancel change"),
    "Escape",
    why_disabled=unless(lambda _, project: project.history.is_held, _("Nothing is dragged.")),
)
@with_project
def cancel_change(session: Session, project: Project) -> None:
    """Undo what the hand changes; its later moves are void."""
    tool = session.tools.end()
    if tool is not None:
        tool.cancel(session)
    if project.drag is not None:
        drop_drag(session, project, project.drag)
    project.history.cancel()
    _forget_what_is_gone(project)


@with_project
def revert_gesture(session: Session, project: Project, gesture: object) -> None:
    """Undo all edits of a gesture."""
    revert_drag(session, gesture)
    project.history.revert(gesture)
    _forget_what_is_gone(project)


def _redo_text(_session: Session, project: Project) -> str:
    step = project.history.redo_label
    return "" if step is None else _("Redo “{step}”").format(step=step)


@named_action(
    _("Redo"),
    "Ctrl+Shift+Z, Ctrl+Y",
    detail=_redo_text,
    why_disabled=unless(_redo_text, _("There is nothing to redo.")),
    repeats_while_held=True,
)
@with_project
def redo(session: Session, project: Project) -> None:
    if project.history.redo_label is None:
        return
    before, unkeyed = project.document, project.history.preview_pose
    _show_step_notice(session, REDONE, project.history.redo_label)
    project.history.redo()
    _forget_what_is_gone(project)
    _go_to_change(session, project, before, unkeyed)


def _show_step_notice(session: Session, text: str, label: str | None) -> None:
    if label is not None:
        session.notices.show(text.format(step=label), topic="undo")


def _go_to_change(
    session: Session, project: Project, before: Document, unkeyed: PreviewPose | None
) -> None:
    """Move a resting playhead to the nearest changed frame, unless its own frame changed."""
    if project.timeline.playhead.since is not None:
        return
    stretches = changed_ranges(before, project.document)
    if project.history.preview_pose is not unkeyed:
        poses = filter(None, (unkeyed, project.history.preview_pose))
        stretches += [FrameRange(pose.frame, pose.frame) for pose in poses]
    here = project.timeline.playhead.frame
    if stretches and not any(here in stretch for stretch in stretches):
        frames = (stretch.clamp(here) for stretch in stretches)
        playback.seek(session, min(frames, key=lambda frame: abs(frame - here)))


@with_project
def select_handles(_: Session, project: Project, handles: frozenset[int]) -> None:
    """Select these handles where they exist, and no keys."""
    project.selection.select_handles(handles)
    _forget_what_is_gone(project)


def _select_text(session: Session, _project: Project) -> str:
    return _("Select all keys") if session.display.is_timeline_focused else _("Select all handles")


@named_action(_("Select all"), "Ctrl+A", detail=_select_text)
@with_project
def select_all(session: Session, project: Project) -> None:
    """Select every handle or, in the timeline, the keys of all channels that it shows."""
    if session.display.is_timeline_focused:
        keys, graph = movable_keys(project.document), project.graph
        graph.select_points(frozenset())
        shown = graph.shown_channels(project.document, project.channel) if graph.is_open else keys
        select_channel_keys(session, {each: keys[each] for each in keys if each in shown})
    else:
        select_handles(session, frozenset(handle.id for handle in project.layer.handles))


@named_action(
    _("Deselect"),
    "Escape",
    why_disabled=unless(
        lambda _, project: project.selection.handles or project.selection.keys,
        _("No handle or key is selected."),
    ),
)
@with_project
def deselect_all(_: Session, project: Project) -> None:
    project.selection.clear()


@with_project
def deselect_keys(_: Session, project: Project) -> None:
    """Deselect all keys; the handle selection stays."""
    project.selection.deselect_keys()


@with_project
def select_keys(session: Session, project: Project, frames: frozenset[int]) -> None:
    """Select the keys at these frames where they exist, and no handles."""
    select_channel_keys(session, {pose_channel(project.selection.active): frames})


@with_project
def select_channel_keys(_: Session, project: Project, keys: KeysByChannel) -> None:
    """Select keys of several channels where they exist, and no handles."""
    project.selection.select_keys(keys)
    _forget_what_is_gone(project)


def movable_keys(document: Document) -> KeysByChannel:
    """Return all keys but the poses of still pictures."""
    return {
        channel: frames
        for channel, frames in all_keys(document).items()
        if channel.kind is not POSE
        or channel.layer is None
        or not document.layer(channel.layer).still
    }


def _has_deletable(session: Session, project: Project) -> bool:
    """Return whether keys, visible handles, a joint of a motion or a channel are selected."""
    joint = session.tools.motion_setup is not None and session.tools.motion_setup.selected_joint
    is_channel = session.display.is_timeline_focused and project.graph.has_lane(project.channel)
    handles = project.selection.handles and not session.tools.is_cutting
    return bool(joint or handles or project.selection.keys or is_channel)


@named_action(
    _("Delete"),
    "Delete, Backspace",
    why_disabled=unless(_has_deletable, _("Select a handle or a key first.")),
)
@with_project
def delete_selection(session: Session, project: Project) -> None:
    """Delete the selected keys or, in the timeline, the selected channel, or selected handles.

    While a motion is drafted, leave out the joint that was touched last.
    """
    draft = session.tools.motion_setup
    if draft is not None and draft.selected_joint is not None:
        joint_placement.exclude_joint(session, draft.selected_joint)
    elif project.selection.keys:
        _delete_keys(session, project)
    elif session.display.is_timeline_focused and project.graph.has_lane(project.channel):
        channel = project.channel
        keys = {channel: frames_in(project.document, channel)}
        edit_document(session, channel_commands.delete_keys(keys))
    elif project.selection.handles:
        remove_handles(session, project.selection.handles)


def _delete_keys(session: Session, project: Project) -> None:
    """Delete the selected keys; a layer whose keys are all selected keeps its first key."""
    keys, keeping = dict(project.selection.keys), list[str]()
    for channel, chosen in project.selection.keys.items():
        is_pose = channel.kind is POSE and channel.layer is not None
        if is_pose and chosen >= frames_in(project.document, channel):
            keys[channel] = chosen - {min(chosen)}
            keeping.append(repr(project.document.layer(channel.layer or 0).name))
    left = {channel: frames for channel, frames in keys.items() if frames}
    edit_document(session, channel_commands.delete_keys(left or project.selection.keys))
    if keeping:
        session.notices.show(_(FIRST_KEY_STAYS).format(layers=", ".join(keeping)))


def _forget_what_is_gone(project: Project) -> None:
    document = project.document
    update_layer_runtimes(project)
    project.layer_list.keep_existing(document)
    project.timeline.keep_existing(document)
