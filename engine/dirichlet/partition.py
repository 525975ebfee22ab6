"""Recursive bisection of panels into boxes that keep panels on facing sides together.

Two sides of a narrow gap or arm interact through as many functions as they have nodes. A box with
both sides interacts with the rest through its ends alone. Gaps and arms are therefore cut across,
by lines or at places along the boundary, where the fewest facing panels are separated.
"""

import numpy as np
from scipy.spatial import Delaunay, QhullError

from engine.arrays import Floats, Indices
from engine.dirichlet.panels import Panels
from engine.geometry import as_xy

DIRECTIONS = 8  # of the cutting lines
SMALLEST = 0.35  # smallest share of the panels in either half


def partition_panels(panels: Panels, depth: int) -> list[Indices]:
    """Return 2^depth boxes of panels, at most one per panel; halves are adjacent in the list."""
    middles, own = panels.middles - panels.middles.mean(), np.arange(len(panels))
    turns = np.exp(1j * np.pi * np.arange(DIRECTIONS) / DIRECTIONS)
    keys = np.vstack([(middles * turns[:, None]).real, own])
    try:
        a, b, c = Delaunay(as_xy(middles)).simplices.T.astype(np.intp)
    except QhullError:  # all on one line, or nearly
        a = b = c = np.empty(0, dtype=np.intp)
    # Neighbours in a triangulation face each other, at any distance.
    sides = np.sort(np.concatenate([np.column_stack(pair) for pair in ((a, b), (b, c), (c, a))]))
    facing = np.unique(sides, axis=0)
    gaps = np.abs(np.diff(middles[facing])[:, 0])
    # Panels farther apart interact through fewer functions; neighbours on a loop touch.
    prices = np.minimum(1.0, np.abs(panels.span)[facing].min(axis=1) / gaps)
    pairs = np.concatenate([facing, np.column_stack([own, panels.next_panels])])
    return _parts(keys, pairs, np.append(prices, np.ones(len(panels))), depth)


def _parts(keys: Floats, pairs: Indices, prices: Floats, depth: int) -> list[Indices]:
    """Bisect panels by the key (k, p) with the least price of the separated pairs."""
    count = keys.shape[1]
    if depth == 0:
        return [np.arange(count)]
    order = np.argsort(keys, axis=1)
    ends = np.sort(np.argsort(order, axis=1)[:, pairs])
    # A cut between the first and the second panel of a pair separates them.
    opened, closed = (
        np.array([np.bincount(each, prices, count) for each in ends[:, :, i]]) for i in (0, 1)
    )
    least = max(int(SMALLEST * count), 2 ** (depth - 1))
    sizes = np.arange(least, count - least + 1)
    paid = np.cumsum(opened - closed, axis=1)[:, sizes - 1] * (1 + np.abs(sizes / count - 0.5))
    key, best = np.unravel_index(paid.argmin(), paid.shape)
    found = []
    for half in np.split(order[key], [sizes[best]]):
        number = np.full(count, -1)
        number[half] = np.arange(len(half))
        inner = number[pairs]
        whole = (inner >= 0).all(axis=1)
        parts = _parts(keys[:, half], inner[whole], prices[whole], depth - 1)
        found += [half[part] for part in parts]
    return found
