"""Curves and the shapes made of them: splines, blobs, ribbons of varying width.

Points are complex numbers in pixels, x to the right and y *down*, as in a picture. Shapes are
shapely polygons in the same coordinates.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import shapely
from numpy.typing import ArrayLike, NDArray
from scipy.interpolate import CubicSpline, PchipInterpolator
from shapely.geometry.base import BaseGeometry

Curve = NDArray[np.complex128]
Points = Sequence[complex] | Curve

_SAMPLES_PER_SPAN = 24


def _knots(points: Curve) -> NDArray[np.float64]:
    """Centripetal parameters: the spline neither overshoots nor loops at uneven spacing."""
    return np.concatenate(([0.0], np.cumsum(np.sqrt(np.abs(np.diff(points))))))


def spline(points: Points, *, closed: bool = False) -> Curve:
    """Sample the smooth curve through `points`.

    Parameters
    ----------
    points : sequence of complex
        At least two points (three when closed).
    closed : bool
        Whether the curve returns to its first point, as smoothly as it passes the others.

    Returns
    -------
    complex128 (n,)
        Samples; those of a closed curve end where they began.
    """
    through = np.asarray([*points, points[0]] if closed else points, dtype=complex)
    knots = _knots(through)
    smooth = CubicSpline(knots, through, bc_type="periodic" if closed else "natural")
    samples: Curve = smooth(np.linspace(0.0, knots[-1], _SAMPLES_PER_SPAN * (len(knots) - 1) + 1))
    return samples


def polygon(points: ArrayLike) -> BaseGeometry:
    """Polygon with straight edges between `points`, complex (n,)."""
    corners = np.asarray(points, dtype=complex)
    return shapely.make_valid(shapely.Polygon(np.column_stack((corners.real, corners.imag))))


def blob(*points: complex) -> BaseGeometry:
    """Shape whose rim passes smoothly through all points."""
    return polygon(spline(points, closed=True))


def leaf(*sides: Points) -> BaseGeometry:
    """Shape whose rim is made of splines, with a corner wherever one ends and the next begins."""
    return polygon(np.concatenate([spline(side) for side in sides]))


def ellipse(centre: complex, rx: float, ry: float | None = None, tilt: float = 0.0) -> BaseGeometry:
    """Ellipse (a disc when `ry` is missing), turned clockwise by `tilt` degrees."""
    angle = np.linspace(0.0, 2 * np.pi, 96, endpoint=False)
    rim = rx * np.cos(angle) + 1j * (rx if ry is None else ry) * np.sin(angle)
    return polygon(centre + rim * np.exp(1j * np.deg2rad(tilt)))


def mirrored(points: Points, axis: float) -> list[complex]:
    """Mirror images of `points` about the vertical line x = `axis`."""
    return [2 * axis - point.conjugate() for point in points]


def weld(*shapes: BaseGeometry, radius: float) -> BaseGeometry:
    """Union of `shapes` with the inner corners between them filled to a rounding of `radius`."""
    return shapely.union_all(shapes).buffer(radius, quad_segs=16).buffer(-radius, quad_segs=16)


def rounded(shape: BaseGeometry, radius: float) -> BaseGeometry:
    """`shape` with its outer corners rounded off."""
    return shape.buffer(-radius, quad_segs=16).buffer(radius, quad_segs=16)


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Ribbon:
    """A curve with a width, addressed by arc length and by the side of the curve.

    Attributes
    ----------
    along : float64 (n,)
        Arc length of the samples as a fraction of the whole, from 0 to 1.
    spine, tangent : complex128 (n,)
        Samples of the curve, and its unit tangents.
    width : float64 (n,)
    """

    along: NDArray[np.float64]
    spine: Curve
    tangent: Curve
    width: NDArray[np.float64]

    def at(self, along: ArrayLike, side: float = 0.0) -> Curve:
        """Points of the ribbon: side -1 is its left edge, 0 the curve, +1 its right edge.

        Right and left are those of a walker on the picture who follows the curve.
        """
        place = np.asarray(along, dtype=float)
        half = np.interp(place, self.along, self.width) / 2
        middle: Curve = np.interp(place, self.along, self.spine)
        points: Curve = middle + side * half * 1j * self.heading(along)
        return points

    def heading(self, along: ArrayLike) -> Curve:
        """Unit tangents."""
        tangent: Curve = np.interp(np.asarray(along, dtype=float), self.along, self.tangent)
        unit: Curve = tangent / np.abs(tangent)
        return unit

    def strip(self, start: float, end: float, left: float, right: float) -> BaseGeometry:
        """The part of the ribbon between two arc lengths and two sides, with square ends."""
        along = np.linspace(start, end, max(2, round((end - start) * len(self.along))))
        return polygon(np.concatenate((self.at(along, left), self.at(along, right)[::-1])))

    @property
    def shape(self) -> BaseGeometry:
        """The whole ribbon with round ends: the hulls of neighbouring discs, united."""
        angle = np.linspace(0.0, 2 * np.pi, 48, endpoint=False)
        discs = self.spine[:, None] + self.width[:, None] / 2 * np.exp(1j * angle)
        pairs = np.concatenate((discs[:-1], discs[1:]), axis=1)
        hulls = shapely.convex_hull(shapely.multipoints(np.stack((pairs.real, pairs.imag), -1)))
        return shapely.union_all(hulls)


def ribbon(points: Points, widths: ArrayLike, *, closed: bool = False) -> Ribbon:
    """Ribbon along the spline through `points`.

    Parameters
    ----------
    points : sequence of complex
    widths : array_like of float
        One width, or one for each point; between the points they change without overshoot.
    closed : bool
        Whether the curve returns to its first point; then one width only.
    """
    spine = spline(points, closed=closed)
    length = np.concatenate(([0.0], np.cumsum(np.abs(np.diff(spine)))))
    at_points = np.broadcast_to(np.asarray(widths, dtype=float), (len(points),))
    spans = np.linspace(0.0, len(points) - 1, len(spine))
    tangent = np.gradient(spine)
    if closed:  # the one-sided differences at the seam would leave a kink there
        tangent[[0, -1]] = spine[1] - spine[-2]
    return Ribbon(
        along=length / length[-1],
        spine=spine,
        tangent=tangent / np.abs(tangent),
        width=PchipInterpolator(np.arange(len(points)), at_points)(spans),
    )
