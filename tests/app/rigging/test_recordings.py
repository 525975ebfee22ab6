"""Recorded drags become few keys, whose motion stays within a tolerance."""

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal
from scipy.interpolate import CubicHermiteSpline

from app.rigging import fit_keys
from app.rigging.kinematics.recordings import TOLERANCE, FittedKeys, evaluate_keys
from engine.errors import EngineError


def moves(times, targets, seconds=0.9):
    """A hand that goes from target to target as hands do: with the least jerk."""
    share = np.clip((times[:, None] - seconds * np.arange(len(targets) - 1)) / seconds, 0, 1)
    return targets[0] + (share**3 * (10 - 15 * share + 6 * share**2)) @ np.diff(targets)


def recorded(seconds, *, rate=80, noise=1.0, seed=0):
    """Return frames at 24 a second, in uneven steps, and a path of so many seconds with noise."""
    rng = np.random.default_rng(seed)
    times = np.sort(rng.uniform(0, seconds, rate * seconds))
    times[[0, -1]] = 0, seconds
    targets = np.cumsum(rng.normal(0, 100, (seconds + 1, 2)) @ [1, 1j])
    jitter = rng.normal(0, noise / np.sqrt(2), (len(times), 2)) @ [1, 1j]
    return 24 * times, moves(times, targets) + jitter


def missed(keys, times, places):
    inside = (times >= keys.frames[0]) & (times <= keys.frames[-1])
    return np.abs(evaluate_keys(keys, times[inside]) - places[inside]).max()


def drawn(*frames, seed=0):
    """Return keys at frames, of any places and velocities."""
    rng = np.random.default_rng(seed)
    places, velocities = rng.normal(0, [[[100]], [[10]]], (2, len(frames), 2)) @ [1, 1j]
    return FittedKeys(np.array(frames), places, velocities)


def test_the_motion_is_the_hermite_spline_of_places_and_velocities():
    keys = drawn(3, 4, 9, 11, 30)
    times = np.random.default_rng(0).uniform(3, 30, 300)
    expected = CubicHermiteSpline(*keys)(times)
    assert_allclose(evaluate_keys(keys, times), expected, rtol=0, atol=1e-10)


@pytest.mark.parametrize(("tolerance", "most"), [(3.0, 8), (5.0, 7), (30.0, 4)])
@pytest.mark.parametrize("seed", range(5))
def test_three_seconds_are_a_few_keys(tolerance, most, seed):
    times, places = recorded(3, seed=seed)
    keys = fit_keys(times, places, tolerance)
    frames = keys.frames
    assert len(frames) <= most
    assert frames.dtype == np.intp
    assert (frames[0], frames[-1]) == (0, 72)
    assert (np.diff(frames) > 0).all()
    assert missed(keys, times, places) <= tolerance
    # It is the hand's way, and not its tremor.
    _, steady = recorded(3, seed=seed, noise=0)
    assert missed(keys, times, steady) <= tolerance + 1
    for one, other in zip(fit_keys(times, places, tolerance), keys, strict=True):
        assert_array_equal(one, other)


@pytest.mark.parametrize("seed", range(3))
def test_no_key_could_be_left_out(seed):
    times, places = recorded(3, seed=seed)
    frames = fit_keys(times, places, 3.0).frames
    for key in range(1, len(frames) - 1):
        rest = np.delete(frames, key)
        # All at once, by a dense matrix: the motion of one number at 1 and all others at 0.
        columns = [
            evaluate_keys(FittedKeys(rest, *column), times)
            for column in np.eye(2 * len(rest)).reshape(-1, 2, len(rest))
        ]
        matrix = np.array(columns).T
        best = np.linalg.lstsq(matrix, places, rcond=None)[0]
        assert np.abs(matrix @ best - places).max() > 3.0


