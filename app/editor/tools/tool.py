"""What a tool is: it takes a press, and then has the pointer until the button is let go."""

from abc import ABC, abstractmethod
from dataclasses import dataclass, field
from typing import Self

import numpy as np

from app.editor.actions import editing
from app.editor.project import Project
from app.editor.session import CLICK, Hint, Mark, Session
from app.editor.timeline_view import KeysByRow


@dataclass(frozen=True, slots=True, kw_only=True)
class PointerHit:
    """Where the pointer is, and what is under it."""

    place: complex  # in the plane
    handle: int | None = None  # the one under it
    at_target: bool = False  # whether it is wanted there, and has not arrived
    track_key: int | None = None  # the frame of the key under it, on the path of the chosen track
    on_axis: bool = False  # on the grip of the axis at which poses are flipped
    on_anchor: bool = False  # on the anchor of the layer that is posed
    on_ring: bool = False  # on the ring around the selected handle
    on_shape: bool = False  # on the layer that is posed
    # The one seen there; with Alt held the next one behind the one that is posed.
    layer: int | None = None
    ctrl: bool = False  # which keys are held
    shift: bool = False
    alt: bool = False


@dataclass(frozen=True, slots=True)
class SelectionSnapshot:
    """What was selected when a gesture began."""

    handles: frozenset[int]
    keys: KeysByRow


@dataclass(slots=True, kw_only=True, eq=False)
class Tool(ABC):
    """Something that the pointer does; an instance has it in hand, from press to release.

    Parameters
    ----------
    project : Project
        In which it began.

    Attributes
    ----------
    before : SelectionSnapshot
    """

    project: Project
    before: SelectionSnapshot = field(init=False)

    def __post_init__(self) -> None:
        """Keep what is selected."""
        self.before = SelectionSnapshot(self.project.selected_handles, self.project.selected_keys)

    @classmethod
    @abstractmethod
    def hints(cls, session: Session, project: Project, spot: PointerHit) -> tuple[Hint, ...]:
        """Return what it would do at a spot, in words."""

    @classmethod
    @abstractmethod
    def press(cls, session: Session, project: Project, spot: PointerHit) -> Self | None:
        """Begin at a spot; None where it is for another tool."""

    def move(self, session: Session, place: complex) -> None:  # noqa: B027 - not every tool cares
        """Follow the pointer to another place of the plane."""

    def type(self, session: Session, characters: str) -> None:  # noqa: B027 - not every tool cares
        """Take what is typed meanwhile."""

    def end(self, session: Session, place: complex) -> None:  # noqa: B027 - not every tool cares
        """End where the pointer is."""

    def cancel(self, session: Session) -> None:
        """Undo what it did to the document and to the selection."""
        self.project.selected_handles, self.project.selected_keys = (
            self.before.handles,
            self.before.keys,
        )
        editing.revert_gesture(session, self)

    @property
    def tool_overlays(self) -> tuple[Mark, ...]:
        """What is drawn of it over the picture."""
        return ()

    @property
    def active_hints(self) -> tuple[Hint, ...]:
        """What can be done until it ends."""
        return ()

    def is_away(self, session: Session, start: complex, place: complex) -> bool:
        """Tell whether the pointer has gone farther than a click may."""
        return abs(place - start) * self.project.view(session.screen).scale > CLICK


def to_scene(project: Project, place: complex) -> complex:
    """Return where a place of the layer that is posed, by itself, is in the scene."""
    shown = project.layer_runtime.shown
    return place if shown is None else complex(shown.placement.apply(np.array([place]))[0])
