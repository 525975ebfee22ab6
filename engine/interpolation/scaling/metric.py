"""The ρ of the metric variant around holes, where closing the periods broke its bounds.

The metric variant needs no ρ, Properties 5' to 7' hold by themselves. Around holes ln |f_z| differs
from what Equation (13) asks for, by h and by a constant on the boundary of each hole; between hard
keyframes the map may then leave their bounds, and even fold. There η is scaled, as in the scaled η
variant: both maps, for ρ = 1 and for ρ = 0, are closed.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from engine.arrays import Complexes, Floats
from engine.interpolation.blends import OutlineMetric
from engine.interpolation.chebyshev import PiecewiseSeries
from engine.interpolation.scaling.sharp import Worst, allowed

# What the in-betweens may be beyond the worst of the keyframes: the errors of the Dirichlet
# problem's solution.
ROOM = 1e-3
BLOCK = 64  # times that are looked at together


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class MetricRatios:
    """The largest ρ at each time: the minimum over samples of the boundary (p,).

    Parameters
    ----------
    metric : OutlineMetric
        At the samples.
    lacking : callable
        By how much, at times (t,), ln |f_z| is below the metric's at the samples, (t, p).
    worst : Worst
        Of the keyframes.
    closings : tuple of (complex128 (p, j), PiecewiseSeries)
        The modes of h at the samples, and those of d where it is known.
    """

    metric: OutlineMetric
    lacking: Callable[[Floats], Floats]
    worst: Worst
    closings: tuple[tuple[Complexes, PiecewiseSeries], ...]

    def __call__(self, times: Floats) -> Floats:
        """Return ρ in (0, 1] at times (t,)."""
        blocks = np.array_split(times, max(1, -(-len(times) // BLOCK)))
        return np.concatenate([self._minima(block) for block in blocks])

    def _minima(self, times: Floats) -> Floats:
        metric = self.metric
        h, *opening = (series.at(times).T @ modes.T for modes, series in self.closings)
        logarithm = metric.residuals(times).T + metric.course.full.at(times).T @ metric.log_modulus
        a = np.exp(logarithm - self.lacking(times) + h.real)
        b = np.abs(metric.course.at(times).T @ metric.eta) / a
        limits = (
            self.worst.k * (1 + ROOM),
            self.worst.sigma_a * (1 + ROOM),
            self.worst.sigma_b * (1 - ROOM),
        )
        ratios = allowed(a, b, opening[0] if opening else None, limits)
        smallest: Floats = np.minimum(ratios.min(axis=1), 1.0)
        return smallest
