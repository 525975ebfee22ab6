"""How soon the picture answers, in frames."""

from functools import partial
from itertools import count

import numpy as np
import pytest

from app.document import (
    Clip,
    Pose,
    channel_commands,
    pose_channel,
    segment_keys,
    segment_time_at,
    shape_commands,
)
from app.document.keyframe import Target
from app.editor.actions import editing, playback
from app.editor.actions.posing.pose_drag import drag_handles, release_drag
from app.editor.actions.posing.pose_solver import POSING, STEPS
from app.motion import PoseSampler
from app.motion.inbetweens.pins.auto_pins import AutoPins
from app.motion.inbetweens.segment_keys import segment_key

HAND = object()


def pull(window, bar, by):
    """Pull a handle, and let the solver be as quick as can be."""
    target = Target(position=bar.document.layers[0].handle(1).position + by)
    assert window.session.jobs.wait_until_idle()
    window.act(partial(drag_handles, gesture=HAND), {1: target})
    assert window.session.jobs.wait_until_idle()
    window.frames()
    return target


def test_the_picture_follows_a_pull_in_the_next_frame(window, bar):
    for step in range(1, 6):
        target = pull(window, bar, 40j * step)
        assert bar.layer_runtime.shown.pose.targets[1] == target


def test_a_slow_solver_shows_every_step(window, bar):
    window.session.clock = count().__next__  # each look at the clock takes a second
    pull(window, bar, 40j)
    assert bar.visible_drag.steps == 1
    # Nor does the picture wait while the hand rests.
    for steps in (2, 3):
        assert window.session.jobs.wait_until_idle()
        window.frames()
        assert bar.visible_drag.steps == steps


def test_a_hand_that_moves_sees_every_step(window, bar):
    for step in range(1, 6):
        pull(window, bar, 40j * step)
        assert 1 <= bar.visible_drag.steps <= STEPS


def test_a_hand_that_rests_gets_as_many_steps_as_fit_before_the_next_picture(window, bar):
    window.session.clock = lambda: 0.0  # all of them fit
    pull(window, bar, 60j)
    assert not bar.visible_drag.solver.is_over
    assert window.session.jobs.wait_until_idle()
    window.frames()
    assert bar.visible_drag.solver.is_over
    assert bar.visible_drag.steps > STEPS


def test_nothing_moves_once_the_pose_rests(window, bar):
    pull(window, bar, 60j)
    assert not bar.visible_drag.is_at_rest
    window.settle()
    assert bar.visible_drag.is_at_rest
    rested, shown = bar.document, bar.layer_runtime.shown.positions
    window.frames(20)
    assert POSING not in window.session.jobs.kinds
    window.act(release_drag)
    window.settle()
    window.frames(20)
    assert bar.visible_drag is None
    assert bar.document is rested
    np.testing.assert_array_equal(bar.layer_runtime.shown.positions, shown)


@pytest.mark.usefixtures("everything")
def test_in_between_is_of_the_seen_pose_until_the_drag_rests(window, bent, check):
    window.session.clock = count().__next__  # the solver takes one step at a time
    target = pull(window, bent, 80j)
    seen = bent.layer_runtime.shown.pose
    window.act(playback.scrub, 12)
    exact = []
    while bent.drag is not None:
        assert window.session.jobs.wait_until_idle()
        window.frames()
        shown = bent.layer_runtime.shown
        assert (shown.frame, shown.clip) == (12, bent.clip)
        assert bent.drag is None or bent.layer.key(24).pose is seen
        # Of the motion from key to key; how handles stay in it comes a moment later.
        exact.append(shown.placeholder is None)
        check()
        assert len(exact) < 200
    # A key stands in before the first exact one, and never after it.
    assert exact.index(True) <= 2
    assert all(exact[exact.index(True) : -1])
    assert len(exact) > 4
    pose = bent.layer.key(24).pose
    assert pose.targets[1] == target
    place = bent.layer.map_of(pose)(np.array([bent.layer.handle(1).position]))[0]
    assert abs(place - target.position) < 2
    window.act(editing.undo)
    assert bent.layer.key(24).pose.targets[1] != target


@pytest.fixture
def check(bent):
    """What fails unless the right key is shown, or exactly an in-between of the right two."""
    sampler = PoseSampler(bent.layer, domain=bent.layer_runtime.store.mesh.domain)

    def look():
        shown, clip = bent.layer_runtime.shown, bent.clip
        assert shown.clip == clip
        moment = segment_time_at(clip, shown.frame)
        if isinstance(shown.placeholder, Clip):
            # The frame before the last change; it was looked at then.
            return
        if shown.pose is None and not isinstance(shown.placeholder, Pose):
            if shown.placeholder is not None:
                assert shown.placeholder.segment_key == segment_key(clip, moment.segment)
                moment = moment._replace(weight=shown.placeholder.weight)
            pins = AutoPins(clip, clip.layer.variant, sampler)
            exact = pins.inbetweens(moment.segment, sampler)
            expected = exact.frame(moment.weight).positions
            if shown.correction is not None:
                expected = shown.correction.on(expected, shown.mesh.coordinates)
        else:
            pose = shown.pose or shown.placeholder
            around = [clip.keys[key].pose for key in segment_keys(clip)[moment.segment]]
            assert pose in ([key.pose for key in clip.keys] if shown.is_current else around)
            expected = shown.mesh.pose_vertices(pose)
        assert np.abs(shown.positions - expected).max() < 0.02, (shown.frame, shown.placeholder)

    return look


@pytest.mark.parametrize(
    ("variant", "ends"),
    [
        ("nu", (release_drag,)),
        pytest.param("metric", (release_drag, None), marks=pytest.mark.long),
    ],
    ids=["let go", "held, too"],
)
def test_what_is_shown_after_a_drag_is_never_wrong(window, bent, check, variant, ends):
    editing.edit_layer(window.session, shape_commands.set_variant, variant)
    window.settle()
    window.session.clock = count(step=1 / 60).__next__

    def on(*verb):
        window.act(*verb)
        check()
        for _ in range(2):
            assert window.session.jobs.wait_until_idle()
            window.frames()
            check()

    window.act(
        editing.edit_document,
        channel_commands.copy_keys({pose_channel(bent.selection.active): {0}}, 48),
    )
    window.settle()
    for end in ends:
        playback.scrub(window.session, 24)
        window.settle()
        pull(window, bent, 70j)
        if end is not None:
            window.act(end)
        for frame in (23, 40, 2):
            on(playback.scrub, frame)
        on(playback.toggle_play)
        on(playback.stop_playback)
        on(editing.undo)
        on(editing.redo)
    on(
        editing.edit_document,
        channel_commands.delete_keys({pose_channel(bent.selection.active): {48}}),
    )
    on(playback.scrub, 12)
