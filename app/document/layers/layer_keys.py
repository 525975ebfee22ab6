"""Keys of the camera, and of a layer's transform, opacity and draw order."""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from math import tau
from typing import Final

from app.document.checks import require, require_frame, require_point
from app.document.timing.base_key import BaseKey
from app.document.timing.tangent_mode import TangentMode
from app.document.timing.tracks import MAX_TRACK_ROTATION
from app.errors import LissomError
from app.texts import N_, _

MAX_ZOOM: Final = 1000.0  # largest zoom; its inverse is the smallest


@dataclass(frozen=True, slots=True, kw_only=True)
class CameraKey(BaseKey):
    """A rectangle with the canvas's proportions that the frame shows."""

    centre: complex  # point of the scene in the centre of the frame
    zoom: float = 1.0  # magnification relative to the canvas; interpolated by its logarithm
    turn: float = 0.0  # rotation of the picture, counter-clockwise, in radians

    def __post_init__(self) -> None:
        BaseKey.__post_init__(self)
        require_point(self.centre, _("The camera's centre"))
        require(
            1 / MAX_ZOOM <= self.zoom <= MAX_ZOOM,
            N_("The zoom must be from {smallest:g} to {largest:g}, not {zoom:g}."),
            smallest=1 / MAX_ZOOM,
            largest=MAX_ZOOM,
            zoom=self.zoom,
        )
        _require_rotation(self.turn)


@dataclass(frozen=True, slots=True, kw_only=True)
class TransformKey(BaseKey):
    """A rigid motion of the whole layer, applied after its pose."""

    shift: complex = 0j  # pixels
    turn: float = 0.0  # counter-clockwise around the pivot, in radians

    def __post_init__(self) -> None:
        BaseKey.__post_init__(self)
        require_point(self.shift, _("A layer's movement"))
        _require_rotation(self.turn)


@dataclass(frozen=True, slots=True, kw_only=True)
class OpacityKey(BaseKey):
    """Opacity of a layer at a frame; the default tangent mode gives linear fades."""

    opacity: float  # in [0, 1]
    tangent_mode: TangentMode = TangentMode.CORNER

    def __post_init__(self) -> None:
        BaseKey.__post_init__(self)
        require(
            0 <= self.opacity <= 1,
            N_("Opacity must be from 0 to 1, not {opacity:g}."),
            opacity=self.opacity,
        )


@dataclass(frozen=True, slots=True)
class DrawOrderKey:
    """From a frame on, a layer is drawn next to another; None restores the document's order."""

    frame: int
    beside: int | None  # id of the other layer
    in_front: bool = True

    def __post_init__(self) -> None:
        require_frame(self.frame, _("A draw order key"))


def require_ascending_keys(
    keys: Sequence[BaseKey] | Sequence[DrawOrderKey], what: str, layer: str = ""
) -> None:
    """Refuse keys out of order; `what` is a marked text, with the name of the layer in it."""
    for before, after in pairwise(key.frame for key in keys):
        if before >= after:
            raise LissomError(
                _("{what} has keys at frames {before} and {after} that are out of order.").format(
                    what=_(what).format(layer=layer), after=after, before=before
                )
            )


def _require_rotation(turn: float) -> None:
    require(
        abs(turn) <= MAX_TRACK_ROTATION,
        N_("A rotation can be at most {largest:g} whole turns, not {turn:g}."),
        largest=MAX_TRACK_ROTATION / tau,
        turn=turn / tau,
    )
