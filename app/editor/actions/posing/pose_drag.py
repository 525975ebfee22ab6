"""Pose drags: targets come from the pointer, and the worker's solver follows."""

from collections.abc import Callable, Mapping
from dataclasses import replace
from functools import partial

from app.document import Pose, Target, keyed_pose_at, segment_time_at
from app.editor.actions import playback
from app.editor.actions.action_spec import UNLESS_HANDLES, named_action
from app.editor.actions.posing.pose_commit import POSING, drop_drag
from app.editor.actions.posing.pose_solver import finish_drag, step_pose_solver
from app.editor.project import Project
from app.editor.session import Session, with_project
from app.editor.work.drag_session import DragSession, DragStart, TargetChange, absolute_targets
from app.texts import _
from engine.deform import BoundedPull


@with_project
def drag_handles(
    session: Session,
    project: Project,
    change: TargetChange | Mapping[int, Target],
    *,
    gesture: object | None = None,
    hand: BoundedPull | None = None,
) -> None:
    """Set targets of handles in the pose of the present frame; other targets stay.

    Drags of one gesture are one undo step, and a later target replaces an earlier one. A gesture
    holds the drag until the release. A missing in-between is computed first; targets set meanwhile
    are kept. `hand` pulls with bounded force.
    """
    wanted = change if callable(change) else partial(absolute_targets, change)
    _change(session, project, gesture, lambda held, by: held.change_targets(by, wanted, hand))


@with_project
def move_pose(
    session: Session, project: Project, way: complex, *, gesture: object | None = None
) -> None:
    """Move the pose of the present frame with all its targets, by `way` from the start.

    Moves of one gesture are one undo step.
    """
    _change(session, project, gesture, lambda held, by: held.move(by, way))


def _change(
    session: Session,
    project: Project,
    gesture: object | None,
    change: Callable[[DragSession, object], None],
) -> None:
    """Change the drag of the present pose, or begin one."""
    drag, history = project.visible_drag, project.history
    if drag is None and project.drag is not None:
        history.interrupt()
    is_fixed = project.layer_runtime.shown is None or project.layer.still
    if is_fixed or history.has_ended(gesture):
        return
    if drag is None or not history.is_held:
        drag = _begin(session, project, gesture)
    change(drag, gesture or object())
    if drag is not project.drag:
        history.begin(drag.gesture, _("Pose"), partial(finish_drag, session, project))
        project.pending.add(drag)
    if gesture is not None:
        history.hold(drag.gesture, gesture)
    step_pose_solver(session, project)


@with_project
def release_drag(session: Session, project: Project) -> None:  # noqa: ARG001 - of an action
    """End the drag; the solver goes on until the pose rests."""
    if project.drag is not None:
        project.history.release(project.drag.gesture)


@with_project
def release_drag_forced(session: Session, project: Project) -> None:
    """End the drag, and keep its targets even if the handles cannot reach them."""
    if project.drag is not None and project.history.is_held:
        project.drag.force_targets()
    release_drag(session)


def set_targets(session: Session, targets: Mapping[int, Target]) -> None:
    """Set targets of handles from a field of the panel."""
    drag_handles(session, targets)


@named_action(
    _("Pin here"),
    "P",
    icon="THUMBTACK",
    hint=_("Keep the selected handles where they are in this frame"),
    why_disabled=UNLESS_HANDLES,
)
@with_project
def pin_selected_handles(session: Session, project: Project) -> None:
    """Set the targets of the selected handles to their present places."""
    selected = project.selection.handles

    def here(start: DragStart, targets: Mapping[int, Target]) -> Mapping[int, Target]:
        known = selected & targets.keys()
        return {i: replace(targets[i], position=start.places[i]) for i in known}

    if selected:
        drag_handles(session, here)


