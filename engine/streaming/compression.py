"""Few functions of time instead of many polynomials: the numerical rank of a motion."""

import numpy as np

from engine.arrays import Floats
from engine.streaming.series import Singles

SAMPLED = 8192  # columns that the rank is found from


def leading_functions(snapshots: Singles, tolerance: float) -> Floats:
    """Return an orthonormal basis (m, r) in which all columns of `snapshots` are written.

    A column is what one coordinate of one point does in time. As points move alike, far fewer
    functions of time occur among them than a polynomial basis has.

    Parameters
    ----------
    snapshots : float32, shape (m, c)
    tolerance : float
        The largest entry that `snapshots` may lose; sampled at some columns, which is enough where
        neighbouring points move alike.
    """
    # An odd stride takes x and y in turn.
    stride = (snapshots.shape[1] // SAMPLED) | 1
    rest = snapshots[:, ::stride].astype(np.float64)
    left, sizes, right = np.linalg.svd(rest, full_matrices=False)
    rank = 0
    while rank < len(sizes) and np.abs(rest).max() > tolerance:
        rest -= np.outer(left[:, rank], sizes[rank] * right[rank])
        rank += 1
    return np.ascontiguousarray(left[:, :rank])
