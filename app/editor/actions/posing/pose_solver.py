"""The solver of a drag: jobs of a few Newton steps, until the pose rests and is committed."""

from collections.abc import Callable, Mapping, Sequence
from functools import partial
from math import inf
from typing import NamedTuple

from app.document import (
    Clip,
    Pose,
    Target,
    UnfinishedStepError,
    keyed_pose_at,
    segment_time_at,
)
from app.editor.actions import playback
from app.editor.actions.posing.pose_commit import POSING, commit_drag, drop_drag, preview_pose
from app.editor.actions.posing.reach_limit import clamp_unreachable_targets
from app.editor.error_reports import report_failure, run_job
from app.editor.project import Project
from app.editor.session import Session, with_project
from app.editor.work.drag_session import (
    MOST_STEPS,
    DragSession,
    DragStart,
    TargetChange,
    combine_targets,
    find_changed_handles,
)
from app.errors import EXPECTED_ERRORS
from app.motion import PoseSampler
from app.solving import DragSolver, Rig, fit_shown_pose
from engine.deform import BoundedPull

# During a drag: the most Newton steps of one job, and the seconds after which the job begins no
# further step, so that the next picture shows its result.
STEPS, HASTE = 2, 0.004
# After the release: the seconds of one job, as many as fit between two pictures.
REST = 0.012
AWAITED = 0.1  # the same while a command waits for the pose, so that the worker loses less time


def update_drag(session: Session, project: Project) -> None:
    """Show the newest pose of the drag, and commit it when it rests; once a frame."""
    drag = project.drag
    if drag is None:
        return
    is_here = is_drag_at_playhead(session, project, drag)
    if not is_here:
        project.history.interrupt()
    if drag.newest is not None and (is_here or drag.preview is None):
        preview_pose(project, drag, drag.newest)
    if not project.history.is_held and _is_final(project, drag) and drag.newest is not None:
        commit_drag(session, project, drag, drag.newest)
    else:
        step_pose_solver(session, project)


def finish_drag(session: Session, project: Project) -> None:
    """Solve an unfinished drag to rest on this thread, and commit it.

    Another change of the document follows. So the drag ends even if it is held, and later moves of
    its hand are void. Raises `UnfinishedStepError` after the history's patience; the worker then
    goes on.
    """
    drag = project.drag
    if drag is None:
        return
    session.jobs.drop(POSING)
    project.history.interrupt()
    until = session.clock() + project.history.patience
    try:
        while not _is_final(project, drag):
            left = until - session.clock()
            # The first step may need an in-between, however long it takes.
            if left <= 0 or (left < inf and drag.solver is None):
                drag.note_awaited()
                raise UnfinishedStepError
            pace = _pace(drag)._replace(seconds=left)
            _take(project, drag, _work(session, project, drag, pace)())
    except EXPECTED_ERRORS as error:
        drop_drag(session, project, drag)
        report_failure(session, POSING.complaint, error)
        return
    if drag.newest is not None:
        commit_drag(session, project, drag, drag.newest)


@with_project
def stop_finishing_pose(session: Session, project: Project) -> None:
    """End the drag for which a command waits, with the pose as it is."""
    drag = project.drag
    if drag is None or not drag.is_awaited:
        return
    if drag.newest is None:
        drop_drag(session, project, drag)
    else:
        commit_drag(session, project, drag, drag.newest)


def _is_final(project: Project, drag: DragSession) -> bool:
    """Return whether the pose rests, with unreachable targets clamped; for a released drag."""
    if drag.is_at_rest and drag.dragged_targets:
        clamp_unreachable_targets(project, drag)
    return drag.is_at_rest


def step_pose_solver(session: Session, project: Project) -> None:
    """Queue the next steps of the drag, unless such a job is queued."""
    drag = project.drag
    if drag is None or drag.is_at_rest or POSING in session.jobs.kinds:
        return
    # A drag at another frame goes on once the shown frame is final, or if a command waits for it.
    if not (
        project.history.is_held
        or drag.is_awaited
        or is_drag_at_playhead(session, project, drag)
        or is_display_final(session, project)
    ):
        return

    def failed(error: Exception) -> None:
        if drag in project.pending.changes:
            drop_drag(session, project, drag)
            report_failure(session, POSING.complaint, error)

    def done(steps: _Steps) -> None:
        if session.project is project and drag in project.pending.changes:
            session.diagnostics.note_solver_time(steps.seconds)
            _take(project, drag, steps)
            update_drag(session, project)

    run_job(session, POSING, _work(session, project, drag, _pace(drag)), done, failed)


