"""Closed slits: where a domain is painted, the two sides of a slit meet, in every pose.

A mesh ends at the outline, so a slit would show as a line. Instead, the vertices on its sides are
painted at the places where the sides meet, mapped by a neighbouring triangle.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import numpy.typing as npt

from engine.arrays import Complexes, Floats, Indices, Integers
from engine.domain.build import MeshedDomain
from engine.domain.underlays import Underlay, find_underlay
from engine.geometry import ON_OUTLINE, barycentric_weights, diameter, loop_ends

FARTHEST = 8.0  # sizes of a triangle beyond it, as far as it is extrapolated


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class ClosedCuts:
    """The vertices of a mesh beside slits, as sums of vertices.

    Parameters
    ----------
    vertices : intp, shape (s,)
        Their indices.
    corners : int32, shape (s, 3)
        A triangle of the mesh at each.
    weights : float64, shape (s, 3)
        Barycentric coordinates of the painted place in this triangle. The place is outside, so that
        one coordinate is negative.
    underlay : Underlay, optional
        Material of covered sides under the others: e further vertices.
    """

    vertices: Indices
    corners: Integers
    weights: Floats
    underlay: Underlay | None = None

    @property
    def further_vertices(self) -> int:
        return 0 if self.underlay is None else len(self.underlay.vertices)

    def close_cuts(self, values: npt.NDArray[Any]) -> npt.NDArray[Any]:
        """Return values (v + e, …) that are linear in the vertices' places, with slits closed."""
        return self._closed(values, [] if self.underlay is None else [self.underlay.mirror(values)])

    def find_painted(self, places: npt.NDArray[Any]) -> npt.NDArray[Any]:
        """Return the places (v + e, …) of the picture that the vertices show."""
        return self._closed(places, [] if self.underlay is None else [self.underlay.paint(places)])

    def repeat_values(self, values: npt.NDArray[Any]) -> npt.NDArray[Any]:
        """Return values (v + e, …): further vertices have those of their vertices on the slit."""
        further = [] if self.underlay is None else [values[self.underlay.vertices]]
        return np.concatenate([values, *further])

    def order_under(self, triangles: Integers) -> Integers:
        """Return triangles with those of the underlay before them, so that they cover it."""
        under = [] if self.underlay is None else [self.underlay.triangles]
        return np.concatenate([*under, triangles])

    def _closed(
        self, values: npt.NDArray[Any], further: Sequence[npt.NDArray[Any]]
    ) -> npt.NDArray[Any]:
        result = values.copy()
        result[self.vertices] = np.einsum("sc,sc...->s...", self.weights, values[self.corners])
        return np.concatenate([result, *further])


def find_closed_cuts(domain: MeshedDomain, covered: Sequence[Complexes] = ()) -> ClosedCuts | None:
    """Return the closed slits of a domain's mesh; None without slits.

    `covered` are the lines of slits with a covered side, which is on their left.
    """
    if domain.closed is None:
        return None
    corners = np.concatenate(domain.loops)
    shifts = domain.closed - corners
    on_side, beside = _on_sides(domain, corners, shifts)
    moved = np.concatenate([np.flatnonzero(shifts), on_side])
    places = domain.mesh.vertices[moved] + np.concatenate([shifts[shifts != 0], beside])
    found = _beside(domain, moved, places)
    if not covered:
        return found
    return replace(found, underlay=find_underlay(domain, domain.mesh, moved, covered))


def _on_sides(
    domain: MeshedDomain, corners: Complexes, shifts: Complexes
) -> tuple[Indices, Complexes]:
    """Return the vertices between the corners of slits, and their displacements."""
    ends = loop_ends(domain.loops)
    shifts_at_ends = loop_ends(
        np.split(shifts, np.cumsum([len(loop) for loop in domain.loops])[:-1])
    )
    sides = np.flatnonzero((shifts != 0) | (shifts_at_ends != 0))
    tolerance = ON_OUTLINE * diameter(domain.outline)
    vertices = domain.mesh.vertices
    # Sorted by x, so that each side is compared with few vertices only.
    by_x = len(corners) + np.argsort(vertices.real[len(corners) :])
    x = vertices.real[by_x]
    found, moves = [np.empty(0, dtype=np.intp)], [np.empty(0, dtype=np.complex128)]
    for side in sides:
        start, along = corners[side], ends[side] - corners[side]
        reach = sorted((start.real, ends[side].real))
        first, last = np.searchsorted(x, [reach[0] - tolerance, reach[1] + tolerance])
        share = (vertices[by_x[first:last]] - start) / along
        near = np.abs(share.imag) * abs(along) <= tolerance
        near &= (share.real > 0) & (share.real < 1)
        found.append(by_x[first:last][near])
        move = shifts_at_ends[side] - shifts[side]
        moves.append(shifts[side] + share.real[near] * move)
    return np.concatenate(found), np.concatenate(moves)


def _beside(domain: MeshedDomain, moved: Indices, places: Complexes) -> ClosedCuts:
    """Return the closed slits for vertices at these places, each mapped by a triangle beside it."""
    triangles, vertices = domain.mesh.triangles, domain.mesh.vertices
    number = np.full(len(vertices), -1)
    number[moved] = np.arange(len(moved))
    rows, columns = np.nonzero(number[triangles] >= 0)
    index, around = number[triangles[rows, columns]], triangles[rows]
    weights = barycentric_weights(vertices[around], places[index])
    # Of the triangles at a vertex, choose the one with the least extrapolation.
    order = np.lexsort((-weights.min(axis=1), index))
    chosen = order[np.flatnonzero(np.diff(index[order], prepend=-1))]
    corners, weights = around[chosen], weights[chosen]
    # Meshes have corners with triangles far smaller than a slit: there use a larger triangle
    # nearby.
    tiny = np.flatnonzero(weights.min(axis=1) < -FARTHEST)
    middles = vertices[triangles].mean(axis=1) if len(tiny) else vertices
    areas = domain.mesh.areas() if len(tiny) else np.empty(0)
    for row in tiny:
        far = np.abs(middles - vertices[moved[row]])
        far[areas < np.abs(places[row] - vertices[moved[row]]) ** 2 / 4] = np.inf
        corners[row] = triangles[int(far.argmin())]
        weights[row] = barycentric_weights(vertices[corners[row : row + 1]], places[row : row + 1])[
            0
        ]
    return ClosedCuts(vertices=moved, corners=corners, weights=weights)
