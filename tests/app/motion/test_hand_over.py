"""What hangs on one figure, then on another one, and then on none."""

from dataclasses import replace

import numpy as np
import pytest
from chains import bent, chain, exactly, seen
from documents import CENTRE
from numpy.testing import assert_allclose

from app.document import Spring, carried_by, clip_of, layer_commands as layers, scene_commands
from app.document.keyframe import Handle, Target
from app.document.layering import Attachment
from app.errors import LissomError
from app.motion import Animation, Joints, hand_over, hung_animations
from engine.geometry import HERE

TOL = 1e-9 * 200


@pytest.fixture
def hands():
    """Two hands that move by themselves, and a thing that hangs on the first of them."""
    document = layers.detach(1, 1, 0)(chain())
    assert document.figure(2).joints[0].to == 1
    joint = Attachment(to=0, at=CENTRE + 20j)
    return layers.attach(2, CENTRE - 30, joint)(document)


def around(joints, figure, frame, by=1e-7):
    """Where a figure is just before a frame and at it."""
    return [joints.placement(figure, at) for at in (frame - by, frame)]


def test_what_is_handed_over_does_not_jump_and_goes_on_with_the_other(hands):
    joint = hand_over(Joints(hands), 2, 1, 20, turns=True)
    document = layers.attach(2, hands.figure(2).anchor, joint)(hands)
    joints = Joints(document)
    before, after = around(joints, 2, 20)
    assert abs(before.factor - after.factor) < 1e-6
    assert abs(before.shift - after.shift) < 1e-4
    # Until then as before, to the bit.
    assert joints.placement(2, 12.5) == Joints(hands).placement(2, 12.5)
    # From then on at rest in the frame of the other one's point.
    held = set()
    for frame in (20, 27.5, 40, 48):
        at, fz = exactly(document, 1, joint.at, frame)
        own, _ = exactly(document, 2, document.figure(2).anchor, frame)
        there = joints.placement(2, frame)
        turn = fz / abs(fz)
        held.add(
            tuple(np.round([(there.on(np.array([own]))[0] - at) / turn, there.factor / turn], 7))
        )
    assert len(held) == 1


def test_it_does_not_jump_whatever_is_posed_later(hands):
    joint = hand_over(Joints(hands), 2, 1, 20, turns=True)
    document = layers.attach(2, hands.figure(2).anchor, joint)(hands)
    for identity in (0, 1):
        figure = document.figure(identity)
        keys = [replace(k, pose=bent(figure, 0.1 * k.frame, 0, k.frame)) for k in figure.keys]
        document = document.with_figure(replace(figure, keys=tuple(keys)))
    before, after = around(Joints(document), 2, 20)
    assert abs(before.factor - after.factor) < 1e-5
    assert abs(before.shift - after.shift) < 1e-3


def test_what_is_let_go_stays_or_goes_back_to_where_it_is_by_itself(hands):
    anchor = hands.figure(2).anchor
    for keeps in (True, False):
        document = layers.attach(2, anchor, Attachment(to=None, frame=20, keeps=keeps))(hands)
        joints = Joints(document)
        there = Joints(hands).placement(2, 20)
        for frame in (20, 31.5, 48):
            assert joints.placement(2, frame) == (there if keeps else HERE)
        assert joints.placement(2, 19.5) == Joints(hands).placement(2, 19.5)


def test_before_its_first_joint_a_figure_is_where_it_is_by_itself(hands):
    late = replace(hands.figure(2).joints[0], frame=10, keeps=True)
    document = hands.with_figure(replace(hands.figure(2), joints=(late,)))
    joints = Joints(document)
    assert joints.placement(2, 9.9) == HERE
    assert abs(joints.placement(2, 10).shift) < TOL
    assert joints.placement(2, 30) != HERE


