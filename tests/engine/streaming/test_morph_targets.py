import numpy as np
import pytest
from hypothesis import given, settings, strategies as st
from numpy.testing import assert_allclose

from engine.streaming import build_morph_targets, finish

BASE = np.random.default_rng(5).normal(size=40) + 1j * np.random.default_rng(6).normal(size=40)
TOLERANCE = 0.01


def film(seed, count, *, speed=1.0):
    """A smooth motion of so many shapes over the time from 0 to 10."""
    rng = np.random.default_rng(seed)
    shapes = rng.normal(size=(count, 40)) + 1j * rng.normal(size=(count, 40))
    phases, rates = rng.uniform(0, 6, count), speed * rng.uniform(0.3, 1.0, count)
    return lambda time: BASE + np.cos(rates * time + phases) @ shapes


def built(motion, times=None, **options):
    times = np.linspace(0, 10, 21) if times is None else times
    options = {"tolerance": TOLERANCE} | options
    return finish(build_morph_targets(motion, BASE, list(times), **options))


def largest_distance(targets, motion, times):
    return max(np.abs(targets.positions(time) - motion(time)).max() for time in times)


@settings(max_examples=12, deadline=None)
@given(st.integers(0, 1000), st.integers(1, 6), st.floats(0.1, 2.0))
def test_the_tolerance_holds_at_every_time_for_every_point(seed, count, speed):
    motion = film(seed, count, speed=speed)
    targets = built(motion)
    assert len(targets.targets) <= count + 1
    assert targets.error <= TOLERANCE
    times = np.random.default_rng(seed).uniform(0, 10, 50)
    assert largest_distance(targets, motion, times) <= TOLERANCE
    assert targets.weights.min() >= 0
    assert targets.weights.max() <= 1 + 1e-12


def test_no_more_targets_than_the_tolerance_needs():
    large, small = film(1, 2), film(2, 6)

    def motion(time):
        return large(time) + 1e-4 * (small(time) - BASE)

    assert len(built(motion, tolerance=0.02).targets) <= 3
    assert len(built(motion, tolerance=1e-4).targets) >= 5


def test_as_many_targets_as_may_be_and_the_error_that_is_left():
    motion = film(3, 6)
    targets = built(motion, most=4)
    assert len(targets.targets) == 4
    times = np.random.default_rng(0).uniform(0, 10, 200)
    worst = largest_distance(targets, motion, times)
    assert TOLERANCE < worst <= 1.01 * targets.error
    assert built(motion, most=3).error > targets.error


def test_a_motion_out_of_the_base_has_no_target_that_is_always_there():
    shape = np.random.default_rng(4).normal(size=40) + 0j
    for sign in (1, -1):
        targets = built(lambda time, sign=sign: BASE + sign * np.sin(time / 7) * shape)
        assert len(targets.targets) == 1
        assert_allclose(targets.weights[0], 0, rtol=0, atol=1e-12)


@pytest.mark.parametrize("offset", [0.0, 2.0])
def test_what_stands_still_has_no_shape_but_where_it_stands(offset):
    targets = built(lambda _: BASE + offset)
    assert len(targets.targets) == (1 if offset else 0)
    assert_allclose(targets.positions(3.3), BASE + offset, rtol=0, atol=1e-12)
    assert built(lambda _: BASE + offset, times=[2.0]).times.tolist() == [2.0]


def test_a_jump_is_as_short_as_it_may_be():
    def motion(time):
        return BASE + (1.0 if time >= 4 else 0.0) + 0.1 * time

    targets = built(motion)
    times = np.random.default_rng(0).uniform(0, 10, 400)
    away = times[np.abs(times - 4 + 2.0**-7) > 2.0**-6]
    assert largest_distance(targets, motion, away) <= TOLERANCE
    assert targets.error <= TOLERANCE
    assert_allclose(targets.positions(4.0), motion(4.0), rtol=0, atol=TOLERANCE)


def test_moments_are_close_where_the_motion_is_quick():
    targets = built(lambda time: BASE + 5 * np.exp(-20 * (time - 5.2) ** 2))
    gaps, middles = np.diff(targets.times), (targets.times[1:] + targets.times[:-1]) / 2
    assert gaps[np.abs(middles - 5.2) < 0.3].max() < 0.1 * gaps[np.abs(middles - 5.2) > 3].min()


def test_each_step_tells_how_far_it_is():
    steps = list(build_morph_targets(film(0, 2), BASE, [0.0, 4.0, 10.0], tolerance=0.5))
    assert steps[0] == 0
    assert max(steps) == 10
    assert all(0 <= time <= 10 for time in steps)
