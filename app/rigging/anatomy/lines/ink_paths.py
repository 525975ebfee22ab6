"""Ink of the lines in a picture, and cheapest paths along it."""

import numpy as np
from scipy import ndimage

from engine.arrays import Floats, Indices

# Largest width of a line as a share of the picture's longer side, and the contrast, as a share of
# the brightness around it, that counts fully.
LINE, DARK = 0.02, 0.2


def width_of_lines(longer: float) -> int:
    """Return the odd number of samples that is wider than a line, of the longer side's number."""
    return 2 * int(np.ceil(LINE * longer / 2)) + 1


def mark_ink(brightness: Floats, size: tuple[int, int]) -> Floats:
    """Return how much darker lines are than what is on both sides, from 0 to 1.

    They are narrower than the size, in rows and columns; of one row, those that cross it.
    """
    around = ndimage.grey_closing(brightness, size=size)
    darker = (around - brightness) / (DARK * np.maximum(around, 1.0))
    return np.asarray(np.clip(darker, 0.0, 1.0), np.float64)


def find_cheapest_paths(costs: Floats, steepest: int, slope: float) -> Indices:
    """Return the sample of each row (c, r) on the cheapest path through costs (c, r, k).

    From row to row a path moves by at most `steepest` samples, each of which costs `slope`.
    """
    moves = np.arange(-steepest, steepest + 1)
    total = costs[:, 0]
    choices = np.zeros(costs.shape, dtype=np.intp)
    for row in range(1, costs.shape[1]):
        padded = np.pad(total, ((0, 0), (steepest, steepest)), constant_values=np.inf)
        windows = np.lib.stride_tricks.sliding_window_view(padded, costs.shape[2], axis=1)
        options = windows + slope * np.abs(moves)[:, None]
        choices[:, row] = options.argmin(axis=1)
        total = options.min(axis=1) + costs[:, row]
    path = np.zeros(costs.shape[:2], dtype=np.intp)
    path[:, -1] = total.argmin(axis=1)
    each = np.arange(len(costs))
    for row in range(costs.shape[1] - 1, 0, -1):
        path[:, row - 1] = path[:, row] + moves[choices[each, row, path[:, row]]]
    return path
