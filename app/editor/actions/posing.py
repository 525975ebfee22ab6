"""Pulling handles: the wish comes from the pointer, the worker's solver follows."""

from collections.abc import Callable, Mapping
from dataclasses import replace
from functools import partial
from typing import NamedTuple

import numpy as np

from app.document import (
    Clip,
    Command,
    Figure,
    Pose,
    Target,
    UnkeyedPose,
    figure_commands,
    handle_commands,
    key_commands,
)
from app.editor.actions import playback
from app.editor.failures import report
from app.editor.jobs import Job
from app.editor.project import PoseInProgress, Project
from app.editor.session import Session
from app.motion import PoseSampler, Shown
from app.solving import Drag, Rig, pose_at

POSING, INSERTING = "Posing", "Inserting a key"
# While the hand moves: Newton steps of one job at most, and the seconds after which it begins no
# other: what it has found by then is in the next picture.
STEPS, HASTE = 2, 0.004
# While the hand rests: the seconds of one job, as many as fit between two pictures.
REST = 0.012
# Steps towards one wish; a drag comes to rest in far fewer.
MOST_STEPS = 600


def pull(session: Session, wishes: Mapping[int, Target], *, gesture: object | None = None) -> None:
    """Wish handles elsewhere in the pose that is shown; the others keep their wishes.

    Pulls of one gesture are one step of undo; without one, each is a step until it is let go.
    """
    project = session.project
    if project is None or project.puppet.shown is None:
        return
    if project.posing is None or not project.posing.is_held:
        project.posing, project.settling = _begin(session, project, gesture or object()), None
    posing = project.posing
    targets = posing.targets
    posing.targets = {**targets, **{i: _instead_of(targets.get(i), wishes[i]) for i in wishes}}
    posing.steps = 0
    _follow(session, project, posing)


def let_go(session: Session) -> None:
    """End the pull; the solver goes on until it rests."""
    if session.project and session.project.posing:
        posing = session.project.posing
        posing.is_held = False
        if POSING not in session.jobs.kinds:
            _end(session.project, posing)


def settle(session: Session) -> None:
    """Bring a pose to rest that the playhead has left; called once a frame."""
    project = session.project
    if project and project.settling and POSING not in session.jobs.kinds:
        _end(project, project.settling)


def drop(session: Session) -> None:
    """End the pull where the solver is."""
    if session.project and session.project.is_posing:
        session.jobs.drop(POSING)
        session.project.posing = session.project.settling = None


def nudge(session: Session, step: complex) -> None:
    """Move the selected handles by a few pixels of the picture."""
    project = session.project
    if project is None or project.puppet.shown is None or not project.selected:
        return
    targets = project.posing.targets if project.posing else _wishes(project)
    moved = {
        identity: replace(targets[identity], position=targets[identity].position + step)
        for identity in project.selected
    }
    pull(session, moved)
    let_go(session)


def add_handle(session: Session, place: complex, *, gesture: object | None = None) -> None:
    """Add a handle where the shape is at a place of the screen's plane; nothing moves."""
    project = session.project
    if project is None or project.puppet.shown is None:
        return
    drop(session)
    rest = _at_rest(project.puppet.shown, place)
    identity = project.figure.next_handle
    _change_handles(project, handle_commands.add_handle(project.active, rest), gesture or object())
    project.selected, project.chosen = frozenset({identity}), frozenset()


def remove_handles(
    session: Session, identities: frozenset[int], *, gesture: object | None = None
) -> None:
    """Delete handles; every pose stays as it is."""
    project = session.project
    if project is None:
        return
    drop(session)
    command = handle_commands.remove_handles(project.active, identities)
    _change_handles(project, command, gesture or object())
    project.selected -= identities


def _change_handles(project: Project, command: Command, gesture: object) -> None:
    """Add or delete handles, in the pose that no key holds as well."""
    project.history.do(command, gesture=gesture)
    unkeyed = project.history.unkeyed
    if unkeyed is not None:
        pose = retargeted(project.figure, unkeyed.pose)
        project.history.pose(replace(unkeyed, pose=pose), gesture=gesture)


def anchor_at(session: Session, identity: int, *, gesture: object | None = None) -> None:
    """Make a handle's point the anchor, or let the engine choose again if it is already."""
    project = session.project
    if project is None:
        return
    place = project.figure.handle(identity).position
    project.history.do(
        figure_commands.set_anchor(
            project.active, None if project.figure.anchor == place else place
        ),
        gesture=gesture,
    )


def put_anchor(session: Session, place: complex, *, gesture: object | None = None) -> None:
    """Make the shape's point at a place of the screen's plane the anchor."""
    project = session.project
    if project and project.puppet.shown:
        rest = _at_rest(project.puppet.shown, place)
        project.history.do(figure_commands.set_anchor(project.active, rest), gesture=gesture)


def _at_rest(shown: Shown, place: complex) -> complex:
    """Return where the point that is shown at a place is in the drawing at rest."""
    found = shown.mesh.locate(np.array([place]), shown.positions)
    return complex(found.on(shown.mesh.domain.mesh.vertices)[0])


def wish(session: Session, wishes: Mapping[int, Target]) -> None:
    """Wish handles elsewhere, as a field of the panel says."""
    pull(session, wishes)
    let_go(session)


