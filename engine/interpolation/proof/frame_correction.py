"""The correction of one frame: targets for handles, within the distortion limits."""

from dataclasses import dataclass

import numpy as np

from engine.arrays import Floats
from engine.deform.correction.barrier import extremes
from engine.deform.correction.corrector import PointCorrector
from engine.deform.correction.limits import (
    BEYOND,
    INSIDE,
    frame_limits,
    log_limits,
    shorten_solution,
    solve_within,
)
from engine.deform.correction.solver import PointSolution, PointTargets
from engine.interpolation.added.pins.pinning import CorrectionBase, CorrectionSeries
from engine.interpolation.inbetweens import Inbetweens
from engine.interpolation.proof.bisection import prove
from engine.maps import Bounds

# Distances from the limits at the samples, tried in turn until the frame is proven. If all fail the
# correction is multiplied by SHORTER, at most MOST_SHORTER times.
INSIDES = (INSIDE, 4 * INSIDE, 16 * INSIDE)
SHORTER, MOST_SHORTER = 0.95, 12


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class FrameCorrection:
    """A correction of one frame.

    Attributes
    ----------
    known : CorrectionSeries
        Constant in time.
    target_errors : float64, shape (m,)
    is_limited : bool
        Whether the correction came near a limit, so that the limits are proven here.
    reached : (float, float, float)
        The largest k and σ_a, and the smallest σ_b, at the samples of the boundary.
    """

    known: CorrectionSeries
    target_errors: Floats
    steps: int
    is_limited: bool
    reached: tuple[float, float, float]


def correct_frame(
    inbetweens: Inbetweens,
    corrector: PointCorrector,
    base: CorrectionBase,
    time: float,
    targets: PointTargets,
    bounds: Bounds,
) -> FrameCorrection:
    """Correct an in-between within bounds, or within its own distortion beyond them.

    Near a limit, a proof shows that the correction keeps the limit between the samples, too.
    Without a proof the correction is solved again farther inside the limits, and at last shortened.
    `inbetweens` are as in `evaluate_base`, and `base` is theirs at the time.
    """
    nodes, samples = base.nodes, base.samples
    found = solve_within(corrector, nodes, samples, targets, bounds)
    if found.is_limited:
        own = extremes(corrector, samples)
        if (own > frame_limits(bounds)).any():
            own = _proven(inbetweens, time) + BEYOND
        limits = frame_limits(bounds, own, inside=-BEYOND)

        def is_kept(solution: PointSolution) -> bool:
            known = CorrectionSeries.of_frame(corrector, solution.x, solution.shift)
            return bool((_proven(inbetweens.with_correction(known), time) <= limits).all())

        kept = is_kept(found)
        for inside in INSIDES[1:]:
            if kept:
                break
            found = solve_within(corrector, nodes, samples, targets, bounds, inside)
            kept = is_kept(found)
        for _ in range(MOST_SHORTER):
            if kept:
                break
            found = shorten_solution(corrector, nodes, targets, found, SHORTER)
            kept = is_kept(found)
    reached = extremes(corrector, samples, found.x)
    return FrameCorrection(
        known=CorrectionSeries.of_frame(corrector, found.x, found.shift),
        target_errors=found.target_errors,
        steps=found.steps,
        is_limited=found.is_limited,
        reached=(float(reached[2]), float(np.exp(reached[0])), float(np.exp(-reached[1]))),
    )


def _proven(inbetweens: Inbetweens, time: float) -> Floats:
    """Return proven bounds of ln σ_a, −ln σ_b and k of a frame, (3,)."""
    proof = prove(inbetweens, time)
    return log_limits(proof.sigma_a, proof.sigma_b, proof.k)
