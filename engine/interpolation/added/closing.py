"""A correction that closes the periods of in-betweens around holes: functions and series in time.

`engine.interpolation.added.hole_closer` finds it.
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import NamedTuple, Self

import numpy as np
import numpy.typing as npt

from engine.arrays import Complexes, Floats, freeze
from engine.interpolation.series.chebyshev import PiecewiseSeries
from engine.interpolation.series.residual import HoleConstants, Residual
from engine.maps import Boundary


class Moduli(NamedTuple):
    """Moduli of a variant at the boundary samples before its periods are closed.

    Attributes
    ----------
    at : callable
        Returns |f_z| and |f_z̄| at times (t,), (t, p) each.
    limits : float64, shape (3,)
        Limits of ln σ_a, −ln σ_b and k.
    constants : HoleConstants
        Constants missing in ln |f_z|, which h approximates.
    """

    at: Callable[[Floats], tuple[Floats, Floats]]
    limits: Floats
    constants: HoleConstants


class Functions(NamedTuple):
    """Functions in the span (n, N), with values and derivatives at the nodes of paths (N, s)."""

    coefficients: Complexes
    values: Complexes
    slopes: npt.NDArray[np.complex64]

    @classmethod
    def of(cls, boundary: Boundary, coefficients: Complexes, nodes: Complexes) -> Self:
        """Evaluate the functions at nodes (s,)."""
        values, slopes = boundary.span.evaluate(coefficients, nodes, orders=(0, 1))
        return cls(coefficients, np.ascontiguousarray(values.T), slopes.T.astype(np.complex64))

    def combined(self, forms: Floats) -> "Functions":
        """Return combinations by forms (N, j)."""
        single = forms.T.astype(np.float32)
        return Functions(
            freeze(self.coefficients @ forms),
            freeze(forms.T @ self.values),
            freeze(single @ self.slopes),
        )

    def joined(self, more: "Functions") -> "Functions":
        return Functions(
            np.hstack([self.coefficients, more.coefficients]),
            np.vstack([self.values, more.values]),
            np.vstack([self.slopes, more.slopes]),
        )


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Closing:
    """The correction of the in-betweens of two keyframes: functions times series in time.

    `largest` is the largest |h| on the boundary at 33 times.
    """

    series: PiecewiseSeries
    functions: Functions
    largest: float

    @property
    def residual(self) -> Residual:
        """H at the nodes of the paths."""
        _, values, slopes = self.functions
        return Residual(series=self.series, modes=values, modes_z=slopes)
