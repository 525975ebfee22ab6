from dataclasses import replace

import numpy as np
import pytest
from chains import SIZE, VARIANTS, bent, chain, exactly, seen
from documents import CENTRE, inside
from numpy.testing import assert_allclose

from app.document import (
    History,
    TangentMode,
    channel_commands,
    clip_of,
    key_commands,
    layer_commands as layers,
    pose_channel,
    rest_pose,
    scene_commands,
)
from app.errors import LissomError
from app.motion import (
    Animation,
    DeformMesh,
    InbetweenCache,
    ParentTransforms,
    StreamedVertices,
    attach_as_drawn,
    attach_in_place,
)
from app.motion.parenting.parent_transforms import BATCH
from app.storage import load_project, save_project
from engine.domain.meshing.triangulation import triangulate
from engine.geometry import IDENTITY_MOTION
from engine.maps import distortion


def check_closed(document, frames, earlier=None):
    """Hold each joint of a document against the points that it joins; return its joints."""
    joints = ParentTransforms(document, earlier=earlier)
    for layer in document.layers:
        joint = document.attachment_at(layer, 0)
        if joint is None:
            continue
        for frame in frames:
            own, parent_motion = (
                joints.placement(layer.id, frame),
                joints.placement(joint.parent, frame),
            )
            anchor, _ = exactly(document, layer.id, layer.anchor, frame)
            at, fz = exactly(document, joint.parent, joint.parent_point, frame)
            there = parent_motion.apply(np.array([at]))[0]
            assert abs(own.apply(np.array([anchor]))[0] - there) < 1e-9 * SIZE
            if joint.inherits_rotation:
                turned = parent_motion.factor * fz / abs(fz) * np.exp(-1j * joint.rest_rotation)
                assert abs(own.factor - turned) < 1e-9
    return joints


@pytest.mark.parametrize("variant", VARIANTS)
def test_joint_stays_closed_and_turns_with_its_parent(variant):
    document = chain(variant, 3 if variant == "nu" else 2)
    last = document.layers[-1].id
    times = np.random.default_rng(2).uniform(0, 48, 16 if variant == "nu" else 2)
    joints = check_closed(document, (*times, 0, 20, 48))
    factors = [joints.placement(last, frame).factor for frame in times[:2]]
    assert_allclose(np.abs(factors), 1, rtol=0, atol=1e-12)


def test_layer_without_a_parent_is_where_it_is():
    joints = ParentTransforms(chain())
    assert joints.placement(0, 17.5) == IDENTITY_MOTION
    places = np.array([1 + 2j])
    assert IDENTITY_MOTION.apply(places) is places


def test_what_does_not_turn_only_moves():
    document = chain()
    layer = document.layer(1)
    still = replace(layer.attachments[0], inherits_rotation=False)
    document = layers.attach_layer(1, layer.anchor, still)(document)
    assert ParentTransforms(document).placement(1, 30.0).factor == 1


def test_a_pose_that_is_shown_takes_the_place_of_the_key_s():
    document = chain()
    layer, joint = document.layer(0), document.layer(1).attachments[0]
    pose = bent(layer, 1.0, 2e-4, 5)
    posed = document.with_layer(
        replace(layer, keys=(replace(layer.keys[0], pose=pose), *layer.keys[1:]))
    )
    shown = ParentTransforms(document).placement(1, 0, {0: pose})
    keyed = ParentTransforms(posed).placement(1, 0)
    assert_allclose([*shown], [*keyed], rtol=0, atol=1e-9)
    f = layer.map_of(pose)
    own, _ = exactly(document, 1, document.layer(1).anchor, 0)
    assert_allclose(shown.apply(own), f(np.array([joint.parent_point]))[0], rtol=0, atol=1e-9)


@pytest.mark.parametrize(("frame", "turns"), [(0, False), (11.5, True)])
def test_attaching_moves_nothing_at_the_present_frame(frame, turns):
    document = chain()
    loose = layers.detach_layer(2, 1, 0)(document)
    before = ParentTransforms(loose)
    held, _ = exactly(loose, 2, CENTRE, frame)
    place = complex(before.placement(2, frame).apply(np.array([held]))[0])
    anchor, joint = attach_in_place(before, 2, 0, frame, place=place, turns=turns)
    assert abs(anchor - CENTRE) < 1e-8
    attached = layers.attach_layer(2, anchor, joint)(loose)
    assert_allclose(seen(attached, 2, frame), seen(loose, 2, frame, before), rtol=0, atol=1e-8)
    by_anchor = attach_in_place(before, 2, 0, frame, turns=turns)
    assert abs(by_anchor[0] - document.layer(2).anchor) < 1e-12


