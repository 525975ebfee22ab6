"""The curb: ln |f_z| and η of blended poses, moved into the limits along the boundary.

k = |η| / |f_z|² and σ_a, σ_b = |f_z| ± |η| / |f_z|. For a given |η| they are within the limits
k_max, σ_a_max and σ_b_min exactly where ln |f_z| is between

    ln max((σ_b_min + √(σ_b_min² + 4 |η|)) / 2, √(|η| / k_max))  and
    ln ((σ_a_max + √(σ_a_max² − 4 |η|)) / 2).

This interval is not empty while |η| is at most

    η_max = min((σ_a_max² − σ_b_min²) / 4, k_max σ_a_max² / (1 + k_max)²).

So the curb scales η by ρ ≤ 1 and adds r to ln |f_z|. Both are continuous in the weights, and change
nothing where the poses' blend is within the limits. Not in the paper.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple, Self

import numpy as np

from engine.arrays import Complexes, Floats, Indices, freeze
from engine.dirichlet import HilbertTransform
from engine.interpolation.series.residual import combine_arrays
from engine.maps import Bounds, HarmonicMap, derivatives_of

# Part of η_max by which ρ lowers |η| further once η_max is exceeded. At η_max the interval is a
# single value, which a polynomial cannot follow.
BACK = 0.03


class Curb(NamedTuple):
    """The curb of one frame.

    Attributes
    ----------
    residual : float64, shape (N,)
        r at the nodes of the boundary.
    rho : float
        Factor of η.
    excess : float
        How far ln |f_z| is outside its interval at any checked place.
    """

    residual: Floats
    rho: float
    excess: float


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class OutlinePoses:
    """Poses on the boundary, at the checked places (p, c) of the transform's panels.

    Attributes
    ----------
    loops : intp, shape (p,)
        The loop of each panel, 0 for the outline.
    log_modulus, conj_eta : float64 and complex128, shape (q, p c)
        ln |f_z| and conj(η) of each pose.
    """

    transform: HilbertTransform
    bounds: Bounds
    loops: Indices
    log_modulus: Floats
    conj_eta: Complexes

    @classmethod
    def of(cls, maps: Sequence[HarmonicMap], transform: HilbertTransform, bounds: Bounds) -> Self:
        """Evaluate poses (q,) on the boundary."""
        panels = transform.panels
        fz, fzbar = derivatives_of(maps, transform.centre + panels.checked.ravel())
        return cls(
            transform=transform,
            bounds=bounds,
            loops=freeze(np.searchsorted(panels.starts, np.arange(len(panels)), "right") - 1),
            log_modulus=freeze(np.ascontiguousarray(np.log(np.abs(fz)))),
            conj_eta=freeze(np.ascontiguousarray(fz * fzbar.conj())),
        )

    def curb(self, weights: Floats, at_nodes: Floats | None, constants: Floats) -> Curb:
        """Return the curb of a frame.

        Parameters
        ----------
        weights : float64, shape (q,)
        at_nodes : float64, shape (N,), optional
            An addition to ln |f_z| at the nodes.
        constants : float64, shape (1 + holes,)
            Added to ln |f_z| on each loop before r moves it into its interval.
        """
        panels = self.transform.panels
        logarithm = (weights @ self.log_modulus).reshape(len(panels), -1)
        if at_nodes is not None:
            logarithm += panels.interpolate(at_nodes.reshape(len(panels), -1))
        eta = np.abs(combine_arrays(weights, self.conj_eta)).reshape(logarithm.shape)
        rho = eta_scale(float(eta.max()), self.bounds)
        low, high = log_modulus_limits(rho * eta, self.bounds)
        residual, excess = panels.fit_within(logarithm, low, high, constants[self.loops])
        return Curb(residual.ravel(), rho, excess)


def largest_eta(bounds: Bounds) -> float:
    """Return η_max."""
    k, sigma_a, sigma_b = bounds.k, bounds.sigma_a, bounds.sigma_b
    return min((sigma_a**2 - sigma_b**2) / 4, k * sigma_a**2 / (1 + k) ** 2)


def eta_scale(eta: float, bounds: Bounds) -> float:
    """Return ρ for the largest |η| on the boundary."""
    beyond = eta / largest_eta(bounds) - 1.0
    if beyond <= 0.0:
        return 1.0
    return (1.0 - BACK * (1.0 - float(np.exp(-beyond / BACK)))) / (1.0 + beyond)


def log_modulus_limits(eta: Floats, bounds: Bounds) -> tuple[Floats, Floats]:
    """Return the ends of the interval of ln |f_z|, given |η| ≤ η_max."""
    k, sigma_a, sigma_b = bounds.k, bounds.sigma_a, bounds.sigma_b
    low = np.maximum((sigma_b + np.sqrt(sigma_b**2 + 4 * eta)) / 2, np.sqrt(eta / k))
    # Rounding may leave |η| a little above η_max.
    high = (sigma_a + np.sqrt(np.maximum(sigma_a**2 - 4 * eta, 0.0))) / 2
    return np.log(low), np.log(high)
