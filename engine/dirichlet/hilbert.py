"""The Dirichlet problem on a polygon and its harmonic conjugate: the Hilbert transform.

Sections 3.5 and 6.2. A holomorphic g with given real part b on the outline is a Cauchy integral
with a real density,

    g(z) = 1/(2πi) ∮ μ(ζ) dζ / (ζ − z),      μ/2 + 1/(2π) ∮ μ Im(dζ / (ζ − z)) = b  on the outline,

an integral equation of the second kind with one solution. It is collocated at the nodes of graded
panels, and solved directly. Near and adjacent panels are integrated exactly. Around holes a
single-valued g has the real part b up to a constant on each hole's loop; the solution includes the
constants (`engine.dirichlet.boundary_operator`).

Departs from the paper: Section 7.4 uses the complex coordinates of Weber and Gotsman (2010) on the
cage's own n-dimensional space. That is wrong by up to a percent of the diameter, does not return
the keyframes, and loses the bounds that Theorem 6 proves.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import NamedTuple, Self

import numpy as np
import shapely
from scipy.spatial import cKDTree

from engine.arrays import Complexes, Floats, as_points, nbytes_of
from engine.dirichlet.boundary_operator import BoundaryOperator
from engine.dirichlet.cauchy_integral import CauchyIntegral
from engine.dirichlet.panels import Panels
from engine.dirichlet.skeleton_solver import SkeletonSolver
from engine.errors import EngineError
from engine.geometry import (
    ON_OUTLINE,
    Domain,
    as_xy,
    contains,
    diameter,
    distance_to_boundary,
    loop_ends,
    next_on_loop,
    require_around,
    require_simple,
    shapely_region,
)

OUTSIDE = (
    "{count} of the points lie outside the domain, the first {distance:.3g} from its boundary. "
    "Leave them out."
)
PARTS_SHAPE = "Real parts must have the shape ({count}, j), one row for each node, not {shape}."
EDGE_DEPTH, CORNER_DEPTH = 1e-9, 1e-13  # of points on the outline, relative to its size


class Extended(NamedTuple):
    """Holomorphic functions with given real parts on the boundary.

    `values` and `derivatives` are complex128 (t, j), for each function at the points. `lacking`
    (holes, j) is the constant by which the real part on each hole is below the given one.
    """

    values: Complexes
    derivatives: Complexes
    lacking: Floats


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class HilbertTransform:
    """The factorised integral equation of one domain, for all segments.

    Build it with `HilbertTransform.on`.

    Attributes
    ----------
    loops : tuple of complex128
        The outline, and the loops of holes.
    centre : complex
        Origin of the panels' coordinates. Far from the coordinate origin, rounding would lose tiny
        distances from an outline.
    solver : SkeletonSolver
        From real parts at the nodes to densities.
    means : float64, shape (holes, N)
        From densities to the constants by which the real parts on holes are too low.
    """

    loops: tuple[Complexes, ...]
    centre: complex
    panels: Panels
    solver: SkeletonSolver
    means: Floats

    @classmethod
    def on(cls, domain: Domain, *, progress: Callable[[float], None] | None = None) -> Self:
        """Discretise and factorise the integral equation of a domain.

        The number of nodes depends on the shape. It grows with the number of corners, and where the
        outline comes close to itself or to the cage. Time and memory grow with it, and somewhat
        faster where the outline fills an area. `progress` is called repeatedly with the completed
        share of the work, from 0 to 1; an exception that it raises ends the work.

        Raises
        ------
        EngineError
            If the outline is not simple, runs clockwise, or does not lie within the cage.
        """
        require_simple(domain.outline, "outline")
        require_around(domain.cage, domain.outline)
        centre = complex(domain.outline.mean())
        panels = Panels.on(domain.moved(-centre))
        return cls.of(domain.loops, panels, centre, progress)

    @classmethod
    def of(
        cls,
        loops: Sequence[Complexes],
        panels: Panels,
        centre: complex = 0j,
        progress: Callable[[float], None] | None = None,
    ) -> Self:
        """Factorise the integral equation on given panels of loops, relative to a centre."""
        operator = BoundaryOperator.of(panels)
        solver = SkeletonSolver.of(operator, progress)
        return cls(
            loops=tuple(loops), centre=centre, panels=panels, solver=solver, means=operator.means
        )

    @property
    def nbytes(self) -> int:
        """Memory of the solver's arrays, in bytes."""
        return nbytes_of(self.solver)

    @property
    def nodes(self) -> Complexes:
        """Points of the boundary (N,) for the given real parts."""
        return self.centre + self.panels.nodes.ravel()

    def at(self, points: Complexes, *, single: bool = False) -> "Extension":
        """Prepare the evaluation at points (t,) of the closed domain.

        Time and memory grow with the number of points and nodes, not with their product. In single
        precision the error away from a point is 2e-7 of the largest density.
        """
        points = as_points(points, "points", at_least=1)
        rounding = 4 * np.finfo(np.float64).eps * float(np.abs(points).max())
        local = [loop - self.centre for loop in self.loops]
        inside = _strictly_inside(local, points - self.centre, rounding)
        integral = CauchyIntegral.of(self.panels, inside, single=single)
        return Extension(transform=self, points=points, inside=inside, integral=integral)


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Extension:
    """A Hilbert transform at fixed points, for all segments.

    Build it with `HilbertTransform.at`.

    Attributes
    ----------
    points : complex128, shape (t,)
    inside : complex128, shape (t,)
        The points relative to the transform's centre; points on the boundary are moved slightly
        inside.
    integral : CauchyIntegral
        At `inside`.
    """

    transform: HilbertTransform
    points: Complexes
    inside: Complexes
    integral: CauchyIntegral

    @property
    def loops(self) -> tuple[Complexes, ...]:
        """The outline, and the loops of holes."""
        return self.transform.loops

    @property
    def nodes(self) -> Complexes:
        """Points of the boundary (N,) for the given real parts."""
        return self.transform.nodes

    @property
    def nbytes(self) -> int:
        """Memory without the transform, in bytes."""
        return nbytes_of(self.integral)

    def extend(self, real_parts: Floats) -> Extended:
        """Return holomorphic functions with given real parts (N, j) at the nodes of the boundary.

        They are unique up to an imaginary constant. At a reflex corner a derivative is unbounded,
        and its value there is meaningless.
        """
        if np.ndim(real_parts) != 2 or len(real_parts) != len(self.nodes):
            raise EngineError(PARTS_SHAPE, count=len(self.nodes), shape=np.shape(real_parts))
        densities = self.transform.solver(real_parts)
        return Extended(*self.integral(densities), self.transform.means @ densities)


