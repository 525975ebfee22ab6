"""Where tracks want their handles: at keys, between them, late, and around loops."""

from dataclasses import replace

import numpy as np
import pytest
from documents import altered, disc_document
from hypothesis import given, strategies as st
from numpy.testing import assert_allclose
from scipy.interpolate import CubicHermiteSpline

from app.document.channels.easing import HOLD, LINEAR, PRESETS, Easing
from app.document.channels.tangent_mode import TangentMode
from app.document.channels.tracks import Track, TrackKey
from app.document.queries.channel_values.tracks_at import track_at, velocity_at
from app.document.queries.clips import clip_of
from app.document.settings import FrameRange

EMPTY = disc_document()
PLACES = [0j, 3 + 1j, -2 + 4j, 1 / 3 - 0.1j, 7 - 5j]
STEP = 1e-4  # frames, for slopes


def track_of(*frames, places=PLACES, delay=0, turns=(), **changes):
    """Return a track with keys at some frames; `changes` has values for each of them."""
    keys = [
        TrackKey(frame=frame, place=place, **{name: each[i] for name, each in changes.items()})
        for i, (frame, place) in enumerate(zip(frames, places, strict=False))
    ]
    if turns:
        keys = [replace(key, turn=turn) for key, turn in zip(keys, turns, strict=True)]
    return Track(handles=(0,), keys=tuple(keys), delay=delay, keys_rotation=bool(turns))


def clip(last=48, first=0, *, loop=False):
    keys = (replace(EMPTY.layers[0].keys[0], frame=first),)
    return clip_of(altered(EMPTY, keys=keys, frames=FrameRange(first, last), loop=loop), 0)


def places(track, frames, shown=None):
    return np.array([track_at(track, shown or clip(), frame).place for frame in frames])


def slopes(track, frame, shown=None):
    """Return the velocities just before a frame and just after it, in pixels a frame."""
    before, at, after = places(track, (frame - STEP, frame, frame + STEP), shown)
    return (at - before) / STEP, (after - at) / STEP


easings = st.sampled_from([*PRESETS.values(), Easing((0.1, 0.2, 0.6, 0.7))])
numbers = st.floats(-1e3, 1e3)


@given(
    st.sets(st.integers(0, 90), min_size=1, max_size=6),
    st.data(),
    st.integers(0, 90),
    st.booleans(),
)
def test_a_keys_own_place_and_turn_are_given_to_the_bit(frames, data, delay, loop):
    keys = tuple(
        TrackKey(
            frame=frame,
            place=complex(data.draw(numbers), data.draw(numbers)),
            turn=0.1 * data.draw(numbers),
            easing=data.draw(easings),
            tangent_mode=data.draw(st.sampled_from(["through", "corner", "stop"])),
        )
        for frame in sorted(frames)
    )
    track = Track(handles=(0,), keys=keys, delay=delay, keys_rotation=True)
    shown = clip(91, loop=loop)  # a frame longer than from the first possible key to the last
    for key in keys:
        assert track_at(track, shown, key.frame + delay) == (key.place, key.turn)
    unturned = replace(track, keys_rotation=False)
    assert track_at(unturned, shown, keys[0].frame + delay).turn == 0.0


def test_nothing_is_wanted_before_the_first_key_and_after_the_last():
    track = track_of(10, 20, 30)
    for frame in (-1, 0, 9, 9.999, 30.001, 48, 70):
        assert track_at(track, clip(), frame) is None
    assert track_at(replace(track, enabled=False), clip(), 20) is None
    alone = track_of(10)
    wanted = [frame for frame in np.arange(0, 48, 0.5) if track_at(alone, clip(), frame)]
    assert wanted == [10.0]


def test_a_key_between_two_others_is_passed_at_the_slope_of_the_parabola_through_them():
    track = track_of(0, 10, 30, 36)
    for one, two, three in ((0, 1, 2), (1, 2, 3)):
        frames = np.array([track.keys[i].frame for i in (one, two, three)], float)
        parabola = np.polyfit(frames - frames[1], PLACES[one : three + 1], 2)
        for slope in slopes(track, frames[1]):
            assert_allclose(slope, parabola[1], rtol=0, atol=1e-3)


