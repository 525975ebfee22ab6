"""Square blocks of pixels: large masks are worked on in blocks, so that no pixel is lost."""

import numpy as np

from engine.arrays import Booleans


def block_factor(shape: tuple[int, ...], longest: int) -> int:
    """Return the block side, in pixels, at which no side of `shape` has over `longest` blocks."""
    return max(1, -(-max(shape) // longest))


def reduce_blocks(mask: Booleans, factor: int, combine: np.ufunc) -> Booleans:
    """Combine the pixels of each block into one: `np.logical_or` for any, `np.logical_and` for all.

    Parameters
    ----------
    mask : bool, shape (h, w)
    factor : int
        Side of a block in pixels. The last blocks of a row or column may be cut off.
    combine : numpy ufunc

    Returns
    -------
    bool, shape (ceil(h / factor), ceil(w / factor))
    """
    if factor == 1:
        return mask
    height, width = mask.shape
    rows = combine.reduceat(mask, np.arange(0, height, factor), axis=0)
    return np.asarray(combine.reduceat(rows, np.arange(0, width, factor), axis=1), dtype=np.bool_)


def repeat_blocks(blocks: Booleans, factor: int, shape: tuple[int, ...]) -> Booleans:
    """Spread each block over its pixels; `shape` cuts off the last ones."""
    pixels = np.repeat(np.repeat(blocks, factor, axis=0), factor, axis=1)
    return pixels[: shape[0], : shape[1]]