def test_what_keys_made_is_found_again():
    made = drawn(0, 6, 12, 24, 36, 48)
    times = np.linspace(0, 48, 400)
    places = evaluate_keys(made, times)
    found = fit_keys(times, places, 1e-3)
    assert len(found.frames) <= len(made.frames) + 2
    assert missed(found, times, places) <= 1e-3
    every = fit_keys(times, places, 0.0)
    assert_array_equal(every.frames, np.arange(49))
    # What is tied to the recording where places are few gives way to them where they are not.
    assert missed(every, times, places) < 1e-3
    assert_allclose(every.velocities[0], made.velocities[0], rtol=0, atol=0.01)


def test_frames_that_are_required_have_a_key():
    times, places = recorded(3)
    usual = fit_keys(times, places, 3.0).frames
    wanted = next(frame for frame in range(20, 60) if frame not in usual)
    keys = fit_keys(times, places, 3.0, required=(wanted, -5, 0, 90))
    assert wanted in keys.frames
    assert (keys.frames[0], keys.frames[-1]) == (0, 72)
    assert len(keys.frames) <= len(usual) + 1
    assert missed(keys, times, places) <= 3.0


def test_a_straight_way_at_one_pace_has_two_keys():
    times = np.sort(np.random.default_rng(2).uniform(3.2, 60.4, 300))
    times[[0, -1]] = 3.2, 60.4
    keys = fit_keys(times, 5 + (2 + 1j) * times, 1e-6)
    assert_array_equal(keys.frames, [4, 60])
    assert_allclose(keys.places, 5 + (2 + 1j) * keys.frames, rtol=0, atol=1e-3)
    assert_allclose(keys.velocities, 2 + 1j, rtol=0, atol=1e-6)


def test_a_hand_that_rests_leaves_the_handle_where_it_is():
    times = np.arange(0, 120, 0.4)
    there, back = 30 * np.clip((times - 20) / 15, 0, 1), 30 * np.clip((times - 80) / 15, 0, 1)
    places = np.round(there - back) + 7j
    rests = evaluate_keys(fit_keys(times, places, 1.5), np.linspace(45, 70, 200))
    assert np.abs(rests - (30 + 7j)).max() < 1.5
    keys = fit_keys(times, np.full(len(times), 3 + 4j), 1.5)
    assert_array_equal(keys.frames, [0, 119])
    assert_array_equal(keys.places, [3 + 4j, 3 + 4j])
    assert_allclose(keys.velocities, [0, 0], rtol=0, atol=1e-15)


def test_a_long_recording_is_fitted_as_well_as_a_short_one():
    times, places = recorded(60, rate=120)
    keys = fit_keys(times, places, 3.0)
    assert missed(keys, times, places) <= 3.0
    assert len(keys.frames) <= 60 * 2.2
    # Far away one does not know of the other end.
    short = times <= 24 * 20
    first = fit_keys(times[short], places[short], 3.0).frames
    assert abs(len(first) - np.count_nonzero(keys.frames <= 24 * 20)) <= 4


def test_a_tremor_beyond_the_tolerance_costs_no_key_in_each_frame():
    times, places = recorded(20, noise=1.2)
    keys, closest = (fit_keys(times, places, tolerance) for tolerance in (2.0, 0.0))
    assert missed(keys, times, places) < 1.05 * max(missed(closest, times, places), 2.0)
    assert len(keys.frames) < len(closest.frames) / 2


def test_a_spike_costs_keys_around_it_only():
    times, places = recorded(6)
    usual = len(fit_keys(times, places, 3.0).frames)
    places[200] += 200
    keys = fit_keys(times, places, 3.0)
    away = np.abs(times - times[200]) > 4
    assert np.abs(evaluate_keys(keys, times[away]) - places[away]).max() <= 3.0
    assert len(keys.frames) <= usual + 16


