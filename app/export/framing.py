"""The part of the plane that an export shows, and its size in pixels."""

import math
from dataclasses import replace
from typing import Final, NamedTuple

from app.document import Document, ExportSettings
from app.errors import LissomError
from app.export_formats import EXPORT_FORMATS
from app.motion import BoundingBox
from app.render import View, canvas_view, fit_view
from app.texts import _

# Margin at each side of a fitted motion, as a share of its longer side.
MARGIN: Final = 0.02
MOST_PIXELS: Final = 2**28  # pixels of a frame: a gigabyte


class FrameTile(NamedTuple):
    """A part of a frame that is drawn at once, and its upper left corner."""

    view: View
    left: int
    top: int


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


def split_into_tiles(view: View, side: int) -> list[FrameTile]:
    """Divide a frame into equal tiles; the last ones may extend beyond it."""
    width, height = view.size
    if width * height > MOST_PIXELS:
        raise LissomError(
            _(
                "a frame of {width} × {height} pixels is too large; a frame can have at most "
                "{most:,} pixels. Choose a smaller size"
            ).format(width=width, height=height, most=MOST_PIXELS)
        )
    size = min(width, side), min(height, side)
    half = complex(*size) / 2
    return [
        FrameTile(
            replace(view, centre=view.to_plane(complex(left, top) + half), size=size), left, top
        )
        for top in range(0, height, size[1])
        for left in range(0, width, size[0])
    ]


def check_largest_size(name: str, size: tuple[int, int]) -> None:
    """Refuse pictures too large for a format."""
    largest = EXPORT_FORMATS[name].largest
    if largest is not None and max(size) > largest:
        raise LissomError(
            _(
                "{name} can have at most {largest:,} pixels each way, not {width} × {height}; "
                "choose a smaller size"
            ).format(name=name, largest=largest, width=size[0], height=size[1])
        )


def check_blocks(name: str, size: tuple[int, int]) -> None:
    """Refuse pictures that are not made of whole blocks of a format."""
    format_ = EXPORT_FORMATS[name]
    width, height = format_.whole_blocks(size)
    if (width, height) != size:
        raise LissomError(
            _(
                "{name} keeps colours in blocks of {block} × {block} pixels, and {width} × "
                "{height} has an odd side; choose {even_width} × {even_height}"
            ).format(
                name=name,
                block=format_.block,
                width=size[0],
                height=size[1],
                even_width=width,
                even_height=height,
            )
        )


def list_added_pixels(name: str, size: tuple[int, int]) -> tuple[str, ...]:
    """Return notices about rows and columns that a format of whole blocks adds."""
    width, height = EXPORT_FORMATS[name].whole_blocks(size)
    if (width, height) == size:
        return ()
    return (
        _(
            "{format} needs even sides, so background extends the frames to {width} × {height} "
            "pixels"
        ).format(format=name, width=width, height=height),
    )


def _even(pixels: int) -> int:
    return pixels + pixels % 2
