"""The rigid motion that brings points nearest to their targets."""

import numpy as np

from engine.arrays import Complexes, Floats, as_points, as_reals
from engine.errors import EngineError
from engine.geometry.similarity import IDENTITY_MOTION, Similarity

NEGATIVE_WEIGHTS = "weights must be finite and not negative, not {weights}."
TOWARDS_REST = 1e-6  # pull of all points together towards the identity


def fit_rigid(
    places: Complexes, offsets: Complexes, weights: Floats, pivot: complex | None = None
) -> Similarity:
    """Return argmin over R of Σ w |R p − p − o|² + (ε / h) Σ |R p − p|².

    In closed form and smooth in its arguments; the identity where all offsets are 0.

    Parameters
    ----------
    places, offsets : complex128, shape (h,)
        p, and o from there to the target.
    weights : float64, shape (h,)
        Not negative.
    pivot : complex, optional
        A fixed point.
    """
    places, offsets = as_points(places, "places"), as_points(offsets, "offsets")
    weights = as_reals(weights, "weights")
    if not (np.isfinite(weights) & (weights >= 0)).all():
        raise EngineError(NEGATIVE_WEIGHTS, weights=weights)
    if not len(places) or not weights.any():
        return IDENTITY_MOTION
    total = weights + TOWARDS_REST / len(places)
    wanted = places + offsets * weights / total
    if pivot is None:
        mean, wanted_mean = total @ places / total.sum(), total @ wanted / total.sum()
    else:
        mean = wanted_mean = pivot
    turn = complex(np.sum(total * np.conj(places - mean) * (wanted - wanted_mean)))
    factor = turn / abs(turn) if turn else 1.0 + 0j
    return Similarity(factor, complex(wanted_mean - factor * mean))
