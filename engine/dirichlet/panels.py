"""Straight panels of an outline, on which densities are polynomials in a graded parameter."""

from dataclasses import dataclass
from functools import cache
from typing import Self

import numpy as np

from engine.arrays import Booleans, Complexes, Floats, Indices, readonly
from engine.geometry import distance_to_segments, edges

NODES = 12  # Gauss-Legendre nodes of a panel
POWER = 3  # grading at corners: arc length is the third power of the parameter
# A panel is no longer than its distance to the nearest cage vertex (where the keyframes vary fast)
# times the first, and to the nearest edge that is no neighbour times the second.
CAGE_RATIO = 2.0
GAP_RATIO = 8.0
FINEST = 2.0**-20  # of an edge: panels are not cut below this


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Panels:
    """Pieces ζ(τ) = origin + span · τ^power of an outline, 0 ≤ τ ≤ 1, in order along it.

    A panel that ends at a corner has its origin there and the power `POWER`, the others have the
    power 1. Solutions of the Dirichlet problem behave like s^β at a corner, with β above 1/2; in τ
    that is smooth enough for polynomials.

    Parameters
    ----------
    origin, span : complex128, shape (p,)
    power : intp, shape (p,)
    forward : bool, shape (p,)
        Whether the panel runs from its origin along the outline, or against it.
    """

    origin: Complexes
    span: Complexes
    power: Indices
    forward: Booleans

    @classmethod
    def on(cls, outline: Complexes, cage: Complexes, *, coarseness: float = 1.0) -> Self:
        """Cut an outline into panels as short as its narrow places and the cage ask for.

        Parameters
        ----------
        outline, cage : complex128, shapes (p,) and (n,)
        coarseness : float
            Factor on how long the panels may be.
        """
        sides = edges(outline)
        count = len(outline)
        # Every edge is first halved, so that a panel touches one corner at most.
        edge = np.repeat(np.arange(count), 2)
        place = np.tile([0.0, 0.5], count)
        width = np.full(2 * count, 0.5)
        done = []
        while len(edge):
            starts = outline[edge] + place * sides[edge]
            ends = outline[edge] + (place + width) * sides[edge]
            room = coarseness * _room(starts, ends, edge, outline, cage)
            fine = (np.abs(ends - starts) <= room) | (width <= FINEST)
            done.append(np.column_stack([edge, place, width])[fine])
            coarse = ~fine
            half = width[coarse] / 2
            edge, width = np.tile(edge[coarse], 2), np.tile(half, 2)
            place = np.concatenate([place[coarse], place[coarse] + half])
        table = np.concatenate(done)
        table = table[np.lexsort((table[:, 1], table[:, 0]))]
        edge, place, width = table[:, 0].astype(np.intp), table[:, 1], table[:, 2]
        forward = place + width < 1.0
        corner = (place == 0.0) | ~forward
        following = np.roll(outline, -1)[edge]
        span = width * sides[edge]
        return cls(
            origin=readonly(np.where(forward, outline[edge] + place * sides[edge], following)),
            span=readonly(np.where(forward, span, -span)),
            power=readonly(np.where(corner, POWER, 1)),
            forward=readonly(forward),
        )

    def __len__(self) -> int:
        """Return the number of panels."""
        return len(self.origin)

    @property
    def nodes(self) -> Complexes:
        """Gauss-Legendre nodes, (p, NODES)."""
        result: Complexes = self.origin[:, None] + self.span[:, None] * self.arcs()
        return result

    def arcs(self) -> Floats:
        """Return τ^power at the nodes, (p, NODES): their distance from the origin over the span."""
        tau, _ = gauss_legendre()
        result: Floats = tau ** self.power[:, None]
        return result

    def differentials(self) -> Complexes:
        """Return dζ at the nodes, (p, NODES), counter-clockwise: the weights of line integrals."""
        tau, weights = gauss_legendre()
        speed = self.power[:, None] * tau ** (self.power[:, None] - 1)
        sign = np.where(self.forward, 1.0, -1.0)
        result: Complexes = (sign * self.span)[:, None] * speed * weights
        return result

    def increments(self, values: Complexes) -> Complexes:
        """Return dμ at the nodes, like the values (p, NODES, j): weights of integrals of dμ."""
        sign = np.where(self.forward, 1.0, -1.0)
        _, weights = gauss_legendre()
        _, differentiation = legendre_matrices()
        slopes = np.einsum("ik,pkj->pij", differentiation, values)
        result: Complexes = sign[:, None, None] * weights[:, None] * slopes
        return result


@cache
def gauss_legendre() -> tuple[Floats, Floats]:
    """Return the Gauss-Legendre nodes of [0, 1] and their weights, (NODES,) each."""
    x, weights = np.polynomial.legendre.leggauss(NODES)
    return readonly((1 + x) / 2), readonly(weights / 2)


@cache
def legendre_matrices() -> tuple[Floats, Floats]:
    """Return the matrices from values at the nodes to Legendre coefficients and to derivatives."""
    tau, weights = gauss_legendre()
    degrees = np.arange(NODES)
    values = np.polynomial.legendre.legvander(2 * tau - 1, NODES - 1)
    to_legendre = (2 * degrees + 1)[:, None] * values.T * weights
    by_degree = np.polynomial.legendre.legder(np.eye(NODES), scl=2.0)
    slopes = np.polynomial.legendre.legval(2 * tau - 1, by_degree).T
    return readonly(to_legendre), readonly(slopes @ to_legendre)


def _room(
    starts: Complexes, ends: Complexes, edge: Indices, outline: Complexes, cage: Complexes
) -> Floats:
    """Return how long a panel on each of the segments may be."""
    count = len(outline)
    following = np.roll(outline, -1)
    to_cage = distance_to_segments(cage, starts, ends).min(axis=0)
    # Two segments that do not cross are nearest at an end of one of them.
    from_vertices = distance_to_segments(outline, starts, ends).T
    to_edges = np.minimum(from_vertices, np.roll(from_vertices, -1, axis=1))
    for end in (starts, ends):
        np.minimum(to_edges, distance_to_segments(end, outline, following), out=to_edges)
    own = np.arange(len(edge))
    for neighbour in (-1, 0, 1):
        to_edges[own, (edge + neighbour) % count] = np.inf
    room: Floats = np.minimum(CAGE_RATIO * to_cage, GAP_RATIO * to_edges.min(axis=1))
    return room
