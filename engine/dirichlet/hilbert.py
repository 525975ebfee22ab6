"""The Dirichlet problem on a polygon and its harmonic conjugate: the Hilbert transform.

Sections 3.5 and 6.2. A holomorphic g with given real part b on the outline is a Cauchy integral
with a real density,

    g(z) = 1/(2πi) ∮ μ(ζ) dζ / (ζ − z),      μ/2 + 1/(2π) ∮ μ Im(dζ / (ζ − z)) = b  on the outline,

an integral equation of the second kind with one solution. It is collocated at the nodes of graded
panels, with near and adjacent panels integrated exactly, and solved directly. Around holes a
single-valued g has the real part b but for a constant on the loop of each, which comes out with it
(`engine.dirichlet.boundary_operator`).

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
    "{count} of the points lie outside the domain, the first of them {distance:.3g} from its "
    "boundary; leave them out."
)
PARTS_SHAPE = "Real parts must be of shape ({count}, j), one row for each node, not {shape}."
EDGE_DEPTH, CORNER_DEPTH = 1e-9, 1e-13  # of points on the outline, over its size


class Extended(NamedTuple):
    """Holomorphic functions with given real parts on the boundary.

    Parameters
    ----------
    values, derivatives : complex128, shape (t, j)
        Of each function at the points.
    lacking : float64, shape (holes, j)
        By how much, a constant around each hole, the real parts are below what was given.
    """

    values: Complexes
    derivatives: Complexes
    lacking: Floats


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class HilbertTransform:
    """The integral equation of one domain, factorised; it serves all intervals.

    Build it with `HilbertTransform.on`.

    Parameters
    ----------
    loops : tuple of complex128
        The outline, and those of holes.
    centre : complex
        From which the panels' places are told: far from the origin a hair's breadth beside an
        outline would be lost in the rounding of coordinates.
    panels : Panels
    solver : SkeletonSolver
        From real parts at the nodes to densities.
    means : float64, shape (holes, N)
        From densities to the constants by which the real parts give way around holes.
    """

    loops: tuple[Complexes, ...]
    centre: complex
    panels: Panels
    solver: SkeletonSolver
    means: Floats

    @classmethod
    def on(cls, domain: Domain, *, progress: Callable[[float], None] | None = None) -> Self:
        """Discretise and factorise the integral equation of a domain.

        The number of nodes follows from the shape: it grows with the number of corners, and where
        the outline comes near itself or near the cage. Time and memory grow with it, and somewhat
        faster where the outline fills an area. `progress` is called again and again with the share
        of the work that is done, from 0 to 1; what it raises ends the work.

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
        """Factorise the integral equation on given panels of some loops, told from a centre."""
        operator = BoundaryOperator.of(panels)
        solver = SkeletonSolver.of(operator, progress)
        return cls(
            loops=tuple(loops), centre=centre, panels=panels, solver=solver, means=operator.means
        )

    @property
    def nbytes(self) -> int:
        """Memory that the arrays take, in bytes."""
        return nbytes_of(self.solver)

    @property
    def nodes(self) -> Complexes:
        """Points of the boundary (N,) at which real parts are given."""
        return self.centre + self.panels.nodes.ravel()

    def at(self, points: Complexes, *, single: bool = False) -> "Extension":
        """Prepare the evaluation at points (t,) of the closed domain.

        Time and memory grow with the number of points and nodes, and not with their product. In
        single precision, what is far from a point errs by 2e-7 of the largest density.
        """
        points = as_points(points, "points", at_least=1)
        rounding = 4 * np.finfo(np.float64).eps * float(np.abs(points).max())
        local = [loop - self.centre for loop in self.loops]
        inside = _strictly_inside(local, points - self.centre, rounding)
        integral = CauchyIntegral.of(self.panels, inside, single=single)
        return Extension(transform=self, points=points, inside=inside, integral=integral)


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Extension:
    """A Hilbert transform at fixed points; it serves all intervals.

    Build it with `HilbertTransform.at`.

    Parameters
    ----------
    transform : HilbertTransform
    points, inside : complex128, shape (t,)
        And the same from the transform's centre, but that those on the boundary are a hair's
        breadth from there.
    integral : CauchyIntegral
        At the latter.
    """

    transform: HilbertTransform
    points: Complexes
    inside: Complexes
    integral: CauchyIntegral

    @property
    def loops(self) -> tuple[Complexes, ...]:
        """The outline, and those of holes."""
        return self.transform.loops

    @property
    def nodes(self) -> Complexes:
        """Points of the boundary (N,) at which real parts are given."""
        return self.transform.nodes

    @property
    def nbytes(self) -> int:
        """Memory beyond the transform's own, in bytes."""
        return nbytes_of(self.integral)

    def extend(self, real_parts: Floats) -> Extended:
        """Return holomorphic functions with given real parts on the boundary.

        They are so up to an imaginary constant. At a corner that turns inwards a derivative is
        unbounded, and the value there means nothing.

        Parameters
        ----------
        real_parts : float64, shape (N, j)
            At `nodes`.
        """
        if np.ndim(real_parts) != 2 or len(real_parts) != len(self.nodes):
            raise EngineError(PARTS_SHAPE.format(count=len(self.nodes), shape=np.shape(real_parts)))
        densities = self.transform.solver(real_parts)
        return Extended(*self.integral(densities), self.transform.means @ densities)


def _strictly_inside(loops: Sequence[Complexes], points: Complexes, rounding: float) -> Complexes:
    """Move points on the boundary, or outside it by rounding, a hair's breadth inside.

    There the limit from inside is meant. Where two panels meet on an edge, the logarithms of both
    cancel only as far as the point's distance is known: 1e-9 of the size leaves seven digits. At a
    corner both panels start from the same point, and 1e-13 keeps the root of a distance small.
    """
    outline, *holes = loops
    size = diameter(outline)
    # Nearly all points are inside a region that is a little smaller.
    area = shapely_region(outline, holes)
    room = area.buffer(-2 * EDGE_DEPTH * size, join_style="mitre")
    shapely.prepare(room)
    doubtful = np.flatnonzero(~shapely.intersects_xy(room, points.real, points.imag))
    outer = points[doubtful]
    distance = distance_to_boundary(outline, outer, holes)
    is_outside = ~contains(outline, outer, holes=holes)
    far = np.flatnonzero(is_outside & (distance > ON_OUTLINE * size + rounding))
    if len(far):
        raise EngineError(OUTSIDE.format(count=len(far), distance=distance[far[0]]))
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
