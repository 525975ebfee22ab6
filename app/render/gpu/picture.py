"""The source picture as a texture."""

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any, Final

import moderngl
import numpy as np
import numpy.typing as npt

from app.errors import LissomError
from app.render.gpu.context import largest_size
from app.texts import _
from engine.arrays import Bytes

# Colour times alpha for each pair [alpha, colour] of bytes. Half floats keep 11 bits of a value at
# any size. The faintest pixel's colour survives the multiplication and its inverse.
_LEVELS = np.arange(256) / 255
_PRODUCTS: Final = np.outer(_LEVELS, _LEVELS).astype(np.float16).ravel()
# Bytes suffice for a screen, which has no more levels.
_BYTES: Final = np.rint(255 * np.outer(_LEVELS, _LEVELS)).astype(np.uint8).ravel()
_BLOCK = 1 << 20  # pixels premultiplied at a time


class GpuPicture:
    """Owner of a premultiplied, mip-mapped texture that is transparent outside.

    Parameters
    ----------
    straight : uint8, shape (h, w, 4)
        Straight alpha, first row on top.
    is_for_screen : bool
        Whether frames need not reproduce its pixels exactly. This halves the memory.

    Raises
    ------
    LissomError
        If the picture is larger than the context's textures can be.
    """

    def __init__(
        self, context: moderngl.Context, straight: Bytes, *, is_for_screen: bool = False
    ) -> None:
        height, width = straight.shape[:2]
        limit = largest_size(context)
        if max(width, height) > limit:
            raise LissomError(
                _(
                    "the picture has {width} × {height} pixels, but this machine's graphics "
                    "allow at most {limit} × {limit}; scale it down first"
                ).format(width=width, height=height, limit=limit)
            )
        self.size = (width, height)
        self._context = context
        self._products = _BYTES if is_for_screen else _PRODUCTS
        self._texture = self._new_texture(self.size)
        self._written: Bytes | None = None
        self.write(straight)
        self._sampler = context.sampler(
            filter=(moderngl.LINEAR_MIPMAP_LINEAR, moderngl.LINEAR),
            border_color=(0.0, 0.0, 0.0, 0.0),
        )

    def write(self, straight: Bytes) -> None:
        """Upload another picture; unchanged rows are skipped.

        A picture with more or fewer pixels is stretched to the same size.
        """
        if straight is self._written:
            return
        height, width = straight.shape[:2]
        if (width, height) != self._texture.size:
            self._texture.release()
            self._texture, self._written = self._new_texture((width, height)), None
        changed = np.ones(height, dtype=np.bool_)
        if self._written is not None:
            changed = (straight != self._written).any(axis=(1, 2))
        self._written = straight
        if not changed.any():
            return
        first, last = np.flatnonzero(changed)[[0, -1]]
        rows = max(1, _BLOCK // width)
        for top in range(first, last + 1, rows):
            block = _multiplied(straight[top : min(top + rows, last + 1)], self._products)[::-1]
            bottom = height - top - len(block)
            self._texture.write(block.tobytes(), viewport=(0, int(bottom), width, len(block)))
        self._texture.build_mipmaps()

    def _new_texture(self, size: tuple[int, int]) -> moderngl.Texture:
        dtype = "f1" if self._products is _BYTES else "f2"
        return self._context.texture(size, 4, dtype=dtype)

    @contextmanager
    def bound(self, unit: int) -> Iterator[None]:
        """Bind the texture to a texture unit for the draws in a `with` block."""
        self._texture.use(unit)
        self._sampler.use(unit)
        try:
            yield
        finally:
            # A bound sampler would override the settings of the unit's next texture.
            self._sampler.clear(unit)

    def release(self) -> None:
        self._sampler.release()
        self._texture.release()


def _multiplied(straight: Bytes, products: npt.NDArray[Any]) -> npt.NDArray[Any]:
    """Return pixels (h, w, 4) with their colours times alpha, from a table of products."""
    if products is not _BYTES:
        return np.asarray(products[_index(straight)])
    # In bytes, opaque pixels stay as they are. Few pixels are half transparent.
    alpha = straight[..., 3]
    result = straight * (alpha > 0)[..., None]
    is_soft = (alpha > 0) & (alpha < 255)
    result[is_soft] = products[_index(straight[is_soft])]
    return result


def _index(straight: Bytes) -> npt.NDArray[np.uint16]:
    """Return the indices of pixels (…, 4) in the tables of products."""
    index = straight.astype(np.uint16)
    index[..., :3] += straight[..., 3:].astype(np.uint16) << 8
    index[..., 3] += 255 << 8
    return index
