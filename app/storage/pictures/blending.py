"""Blend modes of pictures in memory, as `shaders/blend.glsl` has them for the renderer."""

from collections.abc import Callable, Mapping
from typing import Final

import numpy as np
from PIL import Image

from app.document import BlendMode
from engine.arrays import Floats

_ROWS: Final = 64  # blended at a time: floats of a whole picture would take much memory
_TINY: Final = 1e-6
_LUMINANCE: Final = np.array([0.3, 0.59, 0.11])


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
