"""Places in triangles."""

import numpy as np

from engine.arrays import Complexes, Floats


def barycentric_weights(corners: Complexes, places: Complexes | complex) -> Floats:
    """Return the barycentric weights (n, 3) of places (n,), or of one, in triangles (n, 3)."""
    a, b, c = corners.T
    area, away = ((b - a).conj() * (c - a)).imag, places - a
    second, third = (away.conj() * (c - a)).imag / area, ((b - a).conj() * away).imag / area
    return np.column_stack([1 - second - third, second, third])
