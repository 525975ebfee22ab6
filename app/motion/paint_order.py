"""What of a figure is painted over what, at any frame."""

from functools import lru_cache

import numpy as np

from app.document import Clip, Front, fronts_at
from engine.arrays import Floats, Integers
from engine.domain.meshing import Mesh, in_depth_order, spread_depth


def painted_triangles(mesh: Mesh, clip: Clip, frame: float) -> Integers:
    """Return a mesh's triangles, int32 (m, 3), from back to front as they are at a frame.

    The same array as long as nothing comes to the front or goes behind.
    """
    fronts = fronts_at(clip, frame)
    return _ordered(mesh, fronts) if fronts else mesh.triangles


def painted_depths(mesh: Mesh, clip: Clip, frame: float) -> Floats:
    """Return how far in front each vertex (v,) of a mesh is at a frame, −1 to 1."""
    return _depths(mesh, fronts_at(clip, frame))


@lru_cache(maxsize=16)
def _ordered(mesh: Mesh, fronts: tuple[Front, ...]) -> Integers:
    return in_depth_order(mesh, _depths(mesh, fronts))


@lru_cache(maxsize=4)
def _depths(mesh: Mesh, fronts: tuple[Front, ...]) -> Floats:
    places = np.array([front.place for front in fronts], dtype=np.complex128)
    depths = [front.depth for front in fronts]
    return spread_depth(mesh, places, depths, [front.extent for front in fronts])
