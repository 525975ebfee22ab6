"""How keys are passed: joints, corners, stops and holds, in a row and around a loop."""

from dataclasses import astuple, replace

import pytest
from documents import altered, disc_document, random_pose
from numpy import random
from numpy.testing import assert_allclose

from app.document import channel_commands as channels, pose_channel
from app.document.channels.easing import HOLD, LINEAR, PRESETS, Easing
from app.document.channels.tangent_mode import TangentMode
from app.document.keyframe import Keyframe
from app.document.queries.clips import clip_of
from app.document.queries.pose_tangents import pose_segments
from app.document.queries.timeline import segment_time_at
from app.document.settings import FrameRange
from app.errors import LissomError
from engine.interpolation import InteriorKnot

CHANNEL = pose_channel(0)

EMPTY = disc_document()
POSES = [random_pose(random.default_rng(seed), EMPTY) for seed in range(6)]


def keyed(*frames, last=48, loop=False, poses=POSES, **changes):
    """Return a clip with keys at some frames; `changes` has values for each of them."""
    keys = [
        Keyframe(frame=frame, pose=pose, **{name: values[i] for name, values in changes.items()})
        for i, (frame, pose) in enumerate(zip(frames, poses, strict=False))
    ]
    document = altered(EMPTY, keys=tuple(keys), frames=FrameRange(0, last), loop=loop)
    return clip_of(document, 0)


def ends(clip):
    return [(segment.start, segment.end) for segment in pose_segments(clip)]


def test_new_keys_between_others_are_passed_through():
    clip = keyed(0, 10, 30, 48)
    one, other = InteriorKnot(10, 20), InteriorKnot(20, 18)
    assert ends(clip) == [(1.0, one), (one, other), (other, 1.0)]
    frames = [[key.frame for key in segment.keys] for segment in pose_segments(clip)]
    assert frames == [[0, 10, 30], [0, 10, 30, 48], [10, 30, 48]]


def test_two_keys_are_blended_straight_whatever_is_set():
    assert ends(keyed(0, 20)) == [(1.0, 1.0)]
    assert segment_time_at(keyed(0, 20), 5).weight == 0.25
    stopped = keyed(0, 20, tangent_mode=[TangentMode.STOP, TangentMode.STOP])
    assert_allclose(segment_time_at(stopped, 5).weight, 0.25**2 * (3 - 0.5), rtol=1e-15)
    assert not pose_segments(stopped)[0].has_smooth_tangent


def test_a_corner_and_a_stop_take_no_heed_of_other_keys():
    passings = [TangentMode.SMOOTH, TangentMode.CORNER, TangentMode.STOP, TangentMode.SMOOTH]
    clip = keyed(0, 10, 30, 48, tangent_mode=passings)
    assert ends(clip) == [(1.0, 1.0), (1.0, 0.0), (0.0, 1.0)]
    assert segment_time_at(clip, 5).weight == 0.5
    slow, fast = segment_time_at(clip, 29.9).weight, segment_time_at(clip, 10.1).weight
    assert 1 - slow < 1e-4 < fast < 0.006


def test_in_a_loop_the_motion_passes_its_first_and_last_key():
    closing = keyed(0, 10, 30, loop=True)
    joints = [InteriorKnot(18, 10), InteriorKnot(10, 20), InteriorKnot(20, 18)]
    assert ends(closing) == [(joints[i], joints[(i + 1) % 3]) for i in range(3)]
    frames = [[key.frame for key in segment.keys] for segment in pose_segments(closing)]
    assert frames == [[30, 0, 10, 30], [0, 10, 30, 0], [10, 30, 0, 10]]
    # The last key is the first one again.
    around = keyed(0, 10, 30, 48, loop=True, poses=[*POSES[:3], POSES[0]], revolutions=[1, 2, 3, 9])
    assert ends(around) == ends(closing)
    frames = [[key.frame for key in segment.keys] for segment in pose_segments(around)]
    assert frames == [[30, 0, 10, 30], [0, 10, 30, 48], [10, 30, 48, 10]]
    assert [segment.revolutions for segment in pose_segments(around)] == [
        (3, 1, 2),
        (1, 2, 3),
        (2, 3, 1),
    ]
    # Here it is another pose, at which the loop jumps.
    assert ends(keyed(0, 10, 30, 48, loop=True)) == ends(keyed(0, 10, 30, 48))


def test_a_hold_is_left_and_reached_straight():
    clip = keyed(0, 10, 30, 48, easing=[LINEAR, HOLD, LINEAR, LINEAR])
    assert ends(clip) == [(1.0, 1.0), (1.0, 1.0), (1.0, 1.0)]
    assert segment_time_at(clip, 29).weight == 0.0


def test_a_pose_that_is_given_twice_is_kept():
    clip = keyed(0, 10, 30, 48, poses=[POSES[0], POSES[1], POSES[1], POSES[2]])
    assert ends(clip) == [(1.0, 0.0), (0.0, 0.0), (0.0, 1.0)]


def numbers(end):
    """Return how a key is passed as numbers."""
    return astuple(end) if isinstance(end, InteriorKnot) else (end,)


@pytest.mark.parametrize(
    ("before", "after", "reached", "left"),
    [
        ("in-out", "in-out", InteriorKnot(10, 20), InteriorKnot(10, 20)),
        ("in-out", "linear", 1.0, 0.0),
        ("linear", "in", 0.0, 1.0),
        ("in", "linear", *2 * [InteriorKnot(10, 20, end_pace=1 / 0.58)]),
        ("linear", "out", *2 * [InteriorKnot(10, 20, start_pace=1 / 0.58)]),
    ],
)
def test_easings_beside_a_key_agree_on_its_velocity(before, after, reached, left):
    clip = keyed(0, 10, 30, easing=[PRESETS[before], PRESETS[after], LINEAR])
    for found, wanted in ((ends(clip)[0][1], reached), (ends(clip)[1][0], left)):
        assert_allclose(numbers(found), numbers(wanted), rtol=1e-12)


@pytest.mark.parametrize(
    ("curve", "paces"),
    [
        ((0.0, 0.0, 1.0, 1.0), (1.0, 1.0)),
        ((0.5, 0.25, 0.5, 0.75), (0.5, 0.5)),
        ((0.0, 0.0, 0.5, 1.0), (2.0, 0.0)),
        ((0.0, 0.5, 0.5, 0.9), (float("inf"), 0.2)),
        ((0.0, 0.0, 0.0, 0.0), (1.0, 1.0)),
    ],
)
def test_the_paces_of_an_easing(curve, paces):
    easing = Easing(curve)
    assert_allclose(easing.end_speeds, paces, rtol=1e-9)
    assert_allclose(easing.reversed().end_speeds, paces[::-1], rtol=1e-9)


def test_passings_are_set_and_holds_undone():
    document = altered(EMPTY, keys=keyed(0, 10, 30).keys)
    held = channels.set_tangent_mode({CHANNEL: {10, 30}}, TangentMode.HOLD)(document)
    assert [key.shown_tangent_mode for key in held.layers[0].keys] == ["through", "hold", "hold"]
    assert channels.set_tangent_mode({CHANNEL: {10}}, TangentMode.HOLD)(held) is held
    stopped = channels.set_tangent_mode({CHANNEL: {0, 10}}, TangentMode.STOP)(held)
    assert [key.shown_tangent_mode for key in stopped.layers[0].keys] == ["stop", "stop", "hold"]
    assert stopped.layers[0].key(10).easing == LINEAR
    with pytest.raises(LissomError, match="hold is an easing"):
        replace(stopped.layers[0].keys[0], tangent_mode=TangentMode.HOLD)
