"""Geometry of closed polygons given by their vertices (n,), the last one joined to the first.

The holes of a region are polygons within its outline that run clockwise, so that the region lies on
the left of all its loops.
"""

from collections.abc import Sequence

import numpy as np
import shapely

from engine.arrays import Booleans, Complexes, Floats, Indices
from engine.errors import EngineError
from engine.geometry.segments import Pieces, bisect_segments, distance_to_segments

# Distance, over the size of a shape, at which a point counts as on its outline, for rounding.
ON_OUTLINE = 1e-9
SIZES = (1e-60, 1e60)  # of polygons; the fourth powers of other sizes overflow or vanish
FARTHEST = 1e9  # from the origin, over a polygon's size: beyond, rounding destroys its shape
SHORTEST_EDGE = 1e-12  # of a cage, over the outline's size: the coordinates divide by it
FARTHEST_CAGE = 1e6  # from the outline, over its size: beyond, the coordinates are all the same
OUTSIDE_OUTLINE = (
    "The {name}{number} at ({x:.6g}, {y:.6g}) is outside the outline{holes}; place it on the shape."
)
CAGE_ORDER = "The cage does not run once counter-clockwise around the outline; check its order."
CAGE_TOUCHES = "The cage touches or crosses the outline; the outline must lie strictly inside it."
CAGE_REPEATS = "The cage has the same vertex twice, or nearly; give each vertex once."
CAGE_FAR = "The cage lies too far from the outline; move the cage closer to the outline."
HOLE_LEAVES = (
    "Hole {number} leaves the outline, or meets another hole. Keep holes apart and inside the "
    "outline."
)
SELF_TOUCHING = "The {name} crosses or touches itself; it must be a simple polygon."
FEW_VERTICES = "The {name} needs at least 3 vertices, not {count}."
FEW_DIGITS = (
    "The {name} is {size:.3g} large and lies {distance:.3g} from the origin, too far for the "
    "precision of numbers. Move it nearer, or scale it up."
)


def edge_vectors(polygon: Complexes) -> Complexes:
    """Return the edge vectors (n,): entry j leads from vertex j to vertex j + 1."""
    return np.roll(polygon, -1) - polygon


def loop_ends(loops: Sequence[Complexes]) -> Complexes:
    """Return the ends (n,) of the edges of several polygons, one polygon after the other."""
    return np.concatenate([np.roll(loop, -1) for loop in loops])


def next_on_loop(starts: Indices, count: int) -> Indices:
    """Return the successor of each of `count` items on closed loops that begin at `starts`."""
    following: Indices = np.arange(1, count + 1)
    following[np.append(starts[1:], count) - 1] = starts
    return following


def signed_area(polygon: Complexes) -> float:
    """Return the area, positive where the polygon runs counter-clockwise (shoelace formula)."""
    # Taken about the first vertex: far from the origin the plain sum would lose digits.
    z = polygon - polygon[0]
    return 0.5 * float(np.sum((z.conj() * np.roll(z, -1)).imag))


def box_diagonal(polygon: Complexes) -> float:
    """Return the diagonal of the bounding box, the size of pictures."""
    return float(np.hypot(np.ptp(polygon.real), np.ptp(polygon.imag)))


def diameter(polygon: Complexes) -> float:
    """Return L, the largest distance between two vertices: the length scale of all tolerances.

    Unlike the box, it does not change under rotation. Rotating calipers on the convex hull: each
    edge is measured against the vertices farthest from its line.
    """
    # By a power of two, so that nothing is rounded: hulls of 1e200 are lost in squares.
    spokes = polygon - polygon[0]
    scale = float(np.exp2(np.floor(np.log2(max(np.abs(spokes).max(), 1e-300)))))
    hull = shapely.convex_hull(shapely.MultiPoint(as_xy(spokes / scale)))
    x, y = shapely.get_coordinates(hull.normalize())[::-1].T  # counter-clockwise
    z: Complexes = x + 1j * y
    if len(z) < 4:
        return scale * float(np.abs(z[-1] - z[0]))
    count, directions = len(z) - 1, np.unwrap(np.angle(np.diff(z)))
    far = np.searchsorted(np.append(directions, directions + 2 * np.pi), directions + np.pi)
    farthest = z[(far + np.array([[-1], [0], [1]])) % count]
    return scale * float(max(np.abs(farthest - z[:-1]).max(), np.abs(farthest - z[1:]).max()))


