"""Triangulated shapes and keyframes for the tests of the methods that the paper compares with."""

from functools import cache

import numpy as np
from interpolation_shapes import Shape, around, bar, bent, letter_l, subdivided

from engine.domain.meshing import Mesh, triangulate
from engine.maps import HarmonicMap


@cache
def meshed(shape_name: str, triangles: int = 600) -> Mesh:
    return triangulate(
        {"bar": bar, "letter L": letter_l, "S": letter_s}[shape_name]()[0], triangles
    )


@cache
def letter_s() -> Shape:
    """An S of three strokes."""
    corners = np.array([0, 3, 3 + 3j, 1 + 3j, 1 + 4j, 3 + 4j, 3 + 5j, 5j, 2j, 2 + 2j, 2 + 1j, 1j])
    outline = subdivided(corners, 0.55)
    return outline, around(outline, 0.05)


def rigid(turn: float, shift: complex) -> HarmonicMap:
    return bent(bar(), turn=turn, shift=shift)
