"""The paper's own method on meshes: scaled η in each triangle, and a Poisson step (Section 9.1)."""

from dataclasses import dataclass, replace
from typing import Self

import numpy as np

from app.motion.rival_methods.mesh_keyframes import MeshFrame, MeshKeyframe
from app.motion.rival_methods.poisson import PoissonStep
from engine.arrays import Complexes, freeze
from engine.interpolation import KeyframeExtremes, PointSamples, blend_in_outline_bounds
from engine.maps import distortion


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class MeshEtaInbetweens:
    """log f_z and η are blended linearly in each triangle, and η is scaled by one ρ (Figure 11).

    f_z and f_z̄ then keep the keyframes' bounds in every triangle, but belong to no map; the
    nearest map is taken. For discrete harmonic keyframes the added distortion goes to 0 with the
    size of the triangles (Section 9.1); for others it need not.

    ρ is the least of the triangles' limits, Equations (16) to (18). It is blended from the worst
    bounds beside a keyframe as in `engine.interpolation.scaling.exact_rho.ExactRho`.
    """

    first: MeshKeyframe
    second: MeshKeyframe
    step: PoissonStep
    eta: Complexes  # of both keyframes, (2, m)
    samples: PointSamples  # the values of each triangle that determine ρ
    extremes: KeyframeExtremes  # of all triangles

    @classmethod
    def of(cls, first: MeshKeyframe, second: MeshKeyframe, step: PoissonStep) -> Self:
        """Compute η and the bounds of both keyframes."""
        fz, fzbar = np.array([first.fz, second.fz]), np.array([first.fzbar, second.fzbar])
        none = np.empty((0, fz.shape[1]), dtype=np.complex128)
        samples = PointSamples.of(fz, fzbar.conj(), none, none)
        worst = KeyframeExtremes(
            k=float(samples.k.max()),
            sigma_a=float(samples.sigma_a.max()),
            sigma_b=float(samples.sigma_b.min()),
        )
        eta = freeze(distortion.eta(fz, fzbar))
        return cls(first=first, second=second, step=step, eta=eta, samples=samples, extremes=worst)

    def rho(self, time: float) -> float:
        """Return the scaling of η at a time, 1 at keyframes."""
        if not 0.0 < time < 1.0:
            return 1.0
        weights = np.array([1.0 - time, time])[:, None, None]
        share = float(blend_in_outline_bounds(np.array([time]))[0])
        tight, loose = (
            min(1.0, float(self.samples.with_bounds(worst).largest_rhos(weights).min()))
            for worst in (None, self.extremes)
        )
        return float(tight ** (1.0 - share) * loose**share)

    def frame(self, time: float) -> MeshFrame:
        first, second, rest = self.first, self.second, 1.0 - time
        modulus = np.abs(first.fz) ** rest * np.abs(second.fz) ** time
        fz = modulus * np.exp(1j * (rest * first.angles + time * second.angles))
        rho = self.rho(time)
        fzbar = rho * (rest * self.eta[0] + time * self.eta[1]) / fz.conj()
        anchor = rest * first.anchor_position + time * second.anchor_position
        return replace(self.step.integrate(fz, fzbar, anchor), rho=rho)
