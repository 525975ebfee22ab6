"""The worker's way to a pose: a few Newton steps at a time, each taken into the document."""

from collections.abc import Callable, Mapping, Sequence
from functools import partial
from typing import NamedTuple

from app.document import Clip, Pose, Target, keyed_pose_at, segment_time_at
from app.editor.actions import playback
from app.editor.actions.posing.pose_commit import commit_pose
from app.editor.error_reports import report_failure, run_job
from app.editor.project import Project
from app.editor.session import Session
from app.editor.work import (
    MOST_STEPS,
    DragStart,
    JobKind,
    Pull,
    TargetChange,
    combine_targets,
    find_changed_handles,
)
from app.motion import PoseSampler
from app.solving import DragSolver, Rig, fit_shown_pose
from engine.deform import BoundedPull

POSING = JobKind("Posing", "This pose could not be found", "hand")
# While the hand moves: Newton steps of one job at most, and the seconds after which it begins no
# other: what it has found by then is in the next picture.
STEPS, HASTE = 2, 0.004
# While the hand rests: the seconds of one job, as many as fit between two pictures.
REST = 0.012


def step_pose_solver(session: Session, project: Project) -> None:
    """Let the worker, unless it is busy with a pull, go on with the one that is wanted most."""
    if POSING in session.jobs.kinds:
        return
    moving = [pull for pull in project.pulls if not pull.is_at_rest]
    if not moving:
        return

    def urgency(pull: Pull) -> tuple[bool, bool, bool]:
        return (
            pull.is_held,
            is_drag_at_playhead(session, project, pull),
            pull.is_in(project.history),
        )

    pull = max(moving, key=urgency)
    # One that the playhead has left goes on once what is shown is there.
    if not (
        pull.is_held
        or is_drag_at_playhead(session, project, pull)
        or is_display_final(session, project)
    ):
        return

    def failed(error: Exception) -> None:
        if pull in project.pending:
            project.pending.remove(pull)
            report_failure(session, POSING.complaint, error)

    puppet = project.layer_runtimes.get(pull.layer)
    begin = partial(
        _begin,
        pull.clip,
        pull.frame,
        pull.before,
        None if puppet is None else puppet.rig,
        None if puppet is None else puppet.store.sampler,
    )
    aim = pull.targets if pull.targets is not None else tuple(pull.target_changes.values())
    hands = tuple(pull.dragged_targets.values())
    work = partial(
        _take_steps,
        pull.drag or begin,
        aim,
        hands,
        pull.dragged_handles,
        _pace(pull),
        session.clock,
    )
    run_job(session, POSING, work, partial(_note, session, project, pull), failed)


def is_drag_at_playhead(session: Session, project: Project, pull: Pull) -> bool:
    """Tell whether the playhead rests on a pull's frame, where each of its poses is shown."""
    frame = playback.current_frame(session, project)
    if project.playhead.since is not None or pull.layer not in project.layer_runtimes:
        return False
    return project.document.layer(pull.layer).source_of(frame) == pull.frame


def is_display_final(session: Session, project: Project) -> bool:
    """Tell whether what belongs at the playhead is shown, or is known never to be."""
    shown, store = project.layer_runtime.shown, project.layer_runtime.store
    has_failed = store.has_failed(project.clip) or store.has_failed(project.clip, "correction")
    if project.unkeyed_pose is not None or has_failed:
        return True
    if shown is None or shown.placeholder is not None:
        return False
    if project.playhead.since is not None:
        # What is shown is always that of a moment ago, and nothing finds its own corrections.
        return True
    return not shown.is_approximate and shown.frame == playback.current_frame(session, project)


class _Pace(NamedTuple):
    """How many Newton steps the worker may take at once, and for how many seconds it begins one."""

    most: int
    seconds: float


def _pace(pull: Pull) -> _Pace:
    """Return the pace: while the hand moves, every step is shown; at rest, it is hurried."""
    if pull.is_rigid:
        return _Pace(0, 0.0)
    return _Pace(STEPS, HASTE) if pull.steps == 0 else _Pace(MOST_STEPS, REST)


class _Steps(NamedTuple):
    """Where the worker has come with a drag, towards what, in how many Newton steps and seconds.

    The start is what it began with, where it had to be worked out.
    """

    drag: DragSolver
    targets: Mapping[int, Target]
    hands: tuple[BoundedPull, ...]
    taken: int
    seconds: float
    start: DragStart | None


def _take_steps(
    drag: DragSolver | Callable[[], tuple[DragSolver, Pose]],
    aim: Mapping[int, Target] | Sequence[TargetChange],
    hands: tuple[BoundedPull, ...],
    pulled: frozenset[int],
    pace: _Pace,
    clock: Callable[[], float],
) -> _Steps:
    """Go on with a drag, or begin it; on the worker thread."""
    begun, start = clock(), None
    if not isinstance(drag, DragSolver):
        drag, pose = drag()
        start = DragStart.of(drag.rig.layer, pose)
    if isinstance(aim, Mapping):
        targets = aim
    elif start is not None:
        targets, pulled = combine_targets(start, aim), find_changed_handles(start, aim)
    else:
        raise ValueError("a drag that goes on has targets")
    taken = 0
    while taken < pace.most and (
        taken == 0 or not (drag.is_over or clock() - begun >= pace.seconds)
    ):
        drag = drag.step_towards(targets, 1, hands, pulled)
        taken += 1
    return _Steps(drag, targets, hands, taken, clock() - begun, start)


def _begin(
    clip: Clip, frame: int, before: Pose | None, rig: Rig | None, sibling: PoseSampler | None
) -> tuple[DragSolver, Pose]:
    """Return the drag that begins with a pose, or with what is shown at a frame; and that pose."""
    rig = Rig.of(clip.layer, rig)
    pose = (
        before
        or keyed_pose_at(clip, segment_time_at(clip, frame))
        or fit_shown_pose(rig, clip, frame, sibling)
    )
    return DragSolver.begin(rig, pose), pose


def _note(session: Session, project: Project, pull: Pull, steps: _Steps) -> None:
    """Take note of where the worker has come, and let it go on if there is more to do."""
    if session.project is not project or pull not in project.pending:
        return
    session.solver_seconds = steps.seconds
    if pull.layer in project.layer_runtimes:
        project.layer_runtimes[pull.layer].rig = steps.drag.rig
    if pull.start is None:
        pull.start = steps.start
        pull.update_targets()
    towards = (steps.targets, steps.hands)
    if (pull.targets, tuple(pull.dragged_targets.values())) == towards:
        pull.steps += steps.taken
    pull.drag, pull.solved = steps.drag, towards
    newest = pull.take(steps.drag.make_pose(steps.targets))
    if pull.kept is None or is_drag_at_playhead(session, project, pull):
        commit_pose(session, project, pull, newest)
    step_pose_solver(session, project)
