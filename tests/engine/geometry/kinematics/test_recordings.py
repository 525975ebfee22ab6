"""Recorded drags become few keys, whose motion stays within a tolerance."""

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal
from scipy.interpolate import CubicHermiteSpline

from engine.errors import EngineError
from engine.geometry.kinematics import fit_keys
from engine.geometry.kinematics.recordings import key_motion


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


def missed(frames, values, times, places):
    inside = (times >= frames[0]) & (times <= frames[-1])
    return np.abs(key_motion(frames, values, times[inside]) - places[inside]).max()


def test_the_motion_is_that_of_the_parabolas_through_keys():
    rng = np.random.default_rng(0)
    frames = np.array([3, 4, 9, 11, 30])
    values = rng.normal(0, 50, (5, 2)) @ [1, 1j]
    inner = [
        np.polyfit(frames[i - 1 : i + 2] - frames[i], values[i - 1 : i + 2], 2)[1]
        for i in (1, 2, 3)
    ]
    chords = np.diff(values) / np.diff(frames)
    expected = CubicHermiteSpline(frames, values, [chords[0], *inner, chords[-1]])
    times = rng.uniform(3, 30, 300)
    assert_allclose(key_motion(frames, values, times), expected(times), rtol=0, atol=1e-10)
    # C¹ at keys, and through them.
    for side in (-1e-7, 1e-7):
        at = frames[1:-1] + side
        slopes = (
            key_motion(frames, values, at + 1e-7) - key_motion(frames, values, at - 1e-7)
        ) / 2e-7
        assert_allclose(slopes, inner, rtol=0, atol=1e-4)
    assert_allclose(key_motion(frames, values, frames.astype(float)), values, rtol=0, atol=1e-12)


def test_a_motion_stops_at_keys_that_are_at_one_place():
    frames, values = np.array([0, 10, 20, 30]), np.array([0, 50, 50.001, 100])
    still = key_motion(frames, values, np.linspace(10, 20, 50))
    assert np.ptp(still.real) < 0.0011
    assert_allclose(key_motion(frames, values, np.array([9.999])), 50, rtol=0, atol=1e-5)


@pytest.mark.parametrize(("tolerance", "most"), [(3.0, 13), (5.0, 11), (30.0, 7)])
@pytest.mark.parametrize("seed", range(5))
def test_three_seconds_are_a_few_keys(tolerance, most, seed):
    times, places = recorded(3, seed=seed)
    frames, values = fit_keys(times, places, tolerance)
    assert len(frames) <= most
    assert frames.dtype == np.intp
    assert (frames[0], frames[-1]) == (0, 72)
    assert (np.diff(frames) > 0).all()
    assert missed(frames, values, times, places) <= tolerance
    # It is the hand's way, and not its tremor.
    _, steady = recorded(3, seed=seed, noise=0)
    assert missed(frames, values, times, steady) <= tolerance + 1
    again = fit_keys(times, places, tolerance)
    assert_array_equal(again[0], frames)
    assert_array_equal(again[1], values)


@pytest.mark.parametrize("seed", range(3))
def test_no_key_could_be_left_out(seed):
    times, places = recorded(3, seed=seed)
    frames, _ = fit_keys(times, places, 3.0)
    for key in range(1, len(frames) - 1):
        rest = np.delete(frames, key)
        # All places at once, by a dense matrix: the motion of one key at 1 and all others at 0.
        columns = [key_motion(rest, column, times) for column in np.eye(len(rest))]
        matrix = np.array(columns).real.T
        best = np.linalg.lstsq(matrix, places, rcond=None)[0]
        assert np.abs(matrix @ best - places).max() > 3.0


def test_what_keys_made_is_found_again():
    frames = np.array([0, 7, 20, 31, 36, 48])
    values = np.random.default_rng(1).normal(0, 100, (6, 2)) @ [1, 1j]
    times = np.linspace(0, 48, 400)
    places = key_motion(frames, values, times)
    found, best = fit_keys(times, places, 0.5)
    assert missed(found, best, times, places) <= 0.5
    found, best = fit_keys(times, places, 0.0)
    assert_array_equal(found, np.arange(49))
    # The motion of keys in every frame is nearly that of fewer keys.
    assert missed(found, best, times, places) < 0.3


def test_a_straight_way_at_one_pace_has_two_keys():
    times = np.sort(np.random.default_rng(2).uniform(3.2, 60.4, 300))
    times[[0, -1]] = 3.2, 60.4
    frames, values = fit_keys(times, 5 + (2 + 1j) * times, 1e-6)
    assert_array_equal(frames, [4, 60])
    assert_allclose(values, 5 + (2 + 1j) * frames, rtol=0, atol=1e-3)