@pytest.mark.parametrize(
    ("before", "after", "passes"),
    [
        ("in", "linear", True),
        ("linear", "out", True),
        ("in-out", "in-out", True),
        ("in-out", "linear", False),
        ("linear", "in", False),
    ],
)
def test_easings_beside_a_key_agree_on_its_velocity(before, after, passes):
    track = track_of(0, 10, 30, easing=[PRESETS[before], PRESETS[after], LINEAR])
    coming, going = slopes(track, 10)
    assert_allclose(coming, going, rtol=0, atol=1e-3)
    assert (abs(going) > 0.1) == (passes and before != "in-out")


@pytest.mark.parametrize("loop", [False, True])
@pytest.mark.parametrize("easing", [LINEAR, PRESETS["in"], PRESETS["in-out"]])
def test_a_track_begins_and_ends_at_rest_beside_what_is_not_moved(easing, loop):
    track, shown = track_of(4, 14, 34, easing=[easing] * 3, delay=3), clip(loop=loop)
    ends = (places(track, [7 + STEP], shown)[0] - PLACES[0]) / STEP
    assert_allclose(ends, 0, rtol=0, atol=1e-3)
    ends = (PLACES[2] - places(track, [37 - STEP], shown)[0]) / STEP
    assert abs(ends) < 1e-3 or easing == PRESETS["in"]
    # A person who wants otherwise says so.
    straight = track_of(4, 14, 34, tangent_mode=[TangentMode.CORNER] * 3, delay=3)
    begin = (places(straight, [7 + STEP], shown)[0] - PLACES[0]) / STEP
    assert_allclose(begin, (PLACES[1] - PLACES[0]) / 10, rtol=0, atol=1e-3)


def test_a_turn_begins_and_ends_at_rest():
    track = track_of(0, 10, places=[5, 5], turns=(0.0, 2.0))
    turns = [track_at(track, clip(), frame).turn for frame in (STEP, 10 - STEP)]
    assert_allclose(turns, [0, 2], rtol=0, atol=1e-6)


VELOCITIES = [0.5 - 2j, 3j, -1 + 0.25j, 4 + 0j]


def test_keys_with_velocities_are_passed_at_those():
    frames = [0, 10, 16, 40]
    track = track_of(*frames, velocity=VELOCITIES)
    spline = CubicHermiteSpline(frames, PLACES[:4], VELOCITIES)
    between = np.linspace(0, 40, 97)
    assert_allclose(places(track, between), spline(between), rtol=0, atol=1e-12)
    # One of them leaves its neighbours as they were but for the slope there.
    mixed = track_of(*frames, velocity=[None, VELOCITIES[1], None, None])
    assert_allclose(slopes(mixed, 10), [VELOCITIES[1]] * 2, rtol=0, atol=1e-3)
    assert_allclose(*slopes(mixed, 16), rtol=0, atol=1e-3)
    assert_allclose(slopes(mixed, STEP)[1], 0, rtol=0, atol=1e-3)


@pytest.mark.parametrize(
    ("before", "after", "is_led"),
    [
        (LINEAR, Easing((0.1, 0.2, 0.6, 0.7)), True),
        (PRESETS["in"], PRESETS["out"], True),
        (PRESETS["in"], PRESETS["in"], False),
        (LINEAR, HOLD, False),
        (Easing((0.2, 0.0, 1.0, 0.4)), LINEAR, False),
    ],
)
def test_easings_that_stand_still_or_jump_at_a_key_leave_no_velocity_there(before, after, is_led):
    track = track_of(
        0, 10, 30, easing=[before, after, LINEAR], velocity=[None, VELOCITIES[1], None]
    )
    without = track_of(0, 10, 30, easing=[before, after, LINEAR])
    for slope, other in zip(slopes(track, 10), slopes(without, 10), strict=True):
        assert_allclose(slope, VELOCITIES[1] if is_led else other, rtol=0, atol=2e-3)


