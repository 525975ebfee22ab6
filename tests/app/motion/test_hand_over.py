"""A layer that is attached to one layer, then to another, and then to none."""

from dataclasses import replace

import numpy as np
import pytest
from chains import bent, chain, exactly, seen
from documents import CENTRE
from messages import says
from numpy.testing import assert_allclose

from app.document import (
    PARENT,
    Channel,
    Cycle,
    FrameRange,
    Spring,
    channel_commands,
    cycle_commands,
    layer_commands as layers,
    parent_label,
    scene_commands,
)
from app.document.keyframe import Handle, Target
from app.document.layers.attachments import Attachment
from app.document.model import PARENT_CIRCLE
from app.errors import LissomError
from app.motion import Evaluator, ParentTransforms, reparent_in_place
from engine.geometry import IDENTITY_MOTION

TOL = 1e-9 * 200


@pytest.fixture(scope="module")
def hands():
    """Two hands that move by themselves, and a thing that is attached to the first of them."""
    document = layers.detach_layer(1, 1, 0)(chain())
    assert document.layer(2).attachments[0].parent == 1
    joint = Attachment(parent=0, parent_point=CENTRE + 20j)
    return layers.attach_layer(2, CENTRE - 30, joint)(document)


def around(joints, layer, frame, by=1e-7):
    """Where a layer is just before a frame and at it."""
    return [joints.placement(layer, at) for at in (frame - by, frame)]


def test_reparented_layer_goes_on_without_a_jump(hands):
    as_before = ParentTransforms(hands)
    joint = reparent_in_place(as_before, 2, 1, 20, turns=True)
    document = layers.attach_layer(2, hands.layer(2).anchor, joint)(hands)
    joints = ParentTransforms(document)
    before, after = around(joints, 2, 20)
    assert abs(before.factor - after.factor) < 1e-6
    assert abs(before.shift - after.shift) < 1e-4
    # Until then as before, to the bit.
    assert joints.placement(2, 12.5) == as_before.placement(2, 12.5)
    # From then on at rest in the frame of the other one's point.
    held = set()
    for frame in (20, 27.5, 40, 48):
        at, fz = exactly(document, 1, joint.parent_point, frame)
        own, _ = exactly(document, 2, document.layer(2).anchor, frame)
        there = joints.placement(2, frame)
        turn = fz / abs(fz)
        held.add(
            tuple(np.round([(there.apply(np.array([own]))[0] - at) / turn, there.factor / turn], 7))
        )
    assert len(held) == 1


def test_it_does_not_jump_whatever_is_posed_later(hands):
    joint = reparent_in_place(ParentTransforms(hands), 2, 1, 20, turns=True)
    document = layers.attach_layer(2, hands.layer(2).anchor, joint)(hands)
    for identity in (0, 1):
        layer = document.layer(identity)
        keys = [replace(k, pose=bent(layer, 0.1 * k.frame, 0, k.frame)) for k in layer.keys]
        document = document.with_layer(replace(layer, keys=tuple(keys)))
    before, after = around(ParentTransforms(document), 2, 20)
    assert abs(before.factor - after.factor) < 1e-5
    assert abs(before.shift - after.shift) < 1e-3


def test_detached_layer_stays_or_goes_back_as_asked(hands):
    anchor, before = hands.layer(2).anchor, ParentTransforms(hands)
    there = before.placement(2, 20)
    for keeps in (True, False):
        document = layers.attach_layer(
            2, anchor, Attachment(parent=None, frame=20, keep_world_transform=keeps)
        )(hands)
        joints = ParentTransforms(document)
        for frame in (20, 31.5, 48):
            assert joints.placement(2, frame) == (there if keeps else IDENTITY_MOTION)
        assert joints.placement(2, 19.5) == before.placement(2, 19.5)


def test_before_its_first_joint_a_layer_is_where_it_is_by_itself(hands):
    late = replace(hands.layer(2).attachments[0], frame=10, keep_world_transform=True)
    document = hands.with_layer(replace(hands.layer(2), attachments=(late,)))
    joints = ParentTransforms(document)
    assert joints.placement(2, 9.9) == IDENTITY_MOTION
    assert abs(joints.placement(2, 10).shift) < TOL
    assert joints.placement(2, 30) != IDENTITY_MOTION