@pytest.mark.parametrize("late", [0.0, 0.5, 0.95])
def test_a_place_in_each_frame_is_enough(late):
    """Hardly enough: the keys' places are decided by as many recorded ones, between them."""
    times = np.arange(0, 50) + late
    places = np.random.default_rng(3).normal(0, 30, (50, 2)) @ [1, 1j]
    keys = fit_keys(times, places, 0.0)
    assert_array_equal(keys.frames, np.arange(late > 0, 50 + (late > 0.9)))
    for numbers in (keys.places, keys.velocities):
        assert np.abs(numbers).max() < 6 * np.abs(places).max()
    if not late:
        assert_allclose(keys.places, places, rtol=0, atol=0.01)
        # Nothing else tells of them: those of the parabola through three places.
        slopes = (places[2:] - places[:-2]) / 2
        assert_allclose(keys.velocities[1:-1], slopes, rtol=0, atol=0.01)


@pytest.mark.parametrize("offset", [-1e-12, 0, 1e-12, 0.2])
def test_end_keys_are_on_the_recording_whenever_its_places_were_seen(offset):
    times = 0.4 * np.arange(13) + offset
    places = np.repeat([0, 8, 14, 18, 20, 21, 21], 2)[:13] * (3 + 4j)
    keys = fit_keys(times, places, 0.3)
    recording = np.interp(keys.frames, times, places.real) * (1 + 4j / 3)
    assert_allclose(keys.places, recording, rtol=0, atol=10.0)


def test_in_a_gap_of_the_recording_the_way_is_straight():
    times = np.append(np.arange(0, 10, 0.3), np.arange(60, 70, 0.3))
    places = np.where(times < 30, 12 * times, 1000 - 12 * times)
    keys = fit_keys(times, places, 2.0)
    gap = np.linspace(times[33], times[34], 100)
    straight = np.interp(gap, times[33:35], places[33:35])
    assert np.abs(evaluate_keys(keys, gap) - straight).max() < 3.0


@pytest.mark.parametrize(
    ("times", "places", "frames", "values"),
    [
        ([7.3], [5 + 1j], [7], [5 + 1j]),
        ([6.8, 7.3], [0, 10], [7], [4]),
        ([7.0, 7.0, 7.0], [1, 2, 3], [7], [3]),
        ([3.4, 3.8], [0, 8], [4], [8]),
        ([2.6, 4.4], [0, 18], [3, 4], [4, 14]),
        ([2.00001, 3.99999], [0, 20], [2, 4], [0, 20]),
        ([-5.0, 5.0], [0, 1], [-5, 5], [0, 1]),
    ],
)
def test_the_shortest_recordings_have_a_key_or_two(times, places, frames, values):
    keys = fit_keys(times, places, 0.5)
    assert_array_equal(keys.frames, frames)
    assert_allclose(keys.places, values, rtol=0, atol=0.51)
    assert len(keys.velocities) == len(frames)


def test_of_places_at_one_time_the_last_one_counts():
    times = np.repeat(np.arange(0.0, 25), 2)
    places = np.column_stack([np.full(25, 1000), np.arange(25) * 3]).ravel()
    keys = fit_keys(times, places, 0.1)
    assert_array_equal(keys.frames, [0, 24])
    assert_allclose(keys.places, [0, 72], rtol=0, atol=1e-3)


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"places": [0, np.nan, 2]}, "entry 1"),
        ({"times": [0, np.inf, 2]}, "times of a recording must be finite"),
        ({"times": [0, 2, 1]}, "must not decrease"),
        ({"times": [0, 1]}, "one time for each position"),
        ({"times": [], "places": []}, "at least one"),
        ({"tolerance": -1.0}, TOLERANCE),
        ({"tolerance": np.nan}, TOLERANCE),
    ],
)
def test_what_is_no_recording_is_refused_in_words(changes, words):
    given = {"times": [0.0, 1, 2], "places": [0, 1, 2], "tolerance": 1.0} | changes
    with pytest.raises(EngineError, match=words):
        fit_keys(**given)
