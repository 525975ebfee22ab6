"""Vertices that the graphics card computes from a series in time."""

from collections.abc import Mapping
from typing import Final

import moderngl
import numpy as np

from app.errors import LissomError
from app.render.gpu.mesh import VertexSource
from app.texts import N_, _
from engine.domain import ClosedCuts
from engine.streaming import Series, SeriesPiece

_RESERVED: Final = 2  # attributes of a mesh outside the series
SERIES_PIECE = N_(
    "a piece of {rows} rows and {values} values does not fit {own_rows} rows of {own_values} values"
)


class SeriesBuffer(VertexSource):
    """Owner of a series' rows on the graphics card.

    Between two frames of one piece of a series, only the weights change: a few numbers.

    Parameters
    ----------
    count : int
        Number of drawn vertices: those of the series, and the further ones of the seam.
    rows : int
        Largest number of rows of a piece.
    seam : ClosedCuts, optional
        How cuts are closed.

    Raises
    ------
    LissomError
        If the context has too few attributes.
    """

    def __init__(
        self, context: moderngl.Context, count: int, rows: int, *, seam: ClosedCuts | None = None
    ) -> None:
        if rows > max_series_rows(context):
            raise LissomError(
                _(
                    "this machine's graphics allow at most {most} rows of a series, not {rows}"
                ).format(most=max_series_rows(context), rows=rows)
            )
        pairs = (rows + 1) // 2
        buffer = context.buffer(reserve=16 * pairs * count, dynamic=True)
        attribute = (buffer, f"{4 * pairs}f", "rows")
        super().__init__("series.glsl", attribute, (("ROW_PAIRS", pairs),))
        self._count, self._pairs, self._seam = count, pairs, seam
        self._weights = np.zeros((pairs, 2), dtype=np.float32)
        self._piece: SeriesPiece | None = None

    @property
    def uniforms(self) -> Mapping[str, object]:
        """The shader's uniforms in this frame."""
        weights = [tuple(pair) for pair in self._weights.tolist()]
        return {"weights": weights if len(weights) > 1 else weights[0]}

    def place(self, series: Series, time: float) -> None:
        """Show a series of positions (v,) at a time in [0, 1]."""
        piece, weights = series.blend(time)
        if piece is not self._piece:
            self._upload(piece)
        # The further rows are 0, so their old weights have no effect.
        self._weights.ravel()[: len(weights)] = weights

    def _upload(self, piece: SeriesPiece) -> None:
        further = 0 if self._seam is None else self._seam.further_vertices
        count, rows = self._count - further, len(piece.rows)
        if piece.rows.shape[1] != 2 * count or rows > 2 * self._pairs:
            raise LissomError(
                _(SERIES_PIECE).format(
                    rows=rows,
                    values=piece.rows.shape[1],
                    own_rows=2 * self._pairs,
                    own_values=2 * count,
                )
            )
        # A vertex has its rows side by side: one memory access per vertex.
        interleaved = np.zeros((count, 2 * self._pairs, 2), dtype=np.float32)
        interleaved[:, :rows] = piece.rows.reshape(rows, count, 2).transpose(1, 0, 2)
        if self._seam is not None:
            interleaved = self._seam.close_cuts(interleaved)
        self._buffer.write(interleaved.data)
        self._piece = piece


def max_series_rows(context: moderngl.Context) -> int:
    """Return the largest number of rows in a shader of this context."""
    return 2 * (int(context.info["GL_MAX_VERTEX_ATTRIBS"]) - _RESERVED)
