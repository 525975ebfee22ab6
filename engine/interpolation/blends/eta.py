"""The η variants (Sections 5.1, 5.4 and 5.5)."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any, Self

import numpy as np

from engine.arrays import Complexes, Floats, Indices, freeze
from engine.interpolation.added.closing import Closing
from engine.interpolation.blends.blend import Blend, PairCurves
from engine.interpolation.enclosures.cells import BernsteinPatch, BlendChanges, enclose_exponential
from engine.interpolation.enclosures.pieces import EndpointValues
from engine.interpolation.keyframe_blend.derivatives import Derivatives, weighted_sum
from engine.interpolation.keyframe_blend.segment import KeyframeSegment
from engine.interpolation.sampled_domain import SampledDomain
from engine.interpolation.scaling.exact_rho import ExactRho
from engine.interpolation.series.residual import combine_arrays
from engine.maps import Enclosures


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class EtaBlend(Blend):
    """log f_z and η linear in the weights: Properties 1, 2 and 8.

    Another branch of the logarithms only rotates the in-betweens. `conj_eta` and `conj_eta_z` are
    conj(η) = Φ' Ψ' of each keyframe, which is holomorphic, and its derivative, (s,) each.
    """

    conj_eta: tuple[Complexes, ...]
    conj_eta_z: tuple[Complexes, ...]

    @classmethod
    def of(cls, interval: KeyframeSegment) -> Self:
        values, derivatives = [], []
        for key in interval.keyframe_blend.keyframes:
            squared = np.exp(2 * key.log_fz)
            values.append(freeze(key.nu * squared))
            derivatives.append(freeze((key.nu_z + 2 * key.nu * key.log_fz_z) * squared))
        return cls(
            keyframe_blend=interval.keyframe_blend,
            bounds=interval.bounds,
            conj_eta=tuple(values),
            conj_eta_z=tuple(derivatives),
        )

    def values(self, times: Floats) -> tuple[Complexes, Complexes]:
        """Return f_z and conj(f_z̄) at times (t,), each (t, s)."""
        fz = np.exp(self.keyframe_blend.log_fz_at(times))
        g = combine_arrays(
            self.keyframe_blend.eta_time_weights.at(times).T, np.array(self.conj_eta)
        )
        g /= fz
        return fz, g

    def derivatives(self, time: float) -> Derivatives:
        """Blend f_z logarithmically and η linearly.

        Departs from the paper: Equation (7) lost a bar; it reads f_z̄ = η / conj(f_z), that is
        Ψ' = conj(η) / Φ'. The unscaled Ψ' is returned; ρ is a factor of it.
        """
        weights = self.keyframe_blend.eta_time_weights(time)
        logarithm, logarithm_z = self.keyframe_blend.log_fz(time)
        fz = np.exp(logarithm)
        inverse = 1.0 / fz
        g = weighted_sum(self.conj_eta, weights)  # Equation (6), conjugate
        gz = weighted_sum(self.conj_eta_z, weights)
        gz -= g * logarithm_z
        gz *= inverse
        g *= inverse  # Equation (7): conj(f_z̄)
        return Derivatives(fz=fz, fzz=logarithm_z * fz, g=g, gz=gz)

    def at(self, which: Indices) -> Self:
        """Return a copy restricted to some of the nodes."""
        return replace(
            self,
            keyframe_blend=self.keyframe_blend.at(which),
            conj_eta=tuple(freeze(values[which]) for values in self.conj_eta),
            conj_eta_z=tuple(freeze(values[which]) for values in self.conj_eta_z),
        )

    @staticmethod
    def blended_pair(fz: Complexes, g: Complexes) -> tuple[Complexes, Complexes]:
        """Return ln |f_z| and conj(η)."""
        return np.log(np.abs(fz)) + 0j, fz * g

    @staticmethod
    def singular_values(first: Complexes, second: Complexes) -> tuple[Floats, Floats]:
        """Return |f_z| ± |η| / |f_z|."""
        a = np.exp(first.real)
        b = np.abs(second) / a
        return a + b, a - b

    def curves(self, values: EndpointValues) -> PairCurves:
        """Return ln |f_z| and conj(η) along pieces of the boundary."""
        return values.log_modulus(), values.conj_eta()

    @staticmethod
    def enclose(
        first: BernsteinPatch[Any], second: BernsteinPatch[Any], changes: BlendChanges | None, /
    ) -> Enclosures:
        """Enclose the distortion on cells; h keeps η, ρ scales conj(f_z̄) and d scales f_z."""
        if changes is None:
            return enclose_exponential(first, first.times(-1.0), first.times(-2.0), second)
        log_a = first.plus(changes.correction)
        log_g = log_a.times(-1.0).plus(changes.rho)
        log_ratio = log_a.times(-2.0).plus(changes.rho).plus(changes.factor.times(-1.0))
        return enclose_exponential(log_a.plus(changes.factor), log_g, log_ratio, second)


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class ScaledEtaBlend(EtaBlend):
    """The η variant scaled by ρ: it has Properties 3 to 7, too."""

    is_scaled = True

    def exact_rho(
        self, sites: SampledDomain, closing: Closing | None, conformal: Closing | None
    ) -> Callable[[Floats], Floats]:
        """Return the largest ρ that the outline allows."""
        return ExactRho.of(
            [key.map for key in self.keyframe_blend.keyframes],
            sites.outline,
            self.keyframe_blend.time_weights,
            self.bounds,
            tuple(each for each in (closing, conformal) if each is not None),
        )
