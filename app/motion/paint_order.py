"""What of a figure is painted over what, at any frame."""

from functools import lru_cache

import numpy as np

from app.document import Clip, Front, fronts_at
from engine.arrays import Integers
from engine.domain.meshing import Mesh, in_depth_order, spread_depth


def painted_triangles(mesh: Mesh, clip: Clip, frame: float) -> Integers:
    """Return a mesh's triangles, int32 (m, 3), from back to front as they are at a frame.

    The same array as long as nothing comes to the front or goes behind.
    """
    fronts = fronts_at(clip, frame)
    return _ordered(mesh, fronts) if fronts else mesh.triangles


@lru_cache(maxsize=16)
def _ordered(mesh: Mesh, fronts: tuple[Front, ...]) -> Integers:
    places, depths, extents = zip(*fronts, strict=True)
    return in_depth_order(mesh, spread_depth(mesh, np.array(places), depths, extents))
