"""Geometry of closed polygons given by their vertices (n,), the last one joined to the first."""

import numpy as np
import shapely

from engine.arrays import Booleans, Complexes, Floats
from engine.errors import EngineError


def edges(polygon: Complexes) -> Complexes:
    """Return the edge vectors (n,): entry j leads from vertex j to vertex j + 1."""
    return np.roll(polygon, -1) - polygon


def signed_area(polygon: Complexes) -> float:
    """Return the area, positive where the polygon runs counter-clockwise (shoelace formula)."""
    # Taken about the first vertex: far from the origin the plain sum would lose digits.
    z = polygon - polygon[0]
    return 0.5 * float(np.sum((z.conj() * np.roll(z, -1)).imag))


def box_diagonal(polygon: Complexes) -> float:
    """Return L, the diagonal of the bounding box: the length scale of all relative tolerances."""
    return float(np.hypot(np.ptp(polygon.real), np.ptp(polygon.imag)))


def diameter(polygon: Complexes) -> float:
    """Return the largest distance between two vertices."""
    hull = shapely.get_coordinates(shapely.convex_hull(shapely.MultiPoint(as_xy(polygon))))
    z: Complexes = hull[:, 0] + 1j * hull[:, 1]
    return float(np.abs(z[:, None] - z[None, :]).max())


def as_xy(points: Complexes) -> Floats:
    """Return the points as an (n, 2) float64 array of x and y."""
    return np.column_stack([points.real, points.imag])


def is_simple(polygon: Complexes) -> bool:
    """Tell whether no two edges touch except neighbours at their common vertex."""
    return len(polygon) >= 3 and bool(shapely.LinearRing(as_xy(polygon)).is_simple)


def require_simple(polygon: Complexes, name: str) -> None:
    """Raise `EngineError` unless the polygon is simple, has an area and runs counter-clockwise."""
    if len(polygon) < 3:
        raise EngineError(f"The {name} needs at least 3 vertices, not {len(polygon)}.")
    if np.any(edges(polygon) == 0):
        raise EngineError(f"The {name} repeats a vertex; leave each vertex out but once.")
    if not is_simple(polygon):
        raise EngineError(f"The {name} crosses or touches itself; it must be a simple polygon.")
    if signed_area(polygon) <= 0:
        raise EngineError(f"The {name} runs clockwise; give its vertices counter-clockwise.")


def distance_to_segments(points: Complexes, starts: Complexes, ends: Complexes) -> Floats:
    """Return the distances (p, s) between each of p points and each of s segments."""
    along = ends - starts
    offset = points[:, None] - starts
    length2 = np.maximum(np.abs(along) ** 2, np.finfo(np.float64).tiny)
    parameter = np.clip((offset * along.conj()).real / length2, 0.0, 1.0)
    distances: Floats = np.abs(offset - parameter * along)
    return distances


def distance_to_boundary(polygon: Complexes, points: Complexes) -> Floats:
    """Return the distance (p,) of each point from the closed polyline."""
    ring = shapely.LinearRing(as_xy(polygon))
    shapely.prepare(ring)
    distances: Floats = shapely.distance(ring, shapely.points(as_xy(points)))
    return distances


def deepest_point(polygon: Complexes) -> complex:
    """Return the point inside the polygon that is farthest from it, to 1e-4 of its box diagonal."""
    radius = shapely.maximum_inscribed_circle(
        shapely.Polygon(as_xy(polygon)), tolerance=1e-4 * box_diagonal(polygon)
    )
    x, y = shapely.get_coordinates(radius)[0]
    return complex(x, y)


def contains(polygon: Complexes, points: Complexes, *, tolerance: float = 0.0) -> Booleans:
    """Tell for each point whether it lies in the closed polygon or within `tolerance` of it.

    Parameters
    ----------
    polygon : complex128, shape (n,)
    points : complex128, shape (p,)
    tolerance : float
        Distance, in the units of the points, by which a point may lie outside.

    Returns
    -------
    bool, shape (p,)
    """
    area = shapely.Polygon(as_xy(polygon))
    shapely.prepare(area)
    inside = np.asarray(shapely.intersects_xy(area, points.real, points.imag), dtype=np.bool_)
    if tolerance > 0 and not inside.all():
        outside = np.flatnonzero(~inside)
        inside[outside] = distance_to_boundary(polygon, points[outside]) <= tolerance
    return inside


def sample_graded(
    polygon: Complexes, centres: Complexes, *, ratio: float, longest: float
) -> Complexes:
    """Sample a polygon densely where it comes near any of the `centres`.

    Each edge is bisected until every segment is no longer than `ratio` times its distance to the
    nearest centre and no longer than `longest`. With the cage vertices as centres this resolves
    the logarithmic singularities of the Cauchy coordinates' derivatives, which uniform samples
    miss.

    Parameters
    ----------
    polygon : complex128, shape (n,)
    centres : complex128, shape (c,)
        Points off the polygon.
    ratio : float
        Largest segment length over distance to the nearest centre.
    longest : float
        Largest segment length.

    Returns
    -------
    complex128, shape (m,)
        The samples in order along the polygon; every vertex of the polygon is one of them.

    Raises
    ------
    EngineError
        If a centre lies on the polygon.
    """
    pending = np.arange(len(polygon), dtype=np.float64)
    width = np.ones(len(polygon))
    starts, ends = polygon, np.roll(polygon, -1)
    places: list[Floats] = []
    samples: list[Complexes] = []
    while len(starts):
        distance = distance_to_segments(centres, starts, ends).min(axis=0)
        if np.any(distance == 0):
            raise EngineError("A cage vertex lies on the outline; the cage must keep a distance.")
        fine = np.abs(ends - starts) <= np.minimum(ratio * distance, longest)
        places.append(pending[fine])
        samples.append(starts[fine])
        coarse = ~fine
        half = width[coarse] / 2
        middle = (starts[coarse] + ends[coarse]) / 2
        pending = np.concatenate([pending[coarse], pending[coarse] + half])
        starts, ends = (
            np.concatenate([starts[coarse], middle]),
            np.concatenate([middle, ends[coarse]]),
        )
        width = np.concatenate([half, half])
    return np.concatenate(samples)[np.argsort(np.concatenate(places))]
