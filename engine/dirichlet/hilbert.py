"""The Dirichlet problem on a polygon and its harmonic conjugate: the Hilbert transform.

Sections 3.5 and 6.2. A holomorphic g with given real part b on the outline is a Cauchy integral
with a real density,

    g(z) = 1/(2πi) ∮ μ(ζ) dζ / (ζ − z),      μ/2 + 1/(2π) ∮ μ Im(dζ / (ζ − z)) = b  on the outline,

an integral equation of the second kind with one solution. It is collocated at the nodes of graded
panels, with near and adjacent panels integrated exactly, and solved directly.

Departs from the paper: Section 7.4 uses the complex coordinates of Weber and Gotsman (2010) on the
cage's own n-dimensional space. That is wrong by up to a percent of the diameter, does not return
the keyframes, and loses the bounds that Theorem 6 proves.
"""

from dataclasses import dataclass
from typing import Self

import numpy as np

from engine.arrays import Complexes, Floats
from engine.dirichlet.boundary_operator import BoundaryOperator
from engine.dirichlet.cauchy_integral import CauchyIntegral
from engine.dirichlet.panels import Panels
from engine.dirichlet.skeleton_solver import SkeletonSolver
from engine.geometry import box_diagonal, contains, distance_to_boundary, edges

EDGE_DEPTH, CORNER_DEPTH = 1e-9, 1e-13  # of points on the outline, over its size


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class HilbertTransform:
    """The integral equation of one outline, factorised; it serves all intervals.

    Build it with `HilbertTransform.on`.

    Parameters
    ----------
    outline : complex128, shape (p,)
    panels : Panels
    solver : SkeletonSolver
        From real parts at the nodes to densities.
    """

    outline: Complexes
    panels: Panels
    solver: SkeletonSolver

    @classmethod
    def on(cls, outline: Complexes, cage: Complexes) -> Self:
        """Discretise and factorise the integral equation of an outline inside a cage.

        The number of nodes follows from the shape: it grows with the number of corners, and where
        the outline comes near itself or near the cage. Time and memory grow with it.
        """
        return cls.of(outline, Panels.on(outline, cage))

    @classmethod
    def of(cls, outline: Complexes, panels: Panels) -> Self:
        """Factorise the integral equation on given panels of an outline."""
        solver = SkeletonSolver.of(BoundaryOperator.of(panels))
        return cls(outline=outline, panels=panels, solver=solver)

    @property
    def nbytes(self) -> int:
        """Memory that the arrays take, in bytes."""
        return self.solver.nbytes

    @property
    def nodes(self) -> Complexes:
        """Points of the outline (N,) at which real parts are given."""
        return self.panels.nodes.ravel()

    def at(self, points: Complexes) -> "Extension":
        """Prepare the evaluation at points (t,) of the closed domain.

        Time and memory grow with the number of points and nodes, and not with their product.
        """
        inside = _strictly_inside(self.outline, points)
        integral = CauchyIntegral.of(self.panels, inside)
        return Extension(transform=self, points=points, integral=integral)


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Extension:
    """A Hilbert transform at fixed points; it serves all intervals.

    Build it with `HilbertTransform.at`.

    Parameters
    ----------
    transform : HilbertTransform
    points : complex128, shape (t,)
    integral : CauchyIntegral
        At the points, or a hair's breadth from those that are on the outline.
    """

    transform: HilbertTransform
    points: Complexes
    integral: CauchyIntegral

    @property
    def outline(self) -> Complexes:
        """The outline (p,)."""
        return self.transform.outline

    @property
    def nodes(self) -> Complexes:
        """Points of the outline (N,) at which real parts are given."""
        return self.transform.nodes

    @property
    def nbytes(self) -> int:
        """Memory beyond the transform's own, in bytes."""
        return self.integral.nbytes

    def extend(self, real_parts: Floats) -> tuple[Complexes, Complexes]:
        """Return holomorphic functions with given real parts on the outline, and their derivatives.

        Parameters
        ----------
        real_parts : float64, shape (N, j)
            At `nodes`.

        Returns
        -------
        values, derivatives : complex128, shape (t, j)
            Of each function, up to an imaginary constant. At a corner that turns inwards a
            derivative is unbounded, and the value there means nothing.
        """
        return self.integral(self.transform.solver(real_parts))


def _strictly_inside(outline: Complexes, points: Complexes) -> Complexes:
    """Move points on the outline, or outside it by rounding, a hair's breadth inside.

    There the limit from inside is meant. Where two panels meet on an edge, the logarithms of both
    cancel only as far as the point's distance is known: 1e-9 of the size leaves seven digits. At a
    corner both panels start from the same point, and 1e-13 keeps the root of a distance small.
    """
    size = box_diagonal(outline)
    close = distance_to_boundary(outline, points) < EDGE_DEPTH * size
    close |= ~contains(outline, points)
    moved = points.copy()
    z = points[close, None]
    sides = edges(outline)
    direction = sides / np.abs(sides)
    along = np.clip(((z - outline) * sides.conj()).real / np.abs(sides) ** 2, 0.0, 1.0)
    feet = outline + along * sides
    rows, nearest = np.arange(len(z)), np.abs(z - feet).argmin(axis=1)
    inside = feet[rows, nearest] + 1j * EDGE_DEPTH * size * direction[nearest]
    interior_angle = np.pi - np.angle(direction / np.roll(direction, 1))
    bisector = direction * np.exp(0.5j * interior_angle)
    to_vertex = np.abs(z - outline)
    vertex = to_vertex.argmin(axis=1)
    at_corner = to_vertex[rows, vertex] < 4 * EDGE_DEPTH * size
    corner = outline[vertex] + CORNER_DEPTH * size * bisector[vertex]
    moved[close] = np.where(at_corner, corner, inside)
    return moved
