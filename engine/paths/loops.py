"""Closed paths around holes, for the integration of periods."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import shapely

from engine.arrays import Booleans, Complexes, Indices, freeze
from engine.geometry import Pieces, as_xy, bisect_segments, distance_to_segments

NODES = 10  # Gauss-Legendre nodes of a piece
# Longest piece, relative to its distance to the nearest singularity; the error is some 1e-12.
PIECE_PER_DISTANCE = 0.8
ROUNDNESS = 4  # edges of a quarter circle around a corner of the hole


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Loops:
    """Quadrature on closed paths, one around each hole, halfway to the nearest other boundary.

    `nodes` and `differentials` (c,) are the nodes of one loop after the other, clockwise, and dz
    there. `starts` (holes,) are the first nodes of the loops.
    """

    nodes: Complexes
    differentials: Complexes
    starts: Indices

    @classmethod
    def around(cls, outline: Complexes, holes: Sequence[Complexes], singular: Complexes) -> "Loops":
        """Lay loops between the outlines of a domain and of its holes.

        Integrands are `singular` at points (v,) outside the domain or on its boundary.
        """
        nodes, differentials = [], []
        rings = [shapely.LinearRing(as_xy(loop)) for loop in (outline, *holes)]
        x, weights = np.polynomial.legendre.leggauss(NODES)

        def is_fine(pieces: Pieces) -> Booleans:
            room = distance_to_segments(singular, pieces.starts, pieces.ends).min(axis=0)
            return np.asarray(pieces.lengths <= PIECE_PER_DISTANCE * room)

        for number, hole in enumerate(holes):
            others = shapely.MultiLineString(rings[: number + 1] + rings[number + 2 :])
            area = shapely.Polygon(as_xy(hole))
            room = shapely.distance(area, others)
            wider = area.buffer(room / 2, quad_segs=ROUNDNESS).exterior
            corners = shapely.get_coordinates(wider)[:-1] @ [1, 1j]
            if wider.is_ccw:
                corners = corners[::-1]
            pieces = bisect_segments(Pieces.whole(corners, np.roll(corners, -1)), is_fine)
            spans = (pieces.ends - pieces.starts)[:, None]
            nodes.append((pieces.starts[:, None] + spans * (1 + x) / 2).ravel())
            differentials.append((spans * weights / 2).ravel())
        return cls(
            nodes=freeze(np.concatenate([np.empty(0, np.complex128), *nodes])),
            differentials=freeze(np.concatenate([np.empty(0, np.complex128), *differentials])),
            starts=freeze(np.cumsum([0, *map(len, nodes)])[: len(nodes)].astype(np.intp)),
        )

    @property
    def counts(self) -> Indices:
        """Number of nodes of each loop, (holes,)."""
        return np.diff(self.starts, append=len(self.nodes))

    def integrals(self, values: Complexes) -> Complexes:
        """Integrate over each loop: (..., c) to (..., holes)."""
        return np.asarray(np.add.reduceat(values * self.differentials, self.starts, axis=-1))

    def products(self, values: Complexes, functions: Complexes) -> Complexes:
        """Integrate values (t, c) times functions (i, c) over each loop, (t, holes, i)."""
        values = values * self.differentials
        ends = [*self.starts[1:].tolist(), len(self.nodes)]
        parts = [slice(*pair) for pair in zip(self.starts.tolist(), ends, strict=True)]
        return np.stack([values[:, part] @ functions[:, part].T for part in parts], axis=1)
