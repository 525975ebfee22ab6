"""Shapes, maps and hypothesis strategies shared by the tests."""

import numpy as np
from hypothesis import strategies as st

from engine.arrays import Complexes


def regular_polygon(n: int, radius: float = 1.0) -> Complexes:
    return radius * np.exp(2j * np.pi * np.arange(n) / n)


def points_inside_disc(radius: float, count: int, seed: int) -> Complexes:
    rng = np.random.default_rng(seed)
    return radius * np.sqrt(rng.random(count)) * np.exp(2j * np.pi * rng.random(count))


@st.composite
def star_polygons(draw: st.DrawFn, largest: int = 40) -> Complexes:
    """Counter-clockwise polygons that are star-shaped about 0, with radii between 0.5 and 1.5."""
    n = draw(st.integers(5, largest))
    rng = np.random.default_rng(draw(st.integers(0, 2**32 - 1)))
    angles = 2 * np.pi * (np.arange(n) + rng.uniform(-0.3, 0.3, n)) / n
    return rng.uniform(0.5, 1.5, n) * np.exp(1j * angles)
