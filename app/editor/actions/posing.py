"""Pulling handles: the wish comes from the pointer, the worker's solver follows."""

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from app.document import Clip, Figure, Pose, Target, figure_commands, handle_commands, key_commands
from app.editor.actions import playback
from app.editor.failures import report
from app.editor.jobs import Job
from app.editor.session import Grab, Project, Session
from app.motion import Shown
from app.solving import Drag, Rig, pose_at

POSING, INSERTING = "Posing", "Inserting a key"
# Newton steps of one job at most, and the seconds after which it begins no other: what it has found
# by then is in the next picture.
STEPS, HASTE = 2, 0.004
# Steps after the hand let go; a drag that is free to come to rest needs far fewer.
MOST_STEPS = 300
# Part of a pose's lag that another pose may have at most to take its place: less would be a jump
# for little.
MUCH_LESS = 0.5


def pull(session: Session, wishes: Mapping[int, Target]) -> None:
    """Wish handles elsewhere in the pose that is shown; the others keep their wishes."""
    project = session.project
    if project is None or project.puppet.shown is None:
        return
    if project.grab is None or not project.grab.held:
        project.grab, project.settling = _grab(session, project), None
    grab = project.grab
    targets = grab.targets
    grab.targets = {**targets, **{i: _instead_of(targets.get(i), wishes[i]) for i in wishes}}
    grab.steps = 0
    _follow(session, project, grab)


def let_go(session: Session) -> None:
    """End the pull; the solver goes on until it rests."""
    if session.project and session.project.grab:
        grab = session.project.grab
        grab.held = False
        if POSING not in session.jobs.kinds:
            _finish(session, session.project, grab)


def settle(session: Session) -> None:
    """Bring a pose to rest that the playhead has left; called once a frame."""
    project = session.project
    if project and project.settling and POSING not in session.jobs.kinds:
        _finish(session, project, project.settling)


def drop(session: Session) -> None:
    """End the pull where the solver is."""
    if session.project and session.project.is_posing:
        session.jobs.drop(POSING)
        session.project.grab = session.project.settling = None


def nudge(session: Session, step: complex) -> None:
    """Move the selected handles by a few pixels of the picture."""
    project = session.project
    if project is None or project.puppet.shown is None or not project.selected:
        return
    targets = project.grab.targets if project.grab else _wishes(project)
    moved = {
        identity: replace(targets[identity], position=targets[identity].position + step)
        for identity in project.selected
    }
    pull(session, moved)
    let_go(session)


def add_handle(session: Session, place: complex) -> None:
    """Add a handle where the shape is at a place of the screen's plane; nothing moves."""
    project = session.project
    if project is None or project.puppet.shown is None:
        return
    drop(session)
    rest = _at_rest(project.puppet.shown, place)
    identity = project.figure.next_handle
    project.history.do(handle_commands.add_handle(project.active, rest))
    if project.unkeyed is not None:
        project.unkeyed = _retargeted(project.figure, project.unkeyed)
    project.selected, project.chosen = frozenset({identity}), frozenset()


def remove_handles(session: Session, identities: frozenset[int]) -> None:
    """Delete handles; every pose stays as it is."""
    project = session.project
    if project is None:
        return
    drop(session)
    project.history.do(handle_commands.remove_handles(project.active, identities))
    project.selected -= identities
    if project.unkeyed is not None:
        project.unkeyed = _retargeted(project.figure, project.unkeyed)


def anchor_at(session: Session, identity: int) -> None:
    """Make a handle's point the anchor, or let the engine choose again if it is already."""
    project = session.project
    if project is None:
        return
    place = project.figure.handle(identity).position
    project.history.do(
        figure_commands.set_anchor(
            project.active, None if project.figure.anchor == place else place
        )
    )


def put_anchor(session: Session, place: complex) -> None:
    """Make the shape's point at a place of the screen's plane the anchor."""
    project = session.project
    if project and project.puppet.shown:
        project.history.do(
            figure_commands.set_anchor(project.active, _at_rest(project.puppet.shown, place))
        )


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
    targets = project.grab.targets if project.grab else _wishes(project)
    pull(session, {identity: replace(targets[identity], rotation=None)})
    let_go(session)


def insert_key(session: Session) -> None:
    """Hold the pose that is shown in a key at the present frame."""
    project = session.project
    if project is None:
        return
    drop(session)
    clip = project.clip
    frame = playback.current_frame(session, project)
    playback.halt(session)
    if project.unkeyed is not None:
        _hold(project, frame, project.unkeyed, gesture=None)
        project.unkeyed = None
    elif frame not in clip.figure.key_frames:
        rig, sibling = Rig.of(clip.figure, project.puppet.rig), project.puppet.coarse.sampler
        session.jobs.put(
            Job(
                kind=INSERTING,
                work=lambda: pose_at(rig, clip, frame, sibling),
                done=lambda pose: _insert(session, project, clip, frame, pose),
                failed=lambda error: report(session, "The key could not be inserted", error),
                urgent=True,
            )
        )
    else:
        session.tell(f"Frame {frame} has a key already. Drag a handle to change it.")


