"""The Dirichlet problem on partly halved panels, with the solver of the whole panels.

Let e be the given real parts minus their polynomials p on a whole panel. It is small and nonzero on
this panel only. On a straight panel, half of a density is the panel's own part of the real part.
The density 2e there leaves a smooth problem to the solver of the whole panels,

    (1/2 + K) μ = p − 2 K e,      p + e the real parts,

and no new factorisation is necessary.
"""

from dataclasses import dataclass
from itertools import pairwise
from typing import NamedTuple, Self

import numpy as np

from engine.arrays import Booleans, Complexes, Floats, Indices
from engine.dirichlet.hilbert import Extended, Extension, HilbertTransform
from engine.dirichlet.near_field import near_matrix
from engine.dirichlet.panels import NODES, Panels, end_values
from engine.dirichlet.product_integration import near_distance

BLOCK = 2048  # points at a time
FIRM = 1e4  # weight of a panel's ends relative to a node, so that the ends are interpolated


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Refinement:
    """A transform of real parts given at the nodes of panels, some of them halved.

    `transform` has the whole panels; `whole` (p,) is the whole panel of each part in `panels`.
    """

    transform: HilbertTransform
    panels: Panels
    whole: Indices

    @classmethod
    def of(cls, transform: HilbertTransform) -> Self:
        """Return a transform's own panels, none of them halved."""
        panels = transform.panels
        return cls(transform=transform, panels=panels, whole=np.arange(len(panels)))

    def halved(self, chosen: Booleans) -> Self:
        """Return the panels with the chosen ones (p,) cut in the middle."""
        whole = np.repeat(self.whole, 1 + chosen)
        return type(self)(transform=self.transform, panels=self.panels.halved(chosen), whole=whole)

    @property
    def nodes(self) -> Complexes:
        """Points of the boundary (N,) for the given real parts."""
        return self.transform.centre + self.panels.nodes.ravel()

    def solve(self, real_parts: Floats) -> "Densities":
        """Find the holomorphic functions with given real parts (N, j) at the nodes.

        Unlike `Extension.extend` this needs no points; the result holds for any.
        """
        is_cut = np.bincount(self.whole)[self.whole] > 1
        transform, columns = self.transform, real_parts.shape[1]
        if not is_cut.any():
            densities = transform.solver(real_parts)
            return Densities(densities, transform.means @ densities, None)
        given = real_parts.reshape(len(self.panels), NODES, columns)
        smooth = np.empty((len(transform.panels), NODES, columns))
        smooth[self.whole[~is_cut]] = given[~is_cut]
        parts, whole, given = self.panels.only(is_cut), self.whole[is_cut], given[is_cut]
        lacking = np.empty_like(given)
        for number in np.unique(whole):
            own = whole == number
            smooth[number], lacking[own] = _projected(
                transform.panels, number, parts.nodes[own], given[own]
            )
        local = LocalDensities(parts=parts, whole=whole, densities=2 * lacking)
        right = smooth.reshape(-1, columns)
        right -= local.at(transform.panels.nodes.ravel(), np.repeat(np.arange(len(smooth)), NODES))[
            0
        ].real
        means = local.means(transform.panels)
        right -= (transform.means > 0).T @ means
        densities = transform.solver(right)
        return Densities(densities, transform.means @ densities + means, local)


def _projected(
    panels: Panels, number: int, nodes: Complexes, given: Floats
) -> tuple[Floats, Floats]:
    """Fit polynomials to the values on the parts (c, NODES, j) of a panel.

    Returned are the polynomials at the panel's own nodes (NODES, j), and the residuals at the nodes
    of the parts. The residuals vanish at the panel's ends, so densities stay continuous there.
    """
    power, is_forward = panels.power[number], panels.forward[number]
    arcs = ((nodes - panels.origin[number]) / panels.span[number]).real.ravel()
    flat, (first, last) = given.reshape(len(arcs), -1), end_values()
    at_origin, at_end = (0, -1) if is_forward else (-1, 0)
    ends = np.array([first @ given[at_origin], last @ given[at_end]])
    matrix, at_ends = _legendre(arcs ** (1 / power)), FIRM * _legendre(np.array([0.0, 1.0]))
    coefficients = np.linalg.lstsq(
        np.concatenate([matrix, at_ends]), np.concatenate([flat, FIRM * ends])
    )[0]
    at_nodes: Floats = _legendre(panels.arcs()[number] ** (1 / power)) @ coefficients
    return at_nodes, (flat - matrix @ coefficients).reshape(given.shape)