def corners_of(polygon: Complexes) -> Complexes:
    """Return the vertices at which a polygon turns, without those inside straight edges."""
    before, after = polygon - np.roll(polygon, 1), edge_vectors(polygon)
    off = np.abs((before.conj() * after).imag)  # times the chord's length, from the chord
    turns = off > ON_OUTLINE * diameter(polygon) * np.abs(before + after)
    return polygon[turns | ((before.conj() * after).real < 0)]


def as_xy(points: Complexes) -> Floats:
    """Return the points as an (n, 2) float64 array of x and y."""
    return np.column_stack([points.real, points.imag])


def is_simple(polygon: Complexes) -> bool:
    """Whether no two edges touch except neighbours at their common vertex."""
    return len(polygon) >= 3 and bool(shapely.LinearRing(as_xy(polygon)).is_simple)


def require_simple(polygon: Complexes, name: str, *, clockwise: bool = False) -> None:
    """Raise `EngineError` unless the polygon is simple, has an area and runs the right way."""
    if len(polygon) < 3:
        raise EngineError(FEW_VERTICES, name=name, count=len(polygon))
    if np.any(edge_vectors(polygon) == 0):
        raise EngineError("The {name} has the same vertex twice; give each vertex once.", name=name)
    size = diameter(polygon)
    if not SIZES[0] < size < SIZES[1] or np.abs(polygon).max() > FARTHEST * size:
        raise EngineError(FEW_DIGITS, name=name, size=size, distance=np.abs(polygon).max())
    if not is_simple(polygon):
        raise EngineError(SELF_TOUCHING, name=name)
    is_clockwise = signed_area(polygon) <= 0
    if clockwise and not is_clockwise:
        raise EngineError(
            "The {name} runs counter-clockwise; give its vertices clockwise.", name=name
        )
    if is_clockwise and not clockwise:
        raise EngineError(
            "The {name} runs clockwise; give its vertices counter-clockwise.", name=name
        )


def require_holes(holes: Sequence[Complexes], outline: Complexes) -> None:
    """Raise `EngineError` unless the holes are simple, clockwise, inside the outline and apart."""
    for number, hole in enumerate(holes):
        require_simple(hole, f"outline of hole {number}", clockwise=True)
        if not lies_within(hole, outline, holes[:number]):
            raise EngineError(HOLE_LEAVES, number=number)


def lies_within(inner: Complexes, polygon: Complexes, holes: Sequence[Complexes] = ()) -> bool:
    """Whether the inside of one polygon lies in that of another, clear of its boundary."""
    return bool(shapely.contains_properly(shapely_region(polygon, holes), shapely_region(inner)))


def shapely_region(polygon: Complexes, holes: Sequence[Complexes] = ()) -> shapely.Polygon:
    return shapely.Polygon(as_xy(polygon), [as_xy(hole) for hole in holes])


def distance_to_boundary(
    polygon: Complexes, points: Complexes, holes: Sequence[Complexes] = ()
) -> Floats:
    """Return the distance (p,) of each point from the boundary of a polygon and its holes."""
    rings = shapely.MultiLineString([shapely.LinearRing(as_xy(loop)) for loop in (polygon, *holes)])
    shapely.prepare(rings)
    distances: Floats = shapely.distance(rings, shapely.points(as_xy(points)))
    return distances


def deepest_point(polygon: Complexes, holes: Sequence[Complexes] = ()) -> complex:
    """Return the inner point farthest from the boundary, to 1e-4 of the diameter."""
    radius = shapely.maximum_inscribed_circle(
        shapely_region(polygon, holes), tolerance=1e-4 * diameter(polygon)
    )
    x, y = shapely.get_coordinates(radius)[0]
    return complex(x, y)


def contains(
    polygon: Complexes,
    points: Complexes,
    *,
    holes: Sequence[Complexes] = (),
    tolerance: float = 0.0,
) -> Booleans:
    """Return for each point (p,) whether it lies in the closed region or within `tolerance` of it.

    The region excludes the inside of the `holes`, which are polygons.
    """
    area = shapely_region(polygon, holes)
    shapely.prepare(area)
    inside = np.asarray(shapely.intersects_xy(area, points.real, points.imag), dtype=np.bool_)
    if tolerance > 0 and not inside.all():
        outside = np.flatnonzero(~inside)
        inside[outside] = distance_to_boundary(polygon, points[outside], holes) <= tolerance
    return inside


