"""What every variant blends: the derivatives of Φ and Ψ at the nodes of the paths."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from engine.arrays import Complexes, Floats, Integers
from engine.interpolation.keyframe_samples import KeyframeSamples


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Derivatives:
    """Φ', Φ'', Ψ' and Ψ'' of an in-between, each complex128 (s,).

    Section 4.1: f_z = Φ' and f_z̄ = conj(Ψ').
    """

    fz: Complexes
    fzz: Complexes
    g: Complexes
    gz: Complexes


def weighted(arrays: Sequence[Complexes], weights: Floats) -> Complexes:
    """Return Σ w_i a_i; an array whose weight is 0 is not touched."""
    terms = [(a, w) for a, w in zip(arrays, weights, strict=True) if w != 0.0]
    total: Complexes = terms[0][0] * terms[0][1]
    for array, weight in terms[1:]:
        total += array * weight
    return total


def blended_log_fz(
    keyframes: Sequence[KeyframeSamples], sheets: Integers, weights: Floats
) -> tuple[Complexes, Complexes]:
    """Return Σ w_i log f_z of the keyframes and its derivative, each (s,); Equation (3)."""
    logarithm = weighted([key.log_fz for key in keyframes], weights)
    logarithm.imag += 2 * np.pi * float(weights @ sheets)
    return logarithm, weighted([key.log_fz_z for key in keyframes], weights)
