"""Linear blend of the maps themselves: for comparison, without any guarantee."""

from dataclasses import dataclass, replace
from typing import Any, Self

import numpy as np

from engine.arrays import Complexes, Floats, Indices, freeze
from engine.interpolation.blends.blend import Blend, PairCurves
from engine.interpolation.enclosures.cells import BernsteinPatch, BlendChanges, enclose_linear
from engine.interpolation.enclosures.pieces import EndpointValues
from engine.interpolation.keyframe_blend.derivatives import Derivatives, weighted_sum
from engine.interpolation.keyframe_blend.segment import KeyframeSegment
from engine.interpolation.series.residual import combine_arrays
from engine.maps import Enclosures


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class LinearBlend(Blend):
    """f_z and conj(f_z̄) linear in the weights; `known` are the keyframes' derivatives."""

    sign = 0  # sums of closed maps are closed

    known: tuple[Derivatives, ...]

    @classmethod
    def of(cls, interval: KeyframeSegment) -> Self:
        known = []
        for key in interval.keyframe_blend.keyframes:
            fz = np.exp(key.log_fz)
            gz = (key.nu_z + key.nu * key.log_fz_z) * fz
            parts = fz, key.log_fz_z * fz, key.nu * fz, gz
            known.append(Derivatives(*map(freeze, parts)))
        return cls(
            keyframe_blend=interval.keyframe_blend, bounds=interval.bounds, known=tuple(known)
        )

    def values(self, times: Floats) -> tuple[Complexes, Complexes]:
        """Return f_z and conj(f_z̄) at times (t,), each (t, s)."""
        weights = self.keyframe_blend.time_weights.at(times).T
        fz, g = (np.array([getattr(each, of) for each in self.known]) for of in ("fz", "g"))
        return combine_arrays(weights, fz), combine_arrays(weights, g)

    def derivatives(self, time: float) -> Derivatives:
        weights = self.keyframe_blend.time_weights(time)
        return Derivatives(
            *(weighted_sum(parts, weights) for parts in zip(*self.known, strict=True))
        )

    def at(self, which: Indices) -> Self:
        """Return a copy restricted to some of the nodes."""
        known = tuple(Derivatives(*(freeze(part[which]) for part in each)) for each in self.known)
        return replace(self, keyframe_blend=self.keyframe_blend.at(which), known=known)

    @staticmethod
    def blended_pair(fz: Complexes, g: Complexes) -> tuple[Complexes, Complexes]:
        return fz, g

    @staticmethod
    def singular_values(first: Complexes, second: Complexes) -> tuple[Floats, Floats]:
        """Return |f_z| ± |f_z̄|."""
        a, b = np.abs(first), np.abs(second)
        return a + b, a - b

    def curves(self, values: EndpointValues) -> PairCurves:
        """Return f_z and conj(f_z̄) along pieces of the boundary."""
        return values.conformal(), values.anticonformal()

    @staticmethod
    def enclose(
        first: BernsteinPatch[Any], second: BernsteinPatch[Any], _changes: BlendChanges | None, /
    ) -> Enclosures:
        return enclose_linear(first, second)
