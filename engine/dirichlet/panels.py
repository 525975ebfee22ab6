"""Straight panels of a boundary, on which densities are polynomials in a graded parameter."""

from dataclasses import dataclass
from functools import cache
from typing import Self

import numpy as np

from engine.arrays import Booleans, Complexes, Floats, Indices, freeze, ragged_indices
from engine.geometry import (
    Domain,
    Pieces,
    bisect_segments,
    distance_to_segments,
    loop_ends,
    next_on_loop,
)

NODES = 12  # Gauss-Legendre nodes of a panel
POWER = 3  # grading at corners: arc length is the third power of the parameter
# Upper limit of a panel's length: PANEL_PER_CAGE times the distance to the nearest cage vertex,
# where the keyframes vary fast, and PANEL_PER_GAP times that to the nearest non-adjacent edge.
PANEL_PER_CAGE = 2.0
PANEL_PER_GAP = 8.0
FINEST = 2.0**-20  # of an edge: shorter panels are not cut
# Polynomials are checked at so many places between two nodes, and at a panel's ends. While they
# exceed limits by more than SLIGHT, the limits are tightened by so many times the excess.
BETWEEN, SLIGHT, TIGHTER, MOST_TIGHTENINGS = 3, 1e-5, 1.2, 16


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Panels:
    """Pieces ζ(τ) = origin + span · τ^power of a boundary, 0 ≤ τ ≤ 1, in order along its loops.

    A panel that ends at a corner has its origin there and the power `POWER`; the others have the
    power 1. Solutions of the Dirichlet problem behave like s^β at a corner, with β above 1/2. In τ
    they are smooth enough for polynomials.

    Attributes
    ----------
    origin, span : complex128, shape (p,)
    power : intp, shape (p,)
    forward : bool, shape (p,)
        Whether the panel runs from its origin along its loop, or against it.
    starts : intp, shape (1 + holes,)
        The first panel of each loop.
    """

    origin: Complexes
    span: Complexes
    power: Indices
    forward: Booleans
    starts: Indices

    @classmethod
    def on(cls, domain: Domain, *, coarseness: float = 1.0) -> Self:
        """Cut a boundary into panels short enough for its narrow places and for the cages.

        `coarseness` is a factor on the largest length of the panels.
        """
        loops, cages = domain.loops, np.concatenate(domain.cages)
        corners, following = np.concatenate(loops), loop_ends(loops)
        firsts = np.cumsum([0, *map(len, loops[:-1])])
        sides = Pieces.whole(corners, following)
        # Every edge is first halved, so that a panel touches at most one corner.
        halves = sides.halved(np.ones(len(corners), dtype=np.bool_))

        def is_fine(pieces: Pieces) -> Booleans:
            room = coarseness * _room(pieces, corners, next_on_loop(firsts, len(corners)), cages)
            fine: Booleans = (pieces.lengths <= room) | (pieces.width <= FINEST)
            return fine

        pieces = bisect_segments(halves, is_fine)
        forward = pieces.place + pieces.width < 1.0
        corner = (pieces.place == 0.0) | ~forward
        span = pieces.width * pieces.span[pieces.segment]
        return cls(
            origin=freeze(np.where(forward, pieces.starts, following[pieces.segment])),
            span=freeze(np.where(forward, span, -span)),
            power=freeze(np.where(corner, POWER, 1)),
            forward=freeze(forward),
            starts=freeze(np.searchsorted(pieces.segment, firsts)),
        )

    def unresolved(self, values: Floats, tolerance: float) -> Booleans:
        """Return the panels (p,) too coarse for polynomials through values (N, j) at the nodes.

        There one of the last Legendre coefficients is above `tolerance`.
        """
        to_legendre, _ = legendre_matrices()
        last = to_legendre[-2:] @ values.reshape(len(self), NODES, -1)
        coarse: Booleans = np.abs(last).max(axis=(1, 2)) > tolerance
        return coarse

    def halved(self, chosen: Booleans) -> Self:
        """Return the panels with the chosen ones (p,) cut in the middle."""
        panel, place = ragged_indices(1 + chosen.astype(np.intp))
        at_origin = ~chosen[panel] | ((place == 0) == self.forward[panel])
        span = np.where(chosen[panel], self.span[panel] / 2, self.span[panel])
        firsts = np.cumsum([0, *(1 + chosen)])
        return type(self)(
            origin=freeze(self.origin[panel] + np.where(at_origin, 0, span)),
            span=freeze(span),
            power=freeze(np.where(at_origin, self.power[panel], 1)),
            forward=freeze(self.forward[panel]),
            starts=freeze(firsts[self.starts]),
        )

    def only(self, chosen: Booleans) -> Self:
        """Return the chosen panels (p,), as if they were one loop."""
        return type(self)(
            origin=self.origin[chosen],
            span=self.span[chosen],
            power=self.power[chosen],
            forward=self.forward[chosen],
            starts=np.zeros(1, dtype=np.intp),
        )

    def interpolate(self, values: Floats) -> Floats:
        """Return polynomials through values (p, NODES) at `checked_places`, (p, c)."""
        _, to_checked = checked_places()
        result: Floats = values @ to_checked.T
        return result

    def fit_within(
        self, values: Floats, low: Floats, high: Floats, shifts: Floats
    ) -> tuple[Floats, float]:
        """Find polynomials r on the panels with low ≤ values + r ≤ high at the checked places.

        A clipped function has kinks, and polynomials through its nodes exceed the limits beside a
        kink. On such a panel the limits are tightened by the excess, and less and less towards the
        far ends of both neighbours, so that r is continuous along a loop. r is also continuous in
        all arguments, and 0 where the values are within the limits.

        Parameters
        ----------
        values, low, high : float64, shape (p, c)
            At `checked_places`.
        shifts : float64, shape (p,)
            Added to the values before they are clipped.

        Returns
        -------
        fitted : float64, shape (p, NODES)
            r at the nodes.
        excess : float
            How far values + r still are outside the limits.
        """
        tau, _ = gauss_legendre()
        along = np.where(self.forward[:, None], tau, 1.0 - tau)
        own, least, most = (each[:, :NODES] for each in (values, low, high))
        wanted, middle = own + shifts[:, None], (least + most) / 2
        following, previous = self.next_panels, self.previous_panels
        spare = np.zeros(len(self))
        for _ in range(MOST_TIGHTENINGS):
            ends = np.maximum(spare, spare[following])
            starts = ends[previous]
            less = starts[:, None] + along * (ends - starts)[:, None]
            least_now, most_now = np.minimum(least + less, middle), np.maximum(most - less, middle)
            fitted = np.clip(wanted, least_now, most_now) - own
            reached = values + self.interpolate(fitted)
            excess = np.maximum(reached - high, low - reached).max(axis=1)
            if excess.max() <= SLIGHT:
                break
            spare += TIGHTER * np.maximum(excess, 0.0)
        return fitted, max(float(excess.max()), 0.0)

    def __len__(self) -> int:
        return len(self.origin)

    @property
    def next_panels(self) -> Indices:
        """The next panel of each on its loop, intp (p,)."""
        return next_on_loop(self.starts, len(self))

    @property
    def previous_panels(self) -> Indices:
        """The previous panel of each on its loop, intp (p,)."""
        return np.argsort(self.next_panels)

    @property
    def middles(self) -> Complexes:
        """Points halfway between the ends of each panel, (p,)."""
        result: Complexes = self.origin + self.span / 2
        return result

    @property
    def nodes(self) -> Complexes:
        """Gauss-Legendre nodes, (p, NODES)."""
        result: Complexes = self.origin[:, None] + self.span[:, None] * self.arcs()
        return result

    @property
    def checked(self) -> Complexes:
        """The points (p, c) of `checked_places` on each panel."""
        tau, _ = checked_places()
        result: Complexes = self.origin[:, None] + self.span[:, None] * tau ** self.power[:, None]
        return result

    def arcs(self) -> Floats:
        """Return τ^power at the nodes, (p, NODES): the distance from the origin over the span."""
        tau, _ = gauss_legendre()
        result: Floats = tau ** self.power[:, None]
        return result

    def differentials(self) -> Complexes:
        """Return dζ at the nodes, (p, NODES), along the loops: the weights of line integrals."""
        tau, weights = gauss_legendre()
        speed = self.power[:, None] * tau ** (self.power[:, None] - 1)
        sign = np.where(self.forward, 1.0, -1.0)
        result: Complexes = (sign * self.span)[:, None] * speed * weights
        return result


