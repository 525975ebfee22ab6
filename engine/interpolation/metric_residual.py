"""What the metric variant adds to the logarithmic blend, on the outline and in time.

On the outline ln |f_z| of the blended metric, Equation (13), differs from the linear blend of the
keyframes' ln |f_z| by a residual that vanishes at both of them. In time it is analytic, and across
the outline it takes few shapes: it is written as Σ_j c_j(t) U_j(ζ) with piecewise Chebyshev series
c_j, so that a handful of Dirichlet problems serve every time.
"""

from dataclasses import dataclass

import numpy as np
from numpy.polynomial import chebyshev

from engine.arrays import Complexes, Floats, readonly

DEGREE = 24  # of the series of a piece of time
TOLERANCE = 1e-10  # of the series' last terms, and of the shapes left out, in ln |f_z|
LAST_TERMS = 3
SHORTEST = 2.0**-30  # pieces of time are not halved below this


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class TimeSeries:
    """Piecewise Chebyshev series in time of some coefficients.

    Parameters
    ----------
    breaks : float64, shape (b + 1,)
        Ends of the pieces, from 0 to 1.
    coefficients : float64, shape (b, DEGREE + 1, j)
    """

    breaks: Floats
    coefficients: Floats

    def __call__(self, time: float) -> Floats:
        """Return the coefficients (j,) at a time in [0, 1]."""
        last = len(self.breaks) - 2
        piece = min(int(np.searchsorted(self.breaks, time, side="right")) - 1, last)
        start, end = self.breaks[piece], self.breaks[piece + 1]
        x = (2 * time - start - end) / (end - start)
        result: Floats = chebyshev.chebval(x, self.coefficients[piece])
        return result


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class OutlineMetric:
    """The keyframes' metrics at points of the outline, each (N,) for the two keyframes.

    Parameters
    ----------
    log_modulus, trace : float64, shape (2, N)
        ln |f_z|, and 𝒜 = |f_z|² + |f_z̄|², half the trace of the metric tensor.
    eta : complex128, shape (2, N)
        η up to conjugation, which the metric variant does not see.
    """

    log_modulus: Floats
    trace: Floats
    eta: Complexes

    @classmethod
    def of(cls, fz: Complexes, fzbar: Complexes) -> "OutlineMetric":
        """Work the metrics out from the derivatives (2, N)."""
        return cls(
            log_modulus=np.log(np.abs(fz)),
            trace=np.abs(fz) ** 2 + np.abs(fzbar) ** 2,
            eta=fz * fzbar.conj(),
        )

    def residuals(self, times: Floats) -> Floats:
        """Return ln |f_z| of the blended metric less the blend of the ln |f_z|, (N, times).

        Departs from the paper: the bars of Equation (13) and the lines before it were lost; the
        product of its roots is |η|².
        """
        weights = np.stack([1 - times, times])
        trace = self.trace.T @ weights
        twice_eta = 2 * np.abs(self.eta.T @ weights)
        # As a product, the discriminant keeps its digits where the map is nearly singular.
        discriminant = (trace - twice_eta) * (trace + twice_eta)
        modulus = 0.5 * np.log(0.5 * (trace + np.sqrt(discriminant)))
        residuals: Floats = modulus - self.log_modulus.T @ weights
        return residuals


def separate(metric: OutlineMetric) -> tuple[Floats, TimeSeries]:
    """Write the residuals as a sum of products of shapes and functions of time.

    Returns
    -------
    shapes : float64, shape (N, j)
    series : TimeSeries
        Of the j coefficients; the residuals are `shapes @ series(t)` to about 1e-10.
    """
    x = chebyshev.chebpts2(DEGREE + 1)
    to_coefficients = np.linalg.inv(chebyshev.chebvander(x, DEGREE)).T
    pending = [(0.0, 1.0)]
    breaks, pieces = [0.0], []
    while pending:
        start, end = pending.pop()
        times = start + (end - start) * (1 + x) / 2
        coefficients = metric.residuals(times) @ to_coefficients
        rest = np.abs(coefficients[:, -LAST_TERMS:]).max()
        if rest <= TOLERANCE or end - start <= SHORTEST:
            breaks.append(end)
            pieces.append(coefficients)
        else:
            middle = (start + end) / 2
            pending += [(middle, end), (start, middle)]
    shapes, sizes, functions = np.linalg.svd(np.hstack(pieces), full_matrices=False)
    kept = max(1, int(np.count_nonzero(sizes > TOLERANCE)))
    series = (sizes[:kept, None] * functions[:kept]).reshape(kept, len(pieces), DEGREE + 1)
    times, coefficients = np.array(breaks), series.transpose(1, 2, 0)
    return shapes[:, :kept], TimeSeries(
        breaks=readonly(times), coefficients=readonly(_vanishing_at_ends(times, coefficients))
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
