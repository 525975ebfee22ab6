"""The worker's way to a pose: a few Newton steps at a time, each taken into the document."""

from collections.abc import Callable, Mapping
from dataclasses import replace
from functools import partial
from typing import NamedTuple

import numpy as np

from app.document import Clip, Command, Figure, Pose, Target, UnkeyedPose, key_commands
from app.editor.actions.posing.waiting import is_there
from app.editor.failures import report
from app.editor.jobs import Job
from app.editor.project import PoseInProgress, Project
from app.editor.session import Session
from app.motion import PoseSampler
from app.solving import Drag, Rig, pose_at

POSING = "Posing"
# While the hand moves: Newton steps of one job at most, and the seconds after which it begins no
# other: what it has found by then is in the next picture.
STEPS, HASTE = 2, 0.004
# While the hand rests: the seconds of one job, as many as fit between two pictures.
REST = 0.012
# Steps towards one wish; a drag comes to rest in far fewer.
MOST_STEPS = 600


def follow(session: Session, project: Project, posing: PoseInProgress) -> None:
    """Let the worker go on, unless it is at it: then it goes on when that is delivered.

    A pose that the playhead has left goes on once what is shown is there.
    """
    if POSING in session.jobs.kinds:
        return
    posing.is_paused = posing is project.settling and not is_there(session, project)
    if posing.is_paused:
        return
    puppet, targets = project.puppet, posing.targets
    begin = partial(
        _drag_from,
        posing.start,
        posing.frame,
        project.clip,
        puppet.rig,
        puppet.store.sampler,
    )

    def failed(error: Exception) -> None:
        end(project, posing)
        report(session, "This pose could not be found", error)

    session.jobs.put(
        Job(
            kind=POSING,
            work=partial(_take_steps, posing.drag, begin, targets, _pace(posing), session.clock),
            done=partial(_go_on, session, project, posing, targets),
            failed=failed,
            lane="hand",
        )
    )


class _Pace(NamedTuple):
    """How many Newton steps the worker may take at once, and for how many seconds it begins one."""

    most: int
    seconds: float


def _pace(posing: PoseInProgress) -> _Pace:
    """Return the pace that shows every step while the hand moves, and hurries while it rests."""
    has_moved = posing.steps == 0
    return _Pace(STEPS, HASTE) if has_moved else _Pace(MOST_STEPS, REST)


class _Steps(NamedTuple):
    """Where the worker has come with a drag, in how many Newton steps and seconds."""

    drag: Drag
    taken: int
    seconds: float


def _take_steps(
    drag: Drag | None,
    begin: Callable[[], Drag],
    targets: Mapping[int, Target],
    pace: _Pace,
    clock: Callable[[], float],
) -> _Steps:
    """Go on with a drag, or begin it; on the worker thread."""
    begun = clock()
    drag = begin() if drag is None else drag
    taken = 0
    while taken == 0 or (taken < pace.most and not drag.is_over and clock() - begun < pace.seconds):
        drag = drag.towards(targets, 1)
        taken += 1
    return _Steps(drag, taken, clock() - begun)


def _drag_from(
    start: Pose | None, frame: int, clip: Clip, rig: Rig | None, sibling: PoseSampler | None
) -> Drag:
    """Return the drag that begins with a pose, or with what is shown at a frame."""
    rig = Rig.of(clip.figure, rig)
    return Drag.begin(rig, start or pose_at(rig, clip, frame, sibling))


def _go_on(
    session: Session,
    project: Project,
    posing: PoseInProgress,
    targets: Mapping[int, Target],
    steps: _Steps,
) -> None:
    """Take note of where the worker has come, and let it go on if there is more to do."""
    if session.project is not project or posing not in (project.posing, project.settling):
        return
    session.solver_seconds = steps.seconds
    project.puppet.rig = steps.drag.rig
    if posing.targets is targets:
        posing.steps += steps.taken
    posing.drag = steps.drag
    pose = steps.drag.pose(targets)
    if posing is project.settling:
        posing.found = pose
    else:
        accept(session, project, posing.frame, pose, gesture=posing.gesture)
    rests = steps.drag.is_over and posing.targets == targets
    if not rests and posing.steps < MOST_STEPS:
        follow(session, project, posing)
    elif not posing.is_held and posing is not project.settling:
        end(project, posing)


def accept(session: Session, project: Project, frame: int, pose: Pose, gesture: object) -> None:
    """Put a pose that is new into the document, or show it unkeyed."""
    if session.preferences.auto_key:
        hold(session, project, frame, pose, gesture=gesture)
    else:
        unkeyed = UnkeyedPose(figure=project.active, frame=frame, pose=pose)
        project.history.pose(unkeyed, gesture=gesture)


def hold(session: Session, project: Project, frame: int, pose: Pose, gesture: object) -> None:
    """Let a key hold a pose; none is left there that no key holds."""
    project.history.do(holding(session, project, frame, pose), gesture=gesture)
    unkeyed = project.history.unkeyed
    if unkeyed is not None and (unkeyed.figure, unkeyed.frame) == (project.active, frame):
        project.history.pose(None, gesture=gesture)


def holding(session: Session, project: Project, frame: int, pose: Pose) -> Command:
    """Return the command that lets a key hold a pose."""
    if frame in project.figure.key_frames:
        return key_commands.pose_key(project.active, frame, pose)
    return inserting(session, project, frame, pose)


def inserting(session: Session, project: Project, frame: int, pose: Pose) -> Command:
    """Return the command that inserts a key as the person wants new ones."""
    easing = session.preferences.easing
    return key_commands.insert_key(project.active, frame, pose, easing=easing)


def end(project: Project, posing: PoseInProgress) -> None:
    """Take a pose as found: nothing more follows."""
    if project.posing is posing:
        project.posing = None
    if project.settling is posing:
        project.settling = None


def retargeted(figure: Figure, pose: Pose) -> Pose:
    """Return a pose with a target for each handle of a figure: its own, or where it is."""
    places = figure.map_of(pose)(
        np.array([handle.position for handle in figure.handles], dtype=np.complex128)
    )
    targets = {
        handle.id: pose.targets.get(handle.id, Target(position=complex(place)))
        for handle, place in zip(figure.handles, places, strict=True)
    }
    return replace(pose, targets=targets)
