"""The Dirichlet problem on a polygon and its harmonic conjugate: the Hilbert transform.

Sections 3.5 and 6.2. A holomorphic g with given real part b on the outline is a Cauchy integral
with a real density,

    g(z) = 1/(2πi) ∮ μ(ζ) dζ / (ζ − z),      μ/2 + 1/(2π) ∮ μ Im(dζ / (ζ − z)) = b  on the outline,

an integral equation of the second kind with one solution. It is collocated at the nodes of graded
panels, with near and adjacent panels integrated exactly.

Departs from the paper: Section 7.4 uses the complex coordinates of Weber and Gotsman (2010) on the
cage's own n-dimensional space. That is wrong by up to a percent of the diameter, does not return
the keyframes, and loses the bounds that Theorem 6 proves.
"""

from dataclasses import dataclass
from typing import Self

import numpy as np
import scipy.linalg

from engine.arrays import Complexes, Floats, Integers, freeze
from engine.dirichlet.cauchy_integral import cauchy_integrals
from engine.dirichlet.panels import NODES, Panels
from engine.dirichlet.product_integration import is_near, panel_weights
from engine.errors import EngineError
from engine.geometry import box_diagonal, contains, distance_to_boundary, edges

MOST_NODES = 9_000  # 650 MB, and some ten seconds to factorise
COARSEST = 4.0
EDGE_DEPTH, CORNER_DEPTH = 1e-9, 1e-13  # of points on the outline, over its size


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class HilbertTransform:
    """The integral equation of one outline, factorised; it serves all intervals.

    Build it with `HilbertTransform.on`.

    Parameters
    ----------
    outline : complex128, shape (p,)
    panels : Panels
    factors : float64, shape (N, N), in Fortran's order
        LU factors of the matrix of the N = NODES · len(panels) nodes.
    pivots : int32, shape (N,)
    coarseness : float
        Factor by which panels are longer than the shape asks for, 1 at best; at 4 some shapes are
        off by 1e-4 of their size.
    """

    outline: Complexes
    panels: Panels
    factors: Floats
    pivots: Integers
    coarseness: float

    @classmethod
    def on(cls, outline: Complexes, cage: Complexes) -> Self:
        """Discretise and factorise the integral equation of an outline inside a cage.

        The number of nodes follows from the shape: it grows with the number of corners, and where
        the outline comes near itself or near the cage. Time grows with its third power, memory with
        its square; beyond `MOST_NODES` accuracy is given up instead, as `coarseness` tells.
        """
        coarseness = 1.0
        while len(panels := Panels.on(outline, cage, coarseness=coarseness)) * NODES > MOST_NODES:
            coarseness *= 1.25
            if coarseness > COARSEST:
                raise EngineError(
                    f"The outline needs {len(panels) * NODES} nodes for the metric variant, above "
                    f"{MOST_NODES}; smooth it, widen its narrow gaps, or use scaled-eta."
                )
        return cls.of(outline, panels, coarseness=coarseness)

    @classmethod
    def of(cls, outline: Complexes, panels: Panels, *, coarseness: float = 1.0) -> Self:
        """Factorise the integral equation on given panels of an outline."""
        factors, pivots = scipy.linalg.lu_factor(
            _matrix(panels), overwrite_a=True, check_finite=False
        )
        return cls(
            outline=outline,
            panels=panels,
            factors=freeze(factors),
            pivots=freeze(pivots),
            coarseness=coarseness,
        )

    @property
    def nbytes(self) -> int:
        """Memory that the arrays take, in bytes."""
        return self.factors.nbytes + self.pivots.nbytes

    @property
    def nodes(self) -> Complexes:
        """Points of the outline (N,) at which real parts are given."""
        return self.panels.nodes.ravel()

    def extend(self, real_parts: Floats, points: Complexes) -> tuple[Complexes, Complexes]:
        """Return holomorphic functions with given real parts on the outline, and their derivatives.

        Parameters
        ----------
        real_parts : float64, shape (N, j)
            At `nodes`.
        points : complex128, shape (t,)
            In the closed domain.

        Returns
        -------
        values, derivatives : complex128, shape (t, j)
            Of each function, up to an imaginary constant. At a corner that turns inwards a
            derivative is unbounded, and the value there means nothing.
        """
        densities = scipy.linalg.lu_solve(
            (self.factors, self.pivots), real_parts, check_finite=False
        )
        return cauchy_integrals(self.panels, densities, _strictly_inside(self.outline, points))


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


def _matrix(panels: Panels) -> Floats:
    """Return the collocated operator (N, N): row i is the equation at node i."""
    nodes = panels.nodes.ravel()
    differentials = panels.differentials().ravel()
    size = len(nodes)
    matrix = np.empty((size, size), order="F")  # as the factorisation wants it
    for panel in range(len(panels)):
        own = slice(panel * NODES, (panel + 1) * NODES)
        with np.errstate(divide="ignore", invalid="ignore"):
            matrix[:, own] = (differentials[own] / (nodes[own] - nodes[:, None])).imag
    for panel in range(len(panels)):
        _integrate_exactly(panels, panel, nodes, matrix)
    matrix /= 2 * np.pi
    matrix[np.diag_indices(size)] += 0.5
    return matrix


def _integrate_exactly(panels: Panels, panel: int, nodes: Complexes, matrix: Floats) -> None:
    """Replace the columns of a panel at the nodes near it."""
    count = len(panels)
    power = int(panels.power[panel])
    w = (nodes - panels.origin[panel]) / panels.span[panel]
    w = w.reshape(count, NODES)
    backward, following = (panel - 1) % count, (panel + 1) % count
    if power != 1:
        # Across a corner both panels start there, and nodes as close to it as 1e-10 of a panel keep
        # all their digits only if the corner is never added and subtracted.
        across = backward if panels.forward[panel] else following
        w[across] = panels.arcs()[across] * (panels.span[across] / panels.span[panel])
    w = w.ravel()
    near = is_near(w, power)
    own = slice(panel * NODES, (panel + 1) * NODES)
    near[own] = False
    rows = np.flatnonzero(near)
    sign = 1.0 if panels.forward[panel] else -1.0
    matrix[rows, own] = sign * panel_weights(w[rows], power)[0].imag
    # On a straight panel the kernel of a node of the same edge vanishes.
    matrix[own, own] = 0.0
