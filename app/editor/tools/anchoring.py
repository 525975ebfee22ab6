"""Setting the anchor, the point of the shape that in-betweens follow."""

from dataclasses import dataclass
from typing import Self

from app.editor.actions import posing
from app.editor.session import Hint, Mark, Session
from app.editor.tools.tool import Selection, Spot, take_back


@dataclass(slots=True, kw_only=True, eq=False)
class Anchoring:
    """The pointer has set the anchor; until it is let go, that can be taken back."""

    before: Selection

    @classmethod
    def hints(cls, session: Session, spot: Spot) -> tuple[Hint, ...]:  # noqa: ARG003 - as a tool's
        """Tell that a click with Ctrl sets it."""
        if spot.on_ring:
            return ()
        if spot.handle is not None:
            return (Hint("click", "for the anchor", "ctrl"),)
        return (Hint("click", "to put the anchor here", "ctrl"),) if spot.on_shape else ()

    @classmethod
    def press(cls, session: Session, spot: Spot) -> Self | None:
        """Set it where the shape is pressed; the handle that is it already gives it back."""
        if session.project is None or not spot.ctrl or spot.on_ring:
            return None
        anchoring = cls(before=Selection.of(session.project))
        if spot.handle is not None:
            posing.anchor_at(session, spot.handle, gesture=anchoring)
        elif spot.on_shape:
            posing.put_anchor(session, spot.place, gesture=anchoring)
        else:
            return None
        return anchoring

    def move(self, session: Session, place: complex) -> None:
        """Leave it where it was set."""

    def type(self, session: Session, characters: str) -> None:
        """Take nothing."""

    def end(self, session: Session, place: complex) -> None:
        """Leave it where it was set."""

    def cancel(self, session: Session) -> None:
        """Put it back where it was."""
        take_back(session, self, self.before)

    @property
    def marks(self) -> tuple[Mark, ...]:
        """Nothing: the anchor is shown as it is."""
        return ()

    @property
    def ways(self) -> tuple[Hint, ...]:
        """Return what can be done until it ends."""
        return ()
