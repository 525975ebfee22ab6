"""The layers of a document as one flat picture, with the blend modes of `shaders/blend.glsl`."""

from collections.abc import Callable, Mapping, Sequence
from typing import Final

import numpy as np
from PIL import Image, ImageChops

from app.document import BlendMode, CompositeGroup, Document, Layer, composite_layers, is_visible
from engine.arrays import Bytes, Floats, readonly

LARGEST_FLAT = 1_024  # pixels
_ROWS: Final = 64  # blended at a time: floats of a whole picture would take much memory
_TINY: Final = 1e-6
_LUMINANCE: Final = np.array([0.3, 0.59, 0.11])


def flatten_layers(
    document: Document, textures: Mapping[int, Bytes], *, largest: int = LARGEST_FLAT
) -> Bytes:
    """Return the initially visible layers as one picture, as drawn; a large one is reduced.

    Parameters
    ----------
    textures : mapping of int to uint8, shape (h, w, 4)
        The cut-out pictures by layer id.
    largest : int
        A picture of at least twice as many pixels across is reduced.

    Returns
    -------
    uint8, shape (h, w, 4)
        Straight alpha.
    """
    factor = max(1, max(document.canvas) // largest)
    size = -(-document.canvas[0] // factor), -(-document.canvas[1] // factor)

    def draw(layer: Layer, flat: Image.Image) -> None:
        part, corner = _reduced(textures[layer.id], factor), layer.corner / factor
        left, top = round(corner.real), round(size[1] - corner.imag - part.height)
        beyond = min(max(0, -left), part.width), min(max(0, -top), part.height)
        flat.alpha_composite(part, (max(left, 0), max(top, 0)), beyond)

    def over(flat: Image.Image, parts: Sequence[Layer | CompositeGroup[Layer]]) -> Image.Image:
        flat = flat.copy()
        for part in parts:
            if isinstance(part, CompositeGroup) and part.is_pass_through:
                shown, rest = over(flat, part.parts), over(flat, part.kept)
                faded = Image.blend(rest.convert("RGBa"), shown.convert("RGBa"), part.opacity)
                flat = faded.convert("RGBA")
            elif isinstance(part, CompositeGroup):
                flat = _blended(flat, over(Image.new("RGBA", size), part.parts), part)
            else:
                draw(part, flat)
        return flat

    first = document.frames.first
    seen = {each.id: each for each in document.exported_layers if is_visible(document, each, first)}
    painted = over(Image.new("RGBA", size), composite_layers(document, seen, first))
    return readonly(np.asarray(painted))


def _blended(below: Image.Image, above: Image.Image, how: CompositeGroup[Layer]) -> Image.Image:
    """Return a layer over its backdrop ("Compositing and Blending Level 1", Section 10)."""
    alpha = above.getchannel("A").point(lambda a: round(how.opacity * a))
    covered = below.getchannel("A")
    # A clipped layer meets its backdrop as if the backdrop were opaque.
    solid = below.convert("RGB").convert("RGBA") if how.clipped else below
    if "layer_tint" in how.effects:
        tint = tuple(round(255 * level) for level in how.effects["layer_tint"])
        above = ImageChops.multiply(above, Image.new("RGBA", above.size, (*tint, 255)))
    if how.blend != "normal":
        own = above.convert("RGB")
        mixed = blend_pictures(below.convert("RGB"), own, how.blend)
        # Over an empty backdrop the layer keeps its colours.
        above = Image.composite(mixed, own, solid.getchannel("A")).convert("RGBA")
    above.putalpha(alpha)
    flat = Image.alpha_composite(solid, above)
    if how.clipped:
        flat.putalpha(covered)
    return flat


def _reduced(rgba: Bytes, factor: int) -> Image.Image:
    """Return a picture in which one pixel stands for `factor` × `factor` pixels."""
    # Process a few rows at a time: a whole copy would double the memory.
    rows = (rgba[top : top + factor] for top in range(0, len(rgba), factor))
    return Image.fromarray(np.concatenate([Image.fromarray(row).reduce(factor) for row in rows]))


def blend_pictures(backdrop: Image.Image, source: Image.Image, mode: BlendMode) -> Image.Image:
    """Return the blend of two RGB pictures of the same size."""
    behind, front = np.asarray(backdrop), np.asarray(source)
    mixed = np.empty_like(front)
    for top in range(0, len(front), _ROWS):
        rows = slice(top, top + _ROWS)
        levels = _BLENDS[mode](behind[rows] / 255, front[rows] / 255)
        mixed[rows] = np.rint(255 * np.clip(levels, 0, 1))
    return Image.fromarray(mixed)


def _screen(backdrop: Floats, source: Floats) -> Floats:
    return backdrop + source - backdrop * source


def _color_dodge(backdrop: Floats, source: Floats) -> Floats:
    return np.minimum(backdrop / np.maximum(1 - source, _TINY), 1)


def _color_burn(backdrop: Floats, source: Floats) -> Floats:
    return 1 - _color_dodge(1 - backdrop, 1 - source)


def _hard_light(backdrop: Floats, source: Floats) -> Floats:
    light = _screen(backdrop, 2 * source - 1)
    return np.where(source < 0.5, 2 * backdrop * source, light)


def _soft_light(backdrop: Floats, source: Floats) -> Floats:
    deep = ((16 * backdrop - 12) * backdrop + 4) * backdrop
    lit = np.where(backdrop < 0.25, deep, np.sqrt(backdrop))
    room = np.where(source < 0.5, backdrop * (1 - backdrop), lit - backdrop)
    return backdrop + (2 * source - 1) * room


def _luminance(levels: Floats) -> Floats:
    return np.asarray(levels @ _LUMINANCE)[..., None]


def _least(levels: Floats) -> Floats:
    return np.asarray(levels.min(axis=-1, keepdims=True))


def _largest(levels: Floats) -> Floats:
    return np.asarray(levels.max(axis=-1, keepdims=True))


def _with_luminance(levels: Floats, other: Floats) -> Floats:
    """Return colours with the luminance of others, clipped to the range of colours."""
    target, offset = _luminance(other), levels - _luminance(levels)
    down = target / np.maximum(-_least(offset), _TINY)
    up = (1 - target) / np.maximum(_largest(offset), _TINY)
    return target + offset * np.minimum(np.minimum(down, up), 1)


def _with_saturation(levels: Floats, other: Floats) -> Floats:
    low, target = _least(levels), _largest(other) - _least(other)
    return (levels - low) * target / np.maximum(_largest(levels) - low, _TINY)


# By the name of the mode, functions of straight colours from 0 to 1.
_BLENDS: Final[Mapping[BlendMode, Callable[[Floats, Floats], Floats]]] = {
    "darken": np.minimum,
    "multiply": np.multiply,
    "color-burn": _color_burn,
    "linear-burn": lambda backdrop, source: backdrop + source - 1,
    "lighten": np.maximum,
    "screen": _screen,
    "color-dodge": _color_dodge,
    "linear-dodge": np.add,
    "overlay": lambda backdrop, source: _hard_light(source, backdrop),
    "soft-light": _soft_light,
    "hard-light": _hard_light,
    "difference": lambda backdrop, source: abs(backdrop - source),
    "exclusion": lambda backdrop, source: backdrop + source - 2 * backdrop * source,
    "subtract": np.subtract,
    "hue": lambda backdrop, source: _with_luminance(_with_saturation(source, backdrop), backdrop),
    "saturation": lambda backdrop, source: _with_luminance(
        _with_saturation(backdrop, source), backdrop
    ),
    "color": lambda backdrop, source: _with_luminance(source, backdrop),
    "luminosity": _with_luminance,
}
