"""Pieces of time so short that a frame costs little more than a linear blend."""

from collections.abc import Generator
from dataclasses import dataclass
from functools import cache
from typing import NamedTuple, Self

import numpy as np

from engine.arrays import Floats, Singles, freeze
from engine.interpolation import chebyshev
from engine.streaming.components import ROUNDING
from engine.streaming.functions import Gap, TimeFunctions
from engine.streaming.series import SeriesPiece

# Rows of a piece: both ends and two functions. A frame costs as many multiply-adds; a linear blend
# costs two. BLAS takes four in one go in a matrix-vector product.
MOST_ROWS = 4
MOST_ATTEMPTS = 512  # largest number of pieces to try
OF_PIECES = 0.4  # of the tolerance, for the error of two functions
LOOKED_AT = 2048  # columns that estimate the error of a piece
MOMENTS = 129  # times that estimate the size of the numbers
DEGREE = 16  # of the functions of a piece; the error is checked between the nodes, too
NEGLIGIBLE = 1e-9  # coefficients of weights that do not change float32 results
BLOCK = 2**14  # columns of rows that are computed at a time
# Two functions are as accurate as a cubic: the error falls with the fourth power of the length.
ORDER = 4
SAFETY, LEAST, MOST = 0.95, 0.2, 2.5  # factors for the next length
# Where functions bend suddenly, the error follows no power of the length. The search for a longer
# piece ends at this share of the allowed error, or of the length of a failed piece.
ENOUGH, CLOSE = 0.5, 0.87


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class PiecewiseReducedModel:
    """A motion in few functions of time: (1 − t, t, c_1(t), …, c_r(t)) · matrix · values.

    `functions` are the c_j. `matrix` is float64 (2 + r, 2 + s). `values` (2 + s, c) are those at
    times 0 and 1 and at s times in between.
    """

    functions: TimeFunctions
    matrix: Floats
    values: Floats

    @classmethod
    def through(cls, functions: TimeFunctions, times: Floats, values: Floats) -> Self:
        """Interpolate values (2 + s, c) at 0, 1 and times (s,), or fit them by least squares."""
        inverse = np.linalg.pinv(functions.series.at(times).T)
        blends = np.column_stack([1.0 - times, times])
        matrix = np.vstack([np.eye(2, 2 + len(times)), np.hstack([-inverse @ blends, inverse])])
        return cls(functions=functions, matrix=freeze(matrix), values=values)

    def coordinates(self, times: Floats) -> Floats:
        """Return (1 − t, t, c_1(t), …) at times (n,), float64 (n, 2 + r); exact at both ends."""
        added = np.where(times % 1.0 == 0.0, 0.0, self.functions.series.at(times))
        return np.vstack([1.0 - times, times, added]).T

    def rows(self, coordinates: Floats) -> Generator[None, None, Singles]:
        """Return the motion at coordinates (q, 2 + r) in all columns, float32 (q, c)."""
        weights = coordinates @ self.matrix
        rows = np.empty((len(weights), self.values.shape[1]), dtype=np.float32)
        for start in range(0, rows.shape[1], BLOCK):
            block = slice(start, start + BLOCK)
            rows[:, block] = weights @ self.values[:, block]
            yield
        return freeze(rows)


class _Cut(NamedTuple):
    """A piece of time in coordinates: its ends (2, 2 + r), and k functions of time there."""

    piece: Gap
    ends: Floats
    functions: Floats  # (n, k), at the nodes
    forms: Floats  # (k, 2 + r)


class _Longest(NamedTuple):
    """State of the search for the longest accurate piece from a time on.

    It holds the longest accurate piece, its length and the next length to try, and the length of
    the shortest failed piece.
    """

    best: _Cut | None = None
    longest: float = 0.0
    following: float = 0.0
    failed: float = np.inf