@pytest.mark.parametrize("passing", [TangentMode.CORNER, TangentMode.STOP])
def test_a_velocity_is_of_keys_that_are_passed_through(passing):
    passings = [TangentMode.SMOOTH, passing, TangentMode.SMOOTH]
    led = track_of(0, 10, 30, tangent_mode=passings, velocity=[None, 99j, None])
    frames = np.linspace(0, 30, 61)
    assert (places(led, frames) == places(track_of(0, 10, 30, tangent_mode=passings), frames)).all()


def test_the_seam_of_a_loop_has_one_velocity_or_none():
    there, shown = [*PLACES[:3], PLACES[0]], clip(loop=True)

    def seam(first, last):
        track = track_of(0, 10, 30, 48, places=there, velocity=[first, None, None, last])
        coming, going = places(track, [48 - STEP, STEP], shown)
        return (there[0] - coming) / STEP, (going - there[0]) / STEP

    assert_allclose(seam(2 - 1j, 2 - 1j), 2 - 1j, rtol=0, atol=1e-3)
    for velocities in ((2 - 1j, None), (None, 2 - 1j), (2 - 1j, 1j)):
        assert_allclose(seam(*velocities), seam(None, None), rtol=0, atol=1e-9)


@given(st.floats(0.01, 39.99), st.integers(0, 5))
def test_track_stays_when_a_key_is_set_at_its_own_velocity(frame, delay):
    track = track_of(0, 10, 16, 40, velocity=VELOCITIES, delay=delay)
    at, velocity = track_at(track, clip(), frame + delay), velocity_at(track, clip(), frame + delay)
    if frame in {0.0, 10.0, 16.0}:
        return
    keys = [*track.keys, TrackKey(frame=frame, place=at.place, velocity=velocity)]
    more = replace(track, keys=tuple(sorted(keys, key=lambda key: key.frame)))
    between = np.linspace(delay, 40 + delay, 21)
    assert_allclose(places(more, between), places(track, between), rtol=0, atol=1e-7)


def test_where_no_key_tells_a_velocity_a_new_one_has_none():
    plain, eased = track_of(0, 10, 30), track_of(0, 10, 30, easing=[PRESETS["in"]] * 3)
    led = track_of(0, 10, 30, 40, velocity=[None, None, None, 1j])
    for track, frame in ((plain, 5), (eased, 5), (led, 5), (led, 40), (led, 41), (led, -1)):
        assert velocity_at(track, clip(), frame) is None
    assert velocity_at(led, clip(), 35) is not None


def test_a_corner_comes_and_goes_straight():
    passings = [TangentMode.CORNER] * 3
    track = track_of(0, 10, 30, tangent_mode=passings)
    frames = np.linspace(0, 30, 61)
    straight = np.interp(frames, [0, 10, 30], PLACES[:3])
    assert_allclose(places(track, frames), straight, rtol=0, atol=1e-14)


def test_a_stop_and_a_place_that_is_given_twice_come_to_rest():
    stopped = track_of(0, 10, 30, tangent_mode=["through", "stop", "through"])
    twice = track_of(0, 10, 20, 30, places=[0, 5 + 1j, 5.004 + 1j, 2j])
    for track, frame in ((stopped, 10), (twice, 10), (twice, 20)):
        assert_allclose(slopes(track, frame), [0, 0], rtol=0, atol=2e-3)
    assert_allclose(places(twice, np.linspace(10, 20, 9)), 5 + 1j, rtol=0, atol=0.005)


def test_a_place_rests_while_the_turn_goes_on():
    track = track_of(0, 10, 30, places=[5, 5, 9], turns=(0.0, 1.0, 2.0))
    assert_allclose(places(track, np.linspace(0, 10, 9)), 5, rtol=0, atol=0)
    turns = [track_at(track, clip(), frame).turn for frame in (10 - STEP, 10, 10 + STEP)]
    assert_allclose(np.diff(turns) / STEP, 0.25 / 3 * np.ones(2), rtol=0, atol=1e-4)