def test_a_hand_that_rests_leaves_the_handle_where_it_is():
    times = np.arange(0, 120, 0.4)
    there, back = 30 * np.clip((times - 20) / 15, 0, 1), 30 * np.clip((times - 80) / 15, 0, 1)
    places = np.round(there - back) + 7j
    frames, values = fit_keys(times, places, 1.5)
    rests = key_motion(frames, values, np.linspace(45, 70, 200))
    assert np.abs(rests - (30 + 7j)).max() < 1.5
    frames, values = fit_keys(times, np.full(len(times), 3 + 4j), 1.5)
    assert_array_equal(frames, [0, 119])
    assert_array_equal(values, [3 + 4j, 3 + 4j])


def test_a_long_recording_is_fitted_as_well_as_a_short_one():
    times, places = recorded(60, rate=120)
    frames, values = fit_keys(times, places, 3.0)
    assert missed(frames, values, times, places) <= 3.0
    assert len(frames) <= 60 * 4
    # Far away one does not know of the other end.
    short = times <= 24 * 20
    first, _ = fit_keys(times[short], places[short], 3.0)
    assert abs(len(first) - np.count_nonzero(frames <= 24 * 20)) <= 8


def test_a_tremor_beyond_the_tolerance_costs_no_key_in_each_frame():
    times, places = recorded(20, noise=1.2)
    frames, values = fit_keys(times, places, 2.0)
    closest = fit_keys(times, places, 0.0)
    assert missed(frames, values, times, places) < 1.05 * missed(*closest, times, places)
    assert len(frames) < len(closest[0]) / 2


def test_a_spike_costs_keys_around_it_only():
    times, places = recorded(6)
    usual = len(fit_keys(times, places, 3.0)[0])
    places[200] += 200
    frames, values = fit_keys(times, places, 3.0)
    away = np.abs(times - times[200]) > 4
    assert np.abs(key_motion(frames, values, times[away]) - places[away]).max() <= 3.0
    assert len(frames) <= usual + 16


@pytest.mark.parametrize("late", [0.0, 0.5, 0.95])
def test_a_place_in_each_frame_is_enough(late):
    """Hardly enough: the keys' places are decided by as many recorded ones, between them."""
    times = np.arange(0, 50) + late
    places = np.random.default_rng(3).normal(0, 30, (50, 2)) @ [1, 1j]
    frames, values = fit_keys(times, places, 0.0)
    assert_array_equal(frames, np.arange(late > 0, 50 + (late > 0.9)))
    assert np.abs(values).max() < 6 * np.abs(places).max()
    if not late:
        assert_allclose(values, places, rtol=0, atol=0.01)


def test_in_a_gap_of_the_recording_the_way_is_straight():
    times = np.append(np.arange(0, 10, 0.3), np.arange(60, 70, 0.3))
    places = np.where(times < 30, 12 * times, 1000 - 12 * times)
    frames, values = fit_keys(times, places, 2.0)
    gap = np.linspace(times[33], times[34], 100)
    straight = np.interp(gap, times[33:35], places[33:35])
    assert np.abs(key_motion(frames, values, gap) - straight).max() < 3.0


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
    found, best = fit_keys(times, places, 0.5)
    assert_array_equal(found, frames)
    assert_allclose(best, values, rtol=0, atol=0.51)


def test_of_places_at_one_time_the_last_one_counts():
    times = np.repeat(np.arange(0.0, 25), 2)
    places = np.column_stack([np.full(25, 1000), np.arange(25) * 3]).ravel()
    frames, values = fit_keys(times, places, 0.1)
    assert_array_equal(frames, [0, 24])
    assert_allclose(values, [0, 72], rtol=0, atol=1e-3)


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"places": [0, np.nan, 2]}, "entry 1"),
        ({"times": [0, np.inf, 2]}, "times of a recording must be finite"),
        ({"times": [0, 2, 1]}, "must not go back"),
        ({"times": [0, 1]}, "a time for each place"),
        ({"times": [], "places": []}, "at least one"),
        ({"tolerance": -1.0}, "0 pixels or more, not -1"),
        ({"tolerance": np.nan}, "0 pixels or more, not nan"),
    ],
)
def test_what_is_no_recording_is_refused_in_words(changes, words):
    given = {"times": [0.0, 1, 2], "places": [0, 1, 2], "tolerance": 1.0} | changes
    with pytest.raises(EngineError, match=words):
        fit_keys(**given)