def test_hands_may_take_turns_in_carrying_each_other(hands):
    """No circle at any frame, though each carries the other at some."""
    document = layers.attach(0, CENTRE, Attachment(to=2, at=CENTRE, frame=20, keeps=True))(
        layers.attach(2, CENTRE - 30, Attachment(to=None, frame=20, keeps=True))(hands)
    )
    joints = Joints(document)
    for figure in (0, 2):
        before, after = around(joints, figure, 20)
        assert abs(before.shift - after.shift) < 1e-4
    assert [each.id for each in document.carriers(0, 30)] == [0, 2]
    assert [each.id for each in document.carriers(2, 10)] == [2, 0]
    # With springs, too, which follow from where they are carried.
    for identity in (0, 2):
        figure = document.figure(identity)
        handle = Handle(id=figure.next_handle, name="tip", position=CENTRE + 60j)
        keys = tuple(
            replace(
                key,
                pose=replace(key.pose, targets={handle.id: Target(position=CENTRE + 60j)}),
            )
            for key in figure.keys
        )
        figure = replace(
            figure,
            handles=(handle,),
            next_handle=handle.id + 1,
            keys=keys,
            springs=(Spring(handle=handle.id, frequency=2.0, damping=0.3),),
        )
        document = document.with_figure(figure)
    animations = hung_animations(
        [Animation(clip_of(document, each), points=np.array([CENTRE])) for each in (0, 2)], document
    )
    for each in (0, 2):
        assert np.isfinite(animations[each].positions(33.0)).all()


def test_circles_at_any_frame_are_refused_by_name(hands):
    document = layers.attach(2, CENTRE, Attachment(to=1, at=CENTRE, frame=20))(hands)
    with pytest.raises(LissomError, match=r"at frame 30: '1' on '2', '2' on '1'; detach"):
        layers.attach(1, CENTRE, Attachment(to=2, at=CENTRE, frame=30))(document)
    # The other way round it is none before the first lets go.
    layers.attach(1, CENTRE, Attachment(to=0, at=CENTRE, frame=30))(document)


def test_it_is_listed_below_what_carries_it_then(hands):
    document = layers.attach(2, CENTRE, Attachment(to=None, frame=20))(hands)
    assert [carried_by(document, document.figure(2), frame) for frame in (19, 20)] == [
        (1, "on 0"),
        (0, "on nothing…"),
    ]
    document = layers.attach(2, CENTRE, Attachment(to=1, at=CENTRE, frame=20))(chain())
    assert carried_by(document, document.figure(2), 20) == (2, "on 1")


def test_joints_are_taken_back_moved_and_stretched_in_time(hands):
    anchor = hands.figure(2).anchor
    document = layers.attach(2, anchor, Attachment(to=1, at=CENTRE, frame=20))(hands)
    moved = layers.move_joint(2, 20, 26)(document)
    assert [joint.frame for joint in moved.figure(2).joints] == [0, 26]
    back = layers.unjoin(2, 26)(moved)
    assert back.figure(2).joints == hands.figure(2).joints
    with pytest.raises(LissomError, match="not attached anew at frame 21"):
        layers.move_joint(2, 21, 5)(document)
    longer = scene_commands.scale_time(2.0)(document)
    assert [joint.frame for joint in longer.figure(2).joints] == [0, 40]
    gone = layers.remove_figure(1)(document)
    assert gone.figure(2).joints == hands.figure(2).joints


def test_a_loop_comes_round_with_its_joints(hands):
    document = scene_commands.set_loop(loop=True)(
        layers.attach(2, CENTRE - 30, Attachment(to=1, at=CENTRE, frame=20))(hands)
    )
    joints = Joints(document)
    assert [each.id for each in document.carriers(2, 48 + 30)] == [2, 1]
    assert [each.id for each in document.carriers(2, 48 + 3)] == [2, 0]
    assert abs(joints.placement(2, 53).shift - joints.placement(2, 5).shift) < TOL
    assert_allclose(seen(document, 2, 53), seen(document, 2, 5), atol=1e-6)
