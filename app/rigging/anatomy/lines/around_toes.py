"""The line around a near foot: its outline over the far foot, from the ground to the instep.

A toe's upper side may run along the strips across a limb. So the line is found among ways in any
direction, as the cheapest one from the instep to the outline.
"""

import numpy as np
import scipy.sparse
from scipy import ndimage
from scipy.sparse.csgraph import dijkstra

from app.rigging.anatomy.lines.limb_strips import Strips, resample_line
from engine.arrays import Booleans, Complexes, Floats, Indices

INK = 0.5  # evidence of a line
LEVEL = 2  # samples aside and up: the outline rises less between them
EACH, FREE = 0.05, 0.01  # costs of a step, beside 1 in paint, and in background
ROUNDING = 2.0  # samples over which the line is rounded
STEADY = 15  # samples over which the move beyond the ink is steady, more than a line is wide
MOST = 1.3  # of the usual move through ink
FARTHEST = 1.0  # of the usual width of a line: how far its other side is looked for


def lead_round_toes(strips: Strips, instep: int, offset: float, usual: float) -> Complexes:
    """Return the points of the line from the ground up to below the instep.

    Parameters
    ----------
    strips : Strips
        Across the near limb.
    instep, offset : int, float
        Row and sample from which the line leads on above.
    usual : float
        Width of a line, in samples.

    Returns
    -------
    complex128, shape (n,)
        Beside the ink of the near foot; no points where the outline leaves no room beside the feet.
    """
    is_ground = _mark_ground(strips)[:instep]
    start = (instep - 1) * is_ground.shape[1] + round(offset)
    costs = np.where(strips.drawn, EACH + 1.0 - strips.traces, FREE)[:instep]
    distances, before = dijkstra(_steps(costs), indices=start, return_predecessors=True)
    distances[~is_ground.ravel()] = np.inf
    place = int(distances.argmin())
    if not np.isfinite(distances[place]) or place == start:
        return np.empty(0, dtype=np.complex128)
    way = [place]
    while way[-1] != start:
        way.append(int(before[way[-1]]))
    rows, samples = np.divmod(np.array(way), is_ground.shape[1])
    return _beside_ink(strips, rows + 1j * samples, usual)


def _mark_ground(strips: Strips) -> Booleans:
    """Mark what is just below the outline, where it is rather level, and not in its holes."""
    parts, _ = ndimage.label(~strips.inside)
    is_below: Booleans = (parts == parts[0, 0]) & (parts > 0)
    is_below &= np.roll(strips.inside, -1, axis=0)
    for aside in (-LEVEL, LEVEL):
        is_below &= np.roll(strips.inside, (-LEVEL, aside), axis=(0, 1))
    return is_below


def _steps(costs: Floats) -> scipy.sparse.csr_array:
    """Return the costs of steps between the cells of a raster and their eight neighbours."""
    numbers = np.arange(costs.size).reshape(costs.shape)
    starts, ends, lengths = list[Indices](), list[Indices](), list[Floats]()
    for down, right in ((0, 1), (1, 0), (1, 1), (1, -1)):
        here = (slice(None, -down or None), slice(max(0, -right), -right if right > 0 else None))
        there = (slice(down, None), slice(max(0, right), right if right < 0 else None))
        starts.append(numbers[here].ravel())
        ends.append(numbers[there].ravel())
        lengths.append((costs[here] + costs[there]).ravel() / 2 * np.hypot(down, right))
    cells = (np.concatenate(starts), np.concatenate(ends))
    found = scipy.sparse.csr_array((np.concatenate(lengths), cells), shape=(costs.size,) * 2)
    return (found + found.T).tocsr()


def _beside_ink(strips: Strips, way: Complexes, usual: float) -> Complexes:
    """Return a way through ink, in rows + 1j samples, moved along its normals beyond the ink."""
    smooth = ndimage.gaussian_filter1d(resample_line(way, 1.0), ROUNDING, mode="nearest")
    tangents = np.gradient(smooth)
    normals = 1j * tangents / np.abs(tangents)
    at = smooth[:, None] + np.arange(int(FARTHEST * usual) + 2) * normals[:, None]
    is_ink = ndimage.map_coordinates(strips.marks, [at.real, at.imag], order=1) >= INK
    moves = np.where(is_ink.all(axis=1), usual / 2, is_ink.argmin(axis=1))
    # Where the line meets the ground, the ink of the far sole leads on along the normals.
    moves = np.minimum(moves, MOST * np.median(moves[moves > 0])) if moves.any() else moves
    moves = ndimage.median_filter(moves, STEADY, mode="nearest")
    moved = smooth + ndimage.gaussian_filter1d(moves, ROUNDING) * normals
    return strips.place_between(moved.real, moved.imag)
