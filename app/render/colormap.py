"""The colours of the heat map."""

from functools import cache

import numpy as np

from engine.arrays import Bytes, Floats, readonly

# Lightness, chroma and hue (degrees) in OKLCh, at equal steps: from a quiet indigo through magenta
# and orange to a bright yellow. Lightness rises throughout: the order is visible with any colour
# vision, and in grey print.
_STOPS = np.array(
    [
        [0.26, 0.10, 278.0],
        [0.40, 0.17, 305.0],
        [0.54, 0.20, 350.0],
        [0.68, 0.18, 393.0],
        [0.82, 0.15, 432.0],
        [0.96, 0.12, 467.0],
    ]
)
_SIZE = 256


@cache
def heat_colormap() -> Bytes:
    """Return the colours, uint8 (256, 3), from the smallest to the largest distortion."""
    place = np.linspace(0, len(_STOPS) - 1, _SIZE)
    lightness, chroma, hue = (
        np.interp(place, np.arange(len(_STOPS)), column) for column in _STOPS.T
    )
    angle = np.radians(hue)
    colours = oklab_to_srgb(
        np.column_stack([lightness, chroma * np.cos(angle), chroma * np.sin(angle)])
    )
    return readonly(np.rint(255 * colours).astype(np.uint8))


def oklab_to_srgb(colours: Floats) -> Floats:
    """Return sRGB colours (n, 3), 0 … 1, of OKLab colours (n, 3), clipped to the gamut.

    Matrices of B. Ottosson, "A perceptual color space for image processing" (2020).
    """
    to_cones = np.array(
        [
            [1.0, 0.3963377774, 0.2158037573],
            [1.0, -0.1055613458, -0.0638541728],
            [1.0, -0.0894841775, -1.2914855480],
        ]
    )
    to_linear = np.array(
        [
            [4.0767416621, -3.3077115913, 0.2309699292],
            [-1.2684380046, 2.6097574011, -0.3413193965],
            [-0.0041960863, -0.7034186147, 1.7076147010],
        ]
    )
    linear = np.clip((colours @ to_cones.T) ** 3 @ to_linear.T, 0.0, 1.0)
    encoded = np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055)
    return np.asarray(encoded)
