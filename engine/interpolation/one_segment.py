"""In-betweens of two neighbouring keyframes, for all variants."""

from functools import partial

import numpy as np

from engine.arrays import Complexes
from engine.deform.correction.corrector import PointCorrector
from engine.deform.correction.frame import BaseFrame
from engine.errors import EngineError
from engine.interpolation.added.pins.pinning import (
    CorrectionSeries,
    fit_pin_corrections,
    solve_pin_correction,
)
from engine.interpolation.added.pins.segment_solver import CorrectionBase
from engine.interpolation.added.pins.targets import SegmentPins
from engine.interpolation.blends.blend import Blend
from engine.interpolation.blends.table import BLENDS
from engine.interpolation.inbetweens import Correctable, Frame, Inbetweens
from engine.interpolation.keyframe_blend.segment import KeyframeSegment
from engine.interpolation.sampled_domain import SampledDomain
from engine.interpolation.scaling.smoothed_rho import SmoothedRho
from engine.maps import Bounds
from engine.variant import Variant


def prepare_inbetweens(variant: Variant, interval: KeyframeSegment) -> Inbetweens:
    """Prepare the in-betweens of a segment.

    Raises
    ------
    EngineError
        If the transform is missing or belongs to another outline.
    """
    return _closed(BLENDS[variant].of(interval), interval.sampled_domain)


def frame_at(
    time: float, variant: Variant, interval: KeyframeSegment, pins: CorrectionSeries | None = None
) -> Frame:
    """Return a single in-between, equal to the one by `prepare_inbetweens`.

    For the metric variant without holes this costs less: one Dirichlet problem instead of one for
    each function of the residual. For other variants and around holes the cost is the same.

    Raises
    ------
    EngineError
        As `prepare_inbetweens`, and if the time is not in [0, 1].
    """
    if not 0.0 <= time <= 1.0:
        raise EngineError(
            "A segment runs from time 0 to 1, so time {time} is out of range.", time=time
        )
    if interval.sampled_domain.closer is not None:
        found = prepare_inbetweens(variant, interval)
    else:
        found = _closed(BLENDS[variant].at_single_time(time, interval), interval.sampled_domain)
    return (found if pins is None else found.with_correction(pins)).frame(time)


def value_points_for_corrections(corrector: PointCorrector) -> Complexes:
    """Return the value points of corrections: path nodes to the handles, then boundary samples."""
    return np.concatenate([corrector.paths.nodes, corrector.boundary.points])


def evaluate_base(
    inbetweens: Correctable, corrector: PointCorrector, time: float
) -> CorrectionBase:
    """Return an in-between in the form that its correction needs.

    The in-betweens are at the handles, with values at `value_points_for_corrections`.
    """
    frame, (fz, g, k) = inbetweens.frame_with_values(time)
    nodes = len(corrector.paths.nodes)
    parts = slice(nodes), slice(nodes, None)
    of_nodes, of_samples = (BaseFrame(fz[p], g[p], k[p], inbetweens.sign) for p in parts)
    anchor = inbetweens.anchor_position(time)
    return CorrectionBase(frame.positions, frame.fz, anchor, of_nodes, of_samples)


def solve_pins(
    base: Inbetweens, corrector: PointCorrector, pins: SegmentPins, bounds: Bounds
) -> CorrectionSeries:
    """Find the corrections of a segment.

    `base` is as in `evaluate_base`, without pins. The samples keep `bounds` as far as `base` does.
    """
    return fit_pin_corrections(corrector, partial(evaluate_base, base, corrector), pins, bounds)


def solve_pins_at(
    time: float,
    variant: Variant,
    interval: KeyframeSegment,
    corrector: PointCorrector,
    pins: SegmentPins,
    bounds: Bounds,
) -> CorrectionSeries:
    """Find the correction at a single time, where the segment has no holes.

    `interval` is sampled at the handles, with values at `value_points_for_corrections`. For the
    metric variant this costs a fraction of `solve_pins`. Elsewhere the correction is not valid.
    """

    def base_at(at: float) -> CorrectionBase:
        # All variants are the same at the keyframes.
        is_end = at in (0.0, 1.0)
        blend = BLENDS[Variant.ETA if is_end else variant].at_single_time(at, interval)
        return evaluate_base(_closed(blend, interval.sampled_domain), corrector, at)

    return solve_pin_correction(corrector, base_at, pins, bounds, time)


def _closed(blend: Blend, sites: SampledDomain) -> Inbetweens:
    """Close the periods around holes, and scale Ψ if the variant does so."""
    closing = conformal = scale = None
    closed, closer = blend, sites.closer
    if closer is not None and blend.sign:
        values = blend.at(sites.paths.around).values
        closing = closer.close(values, blend.sign, blend.moduli(sites.boundary))
        closed = blend.with_residual(closing.residual)
        if blend.is_scaled:
            conformal = closer.to_conformal(values, blend.sign)
    if blend.is_scaled:
        scale = SmoothedRho.of(blend.exact_rho(sites, closing, conformal))
    return Inbetweens(
        sampled_domain=sites,
        blend=closed,
        scale=scale,
        closing=closing,
        conformal_closing=conformal,
    )
