"""The scaling ρ that brings η back within the keyframes' bounds (Section 7.3, Appendix A)."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Self

import numpy as np

from engine.arrays import Complexes, Floats, readonly
from engine.interpolation.keyframe_samples import KeyframeSamples
from engine.maps import HarmonicMap, evaluate

NEGLIGIBLE = 1e-9  # f_z̄ / f_z below which no scaling is needed, whatever the bounds
NO_SCALING = 1.1  # lowest sampled ratio from which on none between the samples is below 1
CANDIDATES = 6  # lowest local minima that are looked at more closely
REFINEMENTS = 6
PIECES = 16  # of a refined stretch of the outline; each round makes it PIECES / 2 times shorter


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class PointSamples:
    """What ρ depends on at some points (p,), for each of q keyframes.

    Parameters
    ----------
    log_modulus : float64, shape (q, p)
        ln |f_z|.
    conj_eta : complex128, shape (q, p)
    k, sigma_a, sigma_b : float64, shape (p,)
        The largest k and sigma_a and the smallest sigma_b of the keyframes: Properties 5 to 7.
    """

    log_modulus: Floats
    conj_eta: Complexes
    k: Floats
    sigma_a: Floats
    sigma_b: Floats

    @classmethod
    def of(cls, fz: Complexes, g: Complexes) -> Self:
        """Build the samples from f_z and conj(f_z̄), each (q, p)."""
        a, b = np.abs(fz), np.abs(g)
        return cls(
            log_modulus=readonly(np.log(a)),
            conj_eta=readonly(fz * g),
            k=readonly((b / a).max(axis=0)),
            sigma_a=readonly((a + b).max(axis=0)),
            sigma_b=readonly((a - b).min(axis=0)),
        )

    @property
    def nbytes(self) -> int:
        """Memory that the arrays take, in bytes."""
        arrays = (self.log_modulus, self.conj_eta, self.k, self.sigma_a, self.sigma_b)
        return sum(array.nbytes for array in arrays)

    def ratios(self, weights: Floats) -> Floats:
        """Return the largest scaling (p,) that each point allows, which may be above 1.

        Departs from the paper: in Equations (16) to (18) and in the denominators of Section 7.3 the
        bars were lost; the factor of ρ is |f_z̄|.
        """
        a = np.exp(weights @ self.log_modulus)
        b = np.abs(weights @ self.conj_eta) / a
        negligible = b <= NEGLIGIBLE * a
        divisor = np.where(negligible, 1.0, b)
        lowest = np.minimum(self.k * a, np.minimum(self.sigma_a - a, a - self.sigma_b)) / divisor
        return np.where(negligible, np.inf, lowest)


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Scaling:
    """ρ as a function of the weights: the minimum of the pointwise ratios over the outline.

    Bounds on the outline hold inside as well, globally (Properties 5' to 7'); with `interior`
    samples they hold at those points pointwise (Properties 5 to 7).

    Parameters
    ----------
    maps : tuple of HarmonicMap
    outline : complex128, shape (r,)
        Samples in order along the outline, its vertices among them.
    samples : PointSamples
        At `outline`.
    interior : PointSamples or None
        At the nodes of the paths, or None for the global bounds only.
    """

    maps: tuple[HarmonicMap, ...]
    outline: Complexes
    samples: PointSamples
    interior: PointSamples | None

    @classmethod
    def of(
        cls, keyframes: Sequence[KeyframeSamples], outline: Complexes, *, pointwise: bool
    ) -> Self:
        """Compare keyframes at their outline samples (r,) and, if `pointwise`, at the nodes too."""
        interior = None
        if pointwise:
            fz = np.exp([key.log_fz for key in keyframes])
            interior = PointSamples.of(fz, fz * np.array([key.nu for key in keyframes]))
        samples = PointSamples.of(
            np.array([key.outline_fz for key in keyframes]),
            np.array([key.outline_g for key in keyframes]),
        )
        maps = tuple(key.map for key in keyframes)
        return cls(maps=maps, outline=outline, samples=samples, interior=interior)

    @property
    def nbytes(self) -> int:
        """Memory beyond the keyframes' and the outline's own, in bytes."""
        interior = 0 if self.interior is None else self.interior.nbytes
        return self.samples.nbytes + interior

    def __call__(self, weights: Floats) -> float:
        """Return ρ in [0, 1], exactly 1 where one keyframe has all the weight.

        It is above 0 for weights that are convex. Others can blend f_z beyond the bounds; no
        scaling brings it back, and 0 is returned.
        """
        if np.count_nonzero(weights) == 1:
            return 1.0
        rho = self._lowest_on_outline(weights)
        if self.interior is not None:
            rho = min(rho, float(self.interior.ratios(weights).min()))
        return min(max(rho, 0.0), 1.0)

    def _lowest_on_outline(self, weights: Floats) -> float:
        """Return the minimum of the ratios, refined where the samples are lowest.

        The ratios have kinks where the worse keyframe changes, so that the stretch around each
        lowest sample is only cut finer: no parabola is fitted.
        """
        ratios = self.samples.ratios(weights)
        lowest = float(ratios.min())
        if lowest > NO_SCALING:
            return lowest
        valley = (ratios <= np.roll(ratios, 1)) & (ratios <= np.roll(ratios, -1))
        valleys = np.flatnonzero(valley)
        centres = valleys[np.argsort(ratios[valleys], kind="stable")[:CANDIDATES]]
        corners = self.outline[centres]
        before, after = np.roll(self.outline, 1)[centres], np.roll(self.outline, -1)[centres]
        along = np.linspace(-1.0, 1.0, PIECES + 1)
        rows = np.arange(len(centres))
        middle = np.zeros(len(centres))
        for level in range(REFINEMENTS):
            place = np.clip(middle[:, None] + along * (2.0 / PIECES) ** level, -1.0, 1.0)
            ends = np.where(place < 0, before[:, None], after[:, None])
            points = corners[:, None] + np.abs(place) * (ends - corners[:, None])
            found = _samples_at(self.maps, points.ravel()).ratios(weights).reshape(place.shape)
            best = found.argmin(axis=1)
            middle = place[rows, best]
            lowest = min(lowest, float(found.min()))
        return lowest


def _samples_at(maps: Sequence[HarmonicMap], points: Complexes) -> PointSamples:
    coefficients = np.column_stack([c for f in maps for c in (f.phi, f.psi)])
    (slopes,) = evaluate(maps[0].cage, coefficients, points, orders=(1,))
    return PointSamples.of(slopes[:, 0::2].T, slopes[:, 1::2].T)
