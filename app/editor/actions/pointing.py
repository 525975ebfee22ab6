"""Gestures of the pointer in the viewport, from press to release."""

import cmath
from dataclasses import replace

from app.document import Target
from app.editor.actions import editing, posing
from app.editor.session import Boxing, Gesture, Project, Pulling, Session, Turning

LEAST_ARM = 12.0  # pixels of the screen from a handle, within which a press has no direction
CLICK = 3.0  # pixels of the screen that a click may wander


def begin(session: Session, gesture: Gesture) -> None:
    """Begin a gesture; a pull takes hold of the selected handles where they are."""
    project = session.project
    if project is None or project.puppet.shown is None:
        return
    if isinstance(gesture, Pulling):
        gesture = replace(gesture, places=_places(project))
    session.pointer = gesture


def add_handle(session: Session, place: complex) -> None:
    """Add a handle under the pointer, and take hold of it."""
    posing.add_handle(session, place)
    if session.project:
        held = tuple((identity, place) for identity in session.project.selected)
        session.pointer = Pulling(start=place, places=held)


def move(session: Session, place: complex) -> None:
    """Follow the pointer to another place of the plane."""
    gesture, project = session.pointer, session.project
    if project is None or gesture is None or isinstance(gesture, Boxing):
        return
    if not gesture.moved and not _is_away(session, project, gesture.start, place):
        return
    if isinstance(gesture, Turning) and not gesture.moved:
        arm = abs(gesture.start - gesture.centre) * project.view(session.screen).scale
        if arm < LEAST_ARM:
            # From so near, the direction in which it leaves is where the turn begins.
            gesture = replace(gesture, start=place)
    session.pointer = gesture = replace(gesture, moved=True)
    if isinstance(gesture, Pulling):
        known = {handle.id for handle in project.figure.handles}
        offset = place - gesture.start
        turns = _wished_turns(project)
        posing.pull(
            session,
            {
                identity: Target(position=start + offset, rotation=turns.get(identity))
                for identity, start in gesture.places
                if identity in known
            },
        )
    else:
        swept = (place - gesture.centre) / (gesture.start - gesture.centre or 1)
        if swept:
            turn = gesture.turn + cmath.phase(swept)
            posing.pull(session, {gesture.identity: Target(position=gesture.centre, rotation=turn)})


def end(session: Session, place: complex) -> None:
    """End the gesture where the pointer is."""
    gesture, project = session.pointer, session.project
    session.pointer = None
    if project is None:
        return
    match gesture:
        case Boxing():
            inside = _inside(project, gesture.start, place)
            select(session, inside | project.selected if gesture.keeps else inside)
        case Turning(moved=False, deletes=True):
            posing.remove_handles(session, frozenset({gesture.identity}))
        case Turning() | Pulling():
            posing.let_go(session)


def select(session: Session, handles: frozenset[int]) -> None:
    """Select these handles and no keys."""
    editing.select(session, handles)


def hover(session: Session, handle: int | None) -> None:
    """Note which handle is under the pointer."""
    session.hovered = handle


def explain(session: Session, hint: str) -> None:
    """Show a hint in the status bar."""
    session.hint = hint


def use_space(session: Session) -> None:
    """Note that Space was held to move the view, so that letting it go does not play."""
    session.space_used = True


def _places(project: Project) -> tuple[tuple[int, complex], ...]:
    """Return where the selected handles are."""
    shown = project.puppet.shown
    if shown is None:
        return ()
    return tuple(
        (handle.id, complex(place))
        for handle, place in zip(shown.clip.figure.handles, shown.handle_places, strict=True)
        if handle.id in project.selected
    )


def _wished_turns(project: Project) -> dict[int, float | None]:
    if project.grab is not None:
        targets = project.grab.targets
    elif project.puppet.shown is not None and project.puppet.shown.pose is not None:
        targets = project.puppet.shown.pose.targets
    else:
        return {}
    return {identity: target.rotation for identity, target in targets.items()}


def _is_away(session: Session, project: Project, start: complex, place: complex) -> bool:
    return abs(place - start) * project.view(session.screen).scale > CLICK


def _inside(project: Project, corner: complex, opposite: complex) -> frozenset[int]:
    if project.puppet.shown is None:
        return frozenset()
    low = complex(min(corner.real, opposite.real), min(corner.imag, opposite.imag))
    high = complex(max(corner.real, opposite.real), max(corner.imag, opposite.imag))
    return frozenset(
        handle.id
        for handle, place in zip(
            project.puppet.shown.clip.figure.handles,
            project.puppet.shown.handle_places,
            strict=True,
        )
        if low.real <= place.real <= high.real and low.imag <= place.imag <= high.imag
    )
