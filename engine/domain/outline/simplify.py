"""Simplify a closed curve to few, well-shaped edges by dynamic programming."""

import numpy as np

from engine.arrays import Complexes, Floats, Indices

LONGEST_SPAN = 40  # largest number of curve points per edge
FIDELITY = 3.0  # cost of an edge with the whole tolerance as root mean square error, in edges
LAST_RESORT = 1e3  # cost of an edge that is too short, in edges


def choose_vertices(
    curve: Complexes, inner: Floats, outer: Floats, *, shortest: float, longest: float
) -> Indices:
    """Choose the points of a closed curve that make the best polygon.

    An edge may pass on the inner side of the curve by at most `inner` and on its outer side by at
    most `outer`. Of the polygons with such edges the one with the smallest sum over its edges of 1
    + 3 (mean square deviation over tolerance) is chosen: few vertices, well placed.

    Parameters
    ----------
    curve : complex128, shape (n,)
        With its inner side on the left.
    inner, outer : float64, shape (n,)
        Tolerances at each point.
    shortest, longest : float
        Lengths of an edge. Shorter ones are chosen only if nothing else fits.

    Returns
    -------
    intp, shape (p,)
        Ascending.

    Notes
    -----
    The best polygon through point 0 comes first; the best one through a vertex of that polygon far
    from point 0 is then practically the best of all. O(n) steps of 40 candidates each.
    """
    costs = _edge_costs(curve, inner, outer, shortest, longest)
    first = _cheapest_round(costs)
    start = int(first[len(first) // 2])
    second = _cheapest_round(np.roll(costs, -start, axis=1))
    return np.sort((second + start) % len(curve))


def _edge_costs(
    curve: Complexes, inner: Floats, outer: Floats, shortest: float, longest: float
) -> Floats:
    """Return the cost (k, n) of the edge from point i to point i + k + 1."""
    n = len(curve)
    spans = min(LONGEST_SPAN, n // 3)
    costs = np.empty((spans, n))
    # Row s: the point s steps along, and the distance of each point from it.
    further = np.arange(n) + np.arange(spans + 1)[:, None]
    further[further >= n] -= n
    away, inside, outside = curve[further] - curve, inner[further], outer[further]
    for span in range(1, spans + 1):
        chord = away[span]
        length = np.abs(chord)
        offset = away[1:span] * (chord.conj() / np.maximum(length, 1e-300))
        # Left of the chord, the chord passes outside the curve; right of it, inside.
        tolerance = np.where(offset.imag > 0, outside[1:span], inside[1:span])
        # Past an end of the chord the curve turns back: measure from this end.
        past = np.maximum(np.maximum(-offset.real, offset.real - length), 0)
        error = np.hypot(offset.imag, past) / tolerance
        worst, squares = error.max(axis=0, initial=0.0), (error**2).sum(axis=0)
        cost = 1 + FIDELITY * squares / max(span - 1, 1)
        cost[length < shortest] += LAST_RESORT
        # One step along the curve is always allowed, so that a polygon exists.
        if span > 1:
            cost[(worst > 1) | (length > longest)] = np.inf
        costs[span - 1] = cost
    return costs


def _cheapest_round(costs: Floats) -> Indices:
    """Return the vertices, ascending from 0, of the cheapest polygon that starts at point 0."""
    spans, n = costs.shape
    # Row i: the costs of the edges that end at point i, from the points i - 1, i - 2, …
    span = np.arange(spans)
    arriving = costs[span, (np.arange(n)[:, None] - span - 1) % n]
    # Point i is at n - i, so that the points before it follow it; there is nothing before point 0.
    best = np.full(n + 1 + spans, np.inf)
    best[n] = 0
    previous = [0] * (n + 1)
    for end in range(1, n + 1):
        total = best[n - end + 1 : n - end + 1 + spans] + arriving[end % n]
        choice = total.argmin()
        best[n - end], previous[end] = total[choice], end - 1 - int(choice)
    vertices = []
    end = n
    while end > 0:
        end = previous[end]
        vertices.append(end)
    return np.array(vertices[::-1], dtype=np.intp)
