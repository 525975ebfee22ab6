"""The pixels of a Photoshop layer, with its masks and those of its groups applied."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from math import ceil
from typing import Any, Final

import numpy as np
from PIL import Image, ImageChops, ImageCms, ImageFilter, ImageOps

from app.errors import NoticeCollector
from app.storage.pictures.photoshop_paint import Box, draw_path, fill_colour, is_described
from app.texts import _
from engine.arrays import Booleans

TRANSPARENCY: Final = -1  # number of the alpha channel
OPAQUE: Final = 255
LARGEST_FEATHER: Final = 250  # pixels
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
    layer: Any, box: Box, around: Sequence[MaskedGroup], collector: NoticeCollector
) -> Image.Image | None:
    """Return a layer's pixels in a box, cut by its own masks and by those of its groups.

    None if it has no pixels.
    """
    if box[0] >= box[2] or box[1] >= box[3]:
        return None
    pixels = _pixels(layer, box)
    if pixels is None:
        return None
    if is_masked(layer):
        _cut(pixels, _seen_through(layer, box))
    for each in around:
        mask = _seen_through(each.group, box)
        if _shines_through(each, box[:2], pixels, mask) and not each.has_warned:
            each.has_warned = True
            what = _("its mask makes it half transparent, so its layers shine through each other")
            collector.add_warning(each.group.name.strip() or "layer", what)
        _cut(pixels, mask)
    return pixels


def _pixels(layer: Any, box: Box) -> Image.Image | None:
    """Return the own pixels of a layer in sRGB, or those that its path and colour describe."""
    if not layer.has_pixels():
        colour = fill_colour(layer)
        size = box[2] - box[0], box[3] - box[1]
        return None if colour is None else Image.new("RGBA", size, (*colour, OPAQUE))
    image = layer.topil()
    if image is None:
        return None
    pixels = to_rgba(image)
    # Pillow has no alpha beside inks and L*a*b* colours.
    if image.mode not in {"LA", "RGBA"} and (alpha := layer.topil(TRANSPARENCY)) is not None:
        pixels.putalpha(alpha.convert("L"))
    return pixels


def to_rgba(image: Image.Image) -> Image.Image:
    """Return a picture of psd-tools in sRGB; Pillow converts no L*a*b* colours by itself."""
    if image.mode == "LAB":
        lab, srgb = ImageCms.createProfile("LAB"), ImageCms.createProfile("sRGB")
        image = ImageCms.profileToProfile(image, lab, srgb, outputMode="RGB") or image
    return image.convert("RGBA")


def is_masked(layer: Any) -> bool:
    """Return whether a layer or group has a mask that is in use."""
    return _has_pixel_mask(layer) or _has_path_mask(layer)


def _has_pixel_mask(layer: Any) -> bool:
    return layer.mask is not None and not layer.mask.disabled


def _has_path_mask(layer: Any) -> bool:
    """Return whether a path cuts a layer, unless its result is stored as pixels."""
    if not layer.has_vector_mask() or layer.vector_mask.disabled:
        return False
    if is_described(layer) and layer.has_pixels():
        return False
    return layer.mask is None or not (
        layer.mask.has_real() or layer.mask.flags.user_mask_from_render
    )


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


def _seen_through(layer: Any, box: Box) -> Image.Image:
    """Return the opacity of the masks of a layer or group at each pixel of a box."""
    seen = Image.new("L", (box[2] - box[0], box[3] - box[1]), OPAQUE)
    is_cut_by_path = _has_path_mask(layer)
    if _has_pixel_mask(layer):
        density, feather = _softness(layer, "user")
        if density is None and not is_cut_by_path:
            # The pixels may be those of the path.
            density, _feather = _softness(layer, "vector")
        seen = _soft(partial(_mask_pixels, layer.mask), box, density, feather)
    if is_cut_by_path:
        path = _soft(partial(draw_path, layer), box, *_softness(layer, "vector"))
        seen = ImageChops.multiply(seen, path)
    return seen


def _softness(layer: Any, kind: str) -> tuple[int | None, float | None]:
    """Return density and feather of a mask of pixels ("user") or of a path ("vector")."""
    settings = layer.mask.parameters if layer.mask is not None else None
    density = getattr(settings, f"{kind}_mask_density", None)
    return density, getattr(settings, f"{kind}_mask_feather", None)


def _soft(
    draw: Callable[[Box], Image.Image], box: Box, density: int | None, feather: float | None
) -> Image.Image:
    """Return a mask in a box, softened at its edges by the feather, and faded by the density."""
    feather = min(feather or 0, LARGEST_FEATHER)
    margin = ceil(3 * feather)
    seen = draw((box[0] - margin, box[1] - margin, box[2] + margin, box[3] + margin))
    if feather:
        seen = ImageOps.crop(seen.filter(ImageFilter.GaussianBlur(feather)), margin)
    share = 1.0 if density is None else density / OPAQUE
    return seen.point(lambda level: round(OPAQUE - share * (OPAQUE - level)))


def _mask_pixels(mask: Any, box: Box) -> Image.Image:
    drawn = mask.topil()
    # A mask that lacks its pixels cuts nothing.
    outside = OPAQUE if drawn is None and all(mask.size) else mask.background_color
    seen = Image.new("L", (box[2] - box[0], box[3] - box[1]), outside)
    if drawn is not None:
        seen.paste(drawn.convert("L"), (mask.left - box[0], mask.top - box[1]))
    return seen
