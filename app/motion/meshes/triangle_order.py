"""Drawing order of a mesh's triangles at any frame."""

from collections.abc import Callable
from functools import lru_cache, partial
from typing import Final

import numpy as np
import scipy.sparse

from app.document import Clip, DepthPoint, depth_points_at
from engine.arrays import Floats, Integers
from engine.domain.meshing.depth import find_paths, sort_by_depth, spread_depth
from engine.domain.meshing.mesh import Mesh

_KEPT: Final = 8  # cached sets of depths per mesh: about as many as an animation alternates between


class TriangleOrder:
    """The drawing order of a mesh's triangles; the last results are cached."""

    def __init__(self, mesh: Mesh) -> None:
        self._mesh = mesh
        # Of functions and no methods: a reference cycle would outlive the last user of the mesh.
        paths = lru_cache(maxsize=1)(partial(find_paths, mesh))
        self._depths = lru_cache(maxsize=_KEPT)(partial(_depths, mesh, paths))
        self._ordered = lru_cache(maxsize=_KEPT)(partial(_ordered_triangles, mesh, self._depths))

    def triangles(self, clip: Clip, frame: float) -> Integers:
        """Return the triangles, int32 (m, 3), back to front; the same array for same depths."""
        fronts = depth_points_at(clip, frame)
        return self._ordered(fronts) if fronts else self._mesh.triangles

    def depths(self, clip: Clip, frame: float) -> Floats:
        """Return the depth of each vertex (v,) at a frame, −1 to 1."""
        return self._depths(depth_points_at(clip, frame))


def _ordered_triangles(
    mesh: Mesh,
    depths: Callable[[tuple[DepthPoint, ...]], Floats],
    fronts: tuple[DepthPoint, ...],
) -> Integers:
    return sort_by_depth(mesh, depths(fronts))


def _depths(
    mesh: Mesh, paths: Callable[[], scipy.sparse.csr_array], fronts: tuple[DepthPoint, ...]
) -> Floats:
    places = np.array([front.place for front in fronts], dtype=np.complex128)
    depths = [front.depth for front in fronts]
    return spread_depth(mesh, paths(), places, depths, [front.extent for front in fronts])