def test_a_layer_without_a_pose_is_joined_as_it_is_drawn():
    loose = layers.detach_layer(1, 1, 0)(chain(count=2))
    posed = loose.layer(1)
    still = replace(posed.keys[0], pose=rest_pose(posed.domain, ()))
    document = loose.with_layer(replace(posed, keys=(still,)))
    anchor, joint = attach_as_drawn(ParentTransforms(document), 1, 0, turns=True)
    assert joint.parent_point == anchor == posed.anchor
    attached = layers.attach_layer(1, anchor, joint)(document)
    for frame in (0, 20, 33.5):
        at, fz = exactly(document, 0, anchor, frame)
        placed = ParentTransforms(attached).placement(1, frame)
        assert abs(placed.apply(np.array([anchor]))[0] - at) < 1e-9
        assert abs(placed.factor - fz / abs(fz)) < 1e-9
    # What has a pose, or a parent, stays where it is shown.
    assert attach_as_drawn(ParentTransforms(loose), 1, 0, turns=True) is None
    assert attach_as_drawn(ParentTransforms(attached), 1, 0, turns=True) is None


def test_detaching_moves_nothing_at_the_present_frame():
    document, frame = chain(), 20
    joints = ParentTransforms(document)
    before = joints.placement(2, frame)
    loose = layers.detach_layer(2, before.factor, before.shift)(document)
    assert_allclose(seen(loose, 2, frame), seen(document, 2, frame, joints), rtol=0, atol=1e-9)


def test_layers_are_joined_where_they_overlap_without_an_anchor():
    document = layers.detach_layer(2, 1, 0)(chain())
    layer = document.layer(2)
    apart = replace(layer, anchor=CENTRE - 80)
    keys = tuple(replace(k, pose=bent(layer, 0, 0, 130)) for k in layer.keys)
    document = document.with_layer(replace(apart, keys=keys))
    before = ParentTransforms(document)
    anchor, joint = attach_in_place(before, 2, 0, 0, turns=True)
    assert anchor.real < CENTRE.real
    attached = layers.attach_layer(2, anchor, joint)(document)
    assert_allclose(seen(attached, 2, 0), seen(document, 2, 0, before), rtol=0, atol=1e-8)


def test_attached_layer_keeps_its_distance_beside_its_parent():
    """Nothing moves now, and later it goes with the nearest point, as it was beside it."""
    document = layers.detach_layer(2, 1, 0)(chain())
    far = document.with_layer(
        replace(
            document.layer(2),
            keys=tuple(
                replace(k, pose=bent(document.layer(2), 0.3, 0, 400))
                for k in document.layer(2).keys
            ),
        )
    )
    before = ParentTransforms(far)
    anchor, joint = attach_in_place(before, 2, 0, 11.5, turns=True)
    attached = layers.attach_layer(2, anchor, joint)(far)
    joints = ParentTransforms(attached)
    assert_allclose(seen(attached, 2, 11.5, joints), seen(far, 2, 11.5, before), rtol=0, atol=1e-8)
    assert abs(joint.offset) > 200
    lengths = []
    for frame in (0, 11.5, 30.2, 48):
        own, _ = exactly(attached, 2, anchor, frame)
        parent, _ = exactly(attached, 0, joint.parent_point, frame)
        lengths.append(abs(joints.placement(2, frame).apply(own) - parent))
    assert_allclose(lengths, abs(joint.offset), rtol=1e-9)


def test_a_joint_must_be_on_the_attached_layer():
    document = layers.detach_layer(2, 1, 0)(chain())
    with pytest.raises(LissomError, match=r"'2' has no drawing at \(5000, 0\)"):
        attach_in_place(ParentTransforms(document), 2, 0, 0, place=5000 + 0j, turns=True)


def test_joints_stay_closed_when_documents_change_and_are_saved(tmp_path):
    document, frames = chain(), np.random.default_rng(6).uniform(0, 48, 1)
    history, joints = History(document, saved=True), ParentTransforms(document)
    earlier = []
    changes = (
        (layers.duplicate_layer(1), layers.duplicate_layer(2), layers.move_layer(2, 0)),
        (layers.rename_layer(3, "copy"), channel_commands.copy_keys({pose_channel(1): {20}}, 7)),
        (channel_commands.move_keys({pose_channel(0): {20}}, 5), layers.set_hidden(1, hidden=True)),
        (layers.detach_layer(3, *joints.placement(1, 11.5)),),
        (scene_commands.set_loop(loop=True), layers.remove_layer(0)),
    )
    for some in changes:
        for change in some:
            earlier.append(history.document)
            history.do(change)
        joints = check_closed(history.document, frames, joints)
    assert len(history.document.layers) == 4
    for before in reversed(earlier):
        history.undo()
        assert history.document is before
    history.redo()
    save_project(tmp_path / "chain.lissom", history.document)
    again = load_project(tmp_path / "chain.lissom")
    assert [layer.attachments for layer in again.layers] == [
        layer.attachments for layer in history.document.layers
    ]
    check_closed(again, frames)


