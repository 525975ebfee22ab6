"""Turning the shape around a handle, by the ring around it or by a key."""

import cmath
import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Self

from app.document import Target
from app.editor.actions import editing, posing
from app.editor.pull import Start
from app.editor.session import EntryMark, Hint, Mark, Session, SweepMark
from app.editor.tools.entry import TypedWay
from app.editor.tools.tool import Selection, Spot, is_away, take_back

STEP = math.radians(15.0)  # of turning in steps
LEAST_ARM = 12.0  # pixels of the screen from a handle, within which a press has no direction


@dataclass(slots=True, kw_only=True, eq=False)
class Turning:
    """The pointer turns the shape around a handle.

    Parameters
    ----------
    handle : int
    centre : complex
        Where that is.
    start : complex
        Where the pointer was pressed.
    before : Selection
    turn : float
        By how much the shape was turned there at the start, in radians.
    deletes : bool
        Whether a click, which turns nothing, deletes the handle.
    swept : float
        By how much the pointer has turned it, in radians.
    entry : TypedWay
        How many degrees are typed meanwhile.
    moved : bool
    """

    handle: int
    centre: complex
    start: complex
    before: Selection
    turn: float
    deletes: bool
    swept: float = 0.0
    entry: TypedWay = field(default_factory=TypedWay)
    moved: bool = False

    @classmethod
    def hints(cls, session: Session, spot: Spot) -> tuple[Hint, ...]:
        """Tell how the shape is turned."""
        if spot.on_ring:
            return (Hint("drag", "to turn the shape around the handle"),)
        project = session.project
        if project is None or spot.handle is None or project.figure.is_locked(spot.handle):
            return ()
        # Of both gestures the one that no window manager takes for itself, as many do Alt+drag.
        return (Hint("drag its ring", "to turn"),)

    @classmethod
    def press(cls, session: Session, spot: Spot) -> Self | None:
        """Take hold of the ring around the selected handle, or of a handle with Alt."""
        project = session.project
        shown = project.puppet.shown if project else None
        if project is None or shown is None:
            return None
        is_by_key = spot.handle is not None and spot.alt and not (spot.ctrl or spot.shift)
        if not is_by_key and not (spot.on_ring and len(project.selected) == 1):
            return None
        before = Selection.of(project)
        handle = spot.handle if is_by_key else next(iter(project.selected))
        identities = [handle.id for handle in shown.clip.figure.handles]
        if handle is None or handle not in identities or project.figure.is_locked(handle):
            return None
        editing.select(session, frozenset({handle}))
        index = identities.index(handle)
        return cls(
            handle=handle,
            centre=complex(shown.handle_places[index]),
            start=spot.place,
            before=before,
            turn=shown.handle_turns[index],
            deletes=is_by_key,
        )

    def move(self, session: Session, place: complex) -> None:
        """Turn the shape as far as the pointer goes around the handle, maybe in steps."""
        project = session.project
        if project is None or not (self.moved or is_away(session, self.start, place)):
            return
        if not self.moved:
            arm = abs(self.start - self.centre) * project.view(session.screen).scale
            if arm < LEAST_ARM:
                # From so near, the direction in which it leaves is where the turn begins.
                self.start = place
        self.moved = True
        swept = (place - self.centre) / (self.start - self.centre or 1)
        if swept and self.entry.value is None:
            angle = cmath.phase(swept)
            self.swept = STEP * round(angle / STEP) if session.snaps else angle
            self._turn(session)

    def type(self, session: Session, characters: str) -> None:
        """Turn the shape by as many degrees as are typed."""
        self.entry.take(characters)
        self.entry.axis = ""
        if session.project is not None and self.entry.value is not None:
            self.moved = True
            self.swept = math.radians(self.entry.value)
            self._turn(session)

    def _turn(self, session: Session) -> None:
        project, handle, swept = session.project, self.handle, self.swept
        if project is None or handle not in {each.id for each in project.figure.handles}:
            return

        def turned(start: Start, targets: Mapping[int, Target]) -> Mapping[int, Target]:
            if handle not in targets:
                return {}
            place, turn = start.places[handle], start.turns[handle] + swept
            return {handle: Target(position=place, rotation=turn)}

        posing.pull(session, turned, gesture=self)

    def end(self, session: Session, place: complex) -> None:  # noqa: ARG002 - as a tool's
        """Let the shape go; delete the handle that was only clicked."""
        if self.deletes and not self.moved:
            posing.remove_handles(session, frozenset({self.handle}))
        else:
            posing.let_go(session)

    def cancel(self, session: Session) -> None:
        """Turn the shape back."""
        take_back(session, self, self.before)

    @property
    def marks(self) -> tuple[Mark, ...]:
        """How far it is turned, and what was typed."""
        sweep = SweepMark(handle=self.handle, turn=self.turn + self.swept, swept=self.swept)
        if not self.entry.text:
            return (sweep,)
        return (sweep, EntryMark(place=self.centre, direction=None, text=self.entry.words("°")))

    @property
    def ways(self) -> tuple[Hint, ...]:
        """Return what can be done until it ends."""
        return (Hint("turn", "by steps of 15°", "ctrl"), Hint("type", "a number of degrees"))
