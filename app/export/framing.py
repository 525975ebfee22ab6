"""The part of the plane that an export shows."""

import math
from typing import Final

from app.document import Document, ExportSettings
from app.motion import BoundingBox
from app.render import View, canvas_view, fit_view

# Margin at each side of a fitted motion, as a share of its longer side.
MARGIN: Final = 0.02


def find_shown_box(view: View) -> BoundingBox:
    """Return the part of the plane that a view shows."""
    half = complex(*view.size) / (2 * view.scale)
    return BoundingBox(view.centre - half, view.centre + half)


def frame_view(settings: ExportSettings, document: Document, motion: BoundingBox) -> View:
    """Return the view of every frame of an export; with a camera it is the canvas.

    `motion` is a box around the whole motion. A fitted frame without a given size has even sides,
    as video needs. It lies on the picture's pixel grid, so that parts at rest stay sharp.
    """
    if settings.framing == "canvas" or document.camera:
        return canvas_view(document.canvas, settings.size)
    extent = motion.upper - motion.lower
    margin = complex(1, 1) * MARGIN * max(extent.real, extent.imag)
    lower, upper = motion.lower - margin, motion.upper + margin
    if settings.size is not None:
        return fit_view(lower, upper, settings.size)
    left, bottom = math.floor(lower.real), math.floor(lower.imag)
    size = _even(math.ceil(upper.real) - left), _even(math.ceil(upper.imag) - bottom)
    return View(centre=complex(left, bottom) + complex(*size) / 2, scale=1.0, size=size)


def _even(pixels: int) -> int:
    return pixels + pixels % 2
