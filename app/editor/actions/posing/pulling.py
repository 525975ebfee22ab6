"""Pulling handles: the wish comes from the pointer, the worker's solver follows."""

from collections.abc import Mapping
from dataclasses import replace
from functools import partial

import numpy as np

from app.document import Target
from app.editor.actions import playback
from app.editor.actions.posing.steps import POSING, end, follow, hold, retargeted
from app.editor.actions.posing.waiting import give_up, waits
from app.editor.project import PoseInProgress, Project
from app.editor.session import Session


def pull(session: Session, wishes: Mapping[int, Target], *, gesture: object | None = None) -> None:
    """Wish handles elsewhere in the pose that is shown; the others keep their wishes.

    Pulls of one gesture are one step of undo; without one, each is a step until it is let go. What
    is not prepared yet is pulled as soon as it is.
    """
    project = session.project
    if project is None or project.puppet.shown is None:
        return
    if waits(session, partial(pull, wishes=wishes, gesture=gesture), gesture=gesture):
        return
    if project.posing is None or not project.posing.is_held:
        _keep_found(session, project)
        project.posing, project.settling = _begin(session, project, gesture or object()), None
    posing = project.posing
    targets = posing.targets
    posing.targets = {**targets, **{i: _instead_of(targets.get(i), wishes[i]) for i in wishes}}
    posing.steps = 0
    follow(session, project, posing)


def let_go(session: Session) -> None:
    """End the pull; the solver goes on until it rests."""
    if session.project and session.project.awaiting:
        waits(session, let_go)
    elif session.project and session.project.posing:
        posing = session.project.posing
        posing.is_held = False
        if POSING not in session.jobs.kinds:
            end(session.project, posing)


def drop(session: Session) -> None:
    """End the pull where the solver is, or before it began."""
    if session.project:
        give_up(session, session.project)
    if session.project and session.project.is_posing:
        _keep_found(session, session.project)
        session.jobs.drop(POSING)
        session.project.posing = session.project.settling = None


def _keep_found(session: Session, project: Project) -> None:
    """Let the document have how far a pose has come that the playhead left, unless it is another's.

    It has been seen so, before the playhead left it.
    """
    left = project.settling
    if left is None or left.found is None or left.taken is None:
        return
    if any(key.frame == left.frame and key.pose is left.taken for key in project.figure.keys):
        hold(session, project, left.frame, left.found, gesture=left.gesture)


def pin_here(session: Session) -> None:
    """Let the selected handles be wanted where they are, wherever they were wanted before."""
    project = session.project
    shown = project.puppet.shown if project else None
    if project is None or shown is None or not project.selected or waits(session, pin_here):
        return
    wishes = wishes_of(project)
    places = zip(shown.clip.figure.handles, shown.handle_places, strict=True)
    pull(
        session,
        {
            handle.id: replace(wishes[handle.id], position=complex(place))
            for handle, place in places
            if handle.id in project.selected
        },
    )
    let_go(session)


def nudge(session: Session, step: complex) -> None:
    """Move the selected handles by a few pixels of the picture."""
    project = session.project
    if project is None or project.puppet.shown is None or not project.selected:
        return
    if waits(session, partial(nudge, step=step)):
        return
    targets = project.posing.targets if project.posing else wishes_of(project)
    moved = {
        handle.id: replace(targets[handle.id], position=targets[handle.id].position + step)
        for handle in project.figure.handles
        if handle.id in project.selected and not handle.locked
    }
    if moved:
        pull(session, moved)
        let_go(session)


def wish(session: Session, wishes: Mapping[int, Target]) -> None:
    """Wish handles elsewhere, as a field of the panel says."""
    pull(session, wishes)
    let_go(session)


def pull_again(session: Session, *, gesture: object) -> None:
    """Let the pose that is shown follow its own wishes once more, as under other limits."""
    project = session.project
    if waits(session, partial(pull_again, gesture=gesture)):
        return
    if project and project.puppet.shown and project.puppet.shown.pose:
        pull(session, project.puppet.shown.pose.targets, gesture=gesture)
        let_go(session)


def free_turn(session: Session, identity: int) -> None:
    """Let the shape turn freely at a handle in the pose that is shown."""
    project = session.project
    if project is None or project.puppet.shown is None:
        return
    if waits(session, partial(free_turn, identity=identity)):
        return
    targets = project.posing.targets if project.posing else wishes_of(project)
    pull(session, {identity: replace(targets[identity], rotation=None)})
    let_go(session)


def _begin(session: Session, project: Project, gesture: object) -> PoseInProgress:
    playback.halt(session)
    session.jobs.drop(POSING)
    frame = playback.current_frame(session, project)
    pose = project.unkeyed or (project.puppet.shown.pose if project.puppet.shown else None)
    return PoseInProgress(frame=frame, targets=wishes_of(project), start=pose, gesture=gesture)


def wishes_of(project: Project) -> Mapping[int, Target]:
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


def _instead_of(target: Target | None, wish: Target) -> Target:
    """Return a wish with what a later version wrote about the target that it replaces."""
    return wish if target is None else replace(wish, unknown=target.unknown)