def _legendre(tau: Floats) -> Floats:
    """Return the Legendre polynomials of [0, 1] below the degree NODES, (t, NODES)."""
    values = np.polynomial.legendre.legvander(2 * tau - 1, NODES - 1)
    return np.asarray(values, dtype=np.float64)


class Densities(NamedTuple):
    """Holomorphic functions given by densities on the boundary, for evaluation at any points.

    `whole` (N, j) are densities at the nodes of the whole panels, `local` those added on parts of
    panels. `lacking` is as in `Extended`.
    """

    whole: Floats
    lacking: Floats
    local: "LocalDensities | None"

    def at(self, extension: Extension) -> Extended:
        """Return the functions at the points of an extension.

        Time grows with the product of points and halved panels.
        """
        values, derivatives = extension.integral(self.whole)
        if self.local is not None:
            more, steeper = self.local.at(extension.inside)
            values, derivatives = values + more, derivatives + steeper
        return Extended(values, derivatives, self.lacking)


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class LocalDensities:
    """Densities (p, NODES, j) on parts of a few whole panels, 0 on all others."""

    parts: Panels
    whole: Indices
    densities: Floats

    def at(self, points: Complexes, own: Indices | None = None) -> tuple[Complexes, Complexes]:
        """Return the Cauchy integral and its derivative at points (t,), each (t, j).

        `own` are the whole panels (t,) that contain points of the boundary. A panel's contribution
        at its own points is imaginary, and is left out.
        """
        columns = self.densities.shape[2]
        found = np.empty((2, len(points), columns), dtype=np.complex128)
        for start in range(0, len(points), BLOCK):
            block = slice(start, start + BLOCK)
            omitted = None if own is None else own[block, None] == self.whole
            found[:, block] = self._block(points[block], omitted)
        return found[0], found[1]

    def _block(self, points: Complexes, omitted: Booleans | None) -> Complexes:
        parts, columns = self.parts, self.densities.shape[2]
        nodes, densities = parts.nodes.ravel(), self.densities.reshape(-1, columns)
        around = (0.5 + near_distance(parts.power)) * np.abs(parts.span)
        near = np.abs(points[:, None] - parts.middles) < around
        plain = ~near
        if omitted is not None:
            near &= ~omitted
            plain &= ~omitted
        kernel = np.repeat(plain, NODES, axis=1) / (nodes - points[:, None])
        masses = densities * (parts.differentials().reshape(-1, 1) / (2j * np.pi))
        rows, columns_near = np.nonzero(near)
        # Where parts meet, as in the integral over whole panels. At the outer ends the jumps are
        # those of the whole density and cancel with it.
        meets = np.diff(self.whole) == 0
        beside = np.roll(near, 1, axis=1), np.roll(near, -1, axis=1)
        before = np.append(False, meets) & ~beside[0]
        following = np.append(meets, False) & ~beside[1]
        alone = np.array([before[rows, columns_near], following[rows, columns_near]])
        matrix = near_matrix(parts, points, rows, columns_near, alone)
        exact = (matrix @ densities).reshape(len(points), 2, 2, columns)
        slopes = kernel**2 @ masses
        return np.stack(
            [
                kernel @ masses + exact[:, 0, 0] + 1j * exact[:, 0, 1],
                slopes + exact[:, 1, 0] + 1j * exact[:, 1, 1],
            ]
        )

    def means(self, panels: Panels) -> Floats:
        """Return the means over the loops of holes, (holes, j), given the whole panels."""
        lengths = np.abs(panels.differentials()).sum(axis=1)
        weights = np.abs(self.parts.differentials())
        means = []
        for start, end in pairwise([*panels.starts[1:], len(panels)]):
            here = (self.whole >= start) & (self.whole < end)
            total = np.tensordot(weights[here], self.densities[here], axes=2)
            means.append(total / lengths[start:end].sum())
        return np.array(means).reshape(len(means), self.densities.shape[2])
