"""The derivatives of Φ and Ψ at the path nodes, which every variant blends."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple, Self

import numpy as np

from engine.arrays import Complexes, Floats, Indices, Integers
from engine.errors import EngineError
from engine.interpolation.keyframe_blend.keyframe_samples import KeyframeSamples
from engine.interpolation.series.residual import Residual, combine_arrays
from engine.interpolation.time_weights.weights import TimeWeights

KEYFRAMES_OF_SEGMENT = (
    "These time weights need {wanted} keyframes for a segment, but there are {count} keyframes "
    "with {sheets} sheets."
)


class Derivatives(NamedTuple):
    """Φ', Φ'', Ψ' and Ψ'' of an in-between, each complex128 (s,).

    Section 4.1: f_z = Φ' and f_z̄ = conj(Ψ').
    """

    fz: Complexes
    fzz: Complexes
    g: Complexes
    gz: Complexes


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class KeyframeBlend:
    """Keyframes and time weights of one segment.

    Build it with `KeyframeBlend.of`.

    Attributes
    ----------
    keyframes : tuple of KeyframeSamples, length q
        The two keyframes of the segment, and their neighbours as far as the time weights use them.
    sheets : int32, shape (q,)
        Branch of each logarithm, from `root_sheets`.
    time_weights : TimeWeights
        Weights of log f_z and of the anchor.
    eta_time_weights : TimeWeights
        Weights of η; they differ in the metric variant.
    residuals : tuple of Residual
        Terms added to the blend of log f_z.
    """

    keyframes: tuple[KeyframeSamples, ...]
    sheets: Integers
    time_weights: TimeWeights
    eta_time_weights: TimeWeights
    residuals: tuple[Residual, ...] = ()

    @classmethod
    def of(
        cls,
        keyframes: Sequence[KeyframeSamples],
        sheets: Integers,
        time_weights: TimeWeights | None = None,
    ) -> Self:
        """Combine keyframes and time weights; by default two keyframes are blended linearly.

        Raises
        ------
        EngineError
            If the numbers of keyframes, sheets and weights differ.
        """
        time_weights = TimeWeights.straight() if time_weights is None else time_weights
        if not len(keyframes) == len(sheets) == time_weights.count:
            raise EngineError(
                KEYFRAMES_OF_SEGMENT,
                wanted=time_weights.count,
                count=len(keyframes),
                sheets=len(sheets),
            )
        return cls(
            keyframes=tuple(keyframes),
            sheets=sheets,
            time_weights=time_weights,
            eta_time_weights=time_weights,
        )

    @property
    def ends(self) -> tuple[KeyframeSamples, KeyframeSamples]:
        """The keyframes at times 0 and 1."""
        first = self.time_weights.first
        return self.keyframes[first], self.keyframes[first + 1]

    def anchor_positions(self, times: Floats) -> Complexes:
        """Return the blended position of the anchor at times (t,)."""
        known = np.array([key.anchor_position for key in self.keyframes])
        positions: Complexes = self.time_weights.at(times).T @ known
        return positions

    def at(self, which: Indices) -> Self:
        """Return a copy restricted to some of the nodes (c,)."""
        return replace(
            self,
            keyframes=tuple(key.at(which) for key in self.keyframes),
            residuals=tuple(residual.at(which) for residual in self.residuals),
        )

    def with_residual(self, residual: Residual) -> Self:
        """Return a copy with one more term added to log f_z."""
        return replace(self, residuals=(*self.residuals, residual))

    def log_fz(self, time: float) -> tuple[Complexes, Complexes]:
        """Return Σ w_i log f_z with residuals, and its derivative, each (s,)."""
        logarithm, logarithm_z = self.log_fz_without_residuals(time)
        for residual in self.residuals:
            residual.add_to(logarithm, logarithm_z, time)
        return logarithm, logarithm_z

    def log_fz_without_residuals(self, time: float) -> tuple[Complexes, Complexes]:
        """Return Σ w_i log f_z without residuals, and its derivative, each (s,)."""
        weights = self.time_weights(time)
        # Equation (3), as a logarithm.
        logarithm = weighted_sum([key.log_fz for key in self.keyframes], weights)
        logarithm.imag += 2 * np.pi * float(weights @ self.sheets)
        return logarithm, weighted_sum([key.log_fz_z for key in self.keyframes], weights)

    def log_fz_at(self, times: Floats) -> Complexes:
        """Return log f_z with residuals at times (t,), (t, s)."""
        logarithms = self.log_fz_without_residuals_at(times)
        for residual in self.residuals:
            logarithms += residual.at_times(times)
        return logarithms

    def log_fz_without_residuals_at(self, times: Floats) -> Complexes:
        """Return log f_z without residuals at times (t,), (t, s)."""
        weights = self.time_weights.at(times).T
        logarithms = combine_arrays(weights, np.array([key.log_fz for key in self.keyframes]))
        logarithms.imag += 2 * np.pi * (weights @ self.sheets)[:, None]
        return logarithms


def weighted_sum(arrays: Sequence[Complexes], weights: Floats) -> Complexes:
    """Return Σ w_i a_i; arrays of weight 0 are not read."""
    terms = [(a, w) for a, w in zip(arrays, weights, strict=True) if w != 0.0]
    total: Complexes = terms[0][0] * terms[0][1]
    for array, weight in terms[1:]:
        total += array * weight
    return total
