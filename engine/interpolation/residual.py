"""What is added to the blend of log f_z: few holomorphic functions, each times a series in time."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Self

import numpy as np
import numpy.typing as npt

from engine.arrays import Complexes, Floats, Indices, freeze
from engine.chebyshev import PiecewiseSeries, nodes, to_coefficients

DEGREE = 24  # of the series of a piece of time
LAST_TERMS = 3
SHORTEST = 2.0**-30  # pieces of time are not halved below this


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Residual:
    """Σ c_j(t) H_j; what is added to a blend vanishes at both keyframes.

    Parameters
    ----------
    series : PiecewiseSeries
        c_j.
    modes : complex128, shape (j, s)
        H_j at the nodes of the paths.
    modes_z : complex64, shape (j, s)
        H_j' there: the square of a step multiplies it, and single precision is plenty.
    """

    series: PiecewiseSeries
    modes: Complexes
    modes_z: npt.NDArray[np.complex64]

    @classmethod
    def of(cls, series: PiecewiseSeries, values: Complexes, slopes: Complexes) -> Self:
        """Pack functions given with their derivatives, each (s, j)."""
        return cls(
            series=series,
            modes=freeze(np.ascontiguousarray(values.T)),
            modes_z=freeze(slopes.T.astype(np.complex64, order="C")),
        )

    def at(self, which: Indices) -> "Residual":
        """Return the same at some of the nodes (c,)."""
        return Residual(
            series=self.series,
            modes=freeze(np.ascontiguousarray(self.modes[:, which])),
            modes_z=freeze(np.ascontiguousarray(self.modes_z[:, which])),
        )

    @property
    def nbytes(self) -> int:
        """Memory that the arrays take, in bytes."""
        return self.modes.nbytes + self.modes_z.nbytes + self.series.coefficients.nbytes

    def add_to(self, logarithm: Complexes, logarithm_z: Complexes, time: float) -> None:
        """Add it to log f_z and its derivative, each (s,), in place."""
        coefficients = self.series(time)
        # As reals: a complex product with real coefficients would do half its work on zeros.
        logarithm.view(np.float64)[:] += coefficients @ self.modes.view(np.float64)
        single = coefficients.astype(np.float32)
        logarithm_z.view(np.float64)[:] += single @ self.modes_z.view(np.float32)


def separate(
    values: Callable[[Floats], Floats],
    *,
    tolerance: float,
    left_out: float,
    shortest: float = SHORTEST,
    breaks: Sequence[float] = (0.0, 1.0),
    vanishing: bool = True,
) -> tuple[Floats, PiecewiseSeries]:
    """Write functions of time as sums of few forms times series.

    Parameters
    ----------
    values : callable
        Returns the functions at times (t,) in [0, 1], float64 (N, t).
    tolerance : float
        Of the last terms of the series.
    left_out : float
        Of the forms.
    shortest : float
        Piece of time that is not halved any more.
    breaks : sequence of float
        From 0 to 1: where the functions may have kinks.
    vanishing : bool
        Whether they are 0 at times 0 and 1, and the series made exactly so.

    Returns
    -------
    forms : float64, shape (N, j)
    series : PiecewiseSeries
        Of the j coefficients; the functions are `forms @ series(t)`.
    """
    x = nodes(DEGREE)
    pending = list(pairwise(breaks))[::-1]
    found, pieces = [0.0], []
    while pending:
        start, end = pending.pop()
        times = start + (end - start) * (1 + x) / 2
        coefficients = values(times) @ to_coefficients(DEGREE).T
        rest = np.abs(coefficients[:, -LAST_TERMS:]).max()
        if rest <= tolerance or end - start <= shortest:
            found.append(end)
            pieces.append(coefficients)
        else:
            middle = (start + end) / 2
            pending += [(middle, end), (start, middle)]
    forms, sizes, functions = np.linalg.svd(np.hstack(pieces), full_matrices=False)
    kept = max(1, int(np.count_nonzero(sizes > left_out)))
    series = (sizes[:kept, None] * functions[:kept]).reshape(kept, len(pieces), DEGREE + 1)
    times, coefficients = np.array(found), series.transpose(1, 2, 0)
    if vanishing:
        coefficients = _vanishing_at_ends(times, coefficients)
    return forms[:, :kept], PiecewiseSeries(
        breaks=freeze(times), coefficients=freeze(np.ascontiguousarray(coefficients))
    )


def _vanishing_at_ends(breaks: Floats, coefficients: Floats) -> Floats:
    """Take off the rounding that is left at the keyframes, so that they come out exactly."""
    signs = (-1.0) ** np.arange(DEGREE + 1)
    first, last = signs @ coefficients[0], coefficients[-1].sum(axis=0)
    at_breaks = first + np.multiply.outer(breaks, last - first)
    corrected = coefficients.copy()
    corrected[:, 0] -= (at_breaks[1:] + at_breaks[:-1]) / 2
    corrected[:, 1] -= (at_breaks[1:] - at_breaks[:-1]) / 2
    return corrected
