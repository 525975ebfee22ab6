"""Pose drags: targets come from the pointer, and the worker's solver follows."""

from collections.abc import Callable, Mapping
from dataclasses import replace
from functools import partial

from app.document import Pose, Target, keyed_pose_at, segment_time_at
from app.editor.actions import playback
from app.editor.actions.action_spec import UNLESS_HANDLES, named_action
from app.editor.actions.posing.pose_commit import commit_pose
from app.editor.actions.posing.pose_solver import POSING, step_pose_solver
from app.editor.project import Project
from app.editor.session import Session, with_project
from app.editor.work.pull import DragStart, Pull, TargetChange, absolute_targets
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

    Drags of one gesture are one undo step, and a later target replaces an earlier one. Without a
    gesture, each drag until its release is a step. A missing in-between is computed first; targets
    set meanwhile are kept. `hand` pulls with bounded force.
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
    change: Callable[[Pull, object], None],
) -> None:
    """Change the held drag, or begin a drag."""
    if project.layer_runtime.shown is None:
        return
    held = project.pull
    if held is None or not held.is_held:
        release_drag(session)
        held = _begin(session, project, gesture or object())
    change(held, gesture or object())
    held.position = project.history.position
    step_pose_solver(session, project)


@with_project
def release_drag(session: Session, project: Project) -> None:  # noqa: ARG001 - of an action
    """End the drag; the solver goes on until the pose rests."""
    for pull in project.pulls:
        pull.is_held = False


@with_project
def release_drag_forced(session: Session, project: Project) -> None:  # noqa: ARG001 - of an action
    """End the drag, and keep its targets even if the handles cannot reach them."""
    for pull in project.pulls:
        if pull.is_held:
            pull.is_held = False
            pull.force_targets()


def set_targets(session: Session, targets: Mapping[int, Target]) -> None:
    """Set targets of handles from a field of the panel."""
    _once(session, targets)


@named_action(
    "pin here",
    _("Pin here"),
    "P",
    icon="THUMBTACK",
    hint=_("Keep the selected handles where they are in this frame"),
    why_disabled=UNLESS_HANDLES,
)
@with_project
def pin_selected_handles(session: Session, project: Project) -> None:
    """Set the targets of the selected handles to their present places."""
    selected = project.selected_handles

    def here(start: DragStart, targets: Mapping[int, Target]) -> Mapping[int, Target]:
        known = selected & targets.keys()
        return {i: replace(targets[i], position=start.places[i]) for i in known}

    if selected:
        _once(session, here)


@with_project
def nudge_handles(session: Session, project: Project, step: complex) -> None:
    """Move the targets of the selected handles by `step` in pixels of the picture."""
    handles = project.layer.handles
    moved = {h.id for h in handles if h.id in project.selected_handles and not h.locked}

    def away(_: DragStart, targets: Mapping[int, Target]) -> Mapping[int, Target]:
        known = moved & targets.keys()
        return {i: replace(targets[i], position=targets[i].position + step) for i in known}

    if moved:
        _once(session, away)


def free_rotation(session: Session, identity: int) -> None:
    """Let the solver choose the rotation of the shape at a handle."""

    def free(_: DragStart, targets: Mapping[int, Target]) -> Mapping[int, Target]:
        known = {identity} & targets.keys()
        return {i: replace(targets[i], rotation=None) for i in known}

    _once(session, free)


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
    """Undo the targets of a gesture.

    A drag without other targets ends, and its history step is undone.
    """
    for pull in project.pulls:
        if gesture in pull.target_changes:
            pull.revert(gesture)
            pull.is_held = False
            if not pull.target_changes:
                cancel_drag(session, project, pull)
                project.history.revert(pull.gesture)


def cancel_drag(session: Session, project: Project, pull: Pull) -> None:
    """End a drag; its pose in the document stays, and no later pose is committed."""
    if pull not in project.pending:
        # The drag has ended together with another cancelled drag.
        return
    project.pending.remove(pull)
    # The job's result is dropped.
    session.jobs.drop(POSING)
    step_pose_solver(session, project)


def end_drag_at(session: Session, project: Project, pull: Pull, pose: Pose) -> None:
    """Commit a pose instead of the result of a drag."""
    cancel_drag(session, project, pull)
    commit_pose(session, project, pull, pose)


def _once(session: Session, change: TargetChange | Mapping[int, Target]) -> None:
    drag_handles(session, change)
    release_drag(session)


def _begin(session: Session, project: Project, gesture: object) -> Pull:
    """Begin a drag of the pose at the present frame."""
    playback.stop_playback(session)
    frame, shown = playback.edited_frame(session, project), playback.current_frame(session, project)
    if frame != shown:
        session.notices.show(
            _("Frame {shown} repeats frame {frame}. A pose here changes every repeat.").format(
                shown=shown, frame=frame
            ),
            topic="repeat",
        )
    here = (project.active, frame)
    pulls = [pull for pull in project.pulls if (pull.layer, pull.frame) == here]
    earlier = pulls[-1] if pulls else None
    start = _start(session, project, earlier)
    if earlier is not None and earlier.kept is None:
        # No pose of the earlier drag is visible yet, so the new targets join it.
        session.jobs.drop(POSING)
        earlier.clip, earlier.start, earlier.is_held = project.clip, start, True
        return earlier
    before = pose_at_playhead(session, project)
    begun = Pull(
        clip=project.clip,
        frame=frame,
        gesture=gesture,
        start=start,
        before=before,
        is_keyed=session.settings.preferences.auto_key,
        rests=earlier is None or earlier.is_settled,
    )
    project.pending.append(begun)
    return begun


def _start(session: Session, project: Project, earlier: Pull | None) -> DragStart | None:
    """Return the start of a drag; None if its in-between is not computed yet.

    With tracks or springs, shown handles differ from the pose, so the in-between is computed. If an
    earlier drag of the same pose is not at rest, its last targets are used.
    """
    pose, shown, layer = (
        pose_at_playhead(session, project),
        project.layer_runtime.shown,
        project.layer,
    )
    if pose is not None:
        if earlier is not None and earlier.kept is not None and earlier.world_targets is not None:
            is_its_own = earlier.kept.phi is pose.phi
            targets = {**earlier.world_targets, **earlier.reached} if is_its_own else pose.targets
            pose = replace(pose, targets=targets)
        return DragStart.of(layer, pose)
    frame = playback.current_frame(session, project)
    if shown is None or not shown.is_current or shown.frame != frame or shown.clip != project.clip:
        return None
    if layer.tracks or layer.springs:
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
