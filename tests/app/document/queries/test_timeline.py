"""Frames, moments and the playhead."""

from dataclasses import replace

import numpy as np
import pytest
from documents import altered, disc_document
from hypothesis import given, strategies as st
from numpy.testing import assert_allclose

from app.document.channels.easing import HOLD, PRESETS
from app.document.channels.springs import Spring
from app.document.channels.tangent_mode import TangentMode
from app.document.commands.handle_commands import add_handle
from app.document.commands.keys.key_commands import replace_key_pose
from app.document.keyframe import Keyframe, Target
from app.document.playhead import Playhead
from app.document.queries.clips import clip_of
from app.document.queries.key_segments import loop_segment, segment_keys
from app.document.queries.timeline import (
    SegmentTime,
    export_frame_range,
    frame_times,
    segment_time_at,
)
from app.document.settings import FrameRange
from app.errors import LissomError

EMPTY = disc_document()
MIDDLE = 100 + 100j


def keyed(*frames, last=48, first=0, easing=PRESETS["linear"], **settings):
    pose = EMPTY.layers[0].keys[0].pose
    keys = tuple(
        Keyframe(frame=frame, pose=pose, easing=easing, tangent_mode=TangentMode.CORNER)
        for frame in frames
    )
    return altered(EMPTY, keys=keys, frames=FrameRange(first, last), **settings)


@pytest.mark.parametrize(
    ("frame", "moment"),
    [
        (-5, (0, 0.0)),
        (0, (0, 0.0)),
        (10, (0, 0.0)),
        (15, (0, 0.5)),
        (20, (1, 0.0)),
        (25.5, (1, 0.55)),
        (30, (1, 1.0)),
        (40, (1, 1.0)),
        (99, (1, 1.0)),
    ],
)
def test_poses_stand_still_before_the_first_key_and_after_the_last(frame, moment):
    assert segment_time_at(clip_of(keyed(10, 20, 30), 0), frame) == SegmentTime(*moment)


@pytest.mark.parametrize(
    ("frame", "moment"),
    [
        (0, (2, 18 / 28)),
        (9, (2, 27 / 28)),
        (10, (0, 0.0)),
        (30, (2, 0.0)),
        (31, (2, 1 / 28)),
        (48, (2, 18 / 28)),
    ],
)
def test_a_loop_leads_from_the_last_key_to_the_first(frame, moment):
    # The gap leads from 30 over 48, which is 0 again, to 10: 28 frames.
    shown = segment_time_at(clip_of(keyed(10, 20, 30, loop=True), 0), frame)
    assert_allclose(shown, moment, rtol=0, atol=1e-15)


def test_a_loop_comes_round_beyond_its_ends_but_shows_both_of_them():
    document = keyed(0, 24, 48, loop=True)
    assert segment_time_at(clip_of(document, 0), 48) == (1, 1.0)
    assert segment_time_at(clip_of(document, 0), 49) == segment_time_at(clip_of(document, 0), 1)
    assert segment_time_at(clip_of(document, 0), -1) == segment_time_at(clip_of(document, 0), 47)
    assert loop_segment(clip_of(document, 0)) is None


@given(
    st.sets(st.integers(3, 60), min_size=1, max_size=6),
    st.booleans(),
    st.floats(-100, 200, allow_nan=False),
)
def test_moments_are_the_linear_interpolation_of_the_keys(frames, loop, frame):
    frames = sorted(frames)
    document = keyed(*frames, first=2, last=70, loop=loop)
    values = np.sin(np.arange(len(frames)) * 2.3)
    interval, weight = segment_time_at(clip_of(document, 0), frame)
    assert interval in range(len(frames))
    assert 0 <= weight <= 1
    if weight:
        assert (interval, (interval + 1) % len(frames)) in segment_keys(clip_of(document, 0))
    shown = (1 - weight) * values[interval] + weight * values[(interval + 1) % len(values)]
    period = 68 if loop else None
    assert_allclose(shown, np.interp(frame, frames, values, period=period), rtol=0, atol=1e-9)


def test_hold_and_easing():
    document = keyed(0, 10, 20, easing=HOLD)
    assert [segment_time_at(clip_of(document, 0), f) for f in (9.99, 10, 19, 20)] == [
        (0, 0),
        (1, 0),
        (1, 0),
        (1, 1),
    ]
    eased = keyed(0, 10, easing=PRESETS["in"])
    assert segment_time_at(clip_of(eased, 0), 5) == (0, PRESETS["in"](0.5))


def test_one_key_is_a_still_picture():
    for loop in (False, True):
        document = keyed(7, loop=loop)
        assert {segment_time_at(clip_of(document, 0), frame) for frame in range(-3, 60)} == {
            SegmentTime(0, 0.0)
        }
        assert segment_keys(clip_of(document, 0)) == ()
    assert segment_time_at(clip_of(keyed(7, first=7, last=7, loop=True), 0), 9) == (0, 0.0)


def test_intervals():
    assert segment_keys(clip_of(keyed(0, 9, 20), 0)) == ((0, 1), (1, 2))
    assert segment_keys(clip_of(keyed(0, 9, 20, loop=True), 0)) == ((0, 1), (1, 2), (2, 0))
    assert segment_keys(clip_of(keyed(0, 9, 48, loop=True), 0)) == ((0, 1), (1, 2))