def require_inside(
    outline: Complexes,
    points: Complexes,
    name: str,
    *,
    holes: Sequence[Complexes] = (),
    tolerance: float = 0.0,
) -> None:
    """Raise `EngineError` unless the region contains all points (p,), each called `name`."""
    outside = np.flatnonzero(~contains(outline, points, holes=holes, tolerance=tolerance))
    if len(outside):
        number = f" {outside[0]}" if len(points) > 1 else ""
        count = f" ({len(outside)} of {len(points)} are)" if len(outside) > 1 else ""
        z = points[outside[0]]
        raise EngineError(
            OUTSIDE_OUTLINE, name=name, number=number, x=z.real, y=z.imag, holes=count
        )


def require_around(cage: Complexes, outline: Complexes) -> None:
    """Raise `EngineError` unless a cage winds once around the outline, with room between them.

    Crossings elsewhere are allowed: some published cages have them.
    """
    size = diameter(outline)
    if np.abs(edge_vectors(cage)).min() <= SHORTEST_EDGE * size:
        raise EngineError(CAGE_REPEATS)
    if np.abs(cage - outline[0]).max() > FARTHEST_CAGE * size:
        raise EngineError(CAGE_FAR)
    if shapely.intersects(shapely.LinearRing(as_xy(cage)), shapely.Polygon(as_xy(outline))):
        raise EngineError(CAGE_TOUCHES)
    if winding_number(cage, complex(outline[0])) != 1:
        raise EngineError(CAGE_ORDER)


def winding_number(polygon: Complexes, point: complex) -> int:
    """Return how often a polygon runs counter-clockwise around a point off the polygon."""
    spokes = polygon - point
    return round(float(np.angle(np.roll(spokes, -1) / spokes).sum() / (2 * np.pi)))


def constrained_delaunay(polygon: Complexes, holes: Sequence[Complexes] = ()) -> Indices:
    """Return the constrained Delaunay triangulation of a simple polygon without its holes.

    The holes are simple polygons inside and apart. The triangles, intp (t, 3), run
    counter-clockwise. Their vertices are those of the polygon and then of the holes; no vertices
    are added.

    Raises
    ------
    EngineError
        If a polygon crosses or touches itself.
    """
    for loop in (polygon, *holes):
        if not is_simple(loop):
            raise EngineError(SELF_TOUCHING, name="polygon")
    parts = shapely.get_parts(
        shapely.constrained_delaunay_triangles(shapely_region(polygon, holes))
    )
    corners = shapely.get_coordinates(parts).reshape(-1, 4, 2)[:, :3] @ [1, 1j]
    vertices = np.concatenate([polygon, *holes])
    by_place = np.argsort(vertices)
    triangles: Indices = by_place[np.searchsorted(vertices[by_place], corners)]
    a, b, c = vertices[triangles].T
    clockwise = ((b - a).conj() * (c - a)).imag < 0
    return np.where(clockwise[:, None], triangles[:, ::-1], triangles)


def sample_graded(
    polygon: Complexes, centres: Complexes, *, ratio: float, longest: float
) -> Complexes:
    """Sample a polygon densely where it comes near any of the `centres`.

    Each edge is bisected until every segment is no longer than `ratio` times its distance to the
    nearest centre and no longer than `longest`. With the cage vertices as centres this resolves
    the logarithmic singularities of the Cauchy coordinates' derivatives, which uniform samples
    miss. The samples (m,) are in order along the polygon, and every vertex is one of them.

    Raises
    ------
    EngineError
        If a centre lies on the polygon.
    """

    def is_fine(pieces: Pieces) -> Booleans:
        distance = distance_to_segments(centres, pieces.starts, pieces.ends).min(axis=0)
        if np.any(distance == 0):
            raise EngineError("A cage vertex lies on the outline; move it away from the outline.")
        return np.asarray(pieces.lengths <= np.minimum(ratio * distance, longest))

    return bisect_segments(Pieces.whole(polygon, np.roll(polygon, -1)), is_fine).starts


def crossings_at(loops: Sequence[Complexes], height: float) -> Floats:
    """Return where loops cross a level line, from the left."""
    found = [np.empty(0)]
    for loop in loops:
        after = np.roll(loop, -1)
        is_crossed = (loop.imag < height) != (after.imag < height)
        a, b = loop[is_crossed], after[is_crossed]
        found.append(a.real + (height - a.imag) / (b.imag - a.imag) * (b.real - a.real))
    return np.sort(np.concatenate(found))
