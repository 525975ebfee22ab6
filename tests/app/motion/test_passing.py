"""Motion through the keys of a clip: its velocity, and what a changed key has prepared again."""

from dataclasses import replace

import pytest
from documents import altered, disc_document
from key_rows import jump, prepared, row
from numpy.testing import assert_allclose

from app.document.channels.easing import LINEAR, PRESETS, Easing
from app.document.channels.tangent_mode import TangentMode
from app.document.commands.keys import (
    channel_commands,
    key_commands,
)
from app.document.queries.channel_values.channel_keys import pose_channel
from app.document.queries.clips import clip_of
from app.errors import LissomError, listen_to_progress
from app.motion.inbetweens.animation import Animation
from app.motion.inbetweens.pose_sampler import PoseSampler
from engine.maps import Bounds


@pytest.mark.parametrize("easing", [LINEAR, PRESETS["in-out"], Easing((0.3, 0.1, 0.6, 0.9))])
def test_keys_are_passed_at_one_velocity_whatever_the_easings(easing):
    document = row(4, loop=True)
    document = channel_commands.set_easing({pose_channel(0): {10}}, easing)(document)
    animation = Animation(clip_of(document, 0), points=document.layers[0].domain.outline)
    speeds = [jump(animation, frame) for frame in (0.0, 10.0, 20.0, 30.0)]
    largest = max(speed for _, speed in speeds)
    assert max(change for change, _ in speeds) < 1e-5 * largest
    cornered = channel_commands.set_tangent_mode({pose_channel(0): {20}}, TangentMode.CORNER)(
        document
    )
    animation = Animation(clip_of(cornered, 0), points=document.layers[0].domain.outline)
    assert jump(animation, 20.0)[0] > 0.1 * largest


def test_what_is_shown_is_what_the_clip_moves_like():
    document = row(4)
    clip, (store, _) = clip_of(document, 0), prepared(document)
    while build := store.next_build(clip, 13, heat=False):
        store.add_build(build.advance())
    animation = Animation(clip, sampler=store.sampler)
    for frame in (10, 12.5, 17, 20):
        assert_allclose(
            store.vertices(clip, frame).positions, animation.positions(frame), rtol=0, atol=1e-2
        )


def test_a_key_that_changes_has_four_intervals_prepared_again():
    document = row(7)
    store, _ = prepared(document)
    before = store.prepared(clip_of(document, 0))
    pose = document.layers[0].key(20).pose
    posed = key_commands.replace_key_pose(0, 30, replace(pose, phi=1.01 * pose.phi))(document)
    assert prepared(posed, store)[1] == 4
    after = store.prepared(clip_of(posed, 0))
    kept = [new is old for new, old in zip(after, before, strict=True)]
    assert kept == [True, False, False, False, False, True]
    # Corners and stops blend two keys alike, at another pace.
    every = document.layers[0].key_frames
    cornered, stopped = (
        channel_commands.set_tangent_mode({pose_channel(0): every}, passing)(document)
        for passing in (TangentMode.CORNER, TangentMode.STOP)
    )
    store, _ = prepared(cornered)
    assert prepared(stopped, store)[1] == 0


def test_how_much_of_their_velocity_keys_keep_is_reported():
    document = row(4)
    assert prepared(document)[0].velocity_shares(clip_of(document, 0)) == {10: 1.0, 20: 1.0}
    tight = altered(document, bounds=Bounds(k=0.01, sigma_a=1.01, sigma_b=0.99))
    kept = prepared(tight)[0].velocity_shares(clip_of(tight, 0))
    assert kept.keys() == {10, 20}
    assert max(kept.values()) < 0.01
    assert prepared(tight)[0].velocity_shares(clip_of(document, 0)) == {}


def test_transform_is_made_anew_when_it_was_cancelled():
    layer = disc_document(11).layers[0]  # of whose outline nothing is known yet
    sampler = PoseSampler(layer)
    sibling = PoseSampler(layer, sibling=sampler)

    def end(share):
        raise LissomError(f"it was cancelled at {share:.0%}")

    with listen_to_progress(end), pytest.raises(LissomError, match="cancelled"):
        _ = sibling.known.transform
    shares = []
    with listen_to_progress(shares.append):
        assert sibling.known.transform is sampler.known.transform
    assert shares[-1] == 1