def test_hands_may_take_turns_in_carrying_each_other(hands):
    """No circle at any frame, though each carries the other at some."""
    document = layers.attach_layer(
        0, CENTRE, Attachment(parent=2, parent_point=CENTRE, frame=20, keep_world_transform=True)
    )(
        layers.attach_layer(
            2, CENTRE - 30, Attachment(parent=None, frame=20, keep_world_transform=True)
        )(hands)
    )
    joints = ParentTransforms(document)
    for layer in (0, 2):
        before, after = around(joints, layer, 20)
        assert abs(before.shift - after.shift) < 1e-4
    assert [each.id for each in document.parent_chain(0, 30)] == [0, 2]
    assert [each.id for each in document.parent_chain(2, 10)] == [2, 0]
    # With springs, too, which follow from where they are carried.
    for identity in (0, 2):
        layer = document.layer(identity)
        handle = Handle(id=layer.next_handle, name="tip", position=CENTRE + 60j)
        keys = tuple(
            replace(
                key,
                pose=replace(key.pose, targets={handle.id: Target(position=CENTRE + 60j)}),
            )
            for key in layer.keys
        )
        layer = replace(
            layer,
            handles=(handle,),
            next_handle=handle.id + 1,
            keys=keys,
            springs=(Spring(handle=handle.id, frequency=2.0, damping=0.3),),
        )
        document = document.with_layer(layer)
    found = Evaluator.exact(document).evaluate(document, 33.0, only=(0, 2)).layers
    for each in (0, 2):
        assert np.isfinite(found[each].scene_positions).all()


def test_circles_at_any_frame_are_refused_by_name(hands):
    document = layers.attach_layer(2, CENTRE, Attachment(parent=1, parent_point=CENTRE, frame=20))(
        hands
    )
    with pytest.raises(LissomError, match=r"at frame 30: '1' → '2' → '1'. Detach"):
        layers.attach_layer(1, CENTRE, Attachment(parent=2, parent_point=CENTRE, frame=30))(
            document
        )
    # The other way round it is none before the first lets go.
    layers.attach_layer(1, CENTRE, Attachment(parent=0, parent_point=CENTRE, frame=30))(document)


def test_layer_is_labelled_with_its_parent_at_a_frame(hands):
    document = layers.attach_layer(2, CENTRE, Attachment(parent=None, frame=20))(hands)
    assert [parent_label(document, document.layer(2), frame) for frame in (19, 20)] == [
        "on 0",
        "on nothing…",
    ]
    document = layers.attach_layer(2, CENTRE, Attachment(parent=1, parent_point=CENTRE, frame=20))(
        chain()
    )
    assert parent_label(document, document.layer(2), 20) == "on 1"


def test_joints_are_taken_back_moved_and_stretched_in_time(hands):
    anchor = hands.layer(2).anchor
    document = layers.attach_layer(2, anchor, Attachment(parent=1, parent_point=CENTRE, frame=20))(
        hands
    )
    joints = Channel(PARENT, 2)
    moved = channel_commands.move_keys({joints: {20}}, 6)(document)
    assert [joint.frame for joint in moved.layer(2).attachments] == [0, 26]
    back = channel_commands.delete_keys({joints: {26}})(moved)
    assert back.layer(2).attachments == hands.layer(2).attachments
    longer = scene_commands.scale_time(2.0)(document)
    assert [joint.frame for joint in longer.layer(2).attachments] == [0, 40]
    gone = layers.remove_layer(1)(document)
    assert gone.layer(2).attachments == hands.layer(2).attachments


def test_joints_come_round_in_a_loop(hands):
    document = scene_commands.set_loop(loop=True)(
        layers.attach_layer(2, CENTRE - 30, Attachment(parent=1, parent_point=CENTRE, frame=20))(
            hands
        )
    )
    joints = ParentTransforms(document)
    assert [each.id for each in document.parent_chain(2, 48 + 30)] == [2, 1]
    assert [each.id for each in document.parent_chain(2, 48 + 3)] == [2, 0]
    assert abs(joints.placement(2, 53).shift - joints.placement(2, 5).shift) < TOL
    assert_allclose(seen(document, 2, 53, joints), seen(document, 2, 5, joints), atol=1e-6)


def cycling(document, *, until=None, last=200):
    """The same with all layers coming round every 48 frames."""
    document = replace(document, frames=FrameRange(0, last))
    for layer in document.layers:
        keys = tuple(key for key in layer.keys if key.frame < 48)
        cycles = (Cycle(first=0, last=48, until=until),)
        changed = replace(layer, keys=keys, cycles=cycles, has_auto_pins=False)
        document = document.with_layer(changed)
    return document


@pytest.fixture(scope="module")
def juggled(hands):
    """A thing that goes from hand to hand and back, and comes round with them."""
    document = cycling(hands)
    for frame, parent in ((14, 1), (32, 0)):
        joint = reparent_in_place(ParentTransforms(document), 2, parent, frame, turns=True)
        document = layers.attach_layer(2, hands.layer(2).anchor, joint)(document)
    return document


