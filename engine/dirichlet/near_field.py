"""Exact integrals over the panels near some points, as sparse matrices."""

import numpy as np
from scipy.sparse import bsr_array

from engine.arrays import Booleans, Complexes, Indices
from engine.dirichlet.panels import NODES, Panels, end_values
from engine.dirichlet.product_integration import panel_weights

BLOCK = 2048  # pairs that are integrated at a time, to stay in cache

# Distance from a panel, over its length, beyond which single precision is as accurate as the
# expansions of far panels. Closer to it large weights of neighbours cancel.
AWAY = 0.2


def near_matrix(
    panels: Panels,
    points: Complexes,
    rows: Indices,
    columns: Indices,
    alone: Booleans,
    *,
    single: bool = False,
) -> bsr_array:
    """Return the near panels' part of Re g, Im g, Re g' and Im g' at points, (4 t, N).

    Parameters
    ----------
    points : complex128, shape (t,)
        Strictly inside the outline.
    rows, columns : intp, shape (n,)
        Pairs of points and near panels, sorted.
    alone : bool, shape (2, n)
        Whether the panel before the near one, and the one after it, are not near the point.

    Notes
    -----
    g' is the integral of dμ / (ζ − z). With the derivative under the integral, the small jumps of
    a discrete μ between panels would become poles on the outline. A panel that is not near has the
    derivative under the integral; the difference is μ / (ζ − z) at its ends. Where such a panel
    meets a near panel, the near panel includes this term, too. Then only the jump is left, which is
    far.
    """
    data = np.empty((len(rows), 4, NODES), dtype=np.float32 if single else np.float64)
    for power in np.unique(panels.power):
        own = np.flatnonzero(panels.power[columns] == power)
        for start in range(0, len(own), BLOCK):
            block = own[start : start + BLOCK]
            panel = columns[block]
            weights, slopes = _weights(
                panels, panel, points[rows[block]], int(power), alone[:, block]
            )
            data[block, 0], data[block, 1] = weights.real, weights.imag
            data[block, 2], data[block, 3] = slopes.real, slopes.imag
    starts = np.searchsorted(rows, np.arange(len(points) + 1))
    return bsr_array((data, columns, starts), shape=(4 * len(points), NODES * len(panels)))


def near_matrices(
    panels: Panels, points: Complexes, rows: Indices, columns: Indices, alone: Booleans
) -> tuple[bsr_array, bsr_array]:
    """Return two matrices that add up to `near_matrix`: of close pairs, and float32 of the rest."""
    place = (points[rows] - panels.origin[columns]) / panels.span[columns]
    away = np.abs(place - np.clip(place.real, 0.0, 1.0)) >= AWAY
    close, rest = (
        near_matrix(panels, points, rows[own], columns[own], alone[:, own], single=single)
        for own, single in ((~away, False), (away, True))
    )
    return close, rest


def _weights(
    panels: Panels, panel: Indices, z: Complexes, power: int, alone: Booleans
) -> tuple[Complexes, Complexes]:
    """Return the weights (n, NODES) of g and g' at points (n,), each with its panel."""
    forward = panels.forward[panel]
    span = panels.span[panel]
    offset = z - panels.origin[panel]
    weights, slopes = panel_weights(offset / span, power)
    sign = np.where(forward, 1.0, -1.0) / (2j * np.pi)
    # At τ = 0 and 1; `alone` is in the order of the ends along the outline.
    first, last = end_values()
    at_origin = np.where(forward, alone[0], alone[1]) / offset
    at_end = np.where(forward, alone[1], alone[0]) / (offset - span)
    slopes /= span[:, None]
    slopes -= at_origin[:, None] * first
    slopes += at_end[:, None] * last
    return weights * sign[:, None], slopes * sign[:, None]
