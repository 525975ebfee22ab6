"""An addition to the blend of log f_z: few functions of space times series in time."""

from dataclasses import dataclass
from typing import NamedTuple, Self

import numpy as np
import numpy.typing as npt

from engine.arrays import Complexes, Floats, Indices, freeze
from engine.interpolation.series.chebyshev import PiecewiseSeries


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Residual:
    """Σ c_j(t) H_j, which vanishes at both keyframes.

    Attributes
    ----------
    series : PiecewiseSeries
        c_j.
    modes : complex128, shape (j, s)
        H_j at the nodes of the paths.
    modes_z : complex64, shape (j, s)
        H_j' there. It is multiplied by the square of a step, so single precision suffices.
    """

    series: PiecewiseSeries
    modes: Complexes
    modes_z: npt.NDArray[np.complex64]

    @classmethod
    def of(cls, series: PiecewiseSeries, values: Complexes, slopes: Complexes) -> Self:
        """Pack functions and their derivatives, each (s, j)."""
        return cls(
            series=series,
            modes=freeze(np.ascontiguousarray(values.T)),
            modes_z=freeze(slopes.T.astype(np.complex64, order="C")),
        )

    def at(self, which: Indices) -> "Residual":
        """Return a copy restricted to some of the nodes (c,)."""
        return Residual(
            series=self.series,
            modes=freeze(np.ascontiguousarray(self.modes[:, which])),
            modes_z=freeze(np.ascontiguousarray(self.modes_z[:, which])),
        )

    def add_to(self, logarithm: Complexes, logarithm_z: Complexes, time: float) -> None:
        """Add the residual to log f_z and its derivative, each (s,), in place."""
        value, slope = self.combined(self.series(time))
        logarithm += value
        logarithm_z += slope

    def combined(self, coefficients: Floats) -> tuple[Complexes, npt.NDArray[np.complex64]]:
        """Return the sum of the H_j times coefficients (j,), and its derivative, (s,) each."""
        slope = coefficients.astype(np.float32) @ self.modes_z.view(np.float32)
        return combine_arrays(coefficients, self.modes), slope.view(np.complex64)

    def at_times(self, times: Floats) -> Complexes:
        """Return the addition to log f_z at times (t,), (t, s)."""
        return combine_arrays(self.series.at(times).T, self.modes)


class HoleConstants(NamedTuple):
    """Constant by which ln |f_z| stays below its target on the boundary of each hole.

    `at_holes` (holes, j) are multiplied by the values of `series`.
    """

    series: PiecewiseSeries
    at_holes: Floats

    def at(self, times: Floats) -> Floats:
        """Return the constants at times (t,), (t, holes)."""
        constants: Floats = self.series.at(times).T @ self.at_holes.T
        return constants


def combine_arrays(weights: Floats, values: Complexes) -> Complexes:
    """Return the products of real weights (..., q) with arrays (q, s), (..., s)."""
    # In real numbers: a complex product with real weights would spend half its work on zeros.
    sums: Complexes = (weights @ values.view(np.float64)).view(np.complex128)
    return sums
