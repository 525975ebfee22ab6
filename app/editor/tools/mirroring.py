"""Moving the axis at which poses are flipped."""

from dataclasses import dataclass, field
from typing import Self

from app.editor.poses import flipping
from app.editor.session import EntryMark, Hint, Mark, Session
from app.editor.tools.entry import TypedWay
from app.editor.tools.tool import Selection, Spot, take_back


@dataclass(slots=True, kw_only=True, eq=False)
class Mirroring:
    """The pointer moves the axis; what was flipped last is flipped again where it is let go.

    Parameters
    ----------
    axis : float
        Where it was.
    start, place : complex
        Where the pointer was pressed, and where it is.
    before : Selection
    typed : TypedWay
    """

    axis: float
    start: complex
    place: complex
    before: Selection
    typed: TypedWay = field(default_factory=TypedWay)

    @classmethod
    def hints(cls, session: Session, spot: Spot) -> tuple[Hint, ...]:  # noqa: ARG003 - as a tool's
        """Tell what the axis is for."""
        return (Hint("drag", "to flip poses at another place"),) if spot.on_axis else ()

    @classmethod
    def press(cls, session: Session, spot: Spot) -> Self | None:
        """Take hold of the axis."""
        project = session.project
        if project is None or not spot.on_axis:
            return None
        before = Selection.of(project)
        return cls(axis=project.figure.axis, start=spot.place, place=spot.place, before=before)

    def move(self, session: Session, place: complex) -> None:
        """Move the axis as far as the pointer goes sideways."""
        self.place = place
        self._move(session)

    def type(self, session: Session, characters: str) -> None:
        """Move it as far as is typed."""
        self.typed.take(characters)
        self._move(session)

    def _move(self, session: Session) -> None:
        self.typed.axis = "x"
        way = self.typed.way(self.place - self.start).real
        flipping.move_axis(session, self.axis + way, gesture=self)

    def end(self, session: Session, place: complex) -> None:  # noqa: ARG002 - as a tool's
        """Flip again."""
        flipping.flip_again(session, gesture=self)

    def cancel(self, session: Session) -> None:
        """Put the axis back."""
        take_back(session, self, self.before)

    @property
    def marks(self) -> tuple[Mark, ...]:
        """What was typed."""
        if not self.typed.text:
            return ()
        return (EntryMark(place=self.start, direction=None, text=self.typed.words("px")),)

    @property
    def ways(self) -> tuple[Hint, ...]:
        """Return what can be done until it ends."""
        return (Hint("type", "a number of pixels"),)
