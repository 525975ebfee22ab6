"""Layers moved as a whole: a rigid motion after the map, with all layers that are "
"attached to them."""

from dataclasses import replace

import numpy as np
import pytest
from chains import chain, seen
from documents import CENTRE
from numpy.testing import assert_allclose

from app.document import (
    TRANSFORM,
    Attachment,
    Spring,
    Transform,
    clip_of,
    layer_commands as layers,
    layer_value_at,
    transform_at,
)
from app.document.keyframe import Handle, Target
from app.motion import Animation, Evaluator, ParentTransforms
from app.motion.parenting.parent_transforms import find_parent_motion

MOVES = (
    TRANSFORM.key(0, Transform()),
    TRANSFORM.key(20, Transform(40 - 10j, 1.2)),
    TRANSFORM.key(48, Transform()),
)


def moving(document, identity, keys=MOVES):
    return document.with_layer(document.layer(identity).with_keys_of(TRANSFORM, keys))


def test_attached_layers_go_along_when_their_parent_moves():
    still, moved = chain(), moving(chain(), 0)
    without, along = ParentTransforms(still), ParentTransforms(moved)
    for frame in (0.0, 7.5, 20.0, 33.0):
        motion = transform_at(moved, moved.layer(0), frame)
        for layer in (0, 1, 2):
            before = without.placement(layer, frame)
            after = along.placement(layer, frame)
            assert_allclose(after, motion.compose(before), rtol=0, atol=1e-9)


def test_a_layer_is_as_distorted_and_certified_as_without():
    still, moved = chain(), moving(chain(), 0)
    points = still.layer(0).domain.mesh.vertices * 0.9 + 10 + 10j
    one, other = (Animation(clip_of(each, 0), points=points).frame(13.0) for each in (still, moved))
    assert np.array_equal(one.fz, other.fz)
    assert np.array_equal(one.fzbar, other.fzbar)
    assert [key.pose for key in still.layer(0).keys] == [key.pose for key in moved.layer(0).keys]
    frame = Evaluator.exact(moved).evaluate(moved, 13.0).layers[0]
    motion = transform_at(moved, moved.layer(0), 13.0)
    own = Animation(clip_of(still, 0)).positions(13.0)
    assert_allclose(frame.scene_positions, motion.apply(own), rtol=0, atol=1e-9)


def without_own_transform(document, identity):
    """Return the document as one of schema 4: attachments ignore the layer's own transform."""
    layer = document.layer(identity)
    joints = (replace(joint, applies_transform=False) for joint in layer.attachments)
    return document.with_layer(replace(layer, attachments=tuple(joints)))


@pytest.mark.parametrize("frame", [0, 9.5, 20, 33.0])
def test_attached_layer_moves_about_its_joint_by_its_own_transform(frame):
    scaled = (TRANSFORM.key(0, Transform()), TRANSFORM.key(20, Transform(4j, -1.2, 0.6)))
    document = moving(chain(), 1, scaled)
    moved, still = ParentTransforms(document), ParentTransforms(chain())
    own = layer_value_at(document, document.layer(1), TRANSFORM, frame)
    joint = Animation(clip_of(document, 1), points=np.array([document.layer(1).anchor]))
    about = own.about(complex(joint.positions(frame)[0]))
    assert_allclose(
        moved.placement(1, frame), still.placement(1, frame).compose(about), rtol=0, atol=1e-9
    )
    # Children stay on their joint, and turn and scale with it.
    point = document.layer(2).attachments[0].parent_point
    parent = Animation(clip_of(document, 1), points=np.array([point])).positions(frame)
    child = Animation(clip_of(document, 2), points=np.array([document.layer(2).anchor]))
    at = moved.placement(2, frame).apply(child.positions(frame))
    assert_allclose(at, moved.placement(1, frame).apply(parent), rtol=0, atol=1e-9)
    ratio = moved.placement(2, frame).factor / still.placement(2, frame).factor
    assert_allclose(ratio, own.factor, rtol=0, atol=1e-9)


