"""Where the vertices of a layer are in a frame, known or by a series, and what lies over what."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from engine.arrays import Complexes, Integers
from engine.streaming import Series


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class VertexArray:
    """Vertices whose positions are worked out already."""

    positions: Complexes  # complex128 (v,)
    # int32 (m, 3): Of the mesh, in the order in which they are painted: where they overlap, the
    # last is seen.
    triangles: Integers


class StreamedVertices:
    """Vertices as a series places them; a graphics card can do that without the processor.

    Parameters
    ----------
    series : Series
        Of the positions.
    distortions : Series or None
        Of f_z and f_z̄, where they are wanted.
    time : float
        In [0, 1].
    triangles : int32, shape (m, 3)
        In the order in which they are painted.
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
        """The positions (v,), worked out when they are first asked for."""
        return _complexes(self.series, self.time)

    @cached_property
    def derivatives(self) -> tuple[Complexes, Complexes] | None:
        """f_z and f_z̄ at the vertices, each (v,); None where they are not streamed."""
        if self.distortions is None or not self.distortions.covers(self.time):
            return None
        fz, fzbar = _complexes(self.distortions, self.time).reshape(2, -1)
        return fz, fzbar


Vertices = VertexArray | StreamedVertices


def _complexes(series: Series, time: float) -> Complexes:
    return series.values(time).view(np.complex64).astype(np.complex128)
