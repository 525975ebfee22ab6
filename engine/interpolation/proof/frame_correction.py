"""The correction of one frame: targets for handles, within the limits of the distortion."""

from dataclasses import dataclass

import numpy as np

from engine.arrays import Floats
from engine.deform.correction import (
    BEYOND,
    PointCorrector,
    Targets,
    extremes,
    limits_of,
    logarithms,
    shorten_solution,
    solve_within,
)
from engine.interpolation.added.pins import BaseAt, CorrectionSeries
from engine.interpolation.inbetweens import Inbetweens
from engine.interpolation.proof.bisection import prove
from engine.maps import Bounds

# A share of a correction is shorten_solution by this much until it is proven within the limits.
SHORTER, MOST_SHORTER = 0.95, 12


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class FrameCorrection:
    """A correction of one frame.

    Parameters
    ----------
    known : CorrectionSeries
        The same at all times.
    misses : float64, shape (m,)
        Target errors of the points.
    steps : int
    is_held_back : bool
        Whether limits stop it.
    reached : (float, float, float)
        The largest k and σ_a, and the smallest σ_b, at the samples of the boundary.
    """

    known: CorrectionSeries
    misses: Floats
    steps: int
    is_held_back: bool
    reached: tuple[float, float, float]


def correct_frame(
    inbetweens: Inbetweens,
    corrector: PointCorrector,
    base: BaseAt,
    time: float,
    targets: Targets,
    bounds: Bounds,
) -> FrameCorrection:
    """Correct an in-between within bounds, or within its own distortion beyond them.

    A correction that comes near a limit is proven to keep it between the samples, too: the largest
    share of it that is.

    Parameters
    ----------
    inbetweens : Inbetweens
        As `base_at` wants them.
    corrector : PointCorrector
        For the handles.
    base : BaseAt
        Of these in-betweens at the time.
    time : float
    targets : Targets
        For the handles.
    bounds : Bounds
    """
    found = solve_within(corrector, base.nodes, base.samples, targets, bounds)
    own = extremes(corrector, base.samples, 0.0 * found.x)
    reached = extremes(corrector, base.samples, found.x)
    if (reached > limits_of(bounds, inside=.03)).any():
        limits = limits_of(bounds, own, inside=-BEYOND)
        for _ in range(MOST_SHORTER):
            known = CorrectionSeries.of_frame(corrector, found.x, found.shift)
            proof = prove(inbetweens.corrected(known), time)
            if (logarithms(proof.sigma_a, proof.sigma_b, proof.k) <= limits).all():
                break
            found = shorten_solution(corrector, base.nodes, targets, found, SHORTER)
        reached = extremes(corrector, base.samples, found.x)
    return FrameCorrection(
        known=CorrectionSeries.of_frame(corrector, found.x, found.shift),
        misses=found.misses,
        steps=found.steps,
        is_held_back=found.is_held_back,
        reached=(float(reached[2]), float(np.exp(reached[0])), float(np.exp(-reached[1]))),
    )