def _insert(session: Session, project: Project, clip: Clip, frame: int, pose: Pose) -> None:
    if project is session.project and project.clip == clip:
        project.history.do(key_commands.insert_key(project.active, frame, pose))
        project.chosen = frozenset({frame})


def _grab(session: Session, project: Project) -> Grab:
    playback.halt(session)
    session.jobs.drop(POSING)
    frame = playback.current_frame(session, project)
    pose = project.unkeyed or (project.puppet.shown.pose if project.puppet.shown else None)
    return Grab(frame=frame, targets=_wishes(project), pose=pose)


def _wishes(project: Project) -> Mapping[int, Target]:
    """Return what is wished of each handle of the figure in the pose that is shown.

    What is shown may be a frame behind the document, and not know its newest handles.
    """
    shown, figure = project.puppet.shown, project.figure
    pose = project.unkeyed or (shown.pose if shown else None)
    if pose is not None:
        return _retargeted(figure, pose).targets
    if shown is None:
        return {}
    rest = np.array([handle.position for handle in figure.handles], dtype=np.complex128)
    places = shown.mesh.locate(rest, shown.mesh.domain.mesh.vertices).on(shown.positions)
    return {
        handle.id: Target(position=complex(place))
        for handle, place in zip(figure.handles, places, strict=True)
    }


def _follow(session: Session, project: Project, grab: Grab) -> None:
    """Let the worker go on, unless it is at it: then it goes on when that is delivered."""
    if POSING in session.jobs.kinds:
        return
    targets, drag, clip = grab.targets, grab.anew or grab.drag, project.clip
    rig, sibling = project.puppet.rig, project.puppet.coarse.sampler
    clock = session.clock

    def work() -> tuple[Drag, int, float]:
        begun = clock()
        start = drag
        if start is None:
            mine = Rig.of(clip.figure, rig)
            pose = grab.pose or pose_at(mine, clip, grab.frame, sibling)
            start = Drag.begin(mine, pose)
        steps = 0
        while steps == 0 or (steps < STEPS and not start.is_over and clock() - begun < HASTE):
            start = start.towards(targets, 1)
            steps += 1
        return start, steps, clock() - begun

    def done(result: tuple[Drag, int, float]) -> None:
        if session.project is not project or grab not in (project.grab, project.settling):
            return
        drag, steps, session.solver_seconds = result
        project.puppet.rig = drag.rig
        grab.steps += steps
        if grab.anew is None:
            grab.drag = drag
            _keep(session, project, grab, targets)
        else:
            grab.anew = drag
        rests = drag.is_over and grab.targets == targets
        if not rests and (grab.held or grab.steps < MOST_STEPS):
            _follow(session, project, grab)
        elif not grab.held:
            _finish(session, project, grab)

    def failed(error: Exception) -> None:
        _end(project, grab)
        report(session, "This pose could not be found", error)

    session.jobs.put(Job(kind=POSING, work=work, done=done, failed=failed, urgent=True))


def _keep(session: Session, project: Project, grab: Grab, targets: Mapping[int, Target]) -> None:
    """Put the solver's newest map into the document, or show it unkeyed."""
    if grab.drag is None:
        return
    pose = grab.drag.pose(targets)
    if session.preferences.auto_key or grab is project.settling:
        _hold(project, grab.frame, pose, gesture=grab)
        project.unkeyed = None
    else:
        project.unkeyed = pose


def _hold(project: Project, frame: int, pose: Pose, gesture: object) -> None:
    if frame in project.figure.key_frames:
        project.history.do(key_commands.pose_key(project.active, frame, pose), gesture=gesture)
    else:
        project.history.do(key_commands.insert_key(project.active, frame, pose), gesture=gesture)


def _finish(session: Session, project: Project, grab: Grab) -> None:
    """End a pull that was let go and rests; one that is held back is tried from rest, too."""
    drag, anew = grab.drag, grab.anew
    if drag is not None and anew is None and not drag.has_arrived:
        grab.anew, grab.steps = Drag.from_rest(drag.rig), 0
        _follow(session, project, grab)
        return
    if drag is not None and anew is not None and anew.lag < MUCH_LESS * drag.lag:
        grab.drag = anew
        _keep(session, project, grab, grab.targets)
    _end(project, grab)


def _end(project: Project, grab: Grab) -> None:
    if project.grab is grab:
        project.grab = None
    if project.settling is grab:
        project.settling = None


def _instead_of(target: Target | None, wish: Target) -> Target:
    """Return a wish with what a later version wrote about the target that it replaces."""
    return wish if target is None else replace(wish, unknown=target.unknown)


def _retargeted(figure: Figure, pose: Pose) -> Pose:
    """Return a pose with a target for each handle of a figure: its own, or where it is."""
    places = figure.map_of(pose)(
        np.array([handle.position for handle in figure.handles], dtype=np.complex128)
    )
    targets = {
        handle.id: pose.targets.get(handle.id, Target(position=complex(place)))
        for handle, place in zip(figure.handles, places, strict=True)
    }
    return replace(pose, targets=targets)
