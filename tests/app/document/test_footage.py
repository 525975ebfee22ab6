"""The time of footage, as mathematics."""

from fractions import Fraction
from math import floor

import pytest
from hypothesis import given, strategies as st

from app.document import Footage, FootageTime
from app.errors import LissomError


def footage(count=10, fps=24.0, **changes):
    known = {"name": "walk", "folder": "/", "files": ("walk.mp4",), "size": (4, 3)}
    return Footage(**known | {"fps": fps, "picture_count": count} | changes)


RATES = st.sampled_from([8, 12, 24, 25, 30, 50, 60])


@given(RATES, RATES, st.integers(0, 500), st.integers(0, 9), st.sampled_from([-2, -1, 0, 1, 3]))
def test_looped_frames_are_those_of_rational_arithmetic(own, fps, frame, start, speed):
    time = FootageTime(start=start, speed=speed, loops=True)
    expected = floor(start + Fraction(frame, fps) * own * speed) % 10
    moving = footage(fps=float(own))
    assert moving.picture_of(moving.frame_at(time, frame / fps)) == expected


@given(RATES, RATES, st.integers(0, 500), st.integers(0, 9), st.sampled_from([-2, -1, 0, 1, 3]))
def test_held_frames_are_those_of_rational_arithmetic(own, fps, frame, start, speed):
    exact = start + Fraction(frame, fps) * own * speed
    moving = footage(fps=float(own))
    held = moving.frame_at(FootageTime(start=start, speed=speed), frame / fps)
    assert moving.picture_of(held) == floor(min(max(exact, 0), 9))


def test_24_frames_a_second_in_30_repeat_each_fourth_picture():
    moving = footage(count=100)
    shown = [moving.picture_of(moving.frame_at(FootageTime(), frame / 30)) for frame in range(11)]
    assert shown == [0, 0, 1, 2, 3, 4, 4, 5, 6, 7, 8]


def test_pictures_last_as_many_frames_as_they_hold():
    moving = footage(count=3, fps=10.0, holds=(2, 1, 4))
    assert moving.frame_count == 7
    assert [moving.picture_of(frame) for frame in range(7)] == [0, 0, 1, 2, 2, 2, 2]
    looped = FootageTime(loops=True)
    assert moving.picture_of(moving.frame_at(looped, 0.75)) == 0


def test_the_key_frame_holds_before_the_key():
    assert footage().frame_at(FootageTime(start=4), -3.0) == 4


@pytest.mark.parametrize(
    "wrong",
    [
        {"fps": 0.0},
        {"fps": float("nan")},
        {"picture_count": 0},
        {"files": ()},
        {"files": ("a", "b", "c")},
        {"holds": (1, 2)},
        {"picture_count": 2, "holds": (1, 0)},
        {"size": (0, 3)},
    ],
)
def test_impossible_footage_is_refused(wrong):
    with pytest.raises(LissomError):
        footage(**wrong)


@pytest.mark.parametrize("wrong", [{"speed": 101.0}, {"start": 1e9}, {"speed": float("nan")}])
def test_an_impossible_time_is_refused(wrong):
    with pytest.raises(LissomError):
        FootageTime(**wrong)
