"""Choosing the layer to pose by a click on it."""

from dataclasses import dataclass
from typing import Self

from app.editor import layering
from app.editor.session import Hint, Mark, Session
from app.editor.tools.tool import Spot


@dataclass(slots=True, kw_only=True, eq=False)
class Choosing:
    """The pointer has chosen a layer; it does nothing more until it is let go.

    Parameters
    ----------
    before : int
        The one that was posed.
    """

    before: int

    @classmethod
    def hints(cls, session: Session, spot: Spot) -> tuple[Hint, ...]:
        """Tell which layer a click chooses."""
        figure = _other(session, spot)
        if session.project is None or figure is None:
            return ()
        return (Hint("click", f"to pose {session.project.document.figure(figure).name}"),)

    @classmethod
    def press(cls, session: Session, spot: Spot) -> Self | None:
        """Choose the layer that is seen there, if it is another one."""
        figure = _other(session, spot)
        if session.project is None or figure is None:
            return None
        choosing = cls(before=session.project.active)
        layering.choose(session, figure)
        return choosing

    def move(self, session: Session, place: complex) -> None:
        """Do nothing."""

    def type(self, session: Session, characters: str) -> None:
        """Take nothing."""

    def end(self, session: Session, place: complex) -> None:
        """Leave it at that."""

    def cancel(self, session: Session) -> None:
        """Go back to the layer that was posed."""
        layering.choose(session, self.before)

    @property
    def marks(self) -> tuple[Mark, ...]:
        """Nothing: the handles of the layer show it."""
        return ()

    @property
    def ways(self) -> tuple[Hint, ...]:
        """Return what can be done until it ends."""
        return ()


def _other(session: Session, spot: Spot) -> int | None:
    """Return the layer that a press at a spot is for, if it is not the one that is posed."""
    project = session.project
    if project is None or spot.handle is not None or spot.on_ring or spot.ctrl or spot.shift:
        return None
    return None if spot.figure in {None, project.active} else spot.figure