@cache
def gauss_legendre() -> tuple[Floats, Floats]:
    """Return the Gauss-Legendre nodes of [0, 1] and their weights, (NODES,) each."""
    x, weights = np.polynomial.legendre.leggauss(NODES)
    return freeze((1 + x) / 2), freeze(weights / 2)


@cache
def legendre_matrices() -> tuple[Floats, Floats]:
    """Return the matrices from values at the nodes to Legendre coefficients and to derivatives."""
    tau, weights = gauss_legendre()
    degrees = np.arange(NODES)
    values = np.polynomial.legendre.legvander(2 * tau - 1, NODES - 1)
    to_legendre = (2 * degrees + 1)[:, None] * values.T * weights
    by_degree = np.polynomial.legendre.legder(np.eye(NODES), scl=2.0)
    derivatives = np.polynomial.legendre.legval(2 * tau - 1, by_degree).T
    return freeze(to_legendre), freeze(derivatives @ to_legendre)


@cache
def checked_places() -> tuple[Floats, Floats]:
    """Return the nodes of [0, 1], then both ends and places between the nodes, (c,).

    The matrix (c, NODES) leads from values at the nodes to those of their polynomials there.
    """
    tau, _ = gauss_legendre()
    shares = np.arange(1, BETWEEN + 1) / (BETWEEN + 1)
    gaps = (tau[:-1, None] + np.diff(tau)[:, None] * shares).ravel()
    between = np.concatenate([[0.0], gaps, [1.0]])
    to_legendre, _ = legendre_matrices()
    to_between = np.polynomial.legendre.legvander(2 * between - 1, NODES - 1) @ to_legendre
    places = np.concatenate([tau, between])
    return freeze(places), freeze(np.concatenate([np.eye(NODES), to_between]))


