"""Attached layers that bend as bones: exact joints, targets, sides and transforms."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from chains import chain, exactly
from documents import CENTRE
from numpy.testing import assert_allclose

from app.document import (
    HOLD,
    IK_TARGET,
    TRANSFORM,
    Handle,
    IkTarget,
    Spring,
    Target,
    Transform,
    bones_above,
    clip_of,
    joint_commands,
    layer_commands,
)
from app.errors import LissomError
from app.motion import Evaluator, ParentTransforms
from app.motion.parenting.layer_pull import LayerPull
from app.motion.parenting.parent_transforms import find_parent_motion
from app.rigging import bend_side

FRAMES = (0, 7.5, 20, 31.0, 48)
END = 3


@cache
def limb_chain():
    """Discs on each other, each bent otherwise, whose joints are far apart."""
    document = chain(count=4)
    for number in (1, 2, 3):
        layer = document.layer(number)
        joint = replace(layer.attachments[0], parent_point=CENTRE - 50j, rest_rotation=0.4)
        document = document.with_layer(replace(layer, anchor=CENTRE + 50j, attachments=(joint,)))
    return document


def limb(*keys):
    """Discs on each other; the last one has IK targets."""
    document = limb_chain()
    return document.with_layer(document.layer(END).with_keys_of(IK_TARGET, keys))


def joint_place(document, joints, layer, frame):
    own = exactly(document, layer, document.layer(layer).anchor, frame)[0]
    return joints.placement(layer, frame).apply(np.array([own]))[0]


def parent_place(document, joints, layer, frame):
    joint = document.layer(layer).attachments[0]
    own = exactly(document, joint.parent, joint.parent_point, frame)[0]
    return joints.placement(joint.parent, frame).apply(np.array([own]))[0]


def target_near(document, frame, way=4 - 3j, **fields):
    """A target within reach of the bones."""
    joints = ParentTransforms(document)
    return IkTarget(joint_place(document, joints, END, frame) + way, **fields)


def pull_of(document, layer, frame):
    """The pull of a layer from its exact places."""
    joints = ParentTransforms(document)

    def hinge(layer, place):
        return joints._joint(layer, place, frame, {})

    return LayerPull(document, layer, frame, hinge, lambda *_given: None)


def test_bones_are_the_parents_up_to_one_with_several_children():
    document = limb_chain()
    names = [each.name for each in bones_above(document, END, 0)]
    assert names == ["1", "2"], "the root has no anchor"
    anchored = document.with_layer(replace(document.layer(0), anchor=100 + 100j))
    assert [each.name for each in bones_above(anchored, END, 0)] == ["0", "1", "2"]
    shoe = replace(document.layer(3), id=7, name="shoe")
    branched = layer_commands.add_layer(
        replace(shoe, attachments=(replace(shoe.attachments[0], parent=1),))
    )(document)
    assert [each.name for each in bones_above(branched, END, 0)] == ["2"]
    told = joint_commands.set_ik_parents(END, 2)(branched)
    assert [each.name for each in bones_above(told, END, 0)] == ["1", "2"]
    assert bones_above(joint_commands.set_ik_parents(END, 0)(told), END, 0) == ()


@pytest.mark.parametrize("frame", FRAMES)
def test_planted_layer_stays_while_its_parents_are_posed_and_move(frame):
    document = limb(IK_TARGET.key(0, IkTarget(CENTRE - 110j, 0.3)))
    document = document.with_layer(
        document.layer(0).with_keys_of(
            TRANSFORM, (TRANSFORM.key(0, Transform()), TRANSFORM.key(48, Transform(1 + 1j, 0.02)))
        )
    )
    joints = ParentTransforms(document)
    target = document.layer(END).keys_of(IK_TARGET)[0].value
    assert_allclose(joint_place(document, joints, END, frame), target.place, rtol=0, atol=1e-9)
    assert_allclose(np.angle(joints.placement(END, frame).factor), target.turn, rtol=0, atol=1e-9)
    for layer in (1, 2, 3):
        assert_allclose(
            joint_place(document, joints, layer, frame),
            parent_place(document, joints, layer, frame),
            rtol=0,
            atol=1e-9,
        )
    # The bones are as long as without the target.
    free = limb_chain()
    with_free = ParentTransforms(free)
    for first, second in ((1, 2), (2, 3)):
        lengths = [
            abs(joint_place(d, j, first, frame) - joint_place(d, j, second, frame))
            for d, j in ((document, joints), (free, with_free))
        ]
        assert_allclose(*lengths, rtol=0, atol=1e-9)


def test_limb_beyond_reach_is_straight():
    document = limb(IK_TARGET.key(0, IkTarget(5000 + 0j)))
    joints = ParentTransforms(document)
    places = [joint_place(document, joints, layer, 20) for layer in (1, 2, 3)]
    ways = np.diff(places) / np.abs(np.diff(places))
    assert_allclose(ways[0], ways[1], rtol=0, atol=1e-6)
    wanted = (5000 - places[0]) / abs(5000 - places[0])
    assert_allclose(ways[0], wanted, rtol=0, atol=1e-6)


def test_mix_leads_from_the_transforms_to_the_target():
    free = limb_chain()
    target = target_near(free, 20)
    places = []
    for mix in (0.0, 0.5, 1.0):
        document = limb(IK_TARGET.key(0, replace(target, mix=mix)))
        places.append(ParentTransforms(document).placement(END, 20))
    assert_allclose(places[0], ParentTransforms(free).placement(END, 20), rtol=0, atol=1e-12)
    angles = np.angle(np.array([place.factor for place in places]) / places[0].factor)
    assert_allclose(angles[1], angles[2] / 2, rtol=0, atol=1e-9)


def test_pole_side_decides_and_flips_by_a_command():
    document = limb(IK_TARGET.key(0, target_near(limb_chain(), 20)))
    for side in (-1, 1):
        told = joint_commands.set_pole_side(END, side=side)(document)
        joints = ParentTransforms(told)
        places = [joint_place(told, joints, layer, 20) for layer in (1, 2, 3)]
        assert bend_side(*places) in {side, 0}
    with pytest.raises(LissomError, match="pole side"):
        joint_commands.set_pole_side(END, side=2)(document)


def test_pulled_end_follows_and_its_transforms_are_exact():
    document = limb_chain()
    pull = pull_of(document, END, 20)
    grabbed = pull.joint + 3 + 2j
    found = pull.pulled(grabbed, grabbed + 5 - 4j, alone=False)
    assert found.keys() == {1, 2, END}
    moved = document
    for layer, transform in found.items():
        keys = (TRANSFORM.key(20, transform),)
        moved = moved.with_layer(moved.layer(layer).with_keys_of(TRANSFORM, keys))
    before, after = (ParentTransforms(each).placement(END, 20) for each in (document, moved))
    assert_allclose(after.factor, before.factor, rtol=0, atol=1e-9)
    assert_allclose(after.shift, before.shift + 5 - 4j, rtol=0, atol=1e-8)
    alone = pull.pulled(grabbed, grabbed + 5 - 4j, alone=True)
    assert alone.keys() == {END}


def test_layer_with_one_bone_is_pulled_by_any_point():
    document = joint_commands.set_ik_parents(2, 1)(limb_chain())
    pull = pull_of(document, 2, 20)
    grabbed = pull.joint + 30j
    goal = grabbed + 6 + 2j
    found = pull.pulled(grabbed, goal, alone=False)
    assert found.keys() == {1, 2}
    moved = document
    for layer, transform in found.items():
        keys = (TRANSFORM.key(20, transform),)
        moved = moved.with_layer(moved.layer(layer).with_keys_of(TRANSFORM, keys))
    local = ParentTransforms(document).placement(2, 20).apply_inverse(grabbed)
    assert_allclose(
        ParentTransforms(moved).placement(2, 20).apply(np.array([local]))[0],
        goal,
        rtol=0,
        atol=1e-8,
    )


def test_flipped_limb_keeps_its_end_and_bends_the_other_way():
    document = limb_chain()
    pull = pull_of(document, END, 20)
    found = pull.flipped()
    moved = document
    for layer, transform in found.items():
        keys = (TRANSFORM.key(20, transform),)
        moved = moved.with_layer(moved.layer(layer).with_keys_of(TRANSFORM, keys))
    joints = [ParentTransforms(each) for each in (document, moved)]
    before, after = (each.placement(END, 20) for each in joints)
    assert_allclose(after, before, rtol=0, atol=1e-8)
    sides = [
        bend_side(*(joint_place(each, j, layer, 20) for layer in (1, 2, 3)))
        for each, j in zip((document, moved), joints, strict=True)
    ]
    assert sides[0] == -sides[1] != 0


def test_scaled_and_moved_layer_takes_its_children_along():
    document = limb_chain()
    pull = pull_of(document, 2, 20)
    moved = document
    for change in (pull.transformed(0.0, 1.5), pull.moved(7 - 2j)):
        keys = (TRANSFORM.key(20, change[2]),)
        moved = document.with_layer(document.layer(2).with_keys_of(TRANSFORM, keys))
        joints = ParentTransforms(moved)
        assert_allclose(
            joint_place(moved, joints, 3, 20), parent_place(moved, joints, 3, 20), atol=1e-9
        )
    before = joint_place(document, ParentTransforms(document), 2, 20)
    assert_allclose(joint_place(moved, joints, 2, 20), before + 7 - 2j, rtol=0, atol=1e-9)


def test_held_target_holds_until_the_next_key():
    first = target_near(limb_chain(), 20)
    document = limb(
        IK_TARGET.key(0, first, easing=HOLD), IK_TARGET.key(20, replace(first, mix=0.0))
    )
    joints, free = ParentTransforms(document), ParentTransforms(limb_chain())
    assert_allclose(joint_place(document, joints, END, 19.9), first.place, rtol=0, atol=1e-9)
    assert_allclose(joints.placement(END, 20), free.placement(END, 20), rtol=0, atol=1e-12)


def test_springs_feel_the_target_of_their_limb():
    free, moving = (
        limb_chain(),
        limb(IK_TARGET.key(0, IkTarget(CENTRE - 110j)), IK_TARGET.key(20, IkTarget(CENTRE - 60j))),
    )
    for number, joints in ((1, True), (2, True), (END, True)):
        carried = find_parent_motion(moving, number)
        places = [carried(frame) for frame in (0.0, 20.0)]
        assert (places[0] != places[1]) == joints
    handled = []
    for document in (free, moving):
        layer = document.layer(1)
        handle = Handle(id=0, name="tip", position=CENTRE + 0j)
        poses = [replace(pose, targets={0: Target(position=CENTRE + 0j)}) for pose in layer.poses]
        layer = layer.with_poses(poses, handles=(handle,), next_handle=1)
        spring = Spring(handle=0, frequency=2, damping=0.2)
        handled.append(document.with_layer(replace(layer, springs=(spring,))))
    assert clip_of(handled[0], 1) != clip_of(handled[1], 1), "its motion is another one"


def test_frames_for_display_are_those_of_exports():
    document = limb(IK_TARGET.key(0, target_near(limb_chain(), 20)))
    frame = Evaluator.exact(document).evaluate(document, 20).layers[END]
    assert_allclose(frame.placement, ParentTransforms(document).placement(END, 20), atol=1e-9)
