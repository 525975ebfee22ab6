"""The correction of one frame: targets for handles, within the distortion limits."""

from dataclasses import dataclass

import numpy as np

from engine.arrays import Floats
from engine.deform.correction.barrier import extremes
from engine.deform.correction.corrector import PointCorrector
from engine.deform.correction.limits import (
    BEYOND,
    frame_limits,
    log_limits,
    shorten_solution,
    solve_within,
)
from engine.deform.correction.point_targets import PointTargets
from engine.deform.correction.solver import PointSolution
from engine.interpolation.added.pins.pinning import CorrectionSeries
from engine.interpolation.added.pins.segment_solver import CorrectionBase
from engine.interpolation.inbetweens import Inbetweens
from engine.interpolation.proof.bisection import prove
from engine.maps import Bounds

# The limits at the samples are tightened by so many times the proven excess, so often. If the
# excess remains, the correction is multiplied by SHORTER, at most MOST_SHORTER times.
TIGHTER, MOST_TIGHTER = 1.5, 2
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
    inbetweens: Inbetweens | None,
    corrector: PointCorrector,
    base: CorrectionBase,
    time: float,
    targets: PointTargets,
    bounds: Bounds,
) -> FrameCorrection:
    """Correct an in-between within bounds, or within its own distortion beyond them.

    Near a limit, a proof shows that the correction keeps the limit between the samples, too.
    Without a proof the correction is solved again within limits that are tighter by about the
    proven excess, so that nothing jumps between frames, and at last shortened.
    `inbetweens` are as in `evaluate_base`, and `base` is theirs at the time. Without in-betweens,
    as for a frame with sliders, the limits hold at the samples, without a proof between them.
    """
    nodes, samples = base.nodes, base.samples
    own = extremes(corrector, samples)
    inner, least = frame_limits(bounds, own + BEYOND), own + BEYOND / 2
    found = solve_within(corrector, nodes, samples, targets, inner)
    if found.is_limited and inbetweens is not None:
        if (own > frame_limits(bounds)).any():
            own = _proven(inbetweens, time) + BEYOND
        limits = frame_limits(bounds, own, inside=-BEYOND)

        def excess_of(solution: PointSolution) -> Floats:
            known = CorrectionSeries.of_frame(corrector, solution.x, solution.shift)
            proven = _proven(inbetweens.with_correction(known), time)
            return np.maximum(proven - limits, 0.0)

        excess = excess_of(found)
        for tries in range(MOST_TIGHTER + MOST_SHORTER):
            if not excess.any():
                break
            if tries < MOST_TIGHTER:
                inner = np.maximum(inner - TIGHTER * excess, least)
                found = solve_within(corrector, nodes, samples, targets, inner)
            else:
                found = shorten_solution(corrector, nodes, targets, found, SHORTER)
            excess = excess_of(found)
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
