"""Jobs that solve a pose, a few Newton steps at a time, with each step committed."""

from collections.abc import Callable, Mapping, Sequence
from functools import partial
from typing import NamedTuple

from app.document import Clip, Pose, Target, keyed_pose_at, segment_time_at
from app.editor.actions import playback
from app.editor.actions.posing.pose_commit import commit_pose
from app.editor.error_reports import report_failure, run_job
from app.editor.project import Project
from app.editor.session import Session
from app.editor.work.jobs import JobKind
from app.editor.work.pull import (
    MOST_STEPS,
    DragStart,
    Pull,
    TargetChange,
    combine_targets,
    find_changed_handles,
)
from app.motion import PoseSampler
from app.solving import DragSolver, Rig, fit_shown_pose
from app.texts import _
from engine.deform import BoundedPull

POSING = JobKind(_("Posing"), _("This pose could not be found"), "hand")
# During a drag: the most Newton steps of one job, and the seconds after which the job begins no
# further step, so that the next picture shows its result.
STEPS, HASTE = 2, 0.004
# After the release: the seconds of one job, as many as fit between two pictures.
REST = 0.012


def step_pose_solver(session: Session, project: Project) -> None:
    """Queue the next steps of the most urgent drag, unless such a job is queued."""
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
    # A drag at another frame goes on once the shown frame is final.
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

    runtime = project.layer_runtimes.get(pull.layer)
    begin = partial(
        _begin,
        pull.clip,
        pull.frame,
        pull.before,
        None if runtime is None else runtime.rig,
        None if runtime is None else runtime.store.sampler,
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
    """Return whether the playhead rests on a drag's frame, where all its poses are shown."""
    frame = playback.current_frame(session, project)
    if project.playhead.since is not None or pull.layer not in project.layer_runtimes:
        return False
    return project.document.layer(pull.layer).source_of(frame) == pull.frame


def is_display_final(session: Session, project: Project) -> bool:
    """Return whether the shown frame is final, or its final version has failed."""
    shown, store = project.layer_runtime.shown, project.layer_runtime.store
    has_failed = store.has_failed(project.clip) or store.has_failed(project.clip, "correction")
    if project.unkeyed_pose is not None or has_failed:
        return True
    if shown is None or shown.placeholder is not None:
        return False
    if project.playhead.since is not None:
        # During playback the shown frame is always a moment late, and corrections are not computed.
        return True
    return not shown.is_approximate and shown.frame == playback.current_frame(session, project)


class _Pace(NamedTuple):
    """The most Newton steps of one job, and the seconds after which it begins no further step."""

    most: int
    seconds: float


def _pace(pull: Pull) -> _Pace:
    """Return the pace: each step is shown during a drag; after the release the solver hurries."""
    if pull.is_rigid:
        return _Pace(0, 0.0)
    return _Pace(STEPS, HASTE) if pull.steps == 0 else _Pace(MOST_STEPS, REST)


class _Steps(NamedTuple):
    """The state of a drag after a job: its targets, Newton steps and seconds.

    `start` is set if the job had to compute it.
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
    """Advance a drag, or begin it; on the worker thread."""
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
    """Return a drag solver for a pose or the in-between at a frame, and its start pose."""
    rig = Rig.of(clip.layer, rig)
    pose = (
        before
        or keyed_pose_at(clip, segment_time_at(clip, frame))
        or fit_shown_pose(rig, clip, frame, sibling)
    )
    return DragSolver.begin(rig, pose), pose


def _note(session: Session, project: Project, pull: Pull, steps: _Steps) -> None:
    """Store the result of a job, and queue the next job if the drag is not at rest."""
    if session.project is not project or pull not in project.pending:
        return
    session.diagnostics.note_solver_time(steps.seconds)
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
