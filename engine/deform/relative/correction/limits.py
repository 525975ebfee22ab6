"""Which share of a correction keeps the limits of the distortion at samples of the boundary."""

from math import inf

import numpy as np

from engine.arrays import Floats
from engine.deform.relative.correction.corrector import PointCorrector
from engine.deform.relative.correction.frame import BaseFrame
from engine.maps import Bounds

INSIDE = 0.002  # of the limits: how far inside a correction ends, as between samples it is more
HALVINGS = 20
TINY = 1e-300


def limits_of(bounds: Bounds, *known: Floats) -> Floats:
    """Return the largest ln σ_a, −ln σ_b and k that bounds allow, or frames that are given have.

    Parameters
    ----------
    bounds : Bounds
    *known : float64, shape (3,)
        Extremes of frames.
    """
    stretch, squeeze = np.log([bounds.sigma_a, max(bounds.sigma_b, TINY)])
    inside = np.array([stretch - INSIDE, -squeeze - INSIDE, bounds.k * (1 - INSIDE)])
    return np.asarray(np.max([inside, *known], axis=0))


def largest_share(corrector: PointCorrector, base: BaseFrame, x: Floats, limits: Floats) -> float:
    """Return the largest s of [0, 1], about, with which s h and s q keep limits at the samples.

    A base that exceeds a limit itself may exceed it a little more.

    Parameters
    ----------
    corrector : PointCorrector
    base : BaseFrame
        At the samples of the boundary.
    x : float64, shape (2N,)
    limits : float64, shape (3,)
        Of ln σ_a, −ln σ_b and k.
    """
    known = np.maximum(limits, extremes(corrector, base, 0.0 * x) + INSIDE)

    def is_kept(share: float) -> bool:
        return bool((extremes(corrector, base, share * x) <= known).all())

    if is_kept(1.0):
        return 1.0
    low, high = 0.0, 1.0
    for _ in range(HALVINGS):
        middle = (low + high) / 2
        low, high = (middle, high) if is_kept(middle) else (low, middle)
    return low


def extremes(corrector: PointCorrector, base: BaseFrame, x: Floats) -> Floats:
    """Return the largest ln σ_a, −ln σ_b and k of a corrected frame, infinite where it folds."""
    values = corrector.variables.at_samples
    conformal, own, factor = base.corrected(values, x)
    a, b = np.abs(conformal), np.abs(own + factor * values.q_of(x))
    if not (b < a).all():
        return np.full(3, inf)
    return np.array([np.log(a + b).max(), -np.log(a - b).min(), (b / a).max()])