def is_drag_at_playhead(session: Session, project: Project, drag: DragSession) -> bool:
    """Return whether the playhead rests on a drag's frame, where all its poses are shown."""
    if project.timeline.playhead.since is not None:
        return False
    frame = playback.current_frame(session, project)
    return project.document.layer(drag.layer).source_of(frame) == drag.frame


def is_display_final(session: Session, project: Project) -> bool:
    """Return whether the shown frame is final, or its final version has failed."""
    shown, store = project.layer_runtime.shown, project.layer_runtime.store
    has_failed = store.has_failed(project.clip) or store.has_failed(project.clip, "correction")
    if project.unkeyed_pose is not None or has_failed:
        return True
    if shown is None or shown.placeholder is not None:
        return False
    if project.timeline.playhead.since is not None:
        # During playback the shown frame is always a moment late, and corrections are not computed.
        return True
    return not shown.is_approximate and shown.frame == playback.current_frame(session, project)


class _Pace(NamedTuple):
    """The most Newton steps of one job, and the seconds after which it begins no further step."""

    most: int
    seconds: float


def _pace(drag: DragSession) -> _Pace:
    """Return the pace: each step is shown during a drag; after the release the solver hurries."""
    if drag.is_rigid:
        return _Pace(0, 0.0)
    if drag.steps == 0:
        return _Pace(STEPS, HASTE)
    return _Pace(MOST_STEPS, AWAITED if drag.is_awaited else REST)


class _Steps(NamedTuple):
    """The state of a drag after a job: its targets, Newton steps and seconds.

    `start` is set if the job had to compute it.
    """

    solver: DragSolver
    targets: Mapping[int, Target]
    hands: tuple[BoundedPull, ...]
    taken: int
    seconds: float
    start: DragStart | None


def _work(
    session: Session, project: Project, drag: DragSession, pace: _Pace
) -> Callable[[], _Steps]:
    """Return the function that takes the next steps of a drag."""
    runtime = project.runtimes.layers[drag.layer]
    begin = partial(_begin, drag.clip, drag.frame, drag.before, runtime.rig, runtime.store.sampler)
    aim = drag.targets if drag.targets is not None else tuple(drag.target_changes.values())
    hands = tuple(drag.dragged_targets.values())
    return partial(
        _take_steps, drag.solver or begin, aim, hands, drag.dragged_handles, pace, session.clock
    )


def _take_steps(
    solver: DragSolver | Callable[[], tuple[DragSolver, Pose]],
    aim: Mapping[int, Target] | Sequence[TargetChange],
    hands: tuple[BoundedPull, ...],
    pulled: frozenset[int],
    pace: _Pace,
    clock: Callable[[], float],
) -> _Steps:
    """Advance a drag, or begin it."""
    begun, start = clock(), None
    if not isinstance(solver, DragSolver):
        solver, pose = solver()
        start = DragStart.of(solver.rig.layer, pose)
    if isinstance(aim, Mapping):
        targets = aim
    elif start is not None:
        targets, pulled = combine_targets(start, aim), find_changed_handles(start, aim)
    else:
        raise ValueError("a drag that goes on has targets")
    taken = 0
    while taken < pace.most and (
        taken == 0 or not (solver.is_over or clock() - begun >= pace.seconds)
    ):
        solver = solver.step_towards(targets, 1, hands, pulled)
        taken += 1
    return _Steps(solver, targets, hands, taken, clock() - begun, start)


def _begin(
    clip: Clip, frame: int, before: Pose | None, rig: Rig | None, sibling: PoseSampler | None
) -> tuple[DragSolver, Pose]:
    """Return a drag solver for a pose or the in-between at a frame, and its start pose."""
    rig = Rig.of(clip.layer, rig)
    pose = (
        before
        or keyed_pose_at(clip, segment_time_at(clip, frame))
        or fit_shown_pose(rig, clip, frame, sibling)
    )
    return DragSolver.begin(rig, pose), pose


def _take(project: Project, drag: DragSession, steps: _Steps) -> None:
    """Store the result of some steps."""
    project.runtimes.layers[drag.layer].rig = steps.solver.rig
    if drag.start is None:
        drag.start = steps.start
        drag.update_targets(drag.target_changes)
    towards = (steps.targets, steps.hands)
    if (drag.targets, tuple(drag.dragged_targets.values())) == towards:
        drag.steps += steps.taken
    drag.solver, drag.solved = steps.solver, towards
    drag.take(steps.solver.make_pose(steps.targets))
