"""The in-betweens of two neighbouring keyframes, whatever their variant."""

from functools import partial

import numpy as np

from engine.arrays import Complexes, Floats
from engine.deform.correction import BaseFrame, PointCorrector
from engine.errors import EngineError
from engine.interpolation.added.periods import Unclosed, close, to_conformal
from engine.interpolation.added.pins import BaseAt, CorrectionSeries, SegmentPins, pin
from engine.interpolation.blends import BLENDS, Blend
from engine.interpolation.inbetweens import Frame, Inbetweens
from engine.interpolation.passage import Interval
from engine.interpolation.scaling import Scaling
from engine.interpolation.sites import Sites
from engine.maps import Bounds
from engine.variant import Variant

# Times at which it is seen whether in-betweens around holes need a ρ.
TIMES = 24


def prepare_inbetweens(variant: Variant, interval: Interval) -> Inbetweens:
    """Prepare the in-betweens of an interval.

    Raises
    ------
    EngineError
        If the transform is missing or of another outline.
    """
    return _closed(BLENDS[variant].of(interval), interval.sites)


def frame_at(
    time: float, variant: Variant, interval: Interval, pins: CorrectionSeries | None = None
) -> Frame:
    """Return one in-between, where no other is wanted yet: what `prepare_inbetweens` gives then.

    Of the metric variant it costs less, since one Dirichlet problem is solved and not one for each
    of the forms that the residual takes in the whole interval; around holes, and of other variants,
    as much.

    Raises
    ------
    EngineError
        As `prepare_inbetweens`, and if the time is not in [0, 1].
    """
    if not 0.0 <= time <= 1.0:
        raise EngineError(f"An interval runs from time 0 to 1; {time:g} is outside.")
    if interval.sites.period_basis is not None:
        found = prepare_inbetweens(variant, interval)
    else:
        found = _closed(BLENDS[variant].only_at(time, interval), interval.sites)
    return (found if pins is None else found.corrected(pins)).frame(time)


def value_points_for_corrections(corrector: PointCorrector) -> Complexes:
    """Return where corrections need values: nodes of the paths to handles, and the samples."""
    return np.concatenate([corrector.paths.nodes, corrector.boundary.points])


def base_at(inbetweens: Inbetweens, corrector: PointCorrector, time: float) -> BaseAt:
    """Return an in-between as a correction of it needs it.

    Parameters
    ----------
    inbetweens : Inbetweens
        At the handles, with values at `value_points_for_corrections`.
    corrector : PointCorrector
        For the handles.
    time : float
    """
    frame, (fz, g, k) = inbetweens.frame_with_values(time)
    nodes = len(corrector.paths.nodes)
    parts = slice(nodes), slice(nodes, None)
    of_nodes, of_samples = (BaseFrame(fz[p], g[p], k[p], inbetweens.sign) for p in parts)
    anchor = inbetweens.anchor_position(time)
    return BaseAt(frame.positions, frame.fz, anchor, of_nodes, of_samples)


def solve_pins(
    base: Inbetweens, corrector: PointCorrector, pins: SegmentPins, bounds: Bounds
) -> CorrectionSeries:
    """Find the corrections of a segment.

    Parameters
    ----------
    base : Inbetweens
        As `base_at` wants it, without pins.
    corrector : PointCorrector
        For the handles.
    pins : SegmentPins
    bounds : Bounds
        Limits that are kept at the samples, as far as the base keeps them.
    """
    return pin(corrector, partial(base_at, base, corrector), pins, bounds)


def _closed(blend: Blend, sites: Sites) -> Inbetweens:
    """Close the periods around holes, and scale Ψ where that is called for."""
    unclosed, basis = blend, sites.period_basis
    closing = conformal = scale = None
    is_scaled = blend.is_scaled
    if basis is not None and blend.sign:
        constants = blend.constants
        at_loops = unclosed.at(sites.paths.around)

        def at(times: Floats) -> Unclosed:
            return Unclosed(
                *at_loops.values(times), None if constants is None else constants.at(times)
            )

        breaks = (0.0, 1.0) if constants is None else tuple(constants.series.breaks)
        closing = close(basis, at, sign=blend.sign, breaks=breaks)
        blend = blend.with_residual(closing.residual)
        if blend.is_scaled_around_holes:
            times = np.linspace(0.0, 1.0, TIMES + 2)[1:-1]
            is_scaled = bool(unclosed.sharp_scaling(sites, closing, None)(times).min() < 1.0)
        if is_scaled:
            conformal = to_conformal(basis, at, sign=blend.sign, breaks=breaks)
    if is_scaled:
        scale = Scaling.of(unclosed.sharp_scaling(sites, closing, conformal))
    return Inbetweens(
        sites=sites, blend=blend, scale=scale, closing=closing, conformal_closing=conformal
    )
