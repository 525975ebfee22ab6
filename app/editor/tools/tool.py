"""What a tool is: it takes a press, and then has the pointer until the button is let go."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Protocol, Self

from app.editor.actions import editing
from app.editor.project import Project
from app.editor.session import Hint, Session, ToolInHand

CLICK = 3.0  # pixels of the screen that a click may wander


@dataclass(frozen=True, slots=True, kw_only=True)
class Spot:
    """Where the pointer is, and what is under it.

    Parameters
    ----------
    place : complex
        In the plane.
    handle : int, optional
        The one under it.
    on_axis : bool
        Whether it is on the grip of the axis at which poses are flipped.
    on_anchor : bool
        Whether it is on the anchor of the figure that is posed.
    on_ring : bool
        Whether it is on the ring around the selected handle.
    on_shape : bool
        Whether it is on the figure that is posed.
    figure : int, optional
        The figure that is seen there; with Alt held the next one behind the one that is posed.
    ctrl, shift, alt : bool
        Which keys are held.
    """

    place: complex
    handle: int | None = None
    on_axis: bool = False
    on_anchor: bool = False
    on_ring: bool = False
    on_shape: bool = False
    figure: int | None = None
    ctrl: bool = False
    shift: bool = False
    alt: bool = False


class Tool(ToolInHand, Protocol):
    """Something that the pointer does; an instance has it in hand, from press to release."""

    @classmethod
    def hints(cls, session: Session, spot: Spot) -> tuple[Hint, ...]:
        """Return what it would do at a spot, in words."""

    @classmethod
    def press(cls, session: Session, spot: Spot) -> Self | None:
        """Begin at a spot; None where it is for another tool."""


@dataclass(frozen=True, slots=True)
class Selection:
    """What was selected when a gesture began."""

    handles: frozenset[int]
    keys: Mapping[int, frozenset[int]]

    @classmethod
    def of(cls, project: Project) -> Self:
        """Return what is selected now."""
        return cls(project.selected, project.chosen_of)


def take_back(session: Session, gesture: ToolInHand, before: Selection) -> None:
    """Undo what a gesture did to the document and to the selection."""
    if session.project:
        session.project.selected, session.project.chosen_of = before.handles, before.keys
        editing.take_back(session, gesture)


def is_away(session: Session, start: complex, place: complex) -> bool:
    """Tell whether the pointer has gone farther than a click may."""
    if session.project is None:
        return False
    return abs(place - start) * session.project.view(session.screen).scale > CLICK
