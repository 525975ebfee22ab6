"""Vertex positions of a layer in a frame, given or by a series, and their drawing order."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from engine.arrays import Complexes, Integers
from engine.streaming import Series


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class VertexArray:
    """Vertices with computed positions."""

    positions: Complexes  # complex128 (v,)
    # int32 (m, 3): In the drawing order: of overlapping triangles, the last is on top.
    triangles: Integers


class StreamedVertices:
    """Vertices given by a series, which a graphics card can evaluate itself.

    The time is in [0, 1]. `distortions` is the series of f_z and f_z̄, if wanted. `triangles` are
    int32 (m, 3), in the drawing order.
    """

    def __init__(
        self, series: Series, distortions: Series | None, time: float, triangles: Integers
    ) -> None:
        self.series = series
        self.distortions = distortions
        self.time = time
        self.triangles = triangles

    @cached_property
    def positions(self) -> Complexes:
        """The positions (v,), computed on first use."""
        return _complexes(self.series, self.time)

    @cached_property
    def derivatives(self) -> tuple[Complexes, Complexes] | None:
        """f_z and f_z̄ at the vertices, each (v,); None without a series."""
        if self.distortions is None or not self.distortions.covers(self.time):
            return None
        fz, fzbar = _complexes(self.distortions, self.time).reshape(2, -1)
        return fz, fzbar


Vertices = VertexArray | StreamedVertices


def _complexes(series: Series, time: float) -> Complexes:
    return series.values(time).view(np.complex64).astype(np.complex128)
