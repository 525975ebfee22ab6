"""Keys of the camera, and of layers moved as a whole, of their opacity and of their order."""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from math import tau
from typing import Final

from app.document.checks import require, require_frame, require_point
from app.document.timing import MAX_TRACK_ROTATION, BaseKey, TangentMode
from app.errors import LissomError

MAX_ZOOM: Final = 1000.0  # and as many times smaller


@dataclass(frozen=True, slots=True, kw_only=True)
class CameraKey(BaseKey):
    """What the camera shows at a frame: the canvas's rectangle, elsewhere, smaller and turned."""

    centre: complex  # the point of the plane in the middle
    zoom: float = 1.0  # how many times as large as on the canvas things are seen; blended by log
    turn: float = 0.0  # by how much things are seen turned, counter-clockwise, in radians

    def __post_init__(self) -> None:
        BaseKey.__post_init__(self)
        require_point(self.centre, "The camera's centre")
        require(
            1 / MAX_ZOOM <= self.zoom <= MAX_ZOOM,
            f"A zoom is above 0, from {1 / MAX_ZOOM:g} to {MAX_ZOOM:g}, not {self.zoom:g}.",
        )
        _require_rotation(self.turn)


@dataclass(frozen=True, slots=True, kw_only=True)
class TransformKey(BaseKey):
    """Where a whole layer is at a frame, beside where its poses have it."""

    shift: complex = 0j  # pixels
    turn: float = 0.0  # counter-clockwise around its pivot, in radians

    def __post_init__(self) -> None:
        BaseKey.__post_init__(self)
        require_point(self.shift, "A layer's movement")
        _require_rotation(self.turn)


@dataclass(frozen=True, slots=True, kw_only=True)
class OpacityKey(BaseKey):
    """How opaque a layer is at a frame; by itself it fades evenly."""

    opacity: float  # in [0, 1]
    tangent_mode: TangentMode = TangentMode.CORNER

    def __post_init__(self) -> None:
        BaseKey.__post_init__(self)
        require(0 <= self.opacity <= 1, f"Opacity is between 0 and 1, not {self.opacity:g}.")


@dataclass(frozen=True, slots=True)
class DrawOrderKey:
    """From a frame on a layer is painted right in front of another one, or right behind it.

    Beside nothing it is painted where it lies in the order of all layers.
    """

    frame: int
    beside: int | None  # the id of the other layer
    in_front: bool = True

    def __post_init__(self) -> None:
        require_frame(self.frame, "A place in the draw order")


def require_ascending_keys(keys: Sequence[BaseKey] | Sequence[DrawOrderKey], what: str) -> None:
    """Raise a `LissomError` unless each of some keys comes after the one before."""
    for before, after in pairwise(key.frame for key in keys):
        if before >= after:
            raise LissomError(f"{what} has a key at frame {after} after that at frame {before}.")


def _require_rotation(turn: float) -> None:
    require(
        abs(turn) <= MAX_TRACK_ROTATION,
        f"A turn is at most {MAX_TRACK_ROTATION / tau:g} whole turns, not {turn / tau:g}.",
    )
