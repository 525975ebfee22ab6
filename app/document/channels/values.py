"""Values of keys that consist of several numbers."""

from dataclasses import dataclass
from math import tau
from typing import Final

import numpy as np

from app.document.channels.tracks import MAX_TRACK_ROTATION
from app.document.checks import require, require_point
from app.texts import N_, _
from engine.arrays import Complexes
from engine.geometry import Similarity

MAX_ZOOM: Final = 1000.0  # largest zoom; its inverse is the smallest
MAX_FOOTAGE_SPEED: Final = 100.0  # times its own speed
MAX_FOOTAGE_FRAME: Final = 10_000_000
MAX_SCALE: Final = 100.0  # of a layer; its inverse is the smallest


@dataclass(frozen=True, slots=True)
class Camera:
    """A rectangle with the canvas's proportions that the frame shows."""

    centre: complex  # point of the scene in the centre of the frame
    zoom: float = 1.0  # magnification relative to the canvas; interpolated by its logarithm
    turn: float = 0.0  # rotation of the picture, counter-clockwise, in radians

    def __post_init__(self) -> None:
        require_point(self.centre, _("The camera's centre"))
        require(
            1 / MAX_ZOOM <= self.zoom <= MAX_ZOOM,
            N_("The zoom must be from {smallest:g} to {largest:g}, not {zoom:g}."),
            smallest=1 / MAX_ZOOM,
            largest=MAX_ZOOM,
            zoom=self.zoom,
        )
        _require_rotation(self.turn)

    def canvas_motion(self, canvas: tuple[int, int]) -> Similarity:
        """Return the similarity that maps the visible part of the scene to the canvas."""
        factor = self.zoom * complex(np.exp(1j * self.turn))
        return Similarity(factor, complex(*canvas) / 2 - factor * self.centre)

    def frame_corners(self, canvas: tuple[int, int]) -> Complexes:
        """Return the corners (4,) of the visible part, counter-clockwise from the lower left."""
        seen, (width, height) = self.canvas_motion(canvas), canvas
        corners = (0j, complex(width, 0), complex(width, height), complex(0, height))
        return np.array([seen.apply_inverse(corner) for corner in corners])


@dataclass(frozen=True, slots=True)
class Transform:
    """A motion of the whole layer about its joint, after its pose and before its parents.

    The joint is the layer's anchor where the pose has it; for a layer without a parent, the pivot.
    """

    shift: complex = 0j  # pixels, in the axes of the parent's joint
    turn: float = 0.0  # counter-clockwise, in radians
    scale: float = 1.0  # interpolated by its logarithm

    def __post_init__(self) -> None:
        require_point(self.shift, _("A layer's movement"))
        _require_rotation(self.turn)
        require(
            1 / MAX_SCALE <= self.scale <= MAX_SCALE,
            N_("A layer's scale must be from {smallest:g} to {largest:g}, not {scale:g}."),
            smallest=1 / MAX_SCALE,
            largest=MAX_SCALE,
            scale=self.scale,
        )

    @property
    def factor(self) -> complex:
        """Rotation and scale as one factor."""
        return self.scale * complex(np.exp(1j * self.turn))

    def about(self, pivot: complex) -> Similarity:
        """Return the motion about a pivot in the layer's space."""
        return Similarity(self.factor, pivot + self.shift - self.factor * pivot)


@dataclass(frozen=True, slots=True)
class IkTarget:
    """Where a layer's joint and rotation are wanted in the scene; its parents bend as bones."""

    place: complex  # of the layer's joint
    turn: float = 0.0  # of the layer, counter-clockwise, in radians
    mix: float = 1.0  # from the transforms of the layers (0) to the target (1)

    def __post_init__(self) -> None:
        require_point(self.place, _("An IK target"))
        _require_rotation(self.turn)
        require(
            0 <= self.mix <= 1,
            N_("The mix of an IK target must be from 0 to 1, not {mix:g}."),
            mix=self.mix,
        )


@dataclass(frozen=True, slots=True)
class FootageTime:
    """How footage plays from a key on: speed 0 holds a frame, and −1 plays backwards."""

    start: float = 0.0  # frame of the footage at the key
    speed: float = 1.0  # 1 is the footage's own
    loops: bool = False  # whether it begins again at its end; otherwise its last frame holds

    def __post_init__(self) -> None:
        require(
            abs(self.start) <= MAX_FOOTAGE_FRAME,
            N_("Footage can start at most at its frame {largest:,}, not at {start:g}."),
            largest=MAX_FOOTAGE_FRAME,
            start=self.start,
        )
        require(
            abs(self.speed) <= MAX_FOOTAGE_SPEED,
            N_("The speed of footage must be from −{largest:g} to {largest:g}, not {speed:g}."),
            largest=MAX_FOOTAGE_SPEED,
            speed=self.speed,
        )


@dataclass(frozen=True, slots=True)
class DrawOrder:
    """A place in the draw order directly in front of or behind another layer."""

    beside: int | None  # id of the other layer; None restores the document's order
    in_front: bool = True


def _require_rotation(turn: float) -> None:
    require(
        abs(turn) <= MAX_TRACK_ROTATION,
        N_("A rotation can be at most {largest:g} whole turns, not {turn:g}."),
        largest=MAX_TRACK_ROTATION / tau,
        turn=turn / tau,
    )
