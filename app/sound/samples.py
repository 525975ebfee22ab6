"""The type of samples, and their conversion between rates.

The filter is a windowed sinc. It is linear in phase: the conversion moves nothing in time. Equal
rates leave the samples as they are.
"""

from collections.abc import Callable
from functools import lru_cache
from math import ceil, gcd
from typing import Final

import numpy as np
import numpy.typing as npt

Samples = npt.NDArray[np.float32]
CROSSINGS: Final = 24  # zero crossings of the filter on each side
KAISER: Final = 8.0  # shape of its window: 80 dB below in the stop band


def resample(
    read: Callable[[int, int], Samples], first: int, count: int, source: int, target: int
) -> Samples:
    """Return samples at the rate `target`, from a function that reads at the rate `source`.

    Parameters
    ----------
    read : callable
        Receives the first sample and a number of samples, and returns exactly so many.
    first, count : int
        At the rate `target`, counted from the same moment. Neighbouring blocks fit seamlessly.
    """
    if source == target or not count:
        return read(first, count)
    common = gcd(source, target)
    up, down = target // common, source // common
    weights = _filter(up, down)
    half = weights.shape[1] // 2
    places = np.arange(first, first + count, dtype=np.int64) * down
    nearest = places // up
    begin = int(nearest[0]) - half + 1
    known = read(begin, int(nearest[-1]) + half + 1 - begin)
    windows = np.lib.stride_tricks.sliding_window_view(known, 2 * half, axis=0)
    found = np.einsum("nct,nt->nc", windows[nearest - nearest[0]], weights[places % up])
    return np.asarray(found, dtype=np.float32)


@lru_cache(maxsize=8)
def _filter(up: int, down: int) -> Samples:
    """Return the weights (up, taps) of source samples, by the fraction of a sample between them."""
    cutoff = min(1.0, up / down)
    half = ceil(CROSSINGS / cutoff)
    apart = np.arange(1 - half, half + 1) - (np.arange(up) / up)[:, None]
    edge = np.clip(1 - (apart * cutoff / CROSSINGS) ** 2, 0, None)
    window = np.where(edge > 0, np.i0(KAISER * np.sqrt(edge)), 0)
    weights = np.sinc(apart * cutoff) * window
    return np.asarray(weights / weights.sum(axis=1, keepdims=True), dtype=np.float32)