def _strictly_inside(loops: Sequence[Complexes], points: Complexes, rounding: float) -> Complexes:
    """Move points on the boundary, or outside it by rounding, slightly inside.

    There the result is the limit from inside. Where two panels meet on an edge, the logarithms of
    both cancel only to the relative accuracy of the point's distance. A distance of 1e-9 of the
    size leaves seven digits. At a corner both panels start from the same point, and 1e-13 keeps the
    root of a distance small.
    """
    outline, *holes = loops
    size = diameter(outline)
    # Nearly all points are inside a slightly smaller region.
    area = shapely_region(outline, holes)
    room = area.buffer(-2 * EDGE_DEPTH * size, join_style="mitre")
    shapely.prepare(room)
    doubtful = np.flatnonzero(~shapely.intersects_xy(room, points.real, points.imag))
    outer = points[doubtful]
    distance = distance_to_boundary(outline, outer, holes)
    is_outside = ~contains(outline, outer, holes=holes)
    far = np.flatnonzero(is_outside & (distance > ON_OUTLINE * size + rounding))
    if len(far):
        raise EngineError(OUTSIDE, count=len(far), distance=distance[far[0]])
    close = doubtful[(distance < EDGE_DEPTH * size) | is_outside]
    moved = points.copy()
    z, corners, ends = points[close], np.concatenate(loops), loop_ends(loops)
    sides = ends - corners
    direction = sides / np.abs(sides)
    both = np.column_stack([corners, ends])
    edges = shapely.STRtree(shapely.linestrings(both.real, both.imag))
    nearest = edges.nearest(shapely.points(as_xy(z)))
    along = ((z - corners[nearest]) / sides[nearest]).real
    feet = corners[nearest] + np.clip(along, 0.0, 1.0) * sides[nearest]
    inside = feet + 1j * EDGE_DEPTH * size * direction[nearest]
    firsts = np.cumsum([0, *map(len, loops[:-1])])
    before = np.argsort(next_on_loop(firsts, len(corners)))
    interior_angle = np.pi - np.angle(direction / direction[before])
    bisector = direction * np.exp(0.5j * interior_angle)
    to_vertex, vertex = cKDTree(as_xy(corners)).query(as_xy(z))
    at_corner = to_vertex < 4 * EDGE_DEPTH * size
    corner = corners[vertex] + CORNER_DEPTH * size * bisector[vertex]
    moved[close] = np.where(at_corner, corner, inside)
    return moved
