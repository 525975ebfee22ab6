"""Handles that stay during a segment: where they are, keyframes, streams, and proofs."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from interpolation_shapes import bar, bent, inner_points, stage_of
from numpy.testing import assert_allclose

from engine.deform.correction.corrector import build_corrector
from engine.deform.correction.frame import BaseFrame
from engine.deform.correction.limits import solve_within
from engine.deform.correction.solver import solve_correction
from engine.interpolation import (
    SegmentPins,
    Variant,
    finish,
    prove,
    solve_pins,
    value_points_for_corrections,
)
from engine.interpolation.added.pins import pinning, segment_solver
from engine.maps import Bounds
from engine.streaming import Positions, build_series

SHAPE = bar()
ANCHOR = 0.1 + 0.1j
HANDLES = np.array([-1.7, 0.2j, 1.6 - 0.1j])
WIDE = Bounds(k=0.95, sigma_a=20, sigma_b=0.05)


def keyframes():
    """The bar, and the bar bent with the middle where it was."""
    return bent(SHAPE), bent(SHAPE, bend=0.5, stretch=1.1, turn=0.4)


def pins_of(maps, *, pinned=(True, True, False), anchored=False):
    ends = np.array([f(HANDLES) for f in maps])
    none = np.zeros((2, 3))
    return SegmentPins(
        is_pinned=np.array(pinned),
        is_even=np.zeros(3, dtype=np.bool_),
        ends=ends,
        slopes=none + 0j,
        weights=none,
        firmness=np.ones(3),
        is_anchored=anchored,
    )


@cache
def pinned(variant, *, anchored=False, bounds=WIDE):
    """In-betweens at the points that pins need, without pins and with them."""
    maps = keyframes()
    stage = stage_of(SHAPE, HANDLES, ANCHOR)
    corrector = build_corrector(stage.sites.boundary, ANCHOR, HANDLES)
    base = stage_of(SHAPE, HANDLES, ANCHOR, value_points_for_corrections(corrector)).between(
        maps, variant
    )
    pins = pins_of(maps, anchored=anchored)
    return base, base.with_correction(solve_pins(base, corrector, pins, bounds)), pins


def at(points, variant, **options):
    """The same at other points."""
    _, known, _ = pinned(variant, **options)
    series = known.corrections[0].known
    return stage_of(SHAPE, points, ANCHOR).between(keyframes(), variant).with_correction(series)


@pytest.mark.parametrize("variant", list(Variant))
def test_pinned_handles_go_evenly_between_their_places(variant):
    base, known, pins = pinned(variant)
    wandered = 0.0
    for time in (0.1, 0.37, 0.5, 0.9):
        places = known.frame(time).positions[:2]
        wanted = pins.ends[0] + time**2 * (3 - 2 * time) * (pins.ends[1] - pins.ends[0])
        assert np.abs(places - wanted[:2]).max() < 2e-5
        wandered = max(wandered, np.abs(base.frame(time).positions[:2] - wanted[:2]).max())
    assert wandered > 1e-3


@pytest.mark.parametrize("variant", [Variant.METRIC, Variant.NU])
def test_keyframes_are_met_exactly(variant):
    base, known, _ = pinned(variant)
    for time in (0.0, 1.0):
        assert_allclose(known.frame(time).positions, base.frame(time).positions, atol=1e-12)


def test_series_is_what_is_solved_at_any_time():
    base, known, pins = pinned(Variant.METRIC)
    corrector = build_corrector(base.boundary, ANCHOR, HANDLES)
    nodes = slice(len(corrector.paths.nodes))
    for time in (0.21, 0.66):
        frame, values = base.frame_with_values(time)
        fz, g, by = (z[nodes] for z in values)
        targets = pins.targets(time, frame.positions, base.anchor_position(time))
        found = solve_correction(corrector, BaseFrame(fz, g, by, -1), targets)
        series = known.corrections[0].known
        values = corrector.variables.at_samples
        h = base.boundary.span.evaluate(
            series.h @ series.series(time)[:, None], base.boundary.points, orders=(0,)
        )[0][:, 0]
        assert_allclose(h, values.h_of(found.x), atol=2e-5)
        assert series.shift(np.array([time]))[0] == pytest.approx(found.shift, abs=1e-4)


@pytest.mark.parametrize("variant", [Variant.METRIC, Variant.SCALED_ETA, Variant.NU])
def test_frames_are_harmonic_maps_with_these_derivatives(variant):
    z = inner_points(SHAPE[0], 12, 1, margin=0.1)
    e = 1e-4
    around = np.concatenate([z, z + e, z - e, z + 1j * e, z - 1j * e])
    frame = at(around, variant).frame(0.4)
    _, right, left, up, down = frame.positions.reshape(5, -1)
    by_x, by_y = (right - left) / (2 * e), (up - down) / (2 * e)
    assert_allclose((by_x - 1j * by_y) / 2, frame.fz[:12], atol=2e-4)
    assert_allclose((by_x + 1j * by_y) / 2, frame.fzbar[:12], atol=2e-4)


def test_an_anchor_that_stays_is_where_the_base_has_it():
    base, known, _ = pinned(Variant.METRIC, anchored=True)
    for time in (0.3, 0.8):
        assert known.anchor_position(time) == base.anchor_position(time)
        assert np.abs(known.frame(time).positions - base.frame(time).positions).max() > 1e-3


def test_a_stream_holds_the_pins():
    points = inner_points(SHAPE[0], 300, 2)
    known = at(points, Variant.METRIC)
    series = finish(build_series(Positions.of(known, known.sampled_domain)))
    assert series.is_whole
    for time in (0.13, 0.5, 0.77):
        streamed = series.values(time).view(np.complex64)
        assert np.abs(streamed - known.frame(time).positions).max() < 1e-5


def test_derivatives_at_some_points_are_the_frames_own():
    known = pinned(Variant.SCALED_ETA)[1]
    which = np.array([0, 2])
    times = np.array([0.2, 0.7])
    fz, fzbar = known.derivatives_at(which)(times)
    for row, time in enumerate(times):
        frame = known.frame(float(time))
        assert_allclose(fz[row], frame.fz[which], atol=1e-6)
        assert_allclose(fzbar[row], frame.fzbar[which], atol=1e-6)


@pytest.mark.parametrize("variant", list(Variant))
def test_whole_segments_are_proven_with_their_pins(variant):
    boundary = pinned(variant)[0].boundary
    ends = boundary.points[boundary.next_samples]
    dense = [boundary.points * (1 - s) + ends * s for s in (0.3, 0.7)]
    known = at(np.concatenate([boundary.points, *dense]), variant)
    proof = prove(known)
    k, sigma_a, sigma_b = 0.0, 0.0, np.inf
    for time in np.linspace(0, 1, 41):
        frame = known.frame(float(time))
        a, b = np.abs(frame.fz), np.abs(frame.fzbar)
        k = max(k, (b / a).max())
        sigma_a, sigma_b = max(sigma_a, (a + b).max()), min(sigma_b, (a - b).min())
    assert k <= proof.k <= k + 0.004
    assert sigma_a <= proof.sigma_a <= 1.01 * sigma_a
    assert 0.98 * sigma_b - 0.005 <= proof.sigma_b <= sigma_b
    assert proof.unproven_times == ()


def test_limits_are_kept_where_pins_ask_too_much():
    maps = keyframes()
    tight = Bounds(k=0.3, sigma_a=1.4, sigma_b=0.7)
    stage = stage_of(SHAPE, HANDLES, ANCHOR)
    corrector = build_corrector(stage.sites.boundary, ANCHOR, HANDLES)
    beside = value_points_for_corrections(corrector)
    base = stage_of(SHAPE, HANDLES, ANCHOR, beside).between(maps, Variant.NU)
    own = pins_of(maps)
    far = SegmentPins(
        is_pinned=np.array([True, True, True]),
        is_even=np.zeros(3, dtype=np.bool_),
        ends=own.ends,
        slopes=np.array([[3j, 0, 0], [0, 0, 0]]),
        weights=np.array([[1.0, 0, 0], [0, 0, 0]]),
        firmness=own.firmness,
        is_anchored=True,
    )
    reached = base.values_at(np.array([0.5]))
    assert (np.abs(reached.fz) + np.abs(reached.g)).max() < 1.4
    series = solve_pins(base, corrector, far, tight)
    known = base.with_correction(series)
    ends = base.values_at(np.array([0.0, 1.0]))
    most = (np.abs(ends.fz) + np.abs(ends.g)).max()
    least = (np.abs(ends.fz) - np.abs(ends.g)).min()
    values = known.values_at(np.linspace(0.05, 0.95, 19))
    a, b = np.abs(values.fz), np.abs(values.g)
    assert (a + b).max() <= max(1.4, most) * 1.002
    assert (a - b).min() >= min(0.7, least) * 0.998


def test_pinned_handles_stay_where_keyframes_are_at_the_limits():
    maps = bent(SHAPE, bend=-0.5, stretch=1 / 1.3), bent(SHAPE, bend=0.5, stretch=1.3, turn=0.4)
    stage = stage_of(SHAPE, HANDLES, ANCHOR)
    corrector = build_corrector(stage.sites.boundary, ANCHOR, HANDLES)
    beside = value_points_for_corrections(corrector)
    base = stage_of(SHAPE, HANDLES, ANCHOR, beside).between(maps, Variant.NU)
    ends = base.values_at(np.array([0.0, 1.0]))
    a, b = np.abs(ends.fz), np.abs(ends.g)
    tight = Bounds(k=(b / a).max(), sigma_a=(a + b).max(), sigma_b=(a - b).min())
    pins = pins_of(maps)
    known = base.with_correction(solve_pins(base, corrector, pins, tight))
    for time in (0.2, 0.5, 0.7):
        share = time**2 * (3 - 2 * time)
        wanted = (pins.ends[0] + share * (pins.ends[1] - pins.ends[0]))[:2]
        assert np.abs(base.frame(time).positions[:2] - wanted).max() > 0.03
        assert np.abs(known.frame(time).positions[:2] - wanted).max() < 1e-4
        values = known.values_at(np.array([time]))
        a, b = np.abs(values.fz), np.abs(values.g)
        assert (a + b).max() <= 1.003 * tight.sigma_a
        assert (a - b).min() >= 0.997 * tight.sigma_b
        assert (b / a).max() <= tight.k + 0.003


def test_pins_far_out_of_reach_cost_few_solves(monkeypatch):
    solves = []

    def solve(*given, **options):
        solves.append(solve_within(*given, **options))
        return solves[-1]

    monkeypatch.setattr(segment_solver, "solve_within", solve)
    # Neighbours that are to pass each other.
    handles = np.array([-1.7, -1.6, 1.6 - 0.1j])
    maps, stage = keyframes(), stage_of(SHAPE, handles, ANCHOR)
    corrector = build_corrector(stage.sites.boundary, ANCHOR, handles)
    beside = value_points_for_corrections(corrector)
    base = stage_of(SHAPE, handles, ANCHOR, beside).between(maps, Variant.NU)
    pins = SegmentPins(
        is_pinned=np.zeros(3, dtype=bool),
        is_even=np.zeros(3, dtype=np.bool_),
        ends=np.array([f(handles) for f in maps]),
        slopes=np.array([[9, -9, 0], [0, 0, 0]], dtype=complex),
        weights=np.array([[1, 1, 1], [0, 0, 0]], dtype=float),
        firmness=np.ones(3),
        is_anchored=True,
    )
    series = solve_pins(base, corrector, pins, WIDE)
    assert any(solved.is_limited for solved in solves)
    assert len(solves) <= pinning.DEGREES[-1] + 1
    known = base.with_correction(series)
    for time in (0.0, 1.0):
        assert_allclose(known.frame(time).positions, base.frame(time).positions, atol=1e-12)
    values = known.values_at(np.linspace(0.02, 0.98, 49))
    a, b = np.abs(values.fz), np.abs(values.g)
    assert (a + b).max() <= 1.002 * WIDE.sigma_a
    assert (a - b).min() >= 0.998 * WIDE.sigma_b
    assert (b / a).max() <= 1.005 * WIDE.k


def test_pinned_handles_on_moving_ground_move_evenly():
    both = pins_of(keyframes(), pinned=(True, True, True))
    known = replace(both, ends=np.array([HANDLES, HANDLES + 0.4]))
    even = replace(known, is_even=np.array([True, False, False]))
    for time in (0.25, 0.5, 0.8):
        targets = even.targets(time, HANDLES, ANCHOR)
        ways = HANDLES + targets.offsets - HANDLES
        assert_allclose(ways[0], 0.4 * time, atol=1e-12)
        assert_allclose(ways[1:], 0.4 * time * time * (3 - 2 * time), atol=1e-12)
