"""The ν variant (Sections 5.1 and 5.2)."""

from dataclasses import dataclass
from typing import Any, Self

import numpy as np

from engine.arrays import Complexes, Floats
from engine.interpolation.blends.blend import Blend, PairCurves
from engine.interpolation.enclosures.cells import BernsteinPatch, BlendChanges, enclose_exponential
from engine.interpolation.enclosures.pieces import EndpointValues
from engine.interpolation.keyframe_blend.derivatives import Derivatives, weighted_sum
from engine.interpolation.keyframe_blend.segment import KeyframeSegment
from engine.interpolation.series.residual import combine_arrays
from engine.maps import Enclosures


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class NuBlend(Blend):
    """log f_z and ν linear in the weights: Properties 1 to 5 and 7.

    A full turn added to one of the sheets changes the shape of the in-betweens, not only their
    rotation.
    """

    sign = 1

    @classmethod
    def of(cls, interval: KeyframeSegment) -> Self:
        """Use the keyframe blend of the segment unchanged."""
        return cls(keyframe_blend=interval.keyframe_blend, bounds=interval.bounds)

    def values(self, times: Floats) -> tuple[Complexes, Complexes]:
        """Return f_z and conj(f_z̄) at times (t,), each (t, s)."""
        nu = np.array([key.nu for key in self.keyframe_blend.keyframes])
        fz = np.exp(self.keyframe_blend.log_fz_at(times))
        g = combine_arrays(self.keyframe_blend.time_weights.at(times).T, nu)
        g *= fz
        return fz, g

    def derivatives(self, time: float) -> Derivatives:
        """Blend f_z logarithmically and ν linearly.

        Departs from the paper: Equation (5) lost its second bar; it reads
        f_z̄ = conj(ν) conj(f_z), that is Ψ' = ν Φ'.
        """
        keyframes, weights = self.keyframe_blend.keyframes, self.keyframe_blend.time_weights(time)
        logarithm, logarithm_z = self.keyframe_blend.log_fz(time)
        fz = np.exp(logarithm)
        nu = weighted_sum([key.nu for key in keyframes], weights)  # Equation (4)
        nu_z = weighted_sum([key.nu_z for key in keyframes], weights)
        nu_z += nu * logarithm_z
        nu_z *= fz
        logarithm_z *= fz
        nu *= fz  # Equation (5): conj(f_z̄)
        return Derivatives(fz=fz, fzz=logarithm_z, g=nu, gz=nu_z)

    @staticmethod
    def blended_pair(fz: Complexes, g: Complexes) -> tuple[Complexes, Complexes]:
        """Return ln |f_z| and ν."""
        return np.log(np.abs(fz)) + 0j, g / fz

    @staticmethod
    def singular_values(first: Complexes, second: Complexes) -> tuple[Floats, Floats]:
        """Return |f_z| (1 ± |ν|)."""
        a, k = np.exp(first.real), np.abs(second)
        return a * (1.0 + k), a * (1.0 - k)

    def curves(self, values: EndpointValues) -> PairCurves:
        """Return ln |f_z| and ν along pieces of the boundary."""
        return values.log_modulus(), values.nu()

    @staticmethod
    def enclose(
        first: BernsteinPatch[Any], second: BernsteinPatch[Any], changes: BlendChanges | None, /
    ) -> Enclosures:
        """Enclose the distortion on cells; h changes f_z and conj(f_z̄) alike."""
        log_fz = first if changes is None else first.plus(changes.correction)
        return enclose_exponential(
            log_fz, log_fz, BernsteinPatch(0.0 * first.controls, 0.0 * first.error), second
        )
