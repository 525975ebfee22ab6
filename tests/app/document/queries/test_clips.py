"""Clips, which are equal where the motion is."""

from dataclasses import replace

import numpy as np
import pytest
from documents import altered, disc_document

from app.document import (
    DEPTH,
    IK_TARGET,
    LAYER_KINDS,
    SLIDER,
    TRANSFORM,
    IkTarget,
    Slider,
    SliderPose,
    Transform,
    key_commands,
)
from app.document.channels.springs import Spring
from app.document.commands import handle_commands
from app.document.keyframe import LibraryPose
from app.document.layers.groups import Group
from app.document.queries.auto_pins import pinned_segments
from app.document.queries.clips import UNMOVING, UNMOVING_OF_HANDLES, clip_of, motion_source
from app.document.rig.applied_motion import UnreadMotion
from app.document.rig.chains import Bone
from app.motion.extents.extent import extent_key
from engine.maps.bounds import Bounds

DOCUMENT = disc_document()
for place in (80 + 100j, 120 + 100j):
    DOCUMENT = handle_commands.add_handle(0, place)(DOCUMENT)
POSES = tuple(SliderPose(at=complex(at), pose=None) for at in (0, 1))
DOCUMENT = altered(DOCUMENT, sliders=(Slider(name="turn", poses=POSES),))
DOCUMENT = replace(DOCUMENT, groups=(Group(name="all"),))
POSE = DOCUMENT.layers[0].keys[0].pose
UNSEEN = {
    "name": "other",
    "next_handle": 9,
    "library": (LibraryPose(name="Pose 1", pose=POSE),),
    "mirror": 10.0,
    "motions": (),
    "unread_motions": (UnreadMotion(index=0, content={}, reason="It is new."),),
    "reference": True,
    "locked": True,
    "hidden": True,
    "opacity": 0.5,
    "blend": "multiply",
    "clipped": True,
    "group": "all",
    "unread_channels": ({"kind": "later"},),
    "unknown": {"later": 1},
}
STILL_CHANNELS = {
    kind: (kind.key(4, kind.default),) for kind in LAYER_KINDS.values() if not kind.moves_layer
}
MOVING_CHANNELS = {
    (TRANSFORM, None): (TRANSFORM.key(4, Transform(shift=3j)),),
    (IK_TARGET, None): (IK_TARGET.key(4, IkTarget(3j)),),
    (DEPTH, 0): (DEPTH.key(4, 0.5),),
    (SLIDER, "turn"): (SLIDER.key(4, 0.5 + 0j),),
}
SEEN = {
    "bones": (Bone(ends=(0, 1)),),
    "stiffness": np.full(12, 2.0),
    "bounds": Bounds(k=0.4),
    "springs": (Spring(handle=0, frequency=2, damping=0.2),),
    "has_auto_pins": False,
    "anchor": 90 + 90j,
}


def test_every_field_without_motion_is_tried():
    assert set(UNSEEN) == UNMOVING


@pytest.mark.parametrize("field", UNSEEN)
def test_clips_are_equal_where_only_other_things_change(field):
    changed = altered(DOCUMENT, **{field: UNSEEN[field]})
    assert clip_of(changed, 0) == clip_of(DOCUMENT, 0)
    assert hash(clip_of(changed, 0)) == hash(clip_of(DOCUMENT, 0))
    if field not in {"reference", "hidden"}:  # which is not exported
        assert extent_key(changed) == extent_key(DOCUMENT)


def test_every_channel_of_a_layer_is_tried():
    tried = {*STILL_CHANNELS, *(kind for kind, _ in MOVING_CHANNELS)}
    assert tried == set(LAYER_KINDS.values())


@pytest.mark.parametrize("kind", STILL_CHANNELS, ids=lambda kind: kind.name)
def test_clips_are_equal_where_channels_without_motion_differ(kind):
    changed = altered(DOCUMENT, channels={(kind.name, None): STILL_CHANNELS[kind]})
    assert clip_of(changed, 0) == clip_of(DOCUMENT, 0)
    assert hash(clip_of(changed, 0)) == hash(clip_of(DOCUMENT, 0))
    assert extent_key(changed) == extent_key(DOCUMENT)


@pytest.mark.parametrize(("kind", "part"), MOVING_CHANNELS)
def test_clips_differ_where_channels_with_motion_differ(kind, part):
    changed = altered(DOCUMENT, channels={(kind.name, part): MOVING_CHANNELS[kind, part]})
    assert clip_of(changed, 0) != clip_of(DOCUMENT, 0)


@pytest.mark.parametrize("field", SEEN)
def test_clips_differ_where_the_motion_does(field):
    changed = altered(DOCUMENT, **{field: SEEN[field]})
    assert clip_of(changed, 0) != clip_of(DOCUMENT, 0)
    assert extent_key(changed) != extent_key(DOCUMENT)


def test_clips_are_equal_where_stiffness_is_painted_alike():
    one, other = (altered(DOCUMENT, stiffness=np.full(12, 2.0)) for _ in range(2))
    assert clip_of(one, 0) == clip_of(other, 0)


def test_pins_are_known_by_the_stiffness_of_paint_and_bones():
    document = key_commands.insert_key(0, 9, POSE)(DOCUMENT)

    def content(**changes):
        (segment,) = pinned_segments(clip_of(altered(document, **changes), 0))
        return segment.content

    assert content(stiffness=np.full(12, 2.0)) == content(stiffness=np.full(12, 2.0))
    bone = Bone(ends=(0, 1))
    different = [
        content(),
        content(stiffness=np.full(12, 2.0)),
        content(bones=(bone,)),
        content(bones=(replace(bone, stiffness=9.0),)),
    ]
    assert len(set(different)) == len(different)


def test_names_and_groups_of_handles_are_no_motion():
    handle, *others = DOCUMENT.layers[0].handles
    assert {"name", "group", "unknown"} == UNMOVING_OF_HANDLES
    for change, is_same in (
        ({"name": "nose"}, True),
        ({"group": "face"}, True),
        ({"unknown": {"later": 1}}, True),
        ({"is_unpinned": True}, False),
        ({"position": 70 + 100j}, False),
    ):
        handles = (replace(handle, **change), *others)
        changed = altered(DOCUMENT, handles=handles).layers[0]
        assert (motion_source(changed) == motion_source(DOCUMENT.layers[0])) == is_same


def test_clips_differ_in_time():
    assert clip_of(replace(DOCUMENT, fps=12.0), 0) != clip_of(DOCUMENT, 0)
    assert clip_of(DOCUMENT, 0) != DOCUMENT