def split_motion(
    motion: PiecewiseReducedModel, tolerance: float
) -> Generator[None, None, tuple[SeriesPiece, ...]]:
    """Split a motion into pieces of at most `MOST_ROWS` rows, as long as a tolerance allows.

    Times are left out if the motion's functions leave them out, or if the numbers are too large for
    float32 to hold them to the tolerance.
    """
    allowed = OF_PIECES * tolerance
    stride = (motion.values.shape[1] // LOOKED_AT) | 1  # an odd stride alternates x and y
    columns = motion.matrix @ motion.values[:, ::stride]
    forms = columns[2:]
    lower = np.linalg.qr(forms.T).R.T
    cuts: list[_Cut] = []
    attempts = 0
    for start, end in _time_pieces(motion, columns, tolerance):
        place, length = start, end - start
        known = _Longest()
        while place < end and attempts < MOST_ATTEMPTS:
            attempts += 1
            left = end - place
            length = min(max(length, chebyshev.SHORTEST), left)
            if left / 2 < length < left:
                length = left / 2  # avoids a sliver at the end
            goal = end if length == left else place + length
            found, error = _attempt(motion, (place, goal), forms, lower)
            yield
            growth = SAFETY * (allowed / error) ** (1 / ORDER) if error > 0 else MOST
            following = length * min(max(growth, LEAST), MOST)
            if error <= allowed:
                known = known._replace(best=found, longest=length, following=following)
                is_over = error >= ENOUGH * allowed or length >= left / 2
            else:
                known = known._replace(failed=length)
                is_over = length <= chebyshev.SHORTEST
            if is_over or known.longest > CLOSE * known.failed:
                if known.best is not None:
                    cuts.append(known.best)
                    goal, following = known.best.piece[1], known.following
                place, length, known = goal, following, _Longest()
            elif known.best is not None and known.failed < np.inf:
                length = (known.longest * known.failed) ** 0.5
            else:
                length = following
    return (yield from _pieces(motion, cuts))


def _time_pieces(motion: PiecewiseReducedModel, columns: Floats, tolerance: float) -> list[Gap]:
    """Return the pieces of time that a series can represent."""
    times = np.linspace(0.0, 1.0, MOMENTS)
    largest = np.abs(motion.coordinates(times) @ columns).max(axis=1, initial=0.0)
    # A series rounds fewer times than the tolerance allows for.
    large = np.flatnonzero(ROUNDING * largest > 2 * tolerance)
    from_, to = times[np.maximum(large - 1, 0)], times[np.minimum(large + 1, MOMENTS - 1)]
    gaps = [*motion.functions.gaps, *zip(from_.tolist(), to.tolist(), strict=True)]
    found, place = [], 0.0
    for start, end in [*sorted(gaps), (1.0, 1.0)]:
        if start > place:
            found.append((place, start))
        place = max(place, end)
    return found


def _attempt(
    motion: PiecewiseReducedModel, piece: Gap, forms: Floats, lower: Floats
) -> tuple[_Cut, float]:
    """Write a piece in two functions of time; return it with its largest error in some columns.

    `forms` (r, n) are the coefficients of the functions in these columns. They are `lower` (r, r)
    times orthonormal rows.
    """
    start, end = piece
    nodes = chebyshev.chebyshev_nodes(2 * DEGREE)
    coordinates = motion.coordinates(start + (end - start) * (1.0 + nodes) / 2)
    ends = coordinates[[0, -1]]
    # Subtract the linear blend; the rest vanishes at both ends.
    added = (coordinates - np.column_stack([1.0 - nodes, 1.0 + nodes]) / 2 @ ends)[:, 2:]
    at_nodes = added[::2]
    left, sizes, _ = np.linalg.svd(at_nodes @ lower, full_matrices=False)
    kept = left[:, : np.count_nonzero(sizes[: MOST_ROWS - 2])]
    own = kept.T @ at_nodes
    missing = added - _between() @ kept @ own
    error = float(np.abs(missing @ forms).max(initial=0.0))
    padded = np.hstack([np.zeros((len(own), 2)), own])
    return _Cut(piece, ends, kept, padded), error


@cache
def _between() -> Floats:
    """Return the matrix (2 n − 1, n) from values at the nodes to values at the doubled nodes."""
    nodes = chebyshev.chebyshev_nodes(2 * DEGREE)
    basis = np.polynomial.chebyshev.chebvander(nodes, DEGREE)
    return freeze(np.asarray(basis @ chebyshev.to_coefficients(DEGREE)))


def _pieces(
    motion: PiecewiseReducedModel, cuts: list[_Cut]
) -> Generator[None, None, tuple[SeriesPiece, ...]]:
    """Compute the rows of all pieces; consecutive pieces share the row between them."""
    coordinates: list[Floats] = []
    places = []
    for index, each in enumerate(cuts):
        follows = index > 0 and cuts[index - 1].piece[1] == each.piece[0]
        if not follows:
            coordinates.append(each.ends[:1])
        first = sum(map(len, coordinates)) - 1
        coordinates += [each.forms, each.ends[1:]]
        places.append(slice(first, first + len(each.forms) + 2))
    if not cuts:
        return ()
    rows = yield from motion.rows(np.vstack(coordinates))
    return tuple(
        SeriesPiece(
            start=each.piece[0],
            end=each.piece[1],
            functions=_weights(each.functions),
            rows=rows[place],
        )
        for each, place in zip(cuts, places, strict=True)
    )


def _weights(functions: Floats) -> Floats:
    """Return the Chebyshev coefficients of a piece's weights, given functions at the nodes."""
    coefficients = chebyshev.to_coefficients(DEGREE) @ functions
    felt = np.flatnonzero(np.abs(coefficients).max(axis=1, initial=0.0) > NEGLIGIBLE)
    count = max(2, 1 + int(felt.max(initial=0)))
    ends = np.zeros((count, 2))
    ends[:2] = [[0.5, 0.5], [-0.5, 0.5]]
    return freeze(np.column_stack([ends[:, 0], coefficients[:count], ends[:, 1]]))
