"""A piece of motion as a few arrays, blended with weights that depend on time only."""

from bisect import bisect_right
from dataclasses import dataclass

import numpy as np

from engine.arrays import Floats, Singles, as_number, nbytes_of
from engine.errors import EngineError
from engine.interpolation import chebyshev


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class SeriesPiece:
    """The motion from one time to another: Σ_j w_j(t) rows_j.

    The first and the last row are the values at both ends, with the weights of a linear blend. The
    weights of the other rows vanish at both ends. Consecutive pieces share the row between them.
    `functions` (n, r) are the Chebyshev coefficients of the weights; `rows` are float32 (r, c).
    """

    start: float
    end: float
    functions: Floats
    rows: Singles

    def weights(self, time: float) -> Singles:
        """Return the weights (r,) at a time from `start` to `end`, exact at keyframes."""
        if time in (0.0, 1.0):
            keyframe = np.zeros(len(self.rows), dtype=np.float32)
            keyframe[-int(time)] = 1.0
            return keyframe
        x = (2 * time - self.start - self.end) / (self.end - self.start)
        # Twice as fast as the operator @.
        weights: Floats = np.dot(chebyshev.chebyshev_basis(x, len(self.functions)), self.functions)
        return weights.astype(np.float32)


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Series:
    """The motion of many points in a segment between two keyframes; built by `build_series`.

    `pieces` are in the order of time; times between them need direct evaluation. `error` is an
    upper estimate of the difference from the direct evaluation, in units of the values. It is the
    error at some times, with a margin; infinite without pieces.
    """

    pieces: tuple[SeriesPiece, ...]
    error: float

    @property
    def size(self) -> int:
        """Number of values, c; 0 without pieces."""
        return len(self.pieces[0].rows[0]) if self.pieces else 0

    @property
    def nbytes(self) -> int:
        return nbytes_of(self)

    @property
    def is_whole(self) -> bool:
        """Whether the pieces cover all times."""
        if not self.pieces:
            return False
        ends = (0.0, *(piece.end for piece in self.pieces))
        starts = (*(piece.start for piece in self.pieces), 1.0)
        return all(start <= end for start, end in zip(starts, ends, strict=True))

    def covers(self, time: float) -> bool:
        """Return whether the series covers a time."""
        return self._piece_at(time) is not None

    def blend(self, time: float) -> tuple[SeriesPiece, Singles]:
        """Return the piece at a time in [0, 1], and the weights (r,) of its rows.

        Raises
        ------
        EngineError
            If the time is out of range, or if no piece covers it.
        """
        time = as_number(time, "time")
        if not 0.0 <= time <= 1.0:
            raise EngineError(
                "A series runs from time 0 to 1, so time {time} is out of range.", time=time
            )
        piece = self._piece_at(time)
        if piece is None:
            raise EngineError(
                "The series does not cover time {time}; solve this time directly.", time=time
            )
        return piece, piece.weights(time)

    def values(self, time: float, out: Singles | None = None) -> Singles:
        """Return the values (c,) at a time in [0, 1]: one small matrix-vector product.

        The values are written to `out`, float32 (c,), if given.
        """
        piece, weights = self.blend(time)
        return np.dot(weights, piece.rows, out=out)

    def _piece_at(self, time: float) -> SeriesPiece | None:
        index = bisect_right(self.pieces, time, key=_start) - 1
        if index < 0:
            return None
        # A piece without a successor covers its own end.
        piece = self.pieces[index]
        return piece if time <= piece.end else None


def _start(piece: SeriesPiece) -> float:
    return piece.start
