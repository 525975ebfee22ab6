"""The subject of a picture with transparency: all of its pixels that are not nearly invisible."""

from contextlib import suppress
from typing import Any

import numpy as np
import numpy.typing as npt
from scipy import ndimage

from app.texts import ngettext
from engine.arrays import Booleans, Bytes
from engine.errors import EngineError

VISIBLE_ALPHA = 8  # of 255: pixels with less may be left out, others are kept
FAINT_GROWTH = 1.10  # fainter pixels are kept if the subject grows by no more than this


def of_alpha(rgba: Bytes, least: int) -> Booleans:
    """Return the pixels (h, w) of at least this alpha."""
    enough: Booleans = rgba[..., 3] >= least
    return enough


def without_transparency(rgba: Bytes) -> tuple[Booleans, tuple[str, ...]]:
    """Return all pixels that are not fully transparent, without a wide and nearly invisible haze.

    Nearly invisible islands are left out too: a sharp scaling filter leaves them around edges.
    """
    present = of_alpha(rgba, 1)
    if np.count_nonzero(present) == np.count_nonzero(of_alpha(rgba, VISIBLE_ALPHA)):
        return present, ()
    del present
    present, visible = _seen_parts(rgba), of_alpha(rgba, VISIBLE_ALPHA)
    faint = int(np.count_nonzero(present) - np.count_nonzero(visible))
    if np.count_nonzero(present) <= FAINT_GROWTH * np.count_nonzero(visible):
        return present, ()
    notice = ngettext(
        "{count:,} faint pixel left out",
        "{count:,} faint pixels left out",
        faint,
    )
    return visible, (notice.format(count=faint),)


def _seen_parts(rgba: Bytes) -> Booleans:
    """Return all parts that are not fully transparent and have a visible pixel."""
    present = of_alpha(rgba, 1)
    labels, count = _labelled(present)
    seen = np.zeros(count + 1, dtype=np.bool_)
    for numbers, row in zip(labels, rgba, strict=True):  # all at once take eight bytes a pixel
        seen[numbers[row[:, 3] >= VISIBLE_ALPHA]] = True
    for row, numbers in zip(present, labels, strict=True):
        row[...] = seen[numbers]
    return present


def _labelled(mask: Booleans) -> tuple[npt.NDArray[Any], int]:
    """Return the number of each pixel's part, 0 outside, and the number of parts."""
    # Most pictures have few parts; wider numbers would take as much memory as the picture.
    for dtype in (np.uint16, np.int32):
        labels: npt.NDArray[Any] = np.empty(mask.shape, dtype=dtype)
        with suppress(RuntimeError):  # more parts than the type can count
            return labels, int(ndimage.label(mask, np.ones((3, 3)), output=labels))
    raise EngineError("The picture has too many parts; scale the picture down.")
