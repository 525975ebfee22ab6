"""Blend modes of straight colours from 0 to 1, as the W3C prints them.

"Compositing and Blending Level 1", Section 10; linear dodge, linear burn and subtract as in
Photoshop. Each is a function of the colours of the backdrop and of the source, (…, 3).
"""

import numpy as np

from engine.arrays import Floats


def by_pixel(formula):
    """A formula of the W3C for one colour, for an array of colours."""

    def blended(backdrop: Floats, source: Floats) -> Floats:
        pairs = zip(backdrop.reshape(-1, 3).tolist(), source.reshape(-1, 3).tolist(), strict=True)
        return np.reshape([formula(*pair) for pair in pairs], backdrop.shape)

    return blended


def soft_light(b, s):
    if s <= 0.5:
        return b - (1 - 2 * s) * b * (1 - b)
    return b + (2 * s - 1) * ((((16 * b - 12) * b + 4) * b if b <= 0.25 else b**0.5) - b)


def color_dodge(b, s):
    return 0 if b == 0 else 1 if s == 1 else min(1, b / (1 - s))


def color_burn(b, s):
    return 1 if b == 1 else 0 if s == 0 else 1 - min(1, (1 - b) / s)


def hard_light(b, s):
    return b * 2 * s if s <= 0.5 else b + (2 * s - 1) - b * (2 * s - 1)


def luminance(c):
    return 0.3 * c[0] + 0.59 * c[1] + 0.11 * c[2]


def set_luminance(c, lum):
    c = [x + lum - luminance(c) for x in c]
    lum, low, high = luminance(c), min(c), max(c)
    if low < 0:
        c = [lum + (x - lum) * lum / (lum - low) for x in c]
    if high > 1:
        c = [lum + (x - lum) * (1 - lum) / (high - lum) for x in c]
    return c


def saturation(c):
    return max(c) - min(c)


def set_saturation(c, sat):
    least, middle, most = np.argsort(c, kind="stable")
    found = [0.0, 0.0, 0.0]
    if c[most] > c[least]:
        found[middle] = (c[middle] - c[least]) * sat / (c[most] - c[least])
        found[most] = sat
    return found


BLEND_FORMULAS = {
    "normal": lambda _, s: s,
    "darken": np.minimum,
    "multiply": lambda b, s: b * s,
    "color-burn": np.vectorize(color_burn, otypes=[float]),
    "linear-burn": lambda b, s: np.clip(b + s - 1, 0, 1),
    "lighten": np.maximum,
    "screen": lambda b, s: b + s - b * s,
    "color-dodge": np.vectorize(color_dodge, otypes=[float]),
    "linear-dodge": lambda b, s: np.clip(b + s, 0, 1),
    "overlay": np.vectorize(lambda b, s: hard_light(s, b), otypes=[float]),
    "soft-light": np.vectorize(soft_light, otypes=[float]),
    "hard-light": np.vectorize(hard_light, otypes=[float]),
    "difference": lambda b, s: abs(b - s),
    "exclusion": lambda b, s: b + s - 2 * b * s,
    "subtract": lambda b, s: np.clip(b - s, 0, 1),
    "hue": by_pixel(lambda b, s: set_luminance(set_saturation(s, saturation(b)), luminance(b))),
    "saturation": by_pixel(
        lambda b, s: set_luminance(set_saturation(b, saturation(s)), luminance(b))
    ),
    "color": by_pixel(lambda b, s: set_luminance(s, luminance(b))),
    "luminosity": by_pixel(lambda b, s: set_luminance(b, luminance(s))),
}