def test_reparented_layer_is_reparented_in_every_repeat(juggled):
    joints = ParentTransforms(juggled)
    for frame in (0, 14, 20, 31.9, 32, 47.9):
        placed = [seen(juggled, 2, frame + repeat * 48, joints) for repeat in range(3)]
        for other in placed[1:]:
            assert_allclose(other, placed[0], rtol=0, atol=1e-5)
        parents = [juggled.parent_chain(2, frame + repeat * 48)[1].id for repeat in range(3)]
        assert parents == [1 if 14 <= frame < 32 else 0] * 3
    for frame in (14, 32, 48, 62, 80, 96, 144):
        before, after = around(joints, 2, frame)
        assert abs(before.factor - after.factor) < 1e-6
        assert abs(before.shift - after.shift) < 1e-4
    # Without the end of the stretch in the scene it is not another one.
    whole = seen(juggled, 2, 190, joints)
    assert_allclose(seen(replace(juggled, frames=FrameRange(0, 190)), 2, 190), whole, atol=1e-6)


def test_a_joint_at_the_end_of_a_cycle_is_the_one_at_its_beginning(juggled):
    anchor = juggled.layer(2).anchor
    again = Attachment(parent=0, parent_point=CENTRE, frame=48, keep_world_transform=True)
    both = (
        ParentTransforms(juggled),
        ParentTransforms(layers.attach_layer(2, anchor, again)(juggled)),
    )
    for frame in (40, 48, 60, 70, 100):
        one, other = (each.placement(2, frame) for each in both)
        assert abs(one.shift - other.shift) < TOL
    # With another end, or what is said in the repeats, it has its own time.
    for joint in (replace(again, parent=1), replace(again, frame=70)):
        document = layers.attach_layer(2, anchor, joint)(juggled)
        assert document.attachments_of(document.layer(2)) == document.layer(2).attachments


def test_what_is_free_at_first_is_free_in_every_repeat(juggled):
    caught = replace(juggled.layer(2), attachments=juggled.layer(2).attachments[1:])
    document = juggled.with_layer(caught)
    assert [len(document.parent_chain(2, frame)) for frame in (5, 20, 50, 68)] == [1, 2, 1, 2]
    free = ParentTransforms(document)
    for frame in (5, 50, 97):
        assert free.placement(2, frame) == IDENTITY_MOTION
    # Led back from where it was caught last, so that nothing jumps.
    before, after = around(free, 2, 48)
    assert abs(before.shift - after.shift) < 1e-4


def test_repeats_of_joints_made_into_keys_move_as_before(juggled):
    document = juggled
    for keeps in (False, True):
        first = replace(document.layer(2).attachments[0], frame=5, keep_world_transform=keeps)
        later = [joint for joint in document.layer(2).attachments if joint.frame > 5]
        document = document.with_layer(
            replace(
                document.layer(2),
                attachments=(first, *later),
                cycles=(Cycle(first=5, last=53),),
                keys=document.layer(2).keys[:1],
            )
        )
        keyed = cycle_commands.bake_cycle(2, 5, 200)(document)
        assert not keyed.layer(2).cycles or keyed.layer(2).cycles[0].first > 5
        stopped = cycle_commands.delete_cycle(2, 5)(document)
        joints, of_keys, of_stopped = map(ParentTransforms, (document, keyed, stopped))
        for frame in (8, 20, 35, 52.5, 53, 60, 70, 90, 130, 199):
            one, other = (each.placement(2, frame) for each in (joints, of_keys))
            assert abs(one.factor - other.factor) < 1e-9
            assert abs(one.shift - other.shift) < 1e-6
        for frame in (20, 35, 52.5, 53):
            one, other = (each.placement(2, frame) for each in (joints, of_stopped))
            assert abs(one.shift - other.shift) < 1e-6


def test_repeats_end_at_their_frame_and_what_comes_later_follows(juggled):
    layer = juggled.layer(2)
    later = Attachment(parent=None, frame=150, keep_world_transform=True)
    joints = (*layer.attachments, later)
    document = juggled.with_layer(
        replace(layer, attachments=joints, cycles=(Cycle(first=0, last=48, until=96),))
    )
    parents = [[each.id for each in document.parent_chain(2, f)[1:]] for f in (62, 96, 130, 150)]
    assert parents == [[1], [0], [0], []]


def test_circles_in_repeats_are_refused(hands):
    anchor = hands.layer(2).anchor
    document = cycling(
        layers.attach_layer(
            2, anchor, Attachment(parent=None, frame=20, keep_world_transform=True)
        )(hands)
    )
    joint = Attachment(parent=2, parent_point=CENTRE, frame=30)
    with pytest.raises(LissomError, match=says(PARENT_CIRCLE, name="0", frame=48)):
        layers.attach_layer(0, CENTRE, joint)(
            document.with_layer(replace(document.layer(0), cycles=(), keys=hands.layer(0).keys))
        )
    layers.attach_layer(0, CENTRE, joint)(document)
