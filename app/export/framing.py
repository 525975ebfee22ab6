"""Which part of the plane an export shows."""

import math
from typing import Final, NamedTuple

import numpy as np

from app.document.settings import ExportSettings
from app.render.view import View, canvas_view, fit_view
from engine.arrays import Complexes

# Room at each side of a motion that is fitted, as a share of its longer side.
MARGIN: Final = 0.02


class Box(NamedTuple):
    """A rectangle from its lower left to its upper right corner."""

    lower: complex
    upper: complex

    def contains(self, other: "Box", *, slack: float) -> bool:
        """Tell whether the other box sticks out nowhere by more than `slack`."""
        below, above = other.lower - self.lower, self.upper - other.upper
        return min(below.real, below.imag, above.real, above.imag) >= -slack

    def joined(self, other: "Box") -> "Box":
        """Return the smallest box around both."""
        return box_around(np.array([*self, *other]))


def box_around(points: Complexes) -> Box:
    """Return the smallest box around points (n,), of which there is at least one."""
    x, y = points.real, points.imag
    return Box(complex(x.min(), y.min()), complex(x.max(), y.max()))


def shown_box(view: View) -> Box:
    """Return the part of the plane that a view shows."""
    half = complex(*view.size) / (2 * view.scale)
    return Box(view.centre - half, view.centre + half)


def frame_view(settings: ExportSettings, picture: tuple[int, int], reach: Box) -> View:
    """Return the view of every frame of an export.

    Parameters
    ----------
    settings : ExportSettings
        Its framing and size.
    picture : tuple of int
        Width and height of the source picture.
    reach : Box
        Around the whole motion.

    Notes
    -----
    A fitted frame without a size of its own is even both ways, as video needs it, and lies on the
    picture's own grid of pixels, so that what rests stays as sharp as it is.
    """
    if settings.framing == "canvas":
        return canvas_view(picture, settings.size)
    extent = reach.upper - reach.lower
    margin = complex(1, 1) * MARGIN * max(extent.real, extent.imag)
    lower, upper = reach.lower - margin, reach.upper + margin
    if settings.size is not None:
        return fit_view(lower, upper, settings.size)
    left, bottom = math.floor(lower.real), math.floor(lower.imag)
    size = _even(math.ceil(upper.real) - left), _even(math.ceil(upper.imag) - bottom)
    return View(centre=complex(left, bottom) + complex(*size) / 2, scale=1.0, size=size)


def _even(pixels: int) -> int:
    return pixels + pixels % 2
