"""The curb: ln |f_z| and η of blended poses, moved into the limits along the boundary.

k = |η| / |f_z|² and σ_a, σ_b = |f_z| ± |η| / |f_z|. For a given |η| they are within the limits
k_max, σ_a_max and σ_b_min exactly where ln |f_z| is between

    ln max((σ_b_min + √(σ_b_min² + 4 |η|)) / 2, √(|η| / k_max))  and
    ln ((σ_a_max + √(σ_a_max² − 4 |η|)) / 2).

This interval is not empty while |η| is at most

    η_max = min((σ_a_max² − σ_b_min²) / 4, k_max σ_a_max² / (1 + k_max)²).

So the curb scales η by ρ ≤ 1 and adds r to ln |f_z|. Both are continuous in the weights, and change
nothing where the blend is within the limits. Not in the paper.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import NamedTuple, Self

import numpy as np
import shapely

from engine.arrays import Complexes, Floats, Indices, freeze
from engine.dirichlet import HilbertTransform
from engine.dirichlet.panels import Panels
from engine.geometry import as_xy
from engine.interpolation.inbetweens import PointValues
from engine.interpolation.series.residual import combine_arrays
from engine.maps import Boundary, HarmonicMap, LocalBounds, derivatives_of

# Part of η_max by which ρ lowers |η| further once η_max is exceeded. At η_max the interval is a
# single value, which a polynomial cannot follow.
BACK = 0.03


class Curb(NamedTuple):
    """r at the nodes of the boundary, (N,), and how far ln |f_z| then is outside its interval."""

    residual: Floats
    excess: float


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class OutlineBlend:
    """A blend on the boundary, with ln |f_z| and its interval at the checked places (p, c).

    `loops` (p,) are the loops of the panels, 0 for the outline. `rho` is the factor of η.
    """

    panels: Panels
    loops: Indices
    log_modulus: Floats
    low: Floats
    high: Floats
    rho: float

    def curb(self, at_nodes: Floats | None, constants: Floats) -> Curb:
        """Find r, given an addition to ln |f_z| at the nodes (N,), if any.

        `constants` (1 + holes,) are added on each loop before r moves ln |f_z| into its interval.
        """
        panels, logarithm = self.panels, self.log_modulus
        if at_nodes is not None:
            logarithm = logarithm + panels.interpolate(at_nodes.reshape(len(panels), -1))
        fitted, excess = panels.fit_within(logarithm, self.low, self.high, constants[self.loops])
        return Curb(fitted.ravel(), excess)


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class OutlinePoses:
    """Poses on the boundary, at the checked places (p c,) of the transform's panels.

    `bounds` are numbers, or arrays (p, c). `loops` (p,) are as in `OutlineBlend`; `log_modulus` and
    `conj_eta` (q, p c) are ln |f_z| and conj(η) of each pose.
    """

    transform: HilbertTransform
    bounds: LocalBounds
    loops: Indices
    log_modulus: Floats
    conj_eta: Complexes

    @classmethod
    def of(
        cls,
        maps: Sequence[HarmonicMap],
        transform: HilbertTransform,
        boundary: Boundary,
        bounds: LocalBounds,
    ) -> Self:
        """Evaluate poses (q,) on the boundary; bounds may be arrays at its own samples."""
        panels = transform.panels
        checked = transform.centre + panels.checked
        loops = np.searchsorted(panels.starts, np.arange(len(panels)), "right") - 1
        fz, fzbar = derivatives_of(maps, checked.ravel())
        return cls(
            transform=transform,
            bounds=_bounds_at(bounds, boundary, checked, loops),
            loops=freeze(loops),
            log_modulus=freeze(np.ascontiguousarray(np.log(np.abs(fz)))),
            conj_eta=freeze(np.ascontiguousarray(fz * fzbar.conj())),
        )

    def blend(self, base: PointValues, weights: Floats) -> OutlineBlend:
        """Add poses by weights (q,) to a base at the nodes of the transform (N,)."""
        panels, used = self.transform.panels, np.flatnonzero(weights)
        shape = len(panels), -1
        logarithm = panels.interpolate(np.log(np.abs(base.fz)).reshape(shape))
        logarithm += (weights[used] @ self.log_modulus[used]).reshape(shape)
        own = (base.fz * base.g).reshape(shape)
        conj_eta = panels.interpolate(own.real) + 1j * panels.interpolate(own.imag)
        conj_eta += combine_arrays(weights[used], self.conj_eta[used]).reshape(shape)
        eta = np.abs(conj_eta)
        rho = eta_scale(eta, self.bounds)
        low, high = log_modulus_limits(rho * eta, self.bounds)
        return OutlineBlend(
            panels=panels, loops=self.loops, log_modulus=logarithm, low=low, high=high, rho=rho
        )


def _bounds_at(
    bounds: LocalBounds, boundary: Boundary, points: Complexes, loops: Indices
) -> LocalBounds:
    """Return bounds at points (p, c) of loops (p,), between a boundary's own samples."""
    limits = bounds.k, bounds.sigma_a, bounds.sigma_b
    if not any(isinstance(limit, np.ndarray) for limit in limits):
        return bounds
    own, ends = boundary.original_samples
    found = np.empty((3, *points.shape))
    for number, (start, end) in enumerate(pairwise(ends)):
        corners = boundary.loops[number]
        ring = shapely.linestrings(as_xy(np.append(corners, corners[0])))
        length, here = shapely.length(ring), loops == number
        known, wanted = (
            shapely.line_locate_point(ring, shapely.points(as_xy(each.ravel())))
            for each in (boundary.points[own[start:end]], points[here])
        )
        for row, limit in zip(found, limits, strict=True):
            values = np.broadcast_to(limit, len(own))[start:end]
            row[here] = np.interp(wanted, known, values, period=length).reshape(-1, points.shape[1])
    k, sigma_a, sigma_b = found
    return LocalBounds(k=k, sigma_a=sigma_a, sigma_b=sigma_b)


def eta_scale(eta: Floats, bounds: LocalBounds) -> float:
    """Return ρ for |η| on the boundary."""
    k, sigma_a, sigma_b = bounds.k, bounds.sigma_a, bounds.sigma_b
    largest = np.minimum((sigma_a**2 - sigma_b**2) / 4, k * sigma_a**2 / (1 + k) ** 2)
    beyond = float((eta / largest).max()) - 1.0
    if beyond <= 0.0:
        return 1.0
    return (1.0 - BACK * (1.0 - float(np.exp(-beyond / BACK)))) / (1.0 + beyond)


def log_modulus_limits(eta: Floats, bounds: LocalBounds) -> tuple[Floats, Floats]:
    """Return the ends of the interval of ln |f_z|, given |η| ≤ η_max."""
    k, sigma_a, sigma_b = bounds.k, bounds.sigma_a, bounds.sigma_b
    low = np.maximum((sigma_b + np.sqrt(sigma_b**2 + 4 * eta)) / 2, np.sqrt(eta / k))
    # Rounding may leave |η| a little above η_max.
    high = (sigma_a + np.sqrt(np.maximum(sigma_a**2 - 4 * eta, 0.0))) / 2
    return np.log(low), np.log(high)
