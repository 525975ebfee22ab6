"""A closed curve by few, well-shaped edges: the cheapest polygon by dynamic programming."""

import numpy as np

from engine.arrays import Complexes, Floats, Indices

FARTHEST = 40  # points along the curve that one edge may span
FIDELITY = 3.0  # cost of an edge with the whole tolerance as root mean square error, in edges
LAST_RESORT = 1e3  # cost of an edge that is too short, in edges


def choose_vertices(
    curve: Complexes, inner: Floats, outer: Floats, *, shortest: float, longest: float
) -> Indices:
    """Choose the points of a closed curve that make the best polygon.

    An edge may pass on the inner side of the curve by at most `inner` and on its outer side by at
    most `outer`. Among the polygons with such edges the one with the smallest sum over its edges
    of 1 + 3 (mean square deviation over tolerance) is taken: few vertices, well placed.

    Parameters
    ----------
    curve : complex128, shape (n,)
        With its inner side on the left.
    inner, outer : float64, shape (n,)
        Tolerances at each point.
    shortest, longest : float
        Lengths of an edge. Shorter ones are taken only where nothing else fits.

    Returns
    -------
    intp, shape (p,)
        Ascending.

    Notes
    -----
    The best polygon through point 0 comes first; the best one through a vertex of that polygon
    far from point 0 is then practically the best of all. O(n) steps of 40 candidates each.
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
    spans = min(FARTHEST, n // 3)
    costs = np.empty((spans, n))
    # Curve, tolerances continued past the end, so that shifts are slices.
    around, inside, outside = (
        np.concatenate([values, values[: spans + 1]]) for values in (curve, inner, outer)
    )
    for span in range(1, spans + 1):
        chord = around[span : span + n] - curve
        length = np.abs(chord)
        direction = chord.conj() / np.maximum(length, 1e-300)
        worst, squares = np.zeros(n), np.zeros(n)
        for step in range(1, span):
            offset = (around[step : step + n] - curve) * direction
            # Left of the chord, the chord passes outside the curve; right of it, inside.
            tolerance = np.where(offset.imag > 0, outside[step : step + n], inside[step : step + n])
            # Past an end of the chord the curve turns back: measured from that end.
            past = np.maximum(np.maximum(-offset.real, offset.real - length), 0)
            error = np.hypot(offset.imag, past) / tolerance
            np.maximum(worst, error, out=worst)
            squares += error**2
        cost = 1 + FIDELITY * squares / max(span - 1, 1)
        cost[length < shortest] += LAST_RESORT
        # One step along the curve is always allowed, so that there is a polygon at all.
        if span > 1:
            cost[(worst > 1) | (length > longest)] = np.inf
        costs[span - 1] = cost
    return costs


def _cheapest_round(costs: Floats) -> Indices:
    """Return the vertices, ascending from 0, of the cheapest polygon that starts at point 0."""
    spans, n = costs.shape
    best = np.full(n + 1, np.inf)
    best[0] = 0
    previous = np.zeros(n + 1, dtype=np.intp)
    # Row i: the costs of the edges that end at point i, from the points i - 1, i - 2, …
    arriving = np.stack([np.roll(costs[span], span + 1) for span in range(spans)], axis=1)
    for end in range(1, n + 1):
        reach = min(spans, end)
        total = best[end - reach : end][::-1] + arriving[end % n, :reach]
        choice = int(total.argmin())
        best[end], previous[end] = total[choice], end - 1 - choice
    vertices = []
    end = n
    while end > 0:
        end = int(previous[end])
        vertices.append(end)
    return np.array(vertices[::-1], dtype=np.intp)
