"""What is added to a blend of log f_z: few functions of the place times series in time."""

from dataclasses import dataclass
from typing import NamedTuple, Self

import numpy as np
import numpy.typing as npt

from engine.arrays import Complexes, Floats, Indices, freeze
from engine.interpolation.series.chebyshev import PiecewiseSeries


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

    def add_to(self, logarithm: Complexes, logarithm_z: Complexes, time: float) -> None:
        """Add it to log f_z and its derivative, each (s,), in place."""
        coefficients = self.series(time)
        logarithm += combine_arrays(coefficients, self.modes)
        single = coefficients.astype(np.float32)
        logarithm_z.view(np.float64)[:] += single @ self.modes_z.view(np.float32)

    def at_times(self, times: Floats) -> Complexes:
        """Return what is added to log f_z at times (t,), (t, s)."""
        return combine_arrays(self.series.at(times).T, self.modes)


class HoleConstants(NamedTuple):
    """By how much ln |f_z| stays below what was asked for, on the boundary of each hole.

    Parameters
    ----------
    series : PiecewiseSeries
    at_holes : float64, shape (holes, j)
        What the coefficients of the series are multiplied by.
    """

    series: PiecewiseSeries
    at_holes: Floats

    def at(self, times: Floats) -> Floats:
        """Return them at times (t,), (t, holes)."""
        constants: Floats = self.series.at(times).T @ self.at_holes.T
        return constants


def combine_arrays(weights: Floats, values: Complexes) -> Complexes:
    """Return the products of real weights (..., q) with arrays (q, s), (..., s)."""
    # As reals: a complex product with real weights would do half its work on zeros.
    sums: Complexes = (weights @ values.view(np.float64)).view(np.complex128)
    return sums