@with_project
def nudge_handles(session: Session, project: Project, step: complex) -> None:
    """Move the targets of the selected handles by `step` in pixels of the picture."""
    handles = project.layer.handles
    moved = {h.id for h in handles if h.id in project.selection.handles and not h.locked}

    def away(_: DragStart, targets: Mapping[int, Target]) -> Mapping[int, Target]:
        known = moved & targets.keys()
        return {i: replace(targets[i], position=targets[i].position + step) for i in known}

    if moved:
        drag_handles(session, away)


def free_rotation(session: Session, identity: int) -> None:
    """Let the solver choose the rotation of the shape at a handle."""

    def free(_: DragStart, targets: Mapping[int, Target]) -> Mapping[int, Target]:
        known = {identity} & targets.keys()
        return {i: replace(targets[i], rotation=None) for i in known}

    drag_handles(session, free)


@with_project
def solve_pose_again(
    session: Session, project: Project, asked: Mapping[int, Target], *, gesture: object
) -> None:
    """Solve the shown pose for its targets again, for example under other limits.

    The handles in `asked` are pulled to these targets with bounded force.
    """
    if pose_at_playhead(session, project) is not None:
        drag_handles(
            session, asked, gesture=gesture, hand=BoundedPull(frozenset(asked)) if asked else None
        )
        release_drag(session)


@with_project
def revert_drag(session: Session, project: Project, gesture: object) -> None:
    """Undo the targets of a gesture; the drag that it began, or without other targets, ends."""
    drag = project.drag
    if drag is not None and gesture in drag.target_changes:
        drag.revert(gesture)
        project.history.release(drag.gesture)
        if gesture is drag.gesture or not drag.target_changes:
            drop_drag(session, project, drag)


def _begin(session: Session, project: Project, gesture: object | None) -> DragSession:
    """Begin a drag of the pose at the present frame.

    Changes without a gesture, such as presses of an arrow key, continue an unfinished drag. So does
    each change before the first pose is found. Any other earlier drag is committed first.
    """
    playback.stop_playback(session)
    frame, shown = playback.edited_frame(session, project), playback.current_frame(session, project)
    if frame != shown:
        session.notices.show(
            _("Frame {shown} repeats frame {frame}. A pose here changes every repeat.").format(
                shown=shown, frame=frame
            ),
            topic="repeat",
        )
    drag = project.visible_drag
    if drag is not None and drag.newest is None:
        session.jobs.drop(POSING)
        drag.clip, drag.start = project.clip, _start(session, project)
        return drag
    if drag is not None and gesture is None and drag.is_stepped:
        return drag
    finish_drag(session, project)
    return DragSession(
        clip=project.clip,
        frame=frame,
        gesture=gesture or object(),
        is_stepped=gesture is None,
        start=_start(session, project),
        before=pose_at_playhead(session, project),
        is_keyed=session.settings.preferences.auto_key,
        easing=session.settings.preferences.easing,
    )


def _start(session: Session, project: Project) -> DragStart | None:
    """Return the start of a drag; None if its in-between is not computed yet.

    With tracks or springs, shown handles differ from the pose, so the in-between is computed.
    """
    pose, shown, layer = (
        pose_at_playhead(session, project),
        project.layer_runtime.shown,
        project.layer,
    )
    if pose is not None:
        return DragStart.of(layer, pose)
    frame = playback.current_frame(session, project)
    if shown is None or not shown.is_current or shown.frame != frame or shown.clip != project.clip:
        return None
    if layer.tracks or layer.springs or layer.sliders:
        return None
    identities = [handle.id for handle in layer.handles]
    places = shown.handle_positions.tolist()
    return DragStart.at(
        dict(zip(identities, places, strict=True)),
        dict(zip(identities, shown.handle_rotations, strict=True)),
        {},
    )


def pose_at_playhead(session: Session, project: Project) -> Pose | None:
    """Return the layer's pose at the present frame; None for an in-between."""
    if project.unkeyed_pose is not None:
        return project.unkeyed_pose
    clip = project.clip
    return keyed_pose_at(clip, segment_time_at(clip, playback.current_frame(session, project)))