def test_a_held_place_stays_until_the_next_key():
    track = track_of(0, 10, 20, easing=[LINEAR, HOLD, LINEAR])
    assert [track_at(track, clip(), frame).place for frame in (10, 15, 19.99)] == [PLACES[1]] * 3
    assert track_at(track, clip(), 20).place == PLACES[2]
    # It is reached and left as where nothing moves.
    assert_allclose(slopes(track, 10)[0], (PLACES[1] - PLACES[0]) / 10, rtol=0, atol=1e-3)


def test_a_late_track_does_the_same_later():
    frames = np.linspace(0, 30, 41)
    late = track_of(0, 10, 30, delay=7)
    assert (places(late, frames + 7.0) == places(track_of(0, 10, 30), frames + 7.0 - 7.0)).all()
    assert track_at(late, clip(), 6.9) is None
    # Past the end of what does not loop, nobody sees it.
    assert track_at(track_of(40, 48, delay=4), clip(), 43) is None


def test_in_a_loop_a_late_track_comes_round():
    track, shown = track_of(30, 40, 46, delay=10), clip(loop=True)
    acting = [frame for frame in range(49) if track_at(track, shown, frame)]
    assert acting == [*range(9), *range(40, 49)]
    assert track_at(track, shown, 2).place == PLACES[1]  # the key at 40
    assert track_at(track, shown, 8).place == PLACES[2]
    assert track_at(track, shown, 0) == track_at(track, shown, 48)
    assert_allclose(*slopes(track, 0, shown), rtol=0, atol=1e-3)
    for frame in (-3, 49.5, 100, 1_000.25):
        assert track_at(track, shown, frame) == track_at(track, shown, frame % 48)


def test_the_last_frame_of_a_loop_is_its_first_one_for_keys_at_either():
    shown = clip(58, 10, loop=True)
    for track in (track_of(50, 58), track_of(10, 18)):
        assert track_at(track, shown, 10) == track_at(track, shown, 58)
        assert track_at(track, shown, 10) is not None
    assert track_at(track_of(50, 58), shown, 11) is None


@pytest.mark.parametrize("delay", [0, 5, 48])
def test_a_track_over_all_of_a_loop_passes_its_seam_as_it_passes_its_keys(delay):
    track = track_of(0, 10, 30, 48, places=[*PLACES[:3], PLACES[0]], delay=delay)
    shown = clip(loop=True)
    coming = (places(track, [delay - STEP], shown)[0] - PLACES[0]) / -STEP
    going = (places(track, [delay + STEP], shown)[0] - PLACES[0]) / STEP
    parabola = np.polyfit([-18.0, 0.0, 10.0], [PLACES[2], PLACES[0], PLACES[1]], 2)
    assert_allclose([coming, going], parabola[1], rtol=0, atol=1e-3)
    # With other ends it jumps there, and neither end is bent by the other one.
    open_ended = track_of(0, 10, 30, 48)
    assert [track_at(open_ended, shown, frame).place for frame in (0, 48)] == [
        PLACES[0],
        PLACES[3],
    ]
    assert_allclose(slopes(open_ended, STEP, shown)[1], 0, rtol=0, atol=1e-3)


@given(
    st.lists(st.tuples(st.integers(1, 20), st.integers(-3, 3)), min_size=2, max_size=6),
    st.data(),
)
def test_a_track_is_continuous_and_its_slope_too_where_keys_are_passed_through(steps, data):
    frames = np.cumsum([length for length, _ in steps]).tolist()
    easing = [data.draw(st.sampled_from(list(PRESETS.values())[:4])) for _ in steps]
    track = track_of(
        *frames, places=[complex(x, -0.5 * x) for _, x in steps], easing=easing, delay=3
    )
    shown = clip(130)
    for key in track.keys[1:-1]:
        frame = key.frame + 3
        coming, going = slopes(track, frame, shown)
        assert_allclose(coming, going, rtol=0, atol=0.02)