@pytest.mark.parametrize("variant", VARIANTS)
def test_attached_layer_is_as_distorted_as_by_itself(variant):
    """Its anchor and its turn are all that a joint decides."""
    attached = chain(variant, 3 if variant == "nu" else 2)
    rng = np.random.default_rng(9)
    points = np.array([inside(rng) for _ in range(40)])
    points = points[np.abs(points - CENTRE) < 0.8 * 90]
    for layer in attached.layers[1:]:
        free = attached.with_layer(replace(layer, attachments=(), anchor=None))
        both = [Animation(clip_of(each, layer.id), points=points) for each in (attached, free)]
        for frame in rng.uniform(0, 48, 5 if variant == "nu" else 2):
            one, other = (animation.frame(frame) for animation in both)
            for measure in (distortion.k, distortion.sigma_a, distortion.sigma_b):
                values = [measure(each.fz, each.fzbar) for each in (one, other)]
                assert_allclose(*values, rtol=0, atol=1e-9)


def test_streamed_joint_stays_closed_on_the_screen():
    document = chain()
    # Joints at vertices of a finer mesh, which series move.
    domain = document.layers[0].domain
    mesh = triangulate(domain.outline, 300)
    middle = mesh.vertices[np.argsort(np.abs(mesh.vertices - CENTRE))[[3, 20]]]
    for index, layer in enumerate(document.layers):
        finer = replace(layer, domain=replace(domain, mesh=mesh))
        if index:
            joint = replace(layer.attachments[0], parent_point=complex(middle[1]))
            finer = replace(finer, anchor=complex(middle[0]), attachments=(joint,))
        document = document.with_layer(finer)
    joints = ParentTransforms(document)
    stores = []
    for layer in document.layers:
        clip = clip_of(document, layer.id)
        store = InbetweenCache(mesh=DeformMesh.fine(layer.domain))
        store.add(store.segments_job(clip, store.missing_segments(clip, 0))())
        while build := store.next_build(clip, 0, heat=False):
            store.add_build(build.advance())
        stores.append((clip, store))
    anchor, at = (int(np.argmin(np.abs(mesh.vertices - place))) for place in middle)
    for frame in np.random.default_rng(3).uniform(0, 48, 40):
        shown = [store.vertices(clip, frame) for clip, store in stores]
        assert all(isinstance(each, StreamedVertices) for each in shown)
        places = [
            joints.placement(number, frame).apply(each.positions)
            for number, each in enumerate(shown)
        ]
        for child in (1, 2):
            assert abs(places[child][anchor] - places[child - 1][at]) < 1e-6 * SIZE


def worked_out(joints):
    """Go through all frames in batches; return how many had to be worked out, and in how many."""
    batches = 0
    while not joints.is_whole:
        before = joints.computed_count
        assert joints.advance() is joints
        assert joints.computed_count - before <= BATCH
        batches += 1
    return joints.computed_count, batches


def test_an_edit_costs_the_frames_of_its_intervals_and_undo_none():
    document = chain()
    frames = len(range(document.frames.first, document.frames.last + 1))
    first = ParentTransforms(document)
    count, batches = worked_out(first)
    assert count == 3 * frames
    assert batches > 1
    # The last key of one of them: the way to it from the middle one passes through that.
    layer = document.layer(1)
    last = layer.keys[-1]
    poses = {pose_channel(1): layer.key_frames}
    cornered = channel_commands.set_tangent_mode(poses, TangentMode.CORNER)(document)
    edited = key_commands.replace_key_pose(1, last.frame, bent(layer, 0.3, 1e-4, 2))(cornered)
    before = ParentTransforms(cornered, earlier=first)
    worked_out(before)
    after = ParentTransforms(edited, earlier=before)
    assert worked_out(after)[0] == last.frame - 20
    check = ParentTransforms(edited)
    for frame in (7, 33, 48):
        for each in (1, 2):
            expected = check.placement(each, frame)
            assert_allclose([*after.placement(each, frame)], [*expected], rtol=0, atol=1e-9)
    # So far only the frames of one layer; and nothing of what was is lost.
    assert worked_out(ParentTransforms(cornered, earlier=after))[0] == 0
    assert worked_out(ParentTransforms(document, earlier=after))[0] == 0
    # What began and was left is gone on with.
    begun = ParentTransforms(document).advance()
    assert not begun.is_whole
    assert (
        worked_out(ParentTransforms(document, earlier=begun))[0]
        == 3 * frames - begun.computed_count
    )