def test_layer_of_an_earlier_schema_is_not_moved_by_itself_while_attached():
    document = without_own_transform(moving(chain(), 1), 1)
    moved, still = ParentTransforms(document), ParentTransforms(chain())
    for frame in (0, 9.5):
        assert moved.placement(1, frame) == still.placement(1, frame)


def test_detached_layer_moves_about_its_joint_by_its_own_transform():
    document = moving(chain(), 1)
    layer = document.layer(1)
    released = Attachment(parent=None, frame=20, keep_world_transform=True)
    document = layers.attach_layer(1, layer.anchor, released)(document)
    joints = ParentTransforms(document)
    at, before = joints.placement(1, 20), joints.placement(1, 20, before=True)
    assert_allclose(at, before, rtol=0, atol=1e-9)
    joint = Animation(clip_of(document, 1), points=np.array([layer.anchor]))
    kept, gone = (
        layer_value_at(document, document.layer(1), TRANSFORM, frame).about(
            complex(joint.positions(frame)[0])
        )
        for frame in (20, 30)
    )
    assert_allclose(
        joints.placement(1, 30), at.compose(kept.inverse).compose(gone), rtol=0, atol=1e-9
    )


def test_what_is_let_go_goes_on_from_where_it_is():
    document = moving(chain(), 1)
    layer = document.layer(1)
    released = Attachment(parent=None, frame=20, keep_world_transform=True)
    document = without_own_transform(layers.attach_layer(1, layer.anchor, released)(document), 1)
    joints = ParentTransforms(document)
    at, before = joints.placement(1, 20), joints.placement(1, 20, before=True)
    assert_allclose(at, before, rtol=0, atol=1e-9)
    own = document.layer(1)
    gone = transform_at(document, own, 30).compose(transform_at(document, own, 20).inverse)
    assert_allclose(joints.placement(1, 30), gone.compose(at), rtol=0, atol=1e-9)
    assert np.abs(seen(document, 1, 30) - seen(document, 1, 20)).min() > 1


def test_what_takes_hold_of_a_moving_layer_does_not_let_it_jump():
    document = moving(chain(), 1)
    layer = document.layer(1)
    later = (
        Attachment(
            parent=0,
            parent_point=layer.attachments[0].parent_point,
            frame=12,
            keep_world_transform=True,
        ),
    )
    document = document.with_layer(replace(layer, attachments=later))
    joints = ParentTransforms(document)
    assert_allclose(
        joints.placement(1, 12), joints.placement(1, 12, before=True), rtol=0, atol=1e-9
    )
    assert joints.placement(1, 12, before=True) == transform_at(document, layer, 12)


def test_springs_feel_the_movement():
    assert find_parent_motion(chain(), 0) is None
    moved = moving(chain(), 0)
    carried = find_parent_motion(moved, 0)
    assert carried(20.0) == transform_at(moved, moved.layer(0), 20.0)
    assert carried(20.0).shift != pytest.approx(0)


def test_corrections_follow_an_edit_of_the_movement_that_springs_feel():
    spring = Spring(handle=0, frequency=1.5, damping=0.2)
    first = chain(count=1).layer(0)
    keys = [
        replace(k, pose=replace(k.pose, targets={0: Target(position=CENTRE)})) for k in first.keys
    ]
    handles = (Handle(id=0, name="a", position=CENTRE + 60j),)
    swinging = replace(first, handles=handles, next_handle=1, keys=tuple(keys), springs=(spring,))
    document = moving(chain(count=1).with_layer(swinging), 0)
    farther = (*MOVES[:1], TRANSFORM.key(20, Transform(-90 + 30j)), *MOVES[2:])
    edited = moving(document, 0, farther)
    evaluator = Evaluator.exact(document)
    evaluator.evaluate(document, 12)
    found = evaluator.evaluate(edited, 12).layers[0]
    afresh = Evaluator.exact(edited).evaluate(edited, 12).layers[0]
    assert_allclose(found.positions, afresh.positions, rtol=0, atol=1e-9)
