"""The few functions of time in which a whole motion is written, found at a few of its points."""

from collections import deque
from collections.abc import Callable, Generator
from dataclasses import dataclass
from typing import Self

import numpy as np
from scipy.linalg import qr

from engine.arrays import Floats, freeze
from engine.interpolation import chebyshev

DEGREES = (8, 16, 32)  # the nodes of each are among those of the next
LAST_TERMS = 2
SHORTEST = 2.0**-14  # pieces of time are not halved below this
# Pieces that are tried. What is not resolved by then stays on the direct path.
MOST_ATTEMPTS = 96
MOST = 96  # functions; a motion that needs more is none that harmonic maps make
OF_POLYNOMIALS = 0.1  # of what the functions may leave out in all

Gap = tuple[float, float]


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class TimeFunctions:
    """What is added to the linear blend of both keyframes, as functions of time.

    Parameters
    ----------
    series : chebyshev.PiecewiseSeries
        Orthonormal in the sense of the times at which they were found; linear in the gaps.
    gaps : tuple of Gap
        Stretches of time, in order, that no polynomial resolves.
    times : float64, shape (r,)
        At which the r functions are told apart best: what they are multiplied by follows from
        values there.
    """

    series: chebyshev.PiecewiseSeries
    gaps: tuple[Gap, ...]
    times: Floats

    @classmethod
    def of(cls, probe: Callable[[Floats], Floats], tolerance: float) -> Generator[None, None, Self]:
        """Find the functions in which a probe's numbers (t, p) are written to a tolerance.

        Notes
        -----
        The probe is analytic in time but for some moments, so that a polynomial through Chebyshev
        nodes converges geometrically. Pieces of time are halved where its last coefficients do not
        come down. The leading singular vectors of the values at all nodes are the functions.
        """
        ends = probe(np.array([0.0, 1.0]))
        # The longest first: easy stretches are covered before the hard ones take all attempts.
        pending: deque[Gap] = deque([(0.0, 1.0)])
        found: list[tuple[Gap, Floats | None]] = []
        for _ in range(MOST_ATTEMPTS):
            if not pending:
                break
            start, end = pending.popleft()
            values = yield from _resolve(probe, ends, (start, end), OF_POLYNOMIALS * tolerance)
            if values is None and end - start > SHORTEST:
                middle = (start + end) / 2
                pending += [(start, middle), (middle, end)]
            else:
                found.append(((start, end), values))
        found += [(gap, None) for gap in pending]
        found.sort(key=lambda each: each[0])
        resolved = [(piece, values) for piece, values in found if values is not None]
        gaps = tuple(piece for piece, values in found if values is None)
        times = np.concatenate(
            [_times(piece, len(v) - 1) for piece, v in resolved] or [np.empty(0)]
        )
        values = np.vstack([v for _, v in resolved] or [np.empty((0, len(ends[0])))])
        functions = _leading(values, (1.0 - OF_POLYNOMIALS) * tolerance)
        yield
        _, _, pivots = qr(functions.T, mode="economic", pivoting=True)
        chosen = np.sort(pivots[: functions.shape[1]])
        return cls(
            series=_as_series(found, functions),
            gaps=gaps,
            times=freeze(times[chosen]),
        )


def _resolve(
    probe: Callable[[Floats], Floats], ends: Floats, piece: Gap, tolerance: float
) -> Generator[None, None, Floats | None]:
    """Return what a probe adds to the blend of its ends at nodes that resolve it, (n, p)."""
    known: Floats | None = None
    before = np.inf
    for degree in DEGREES:
        times = _times(piece, degree)
        values = np.empty((degree + 1, len(ends[0])))
        new = slice(None) if known is None else slice(1, None, 2)
        if known is not None:
            values[::2] = known
        blends = np.column_stack([1.0 - times[new], times[new]])
        values[new] = probe(times[new]) - blends @ ends
        yield
        last = chebyshev.to_coefficients(degree)[-LAST_TERMS:] @ values
        rest = float(np.abs(last).max(initial=0.0))
        if rest <= tolerance:
            return values
        # At the rate at which the terms came down, twice the degree brings their ratio squared.
        if not rest * (rest / before) ** 2 <= tolerance / OF_POLYNOMIALS:
            return None
        known, before = values, rest
    return None


def _times(piece: Gap, degree: int) -> Floats:
    start, end = piece
    times: Floats = start + (end - start) * (1.0 + chebyshev.nodes(degree)) / 2
    return times


def _leading(values: Floats, tolerance: float) -> Floats:
    """Return an orthonormal basis (n, r) in which all columns of `values` are written.

    A column is what one number does in time. As points move alike, far fewer functions of time
    occur among them than a polynomial basis has.

    Parameters
    ----------
    values : float64, shape (n, p)
    tolerance : float
        The largest entry that `values` may lose.
    """
    # The singular vectors of the triangle are those of the values, and it is far smaller. (Those of
    # a Gram matrix lose half the digits: more than a tolerance of 1e-6 leaves.)
    triangle = np.linalg.qr(values.T, mode="r").T
    vectors, _, _ = np.linalg.svd(triangle, full_matrices=False)
    rest, rank = values.copy(), 0
    while rank < min(vectors.shape[1], MOST) and np.abs(rest).max() > tolerance:
        function = vectors[:, rank]
        rest -= np.outer(function, function @ rest)
        rank += 1
    return vectors[:, :rank]


def _as_series(
    found: list[tuple[Gap, Floats | None]], functions: Floats
) -> chebyshev.PiecewiseSeries:
    """Return functions given at the nodes of all pieces, (n, r), as polynomials on each piece."""
    coefficients = np.zeros((len(found), DEGREES[-1] + 1, functions.shape[1]))
    first = 0
    for room, (_, values) in zip(coefficients, found, strict=True):
        if values is not None:
            here = functions[first : first + len(values)]
            room[: len(values)] = chebyshev.to_coefficients(len(values) - 1) @ here
            first += len(values)
    # Gaps are bridged, so that the pieces beside them are right up to their ends.
    start, first = np.zeros(functions.shape[1]), 0
    for room, (_, values) in zip(coefficients, found, strict=True):
        if values is None:
            end = functions[first] if first < len(functions) else np.zeros_like(start)
            room[0], room[1] = (start + end) / 2, (end - start) / 2
            start = end
        else:
            first += len(values)
            start = functions[first - 1]
    breaks = np.array([0.0, *(end for (_, end), _ in found)])
    return chebyshev.PiecewiseSeries(breaks=freeze(breaks), coefficients=freeze(coefficients))
