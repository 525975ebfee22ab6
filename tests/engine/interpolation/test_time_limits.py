"""Limits at all times of a segment: kept between solved times, with pins in place."""

from functools import partial

import numpy as np
import pytest
from interpolation_shapes import bar, bent, stage_of
from numpy.testing import assert_allclose

from engine.deform.correction.barrier import extremes as corrected_extremes
from engine.deform.correction.corrector import build_corrector
from engine.deform.correction.solver import solve_correction
from engine.interpolation import (
    SegmentPins,
    Variant,
    evaluate_base,
    solve_pins,
    value_points_for_corrections,
)
from engine.interpolation.added.pins import time_limits
from engine.interpolation.added.pins.pinning import solve_pin_correction
from engine.maps import Bounds

SHAPE, ANCHOR = bar(), 0.1 + 0.1j
HANDLES = np.array([-1.7, 0.2j, 1.6 - 0.1j])
TIGHT = Bounds(k=0.3, sigma_a=1.4, sigma_b=0.7)


def asking(slope):
    """In-betweens, their corrector, and pins of which one leaves its place at a velocity."""
    maps = bent(SHAPE), bent(SHAPE, bend=0.5, stretch=1.1, turn=0.4)
    corrector = build_corrector(stage_of(SHAPE, HANDLES, ANCHOR).sites.boundary, ANCHOR, HANDLES)
    beside = value_points_for_corrections(corrector)
    base = stage_of(SHAPE, HANDLES, ANCHOR, beside).between(maps, Variant.NU)
    pins = SegmentPins(
        is_pinned=np.array([False, True, True]),
        is_even=np.zeros(3, dtype=np.bool_),
        ends=np.array([f(HANDLES) for f in maps]),
        slopes=np.array([[slope, 0, 0], [0, 0, 0]]),
        weights=np.array([[1.0, 0, 0], [0, 0, 0]]),
        firmness=np.ones(3),
        is_anchored=True,
    )
    return base, corrector, pins


def extremes(inbetweens, times):
    values = inbetweens.values_at(times)
    a, b = np.abs(values.fz), np.abs(values.g)
    return (a + b).max(), (a - b).min(), (b / a).max()


@pytest.mark.parametrize(
    ("slope", "bounds"), [(8j, TIGHT), (12j, Bounds(k=0.5, sigma_a=2, sigma_b=0.5))]
)
def test_limits_are_kept_at_all_times_and_pins_stay(slope, bounds):
    base, corrector, pins = asking(slope)
    frame = evaluate_base(base, corrector, 0.2)
    targets = pins.targets(0.2, frame.places, frame.anchor)
    free = solve_correction(corrector, frame.nodes, targets)
    assert np.exp(-corrected_extremes(corrector, frame.samples, free.x)[1]) < 0.96 * bounds.sigma_b
    series = solve_pins(base, corrector, pins, bounds)
    assert series.share == 1.0
    known = base.with_correction(series)
    most = extremes(base, np.array([0.0, 1.0]))
    sigma_a, sigma_b, k = extremes(known, np.linspace(0.0, 1.0, 157))
    assert sigma_a <= max(bounds.sigma_a, most[0]) * 1.003
    assert sigma_b >= min(bounds.sigma_b, most[1]) * 0.997
    assert k <= max(bounds.k, most[2]) + 0.003
    for time in np.linspace(0.0, 1.0, 23):
        places, targets = known.frame(float(time)).positions[:3], base.frame(float(time)).positions
        offsets = pins.targets(float(time), targets[:3], base.anchor_position(float(time))).offsets
        assert_allclose(places, targets[:3] + offsets, atol=4e-4)


def test_the_same_segment_has_the_same_corrections():
    first, second = (solve_pins(*asking(8j), TIGHT) for _ in range(2))
    times = np.linspace(0.0, 1.0, 9)
    assert_allclose(
        first.h @ first.series.at(times), second.h @ second.series.at(times), rtol=0, atol=0
    )


def test_a_single_frame_keeps_limits_and_pins_as_the_segment_does():
    base, corrector, pins = asking(8j)
    known = base.with_correction(solve_pins(base, corrector, pins, TIGHT))
    one = solve_pin_correction(corrector, partial(evaluate_base, base, corrector), pins, TIGHT, 0.3)
    alone = base.with_correction(one)
    places, together = (each.frame(0.3).positions[:3] for each in (alone, known))
    assert_allclose(places, together, atol=4e-4)
    most = extremes(base, np.array([0.0, 1.0]))
    assert extremes(alone, np.array([0.3]))[1] >= min(TIGHT.sigma_b, most[1]) * 0.997


def test_pushes_are_the_least_that_remove_the_excess():
    random = np.random.default_rng(5)
    rows = random.normal(size=(12, 30))
    form, excess = rows @ rows.T, random.normal(size=12)
    pushes = time_limits._least_pushes(form, excess)
    left = form @ pushes - excess
    # The conditions of Karush, Kuhn and Tucker.
    assert pushes.min() >= 0
    assert left.min() >= -1e-7
    assert np.abs(pushes * left).max() < 1e-7
    assert 0 < np.count_nonzero(pushes) < 12


def test_targets_that_limits_forbid_are_given_up_without_a_broken_limit():
    base, corrector, pins = asking(60j)
    series = solve_pins(base, corrector, pins, TIGHT)
    sigma_a, sigma_b, _ = extremes(base.with_correction(series), np.linspace(0.0, 1.0, 97))
    most = extremes(base, np.array([0.0, 1.0]))
    assert sigma_a <= max(TIGHT.sigma_a, most[0]) * 1.003
    assert sigma_b >= min(TIGHT.sigma_b, most[1]) * 0.997