def test_exports_keep_the_last_frame_of_a_loop_that_ends_elsewhere():
    document = add_handle(0, EMPTY.layers[0].domain.mesh.vertices[0])(keyed(0, 48, loop=True))
    assert export_frame_range(document) == FrameRange(0, 47)
    pose = document.layers[0].keys[1].pose
    moved = {i: replace(target, position=0j) for i, target in pose.targets.items()}
    posed = replace_key_pose(0, 48, replace(pose, targets=moved))(document)
    assert export_frame_range(posed) == FrameRange(0, 48)


def test_exports_leave_out_the_frame_that_a_loop_repeats():
    assert export_frame_range(keyed(0, 9)) == FrameRange(0, 48)
    assert export_frame_range(keyed(0, 9, loop=True)) == FrameRange(0, 47)
    assert export_frame_range(keyed(0, last=0, loop=True)) == FrameRange(0, 0)
    assert export_frame_range(keyed(0, 9, loop=True, preview=FrameRange(3, 8))) == FrameRange(0, 47)
    assert export_frame_range(keyed(0, 48, loop=True)) == FrameRange(0, 47)
    assert export_frame_range(keyed(10, 30, loop=True)) == FrameRange(0, 47)
    chosen = replace(EMPTY.export, frames=FrameRange(5, 48))
    assert export_frame_range(keyed(0, 9, loop=True, export=chosen)) == FrameRange(5, 48)


def test_what_follows_does_not_keep_a_loop_from_closing():
    document = add_handle(0, MIDDLE)(keyed(0, 48, loop=True))
    layer = document.layers[0]
    first, last = layer.keys
    carried = replace(last.pose, targets={0: Target(position=MIDDLE + 1e-3j)})
    changed = altered(document, keys=(first, replace(last, pose=carried)))
    assert export_frame_range(changed) == FrameRange(0, 48)
    spring = Spring(handle=0, frequency=2.0, damping=0.2)
    assert export_frame_range(altered(changed, springs=(spring,))) == FrameRange(0, 47)


def test_frame_times_at_another_rate():
    document = keyed(0, 9, fps=24.0)
    assert frame_times(document, FrameRange(3, 6)) == [3, 4, 5, 6]
    assert frame_times(document, FrameRange(3, 6), 48.0) == [3, 3.5, 4, 4.5, 5, 5.5, 6]
    assert frame_times(document, FrameRange(3, 6), 12.0) == [3, 5]
    # 24 · 0.1 is not exact in binary, but the last picture must be there.
    times = frame_times(document, FrameRange(0, 24), 30.0)
    assert_allclose(times, np.arange(31) * 0.8, rtol=0, atol=1e-12)
    assert times[-1] == 24
    for fps in (0.0, -1.0, float("nan"), float("inf")):
        with pytest.raises(LissomError, match="frames per second"):
            frame_times(document, FrameRange(0, 1), fps)


@given(st.integers(0, 47), st.integers(0, 3000), st.sampled_from([12, 23.976, 24, 25, 29.97, 60]))
def test_the_playhead_shows_frame_n_when_the_clock_reads_n_frames(start, n, fps):
    document = keyed(0, 9, fps=float(fps), loop=True)
    running = Playhead(frame=start).play(document, 1000.0)
    assert running.frame_at(document, 1000.0 + n / fps) == (start + n) % 48


def test_the_playhead_stops_at_the_end_without_a_loop():
    document = keyed(0, 9, last=48)
    running = Playhead(frame=40).play(document, 5.0)
    assert running.frame_at(document, 5.0 + 7 / 24) == 47
    assert not running.is_over(document, 5.0 + 7 / 24)
    assert running.frame_at(document, 99.0) == 48
    assert running.is_over(document, 5.0 + 8 / 24)
    at_end = running.pause(document, 99.0)
    assert (at_end.frame, at_end.since) == (48, None)
    assert not at_end.is_over(document, 99.0)
    assert at_end.play(document, 100.0).frame == 0


def test_the_playhead_runs_backwards_and_at_other_speeds():
    document = keyed(0, 9, last=48, loop=True)
    back = Playhead(frame=2, speed=-2.0).play(document, 0.0)
    assert [back.frame_at(document, n / 48) for n in range(6)] == [2, 1, 0, 47, 46, 45]
    once = keyed(0, 9, last=48)
    back = Playhead(frame=0, speed=-1.0).play(once, 0.0)
    assert back.frame == 48
    assert back.is_over(once, 2.0)
    assert not back.is_over(once, 1.0)
    slow = Playhead(speed=1.0).play(once, 0.0).at_speed(0.5, once, 1.0)
    assert slow.frame == 24
    assert slow.frame_at(once, 2.0) == 36
    for speed in (0.0, float("nan"), float("inf")):
        with pytest.raises(LissomError, match="speed"):
            Playhead(speed=speed)


def test_the_playhead_stays_in_the_preview_range_while_it_plays():
    document = keyed(0, 9, last=48, loop=True, preview=FrameRange(10, 12))
    running = Playhead(frame=30).play(document, 0.0)
    assert [running.frame_at(document, n / 24) for n in range(5)] == [10, 11, 12, 10, 11]
    assert Playhead(frame=30).frame_at(document, 9.0) == 30
    one = keyed(0, 9, last=48, loop=True, preview=FrameRange(7, 7))
    assert Playhead().play(one, 0.0).frame_at(one, 1.3) == 7
    still = keyed(0, last=0, loop=True)
    assert Playhead().play(still, 0.0).frame_at(still, 1.3) == 0


def test_seeking_keeps_running():
    document = keyed(0, 9)
    running = Playhead().play(document, 0.0).seek(20, 3.0)
    assert running.frame_at(document, 3.0 + 2 / 24) == 22
    assert Playhead().seek(20, 3.0).frame_at(document, 9.0) == 20
