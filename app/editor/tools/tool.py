"""The base class of tools: a tool takes a press, and then gets all events until the release."""

from abc import ABC, abstractmethod
from collections.abc import Iterable
from dataclasses import dataclass, field
from typing import ClassVar, Self

import numpy as np

from app.document import KeysByChannel
from app.editor.actions import editing
from app.editor.overlay_shapes import Cursor, OverlayShape
from app.editor.parts.tools import CLICK, Hint
from app.editor.project import Project
from app.editor.session import Session
from app.motion import LayerFrame
from engine.arrays import Complexes


@dataclass(frozen=True, slots=True, kw_only=True)
class PointerHit:
    """The pointer's place, and the item under it."""

    place: complex  # in the scene
    handle: int | None = None  # the handle under the pointer
    at_target: bool = False  # whether the target is there and not the handle itself
    track_key: int | None = None  # frame of the key under it, on the selected track's path
    on_axis: bool = False  # on the grip of the mirror axis
    on_anchor: bool = False  # on the anchor of the active layer
    on_gizmo: bool = False  # on the ring around a handle, or on a grip of the box
    on_shape: bool = False  # on the active layer
    # The visible layer there; with Alt held, the next one behind the active layer.
    layer: int | None = None
    is_double: bool = False  # whether it is the second press of a double click
    ctrl: bool = False  # whether the modifier keys are held
    shift: bool = False
    alt: bool = False
    is_over: bool = True  # whether the pointer is over the drawing, and not elsewhere in the window
    em: float = 1.0  # the size of the window's text, in pixels of the picture

    @property
    def is_opposite(self) -> bool:
        """Whether the press does the opposite: with Ctrl, or Alt, which window managers take."""
        return self.ctrl or self.alt


@dataclass(frozen=True, slots=True)
class SelectionSnapshot:
    """The selection when a gesture began."""

    handles: frozenset[int]
    keys: KeysByChannel


@dataclass(slots=True, kw_only=True, eq=False)
class Tool(ABC):
    """A tool of the pointer; an instance is active from press to release.

    `before` is the selection at the press.
    """

    cursor: ClassVar[Cursor] = "arrow"
    snaps: ClassVar[bool] = False  # whether it moves in steps while Ctrl is held
    snaps_by_shift: ClassVar[bool] = False  # whether it does so while Shift is held, too
    project: Project
    before: SelectionSnapshot = field(init=False)

    def __post_init__(self) -> None:
        self.before = SelectionSnapshot(self.project.selection.handles, self.project.selection.keys)

    @classmethod
    def mode(cls, _session: Session, _project: Project) -> str:
        """Return what the tool's mode does, for its badge; empty if the tool has no mode."""
        return ""

    @classmethod
    def idle_shapes(
        cls, _session: Session, _project: Project, _spot: PointerHit
    ) -> Iterable[OverlayShape]:
        """Return what is always drawn over the drawing while the tool can be used."""
        return ()

    @classmethod
    def has_gizmo_at(cls, _session: Session, _project: Project, _spot: PointerHit) -> bool:
        """Return whether what the tool draws can be grabbed at a place."""
        return False

    @classmethod
    @abstractmethod
    def hints(cls, session: Session, project: Project, spot: PointerHit) -> tuple[Hint, ...]:
        """Return the hints for a press at a place."""

    @classmethod
    @abstractmethod
    def press(cls, session: Session, project: Project, spot: PointerHit) -> Self | None:
        """Begin at a place; return None to leave the press to another tool."""

    def move(self, session: Session, place: complex) -> None:  # noqa: B027 - not every tool cares
        """Follow the pointer to a place in the scene."""

    def type(self, session: Session, characters: str) -> None:  # noqa: B027 - not every tool cares
        """Take characters that are typed during the drag."""

    def end(self, session: Session, place: complex) -> None:  # noqa: B027 - not every tool cares
        """End at the pointer's place."""

    def cancel(self, session: Session) -> None:
        """Undo the tool's edits, and restore the selection."""
        self.project.selection.restore(self.before.handles, self.before.keys)
        editing.revert_gesture(session, self)

    def shapes(self, _place: complex, _em: float) -> Iterable[OverlayShape]:
        """Return what is drawn over the drawing until the release, with the pointer at a place."""
        return ()

    @property
    def active_hints(self) -> tuple[Hint, ...]:
        """The hints until the release."""
        return ()

    def is_away(self, session: Session, start: complex, place: complex) -> bool:
        """Return whether the pointer has moved farther than in a click."""
        return abs(place - start) * self.project.view_on(session.display.screen).scale > CLICK


def to_scene(project: Project, place: complex) -> complex:
    """Convert a place of the active layer's own space to the scene."""
    shown = project.layer_runtime.shown
    return place if shown is None else complex(shown.placement.apply(np.array([place]))[0])


def scene_outlines(shown: LayerFrame) -> list[Complexes]:
    """Return the deformed outline and holes of a layer, in scene coordinates."""
    # The vertices of a mesh begin with those of the loops.
    ends = np.cumsum([len(loop) for loop in shown.mesh.domain.loops])
    return np.split(shown.placement.apply(shown.positions[: ends[-1]]), ends[:-1])


def handle_places(project: Project) -> dict[int, complex]:
    """Return the shown places of the active layer's handles, by id."""
    shown = project.layer_runtime.shown
    if shown is None:
        return {}
    places = shown.handle_positions.tolist()
    return {each.id: at for each, at in zip(shown.clip.layer.handles, places, strict=True)}


def movable_handles(project: Project) -> frozenset[int]:
    """Return the selected handles that are not locked."""
    handles = project.layer.handles
    return frozenset(h.id for h in handles if h.id in project.selection.handles and not h.locked)
