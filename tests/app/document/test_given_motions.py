"""Ready motions of a layer, and where their frames go as keys are moved and time is scaled."""

from dataclasses import replace

import pytest
from documents import altered, disc_document

from app.document import channel_commands as channels, pose_channel
from app.document.channels.cycles import Cycle
from app.document.commands import scene_commands
from app.document.keyframe import Keyframe
from app.document.queries.applied_motion import (
    digest_motion,
    is_motion_unedited,
    keys_of_motion,
)
from app.document.rig.applied_motion import AppliedMotion
from app.document.settings import FrameRange
from app.rigging import Parameters

POSES = pose_channel(0)

POSE = disc_document().layers[0].keys[0].pose
BREATHE = AppliedMotion(
    id=1,
    motion="breathe",
    kind="anything",
    joints={},
    facing=1,
    parameters=Parameters(),
    first=10,
    start=10,
    last=30,
)


def breathing(*frames, motions=(BREATHE,), cycles=()):
    """Return a document whose layer has keys at some frames, and motions that made some of them."""
    made = {
        frame: each.id for each in motions for frame in frames if each.first <= frame <= each.last
    }
    keys = tuple(Keyframe(frame=frame, pose=POSE, motion=made.get(frame)) for frame in frames)
    document = altered(disc_document(), keys=keys, cycles=cycles, frames=FrameRange(0, 100))
    layer = document.layers[0]
    given = (replace(each, digest=digest_motion(layer, each)) for each in motions)
    return altered(document, motions=tuple(given))


def own_frames(layer):
    """Return the frames of the keys of a layer's first motion."""
    return [key.frame for key in keys_of_motion(layer, layer.motions[0])]


def moved(document, frames, by):
    return channels.move_keys({POSES: frames}, by)(document).layers[0]


def ranges(layer):
    return [(each.first, each.start, each.last) for each in layer.motions]


def test_a_motion_goes_with_all_of_its_keys_as_it_was_given():
    layer = moved(breathing(0, 10, 20, 30, 80), {10, 20, 30}, 40)
    assert ranges(layer) == [(50, 50, 70)]
    assert is_motion_unedited(layer, layer.motions[0])


def test_a_motion_that_repeats_goes_with_its_cycle():
    cycle = Cycle(first=10, last=20, until=30)
    document = breathing(10, 14, cycles=(cycle,))
    layer = moved(document, {10, 14}, 5)
    assert layer.cycles == (Cycle(first=15, last=25, until=35),)
    assert ranges(layer) == [(15, 15, 35)]
    assert is_motion_unedited(layer, layer.motions[0])


def test_a_motion_that_was_edited_stays_edited_when_it_is_moved():
    document = channels.delete_keys({POSES: {20}})(breathing(10, 20, 30))
    layer = moved(document, {10, 30}, 5)
    assert ranges(layer) == [(15, 15, 35)]
    assert not is_motion_unedited(layer, layer.motions[0])


@pytest.mark.parametrize(
    ("frames", "by", "expected"),
    [({30}, 5, (10, 10, 35)), ({10}, -5, (5, 5, 30)), ({20}, 5, (10, 10, 30))],
)
def test_the_ends_of_a_motion_go_with_the_keys_there(frames, by, expected):
    layer = moved(breathing(0, 10, 20, 30, 80), frames, by)
    assert ranges(layer) == [expected]
    assert not is_motion_unedited(layer, layer.motions[0])


def test_motion_knows_its_keys_among_others():
    layer = moved(breathing(10, 20, 30, 40), {30}, 20)
    assert ranges(layer) == [(10, 10, 50)]
    assert own_frames(layer) == [10, 20, 50]
    copied = channels.copy_keys({POSES: {20}}, 3)(breathing(10, 20, 30)).layers[0]
    assert own_frames(copied) == [10, 20, 30]


def test_motions_may_overlap_after_their_keys_were_moved():
    later = replace(BREATHE, id=2, first=40, start=40, last=60)
    layer = moved(breathing(10, 20, 30, 40, 60, motions=(BREATHE, later)), {40, 60}, -15)
    assert ranges(layer) == [(10, 10, 30), (25, 25, 45)]
    assert own_frames(layer) == [10, 20, 30]


def test_a_motion_is_scaled_with_its_keys():
    document = breathing(0, 10, 20, 30, 80)
    layer = channels.scale_keys({POSES: {10, 20, 30}}, 2.0)(document).layers[0]
    assert ranges(layer) == [(10, 10, 50)]
    assert not is_motion_unedited(layer, layer.motions[0])


def test_a_motion_is_scaled_with_the_scene():
    assert ranges(scene_commands.scale_time(0.5)(breathing(0, 10, 20, 30)).layers[0]) == [
        (5, 5, 15)
    ]
    assert ranges(scene_commands.scale_time(0.01)(breathing(20)).layers[0]) == []
