"""Settings of a cut-out: background colour, mask, and strokes by hand."""

from dataclasses import dataclass, field
from math import sqrt
from typing import Literal, Self

import numpy as np

from engine.arrays import Booleans, Bytes, Complexes, as_points, readonly, require_word
from engine.domain.outline.enclosure import HOLES, Holes
from engine.errors import EngineError
from engine.geometry import arc_lengths

BackgroundColour = tuple[int, int, int]  # red, green, blue, each 0 to 255
Enclosed = Literal["auto", "keep", "remove"]
CoveredSide = Literal["none", "left", "right"]

SMALLEST_RADIUS, LARGEST_RADIUS = 0.5, 4096.0  # pixels of a stroke
FARTHEST_STROKE = 1e5  # pixels: farthest point of a stroke from the picture's corner
# Of all strokes together: most points, and most rows of pixels of the discs that draw them, which
# take a minute.
MOST_STROKE_POINTS, MOST_ROWS = 1_000_000, 1e9
AT_ONCE = 1 << 20  # rows in one step of drawing


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Mask:
    """The kept pixels of a picture, eight to a byte.

    Parameters
    ----------
    bits : uint8, shape (ceil(w h / 8),)
        Row after row, first row on top, the first pixel in the highest bit; set for kept pixels.
    size : tuple of int
        Width and height in pixels.
    """

    bits: Bytes
    size: tuple[int, int]

    def __post_init__(self) -> None:
        width, height = self.size
        if self.bits.shape != (-(-width * height // 8),):
            raise EngineError(
                "A mask of {width} × {height} pixels cannot have {count} bytes.",
                width=width,
                height=height,
                count=self.bits.size,
            )

    @classmethod
    def of(cls, kept: Booleans) -> Self:
        """Return the mask of the kept pixels (h, w)."""
        return cls(bits=readonly(np.packbits(kept)), size=(kept.shape[1], kept.shape[0]))

    @property
    def kept(self) -> Booleans:
        """The kept pixels (h, w)."""
        width, height = self.size
        flat = np.unpackbits(self.bits, count=width * height)
        return flat.view(np.bool_).reshape(height, width)


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Stroke:
    """A stroke of a round brush.

    Parameters
    ----------
    points : complex128, shape (n,)
        Path of its centre, in pixels of the picture, y up; at least one.
    radius : float
        In pixels.
    keeps : bool
        Whether the stroke adds pixels to the subject; else it removes them.
    """

    points: Complexes
    radius: float
    keeps: bool
    rows: float = field(init=False, repr=False)  # of pixels of the discs that draw it

    def __post_init__(self) -> None:
        points = as_points(self.points, "stroke", at_least=1)
        object.__setattr__(self, "points", points)
        if not SMALLEST_RADIUS <= self.radius <= LARGEST_RADIUS:
            raise EngineError(
                "The radius of a brush must be from {least:g} to {most:g} pixels, not {radius:g}.",
                least=SMALLEST_RADIUS,
                most=LARGEST_RADIUS,
                radius=self.radius,
            )
        _require_near(points, "A stroke")
        discs = len(points) + np.abs(np.diff(points)).sum() / _spacing(self.radius)
        object.__setattr__(self, "rows", float(discs * (2 * self.radius + 3)))


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class CutLine:
    """A line along which the knife separates touching parts.

    Parameters
    ----------
    points : complex128, shape (n,)
        In pixels of the picture, y up; at least two.
    covered : {"none", "left", "right"}
        The side, along the line, that the other side covers: a limb behind another one. It
        continues under the other side.
    covered_from : int
        Index of the first of the points between which the side is covered, up to the last one.
    """

    points: Complexes
    covered: CoveredSide = "none"
    covered_from: int = 0

    def __post_init__(self) -> None:
        points = as_points(self.points, "knife's line", at_least=2)
        require_word(self.covered, ("none", "left", "right"), "The covered side of a line")
        if not 0 <= self.covered_from <= len(points) - 2:
            raise EngineError(
                "A knife's line of {count} points cannot be covered from point {point} on.",
                count=len(points),
                point=self.covered_from,
            )
        _require_near(points, "The knife's line")
        object.__setattr__(self, "points", points)


@dataclass(frozen=True, slots=True, kw_only=True)
class CutOut:
    """How a subject is separated from its picture.

    Parameters
    ----------
    tolerance : int
        Levels, 0 to 255, by which the background of an opaque picture may vary.
    background : {"auto", "none"} or tuple of int
        "auto" removes the colour of most of the border from an opaque picture, "none" removes
        nothing. A given colour is removed from opaque and transparent pictures alike.
    enclosed : {"auto", "keep", "remove"}
        Whether inner parts with the background's colour are removed too, such as the gap between an
        arm and the body. "auto" removes vivid colours, but not white, grey and black, the colours
        of eyes, teeth and paper.
    mask : Mask, optional
        The kept pixels; then no background is searched.
    strokes : tuple of Stroke
        Pixels kept and removed by hand afterwards, one stroke over the other.
    holes : {"keep", "fill"}
        Whether large holes of the subject stay holes.
    toggled_holes : tuple of complex
        Points in holes, and in enclosed parts, that are treated the other way, in pixels of the
        picture, y up.
    cut_lines : tuple of CutLine
        Lines along which the knife separates it; the picture shows no gap there.
    """

    tolerance: int = 18
    background: Literal["auto", "none"] | BackgroundColour = "auto"
    enclosed: Enclosed = "auto"
    mask: Mask | None = None
    strokes: tuple[Stroke, ...] = ()
    holes: Holes = "keep"
    toggled_holes: tuple[complex, ...] = ()
    cut_lines: tuple[CutLine, ...] = ()

    def __post_init__(self) -> None:
        if not 0 <= self.tolerance <= 255:
            raise EngineError(
                "The tolerance must be between 0 and 255 levels, not {tolerance}.",
                tolerance=self.tolerance,
            )
        if isinstance(self.background, tuple):
            levels = self.background
            if len(levels) != 3 or not all(0 <= level <= 255 for level in levels):
                raise EngineError(
                    "A background colour must have three levels from 0 to 255, not {levels}.",
                    levels=levels,
                )
        else:
            require_word(self.background, ("auto", "none"), "A background that is not a colour")
        require_word(self.enclosed, ("auto", "keep", "remove"), "The treatment of enclosed parts")
        require_word(self.holes, HOLES, "The treatment of holes")
        as_points(self.toggled_holes, "The points of toggled holes")
        points = sum(len(line.points) for line in self.lines)
        if points > MOST_STROKE_POINTS or sum(stroke.rows for stroke in self.strokes) > MOST_ROWS:
            raise EngineError("There are too many strokes; save the mask and load it instead.")

    def covered_lines(self, corner: complex) -> list[Complexes]:
        """Return the cut lines with a covered side, which is on their left, on the canvas."""
        return [
            corner + line.points[line.covered_from :][:: 1 if line.covered == "left" else -1]
            for line in self.cut_lines
            if line.covered != "none"
        ]

    @property
    def is_by_hand(self) -> bool:
        """Whether there is a mask, a stroke or a cut line."""
        return self.mask is not None or bool(self.strokes) or bool(self.cut_lines)

    @property
    def nbytes(self) -> int:
        mask = 0 if self.mask is None else self.mask.bits.nbytes
        return mask + sum(line.points.nbytes for line in self.lines)

    @property
    def lines(self) -> "tuple[Stroke | CutLine, ...]":
        return (*self.strokes, *self.cut_lines)


def _require_near(points: Complexes, name: str) -> None:
    if max(np.abs(points.real).max(), np.abs(points.imag).max()) > FARTHEST_STROKE:
        raise EngineError(
            "{name} goes farther than {farthest:,.0f} pixels from the picture.",
            name=name,
            farthest=FARTHEST_STROKE,
        )


def paint(kept: Booleans, stroke: Stroke) -> None:
    """Draw a stroke on the kept pixels (h, w), first row on top, in place.

    A pixel is covered if its centre is within the radius of the path, up to a quarter of a pixel.
    """
    centres = _close_together(stroke.points, stroke.radius)
    centres = centres.real + 1j * (len(kept) - centres.imag)
    at_once = max(1, int(AT_ONCE / (2 * stroke.radius + 3)))
    for start in range(0, len(centres), at_once):
        _paint_discs(kept, centres[start : start + at_once], stroke)


def _paint_discs(kept: Booleans, centres: Complexes, stroke: Stroke) -> None:
    """Draw discs around centres, y down."""
    height, width = kept.shape
    reach = int(np.ceil(stroke.radius)) + 1
    rows = np.floor(centres.imag).astype(np.int64)[:, None] + np.arange(-reach, reach + 1)
    square = stroke.radius**2 - (rows + 0.5 - centres.imag[:, None]) ** 2
    half = np.sqrt(np.maximum(square, 0))
    first = np.ceil(centres.real[:, None] - half - 0.5).astype(np.int64).clip(0, width)
    last = np.floor(centres.real[:, None] + half - 0.5).astype(np.int64).clip(-1, width - 1)
    hit = (square >= 0) & (last >= first) & (rows >= 0) & (rows < height)
    if not hit.any():
        return
    rows, first, last = rows[hit], first[hit], last[hit]
    top, left, right = rows.min(), first.min(), last.max() + 1
    shape = (int(rows.max() - top) + 1, int(right - left) + 1)
    # Where more spans have begun than ended, the discs cover the row.
    starts = np.bincount((rows - top) * shape[1] + first - left, minlength=shape[0] * shape[1])
    ends = np.bincount((rows - top) * shape[1] + last + 1 - left, minlength=shape[0] * shape[1])
    covered = np.cumsum((starts - ends).reshape(shape), axis=1)[:, :-1] > 0
    kept[top : top + shape[0], left:right][covered] = stroke.keeps


def _spacing(radius: float) -> float:
    """Return the spacing of discs that leaves at most a quarter of a pixel uncovered."""
    # Two circles whose centres are s apart meet about s² / 8 r within their common tangent.
    return min(radius, sqrt(2 * radius))


def _close_together(points: Complexes, radius: float) -> Complexes:
    """Return points along the path no farther apart than the spacing of discs."""
    along = arc_lengths(points)
    count = int(np.ceil(along[-1] / _spacing(radius))) + 1
    places = np.union1d(along, np.linspace(0, along[-1], count))
    between: Complexes = np.interp(places, along, points)
    return between