def free_turn(session: Session, identity: int) -> None:
    """Let the shape turn freely at a handle in the pose that is shown."""
    project = session.project
    if project is None or project.puppet.shown is None:
        return
    targets = project.posing.targets if project.posing else _wishes(project)
    pull(session, {identity: replace(targets[identity], rotation=None)})
    let_go(session)


def insert_key(session: Session) -> None:
    """Hold the pose that is shown in a key at the present frame."""
    project = session.project
    if project is None:
        return
    drop(session)
    frame = playback.current_frame(session, project)
    playback.halt(session)
    if project.unkeyed is not None:
        hold(project, frame, project.unkeyed, gesture=object())
    elif frame not in project.figure.key_frames:
        complaint = "The key could not be inserted"
        fit_pose(session, project, INSERTING, complaint, partial(_insert, session, project))
    else:
        session.tell(f"Frame {frame} has a key already. Drag a handle to change it.")


def fit_pose(
    session: Session,
    project: Project,
    kind: str,
    complaint: str,
    take: Callable[[Clip, int, Pose], None],
) -> None:
    """Let the worker find the pose that is nearest to what the present frame shows."""
    clip, frame = project.clip, playback.current_frame(session, project)
    rig, sibling = Rig.of(clip.figure, project.puppet.rig), project.puppet.coarse.value.sampler
    session.jobs.put(
        Job(
            kind=kind,
            work=lambda: pose_at(rig, clip, frame, sibling),
            done=lambda pose: take(clip, frame, pose),
            failed=lambda error: report(session, complaint, error),
            urgent=True,
        )
    )


def _insert(session: Session, project: Project, clip: Clip, frame: int, pose: Pose) -> None:
    if project is session.project and project.clip == clip:
        project.history.do(key_commands.insert_key(project.active, frame, pose))
        project.chosen = frozenset({frame})


def _begin(session: Session, project: Project, gesture: object) -> PoseInProgress:
    playback.halt(session)
    session.jobs.drop(POSING)
    frame = playback.current_frame(session, project)
    pose = project.unkeyed or (project.puppet.shown.pose if project.puppet.shown else None)
    return PoseInProgress(frame=frame, targets=_wishes(project), start=pose, gesture=gesture)


def _wishes(project: Project) -> Mapping[int, Target]:
    """Return what is wished of each handle of the figure in the pose that is shown.

    What is shown may be a frame behind the document, and not know its newest handles.
    """
    shown, figure = project.puppet.shown, project.figure
    pose = project.unkeyed or (shown.pose if shown else None)
    if pose is not None:
        return retargeted(figure, pose).targets
    if shown is None:
        return {}
    rest = np.array([handle.position for handle in figure.handles], dtype=np.complex128)
    places = shown.mesh.locate(rest, shown.mesh.domain.mesh.vertices).on(shown.positions)
    return {
        handle.id: Target(position=complex(place))
        for handle, place in zip(figure.handles, places, strict=True)
    }


def _follow(session: Session, project: Project, posing: PoseInProgress) -> None:
    """Let the worker go on, unless it is at it: then it goes on when that is delivered."""
    if POSING in session.jobs.kinds:
        return
    puppet, targets = project.puppet, posing.targets
    begin = partial(
        _drag_from,
        posing.start,
        posing.frame,
        project.clip,
        puppet.rig,
        puppet.coarse.value.sampler,
    )

    def failed(error: Exception) -> None:
        _end(project, posing)
        report(session, "This pose could not be found", error)

    session.jobs.put(
        Job(
            kind=POSING,
            work=partial(_take_steps, posing.drag, begin, targets, _pace(posing), session.clock),
            done=partial(_go_on, session, project, posing, targets),
            failed=failed,
            urgent=True,
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
    _accept(session, project, steps.drag.pose(targets), posing)
    rests = steps.drag.is_over and posing.targets == targets
    if not rests and posing.steps < MOST_STEPS:
        _follow(session, project, posing)
    elif not posing.is_held:
        _end(project, posing)


def _accept(session: Session, project: Project, pose: Pose, posing: PoseInProgress) -> None:
    """Put the solver's newest map into the document, or show it unkeyed."""
    if session.preferences.auto_key or posing is project.settling:
        hold(project, posing.frame, pose, gesture=posing.gesture)
    else:
        unkeyed = UnkeyedPose(figure=project.active, frame=posing.frame, pose=pose)
        project.history.pose(unkeyed, gesture=posing.gesture)


def hold(project: Project, frame: int, pose: Pose, gesture: object) -> None:
    """Let a key hold a pose; none is left there that no key holds."""
    has_key = frame in project.figure.key_frames
    command = (key_commands.pose_key if has_key else key_commands.insert_key)(
        project.active, frame, pose
    )
    project.history.do(command, gesture=gesture)
    unkeyed = project.history.unkeyed
    if unkeyed is not None and (unkeyed.figure, unkeyed.frame) == (project.active, frame):
        project.history.pose(None, gesture=gesture)


def _end(project: Project, posing: PoseInProgress) -> None:
    if project.posing is posing:
        project.posing = None
    if project.settling is posing:
        project.settling = None


def _instead_of(target: Target | None, wish: Target) -> Target:
    """Return a wish with what a later version wrote about the target that it replaces."""
    return wish if target is None else replace(wish, unknown=target.unknown)


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
