"""Cutting out by hand: a round brush that keeps or removes, a pipette, and clicks on holes."""

from dataclasses import dataclass
from typing import Self

import numpy as np

from app.editor.actions import cutting
from app.editor.session import Hint, Mark, Session, StrokeMark
from app.editor.tools.tool import Spot
from engine.domain import Stroke

STEP = 0.12  # of the brush's radius: points of a stroke are no nearer together


@dataclass(slots=True, kw_only=True, eq=False)
class Brushing:
    """The pointer draws a stroke; it is done when the button is let go.

    Parameters
    ----------
    places : list of complex
        Its way so far.
    radius : float
    keeps : bool
    """

    places: list[complex]
    radius: float
    keeps: bool

    @classmethod
    def hints(cls, session: Session, spot: Spot) -> tuple[Hint, ...]:  # noqa: ARG003 - as a tool's
        """Tell what the brush does, and how it is changed."""
        if session.cutting not in {"keep", "remove"}:
            return ()
        other = "remove" if session.cutting == "keep" else "keep"
        return (
            Hint("drag", f"to {session.cutting}"),
            Hint("drag", f"to {other}", "alt"),
            Hint("[ and ]", "for its size"),
            Hint("X", "to swap"),
        )

    @classmethod
    def press(cls, session: Session, spot: Spot) -> Self | None:
        """Begin a stroke; with Alt, one that does the opposite."""
        project = session.project
        if project is None or session.cutting not in {"keep", "remove"}:
            return None
        keeps = (session.cutting == "keep") != spot.alt
        return cls(places=[spot.place], radius=cutting.brush_radius(project), keeps=keeps)

    def move(self, session: Session, place: complex) -> None:  # noqa: ARG002 - as a tool's
        """Go on to the pointer."""
        if abs(place - self.places[-1]) >= STEP * self.radius:
            self.places.append(place)

    def type(self, session: Session, characters: str) -> None:
        """Take nothing."""

    def end(self, session: Session, place: complex) -> None:
        """Keep or remove what it covers."""
        if session.project is None:
            return
        if place != self.places[-1]:
            self.places.append(place)
        points = np.array(self.places) - session.project.figure.corner
        cutting.brush(session, Stroke(points=points, radius=self.radius, keeps=self.keeps))

    def cancel(self, session: Session) -> None:
        """Forget it: nothing was done yet."""

    @property
    def marks(self) -> tuple[Mark, ...]:
        """What it covers."""
        return (StrokeMark(points=tuple(self.places), radius=self.radius, keeps=self.keeps),)

    @property
    def ways(self) -> tuple[Hint, ...]:
        """Return what can be done until it ends."""
        return ()


@dataclass(slots=True, kw_only=True, eq=False)
class Pointing:
    """A click that picks the background's colour, or swaps a hole; done when it is let go."""

    place: complex

    @classmethod
    def hints(cls, session: Session, spot: Spot) -> tuple[Hint, ...]:  # noqa: ARG003 - as a tool's
        """Tell what a click does."""
        match session.cutting:
            case "pick":
                return (Hint("click", "on the background to remove its colour"),)
            case "holes":
                return (Hint("click", "in a hole to keep it open, or to fill it"),)
            case _:
                return ()

    @classmethod
    def press(cls, session: Session, spot: Spot) -> Self | None:
        """Begin a click."""
        return cls(place=spot.place) if session.cutting in {"pick", "holes"} else None

    def move(self, session: Session, place: complex) -> None:  # noqa: ARG002 - as a tool's
        """Click elsewhere."""
        self.place = place

    def type(self, session: Session, characters: str) -> None:
        """Take nothing."""

    def end(self, session: Session, place: complex) -> None:
        """Pick the colour, or swap the hole."""
        act = cutting.pick if session.cutting == "pick" else cutting.swap_hole
        act(session, place)

    def cancel(self, session: Session) -> None:
        """Forget it: nothing was done yet."""

    @property
    def marks(self) -> tuple[Mark, ...]:
        """Nothing."""
        return ()

    @property
    def ways(self) -> tuple[Hint, ...]:
        """Return what can be done until it ends."""
        return ()
