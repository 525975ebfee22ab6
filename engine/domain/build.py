"""From a mask or a polygon to a meshed domain (Section 7; Chen and Weber 2015)."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Self

import numpy as np
import numpy.typing as npt

from engine.arrays import Booleans, Complexes, Floats, as_count, as_number, as_points, as_tuple
from engine.domain.meshing.draw_order import order_branches_on_top
from engine.domain.meshing.mesh import Mesh
from engine.domain.meshing.triangulation import triangulate
from engine.domain.outline.cage import offset_cage
from engine.domain.outline.enclosure import MARGINS, Detail, Holes, enclose_subject
from engine.domain.outline.holes import make_hole
from engine.errors import EngineError, Message
from engine.geometry import (
    Domain,
    Pieces,
    bisect_segments,
    deepest_point,
    diameter,
    edge_vectors,
    require_holes,
    require_simple,
    signed_area,
)

FEWEST_TRIANGLES = 1_000
MOST_TRIANGLES = 2_000_000
# Edges of a polygon are halved until they are no longer than this, over the diagonal of the outline
# and over the length of the loop. With the cage's offset they give maps that bend well.
LONGEST_EDGE, FEWEST_EDGES = 0.05, 16
# Size of the cage around a rectangle; any cage serves a picture that is never deformed.
FRAME = 1.1
NO_DETAIL = "There is no detail {detail!r}; choose one of {details}."
NO_MASK = "A mask must be a bool array of shape (h, w), not {dtype} of shape {shape}."


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class MeshedDomain(Domain):
    """A domain in pixels of its picture, y up, with the triangles that are painted.

    Parameters
    ----------
    closed : complex128, shape (m,), optional
        Painted places of the vertices of the `loops`, one loop after the other: the vertices on
        both sides of a slit meet in its middle. None without slits.
    """

    mesh: Mesh
    closed: Complexes | None = None

    @classmethod
    def of(cls, domain: Domain, triangles: int, closed: Complexes | None = None) -> Self:
        """Triangulate a domain with about this many triangles."""
        return cls(
            domain.outline,
            domain.cage,
            domain.holes,
            mesh=mesh_inside(domain, triangles=triangles),
            closed=closed,
        )

    def moved(self, by: complex) -> Self:
        mesh = Mesh(vertices=self.mesh.vertices + by, triangles=self.mesh.triangles)
        closed = None if self.closed is None else self.closed + by
        return replace(Domain.moved(self, by), mesh=mesh, closed=closed)

    def nearest(self, points: Complexes) -> Complexes:
        """Replace points (p,) outside the domain by the nearest centres of triangles.

        No centre is used twice.
        """
        places = points.copy()
        middles = self.mesh.vertices[self.mesh.triangles].mean(axis=1)
        free = np.ones(len(middles), dtype=np.bool_)
        for index in np.flatnonzero(~self.contains(points)):
            distances = np.where(free, np.abs(middles - points[index]), np.inf)
            taken = int(distances.argmin())
            free[taken] = False
            places[index] = middles[taken]
        return places


def build_domain(
    mask: Booleans,
    *,
    triangles: int,
    detail: Detail,
    holes: Holes = "keep",
    toggled_holes: Sequence[complex] = (),
    cut_lines: Sequence[npt.ArrayLike] = (),
) -> tuple[MeshedDomain, tuple[Message, ...]]:
    """Outline a subject, and build its domain.

    Parameters
    ----------
    mask : bool, shape (h, w)
        True on the subject's pixels, first row on top.
    triangles : int
        Approximate number of triangles, 1,000 to 2,000,000.
    detail : Detail
        How closely the outline follows the subject.
    holes : Holes
        Whether large holes stay holes.
    toggled_holes : sequence of complex
        Points in holes that are treated the other way, in pixels, y up.
    cut_lines : sequence of complex, each of shape (n,)
        Lines along which touching parts are separated, in pixels, y up.

    Returns
    -------
    domain : MeshedDomain
    notices : tuple of Message
        Every remedy that was applied.

    Raises
    ------
    EngineError
        If `triangles` is out of range, or the mask has no subject that can be outlined.
    """
    _require_triangles(triangles)
    if detail not in tuple(MARGINS):
        raise EngineError(NO_DETAIL, detail=detail, details=", ".join(MARGINS))
    mask = np.asarray(mask)
    if mask.dtype != np.bool_ or mask.ndim != 2:
        raise EngineError(NO_MASK, dtype=mask.dtype, shape=mask.shape)
    enclosure = enclose_subject(
        mask,
        detail=detail,
        holes=holes,
        swapped=as_points(toggled_holes, "toggled holes"),
        slits=[
            as_points(line, "cut line", at_least=2) for line in as_tuple(cut_lines, "cut lines")
        ],
    )
    domain = Domain(enclosure.outline, enclosure.cage, enclosure.holes)
    return MeshedDomain.of(domain, triangles, enclosure.closed), enclosure.notices


def domain_of_polygon(
    outline: npt.ArrayLike, holes: Sequence[npt.ArrayLike] = (), *, triangles: int = 8_000
) -> MeshedDomain:
    """Build the domain inside a polygon and outside of its holes.

    Long edges are halved. The cages are offset from the polygons as for pictures.

    Parameters
    ----------
    outline : array_like of complex, shape (p,)
        A simple polygon in either direction.
    holes : sequence of array_like of complex, shape (q,)
        Simple polygons inside the outline and apart, in either direction.
    triangles : int
        Approximate number of triangles, 1,000 to 2,000,000.

    Raises
    ------
    EngineError
        If `triangles` is out of range, a polygon is not simple, or the polygons come too close to
        themselves or each other for cages.
    """
    _require_triangles(triangles)
    rings = [as_points(outline, "outline", at_least=3)]
    for number, hole in enumerate(as_tuple(holes, "holes")):
        rings.append(as_points(hole, f"hole {number}", at_least=3))
    around, *inner = (
        ring if (signed_area(ring) > 0) == (place == 0) else ring[::-1]
        for place, ring in enumerate(rings)
    )
    require_simple(around, "outline")
    require_holes(inner, around)
    size = diameter(around)
    offset = MARGINS["normal"] * size
    around, *inner = (_with_short_edges(ring, LONGEST_EDGE * size) for ring in (around, *inner))
    cage = offset_cage(around, offset)
    domain = Domain(around, cage, tuple(make_hole(hole, offset) for hole in inner))
    return MeshedDomain.of(domain, triangles)


def _with_short_edges(ring: Complexes, longest: float) -> Complexes:
    """Return a polygon with edges halved until none is longer than `longest`."""
    longest = min(longest, float(np.abs(edge_vectors(ring)).sum()) / FEWEST_EDGES)
    pieces = Pieces.whole(ring, np.roll(ring, -1))
    return bisect_segments(pieces, lambda each: np.asarray(each.lengths <= longest)).starts


def _require_triangles(count: int) -> None:
    if not FEWEST_TRIANGLES <= as_count(count, "triangles") <= MOST_TRIANGLES:
        raise EngineError(
            "The number of triangles must be between {least:,} and {most:,}, not {count:,}.",
            least=FEWEST_TRIANGLES,
            most=MOST_TRIANGLES,
            count=count,
        )


def rectangle_domain(width: float, height: float) -> MeshedDomain:
    """Return the domain of a whole picture of this size, in two triangles."""
    width = as_number(width, "The width of a picture", above=0)
    height = as_number(height, "The height of a picture", above=0)
    corners = np.array([0, width, width + 1j * height, 1j * height])
    middle = corners.mean()
    return MeshedDomain(
        outline=corners,
        cage=middle + FRAME * (corners - middle),
        mesh=Mesh(vertices=corners, triangles=np.array([[0, 1, 2], [0, 2, 3]], dtype=np.int32)),
    )


def mesh_inside(domain: Domain, *, triangles: int) -> Mesh:
    """Triangulate a domain, in an order that paints limbs over the body."""
    holes = domain.loops[1:]
    mesh = triangulate(domain.outline, triangles, holes=holes)
    return order_branches_on_top(mesh, deepest_point(domain.outline, holes))


def texture_coordinates(points: Complexes, image_size: tuple[int, int]) -> Floats:
    """Return u (right) and v (up) of each point, (v, 2); [0, 1] spans the picture.

    Points outside the picture continue linearly past 0 and 1, where the renderer shows
    transparency.
    """
    width, height = image_size
    return np.column_stack([points.real / width, points.imag / height])