@cache
def end_values() -> tuple[Floats, Floats]:
    """Return the weights (NODES,) from values at the nodes to those at τ = 0 and at τ = 1."""
    to_legendre, _ = legendre_matrices()
    signs = (-1.0) ** np.arange(NODES)
    return freeze(signs @ to_legendre), freeze(to_legendre.sum(axis=0))


def _room(pieces: Pieces, corners: Complexes, following: Indices, cage: Complexes) -> Floats:
    """Return the largest length of a panel on each of the pieces of edges."""
    starts, ends = pieces.starts, pieces.ends
    to_cage = distance_to_segments(cage, starts, ends).min(axis=0)
    # Two segments that do not cross are nearest at an end of one of them.
    from_vertices = distance_to_segments(corners, starts, ends).T
    to_edges = np.minimum(from_vertices, from_vertices[:, following])
    for end in (starts, ends):
        np.minimum(to_edges, distance_to_segments(end, corners, corners[following]), out=to_edges)
    own = np.arange(len(pieces))
    for neighbour in (np.arange(len(corners)), following, np.argsort(following)):
        to_edges[own, neighbour[pieces.segment]] = np.inf
    room: Floats = np.minimum(PANEL_PER_CAGE * to_cage, PANEL_PER_GAP * to_edges.min(axis=1))
    return room
