"""The pixels of a Photoshop layer, with its masks and those of its groups applied."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Final

import numpy as np
from PIL import Image, ImageChops, ImageFilter

from app.errors import NoticeCollector
from app.texts import _
from engine.arrays import Booleans

# Mask levels that leave a layer half transparent.
HALF_SEEN: Final = [2 < level < 253 for level in range(256)]


@dataclass(slots=True, eq=False)
class MaskedGroup:
    """A group with a mask, which cuts its layers."""

    group: Any
    # Pixels of the canvas (h, w) that are half transparent by the mask and already covered by a
    # layer.
    covered: Booleans
    has_warned: bool = False  # about layers that shine through each other


def masked_pixels(
    layer: Any, around: Sequence[MaskedGroup], collector: NoticeCollector
) -> Image.Image | None:
    """Return a layer's pixels, cut by its own mask and by those of its groups.

    None if it has no pixels.
    """
    if layer.width == 0 or layer.height == 0:
        return None
    image = layer.topil()
    if image is None:
        return None
    pixels: Image.Image = image.convert("RGBA")
    corner = layer.left, layer.top
    if is_masked(layer, collector):
        _cut(pixels, _seen_through(layer.mask, corner, pixels.size))
    for each in around:
        mask = _seen_through(each.group.mask, corner, pixels.size)
        if _shines_through(each, corner, pixels, mask) and not each.has_warned:
            each.has_warned = True
            what = _("its mask makes it half transparent, so its layers shine through each other")
            collector.add_warning(each.group.name.strip() or "layer", what)
        _cut(pixels, mask)
    return pixels


def is_masked(layer: Any, collector: NoticeCollector) -> bool:
    """Return whether a layer or group has a pixel mask. A vector mask gives a notice."""
    mask = layer.mask
    is_masked = mask is not None and not mask.disabled
    # Programs store the result of a vector mask as a pixel mask, too.
    is_by_paths = layer.kind != "shape" and mask is None and layer.has_vector_mask()
    if is_by_paths and not layer.vector_mask.disabled:
        collector.add_warning(layer.name.strip() or "layer", _("drawn without its vector mask"))
    return is_masked


def _cut(pixels: Image.Image, mask: Image.Image) -> None:
    pixels.putalpha(ImageChops.multiply(pixels.getchannel("A"), mask))


def _shines_through(
    around: MaskedGroup, corner: tuple[int, int], pixels: Image.Image, mask: Image.Image
) -> bool:
    """Return whether a layer covers another layer where the group's mask is half transparent.

    Layers that are cut one by one show the layer behind them there; a group that is cut as a whole
    does not.
    """
    (left, top), (height, width) = corner, around.covered.shape
    half = np.array(HALF_SEEN)[np.asarray(mask)] & (np.asarray(pixels.getchannel("A")) > 0)
    half = half[max(-top, 0) : max(height - top, 0), max(-left, 0) : max(width - left, 0)]
    rows, columns = half.shape
    covered = around.covered[max(top, 0) :, max(left, 0) :][:rows, :columns]
    found = bool((covered & half).any())
    covered |= half
    return found


def _seen_through(mask: Any, corner: tuple[int, int], size: tuple[int, int]) -> Image.Image:
    """Return the opacity of a mask at each pixel of a layer."""
    seen = Image.new("L", size, mask.background_color)
    drawn = mask.topil()
    if drawn is not None:
        seen.paste(drawn.convert("L"), (mask.left - corner[0], mask.top - corner[1]))
    settings = mask.parameters
    if settings is not None and settings.user_mask_feather:
        seen = seen.filter(ImageFilter.GaussianBlur(settings.user_mask_feather))
    if settings is not None and settings.user_mask_density is not None:
        density = settings.user_mask_density / 255
        seen = seen.point(lambda level: round(255 - density * (255 - level)))
    return seen
