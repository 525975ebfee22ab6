"""Corrections that keep the limits of the distortion at the samples of the boundary."""

from dataclasses import replace

import numpy as np

from engine.arrays import Floats
from engine.deform.correction.barrier import LAST, WIDTH, LimitBarrier, corrected_extremes, extremes
from engine.deform.correction.corrector import PointCorrector
from engine.deform.correction.frame import BaseFrame, CorrectedFrame
from engine.deform.correction.point_targets import PointTargets
from engine.deform.correction.solver import PointSolution, solve_correction
from engine.deform.correction.variables import BasisValues
from engine.maps import Bounds

INSIDE = 0.002  # of the limits: a correction ends so far inside, for larger values between samples
BEYOND = 0.0005  # of the base's own distortion beyond a limit: how much the correction may add
HALVINGS = 20
TINY = 1e-300


def log_limits(sigma_a: float, sigma_b: float, k: float) -> Floats:
    """Return ln σ_a, −ln σ_b and k, (3,)."""
    return np.array([np.log(sigma_a), -np.log(max(sigma_b, TINY)), k])


def frame_limits(bounds: Bounds, *known: Floats, inside: float = INSIDE) -> Floats:
    """Return the largest ln σ_a, −ln σ_b and k that the bounds or the known frames have, (3,).

    Parameters
    ----------
    *known : float64, shape (3,)
        Extremes of frames.
    inside : float
        How far inside the bounds.
    """
    limits = log_limits(bounds.sigma_a, bounds.sigma_b, bounds.k)
    within = limits - inside * np.array([1.0, 1.0, bounds.k])
    return np.asarray(np.max([within, *known], axis=0))


def solve_within(
    corrector: PointCorrector,
    nodes: BaseFrame,
    samples: BaseFrame,
    targets: PointTargets,
    limits: Floats,
    *,
    width: float = WIDTH,
    start: PointSolution | None = None,
) -> PointSolution:
    """Find the correction of one frame that keeps limits at the samples, from zero.

    Where the smallest correction comes near a limit, a barrier keeps it inside. The base keeps the
    limits.

    Parameters
    ----------
    nodes, samples : BaseFrame
        The frame at the nodes of the corrector's paths, and at the samples of the boundary.
    limits : float64, shape (3,)
        Of ln σ_a, −ln σ_b and k.
    width : float
        Distance from the limits at which the barrier begins.
    start : PointSolution, optional
        Of a similar frame, for the search without limits.
    """
    found = solve_correction(corrector, nodes, targets, start, throw=False)
    if (extremes(corrector, samples, found.x) <= limits - width).all():
        return found
    # At zero, points that need no correction are at their targets, and stay there.
    nothing = replace(found, x=0.0 * found.x, shift=0j)
    walls = LimitBarrier(corrector, samples, limits, last=LAST * (width / WIDTH) ** 2)
    near = solve_correction(corrector, nodes, targets, nothing, walls, throw=False)
    return replace(near, steps=found.steps + near.steps, is_limited=True)


def shorten_solution(
    corrector: PointCorrector,
    nodes: BaseFrame,
    targets: PointTargets,
    solution: PointSolution,
    share: float,
) -> PointSolution:
    """Return a part of a correction."""
    x, shift = share * solution.x, share * solution.shift
    count = len(targets.offsets)
    before, after = (CorrectedFrame.of(corrector, nodes, each).places() for each in (0 * x, x))
    moved = (after - before)[:count] + shift
    return replace(solution, x=x, shift=shift, target_errors=np.abs(moved - targets.offsets))


def max_feasible_share(values: BasisValues, base: BaseFrame, x: Floats, limits: Floats) -> float:
    """Return the largest s of [0, 1], about, with which s h and s q keep limits at the samples.

    A base that exceeds a limit may exceed it a little more. `values` and `base` are at the samples
    of the boundary; `limits` are of ln σ_a, −ln σ_b and k, (3,).
    """
    own = corrected_extremes(values, base, 0.0 * x)
    known = np.maximum(limits, own + INSIDE)

    def is_kept(share: float) -> bool:
        return bool((corrected_extremes(values, base, share * x) <= known).all())

    if is_kept(1.0):
        return 1.0
    low, high = 0.0, 1.0
    for _ in range(HALVINGS):
        middle = (low + high) / 2
        low, high = (middle, high) if is_kept(middle) else (low, middle)
    return low
