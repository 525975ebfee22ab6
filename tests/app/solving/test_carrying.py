"""Poses carried from one layer to another by a similarity of their handles."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, strategies as st
from invariants import check_pose
from walkers import AXIS, FAR, HANDLES, SIZE, leg

from app.document import Attachment, Document, Target, handle_commands
from app.solving import PoseTransfer, Rig, SimilarityTransform
from app.solving.drag.drag_solver import DragSolver
from app.solving.pose_transfer import find_initial_map

PLACES = np.array([3 + 1j, 40 - 7j, 12 + 90j, -55 + 20j])
FACTORS = st.builds(lambda r, t: r * np.exp(1j * t), st.floats(0.1, 10), st.floats(-3.1, 3.1))
SHIFTS = st.complex_numbers(max_magnitude=1e3)


@given(factor=FACTORS, shift=SHIFTS, mirrors=st.booleans())
def test_a_similarity_is_found_by_its_images_and_mirrors_where_they_do(factor, shift, mirrors):
    similarity = SimilarityTransform(factor, shift, mirrors)
    found = SimilarityTransform.fit(PLACES, similarity.apply(PLACES))
    assert found.mirrors == mirrors
    size = abs(factor) * 100 + abs(shift)
    np.testing.assert_allclose(
        found.apply(PLACES), similarity.apply(PLACES), rtol=0, atol=1e-9 * size
    )
    back = SimilarityTransform.fit(similarity.apply(PLACES), PLACES)
    np.testing.assert_allclose(
        back.apply(found.apply(PLACES)), PLACES, rtol=0, atol=1e-9 * (size + 100)
    )
    np.testing.assert_allclose(found.apply_inverse(found.apply(PLACES)), PLACES, rtol=0, atol=1e-6)


def test_places_that_are_no_images_are_scaled_by_their_spread_both_ways():
    images = np.array([0j, 9 + 2j, 4 - 30j, 7 + 7j])
    there, back = SimilarityTransform.fit(PLACES, images), SimilarityTransform.fit(images, PLACES)
    if there.mirrors == back.mirrors:
        np.testing.assert_allclose(back.apply(there.apply(PLACES)), PLACES, rtol=0, atol=1e-9)
    spread = np.linalg.norm(images - images.mean()) / np.linalg.norm(PLACES - PLACES.mean())
    assert abs(there.factor) == pytest.approx(spread)


@pytest.mark.parametrize(("mirrors", "factor"), [(None, 1), (False, 1), (True, -1)])
def test_one_place_is_only_moved_or_mirrored_upright(mirrors, factor):
    similarity = SimilarityTransform.fit(np.array([3 + 4j]), np.array([10 + 1j]), mirrors=mirrors)
    assert similarity.factor == factor
    assert similarity.apply_to_point(3 + 4j) == 10 + 1j


def test_a_straight_limb_is_mirrored_only_where_that_is_asked():
    straight = np.array([10 + 90j, 10 + 50j, 10 + 5j])
    for mirrors in (None, True):
        similarity = SimilarityTransform.fit(straight, straight + 30, mirrors=mirrors)
        assert similarity.apply_to_point(15 + 50j) == pytest.approx(
            35 + 50j if mirrors else 45 + 50j
        )


def by_names(layer, source):
    names = {handle.name: handle.id for handle in source.handles}
    return {each.id: names[each.name] for each in layer.handles if each.name in names}


def carriage(source, layer, mirrors=None):
    pairs = by_names(layer, source)
    places = np.array([source.handle(other).position for other in pairs.values()])
    images = np.array([layer.handle(one).position for one in pairs])
    similarity = SimilarityTransform.fit(places, images, mirrors=mirrors)
    return PoseTransfer(source=source, pairs=pairs, similarity=similarity)


def raised(layer):
    """The leg with its knee bent and its foot back, as the solver has it."""
    rig, pose = Rig.of(layer), layer.keys[0].pose
    names = {handle.name: handle.id for handle in layer.handles}
    targets = dict(pose.targets)
    for name, way in (("knee", 18 + 8j), ("foot", -20 + 30j)):
        old = targets[names[name]]
        targets[names[name]] = Target(position=old.position + way)
    return DragSolver.begin(rig, pose).step_towards(targets, 600).make_pose(targets)


@pytest.fixture(scope="module")
def near():
    layer = leg("near leg", 0)
    return layer, raised(layer)


@pytest.mark.parametrize("drawn", ["elsewhere", "mirrored and turned"])
def test_carried_pose_is_the_same_on_a_leg_drawn_elsewhere(near, drawn):
    source, pose = near
    mirrored, turned = "mirrored" in drawn, "turned" in drawn
    by = FAR.shift if drawn == "elsewhere" else 0j
    layer = leg("far leg", 1, by, mirrored=mirrored, turned=turned)
    way = carriage(source, layer)
    assert way.similarity.mirrors == mirrored
    carried = way.transfer_pose(Rig.of(layer), pose)
    check_pose(layer, carried)
    assert carried.certificate.is_certified
    for handle in layer.handles:
        target = pose.targets[way.pairs[handle.id]].position
        image = 2 * AXIS - target.conjugate() if mirrored else target + by
        image = 1j * image + SIZE[1] if turned else image
        assert carried.targets[handle.id].position == pytest.approx(image, abs=1e-9)
    # Not its handles alone: all of it is the image, as near as two cages have it.
    points = source.domain.mesh.vertices
    images = way.similarity.apply(points)
    inside = layer.covers(images)
    apart = layer.map_of(carried)(images) - way.similarity.apply(source.map_of(pose)(points))
    assert np.abs(apart[inside]).max() < 0.05 * np.abs(source.map_of(pose)(points) - points).max()


def test_there_and_back_targets_are_what_they_were(near):
    source, pose = near
    layer = leg("far leg", 1, FAR.shift)
    carried = carriage(source, layer).transfer_pose(Rig.of(layer), pose)
    back = carriage(layer, source).transfer_targets(source, carried)
    for identity, target in pose.targets.items():
        assert back[identity].position == pytest.approx(target.position, abs=1e-6)


def other_leg(**places):
    """A leg drawn elsewhere, whose handles are moved from where they would be alike."""
    layer = leg("far leg", 1, FAR.shift)
    handles = tuple(
        replace(each, position=each.position + places.get(each.name, 0)) for each in layer.handles
    )
    keys = [
        replace(
            key,
            pose=replace(
                key.pose, targets={each.id: Target(position=each.position) for each in handles}
            ),
        )
        for key in layer.keys
    ]
    return replace(layer, handles=handles, keys=tuple(keys))


@pytest.mark.parametrize("mirrors", [False, True])
def test_rest_stays_rest_and_a_turn_of_the_whole_is_as_great_in_any_proportions(near, mirrors):
    source, _ = near
    layer = other_leg(knee=6 - 9j, foot=-8 + 3j)
    way = carriage(source, layer, mirrors=mirrors)
    at_rest = way.transfer_targets(layer, source.keys[0].pose)
    for handle in layer.handles:
        assert at_rest[handle.id].position == pytest.approx(handle.position, abs=1e-9)
    turn, centre = np.exp(2.8j), HANDLES["hip"]
    rest = source.keys[0].pose
    turned = replace(
        rest,
        targets={
            each.id: Target(position=centre + turn * (each.position - centre), rotation=2.8)
            for each in source.handles
        },
        phi=centre + turn * (source.domain.cage - centre),
    )
    carried = way.transfer_pose(Rig.of(layer), turned)
    image = turn.conjugate() if mirrors else turn
    fz, fzbar = layer.map_of(carried).derivatives(layer.domain.mesh.vertices)
    np.testing.assert_allclose(fz, image, rtol=0, atol=1e-6)
    np.testing.assert_allclose(fzbar, 0, rtol=0, atol=1e-6)
    assert all(t.rotation == (-2.8 if mirrors else 2.8) for t in carried.targets.values())


def test_handles_that_take_nothing_over_stay_where_they_are(near):
    source, pose = near
    layer = leg("far leg", 1, FAR.shift)
    add = handle_commands.add_handle(1, HANDLES["hip"] + FAR.shift + 4 - 60j, name="shin")
    (added,) = add(Document(layers=(layer,))).layers
    present = added.keys[0].pose
    carried = carriage(source, added).transfer_pose(Rig.of(added), pose, present)
    shin = next(each.id for each in added.handles if each.name == "shin")
    assert carried.targets[shin].position == present.targets[shin].position
    foot = next(each for each in added.handles if each.name == "foot")
    targets = carriage(source, layer).transfer_targets(layer, pose)
    named = {layer.handle(i).name: target for i, target in targets.items()}
    assert carried.targets[foot.id].position == pytest.approx(named["foot"].position)
    check_pose(added, carried)


@pytest.mark.parametrize("far", [False, True], ids=["alike", "drawn otherwise"])
def test_what_no_handle_tells_is_taken_over_too(near, far):
    """One handle alone does not tell how the shape is turned."""
    source = with_one_handle(near[0])
    layer = with_one_handle(leg("far leg", 1, FAR.shift, turned=far))
    turn, rest = np.exp(0.6j), source.keys[0].pose
    turned = replace(rest, phi=HANDLES["hip"] + turn * (source.domain.cage - HANDLES["hip"]))
    carried = carriage(source, layer).transfer_pose(Rig.of(layer), turned)
    fz, _ = layer.map_of(carried).derivatives(layer.domain.mesh.vertices)
    np.testing.assert_allclose(fz, turn, rtol=0, atol=1e-6)
    assert layer.target_errors(carried)[0] < 1e-6


def with_one_handle(layer):
    (hip, *others) = layer.handles
    remove = handle_commands.remove_handles(layer.id, frozenset(each.id for each in others))
    (alone,) = remove(Document(layers=(layer,))).layers
    assert alone.handles == (hip,)
    return alone


@pytest.mark.parametrize("mirrored", [False, True])
def test_the_solver_begins_with_the_image_of_the_whole_map(near, mirrored):
    source, pose = near
    layer = leg("far leg", 1, mirrored=mirrored, turned=True)
    similarity = carriage(source, layer).similarity
    begin, _ = find_initial_map(Rig.of(layer), source, pose, similarity, {})
    points = source.domain.mesh.vertices
    images, shape = similarity.apply(points), source.map_of(pose)
    inside = layer.covers(images)
    wanted = similarity.apply(shape(points))[inside]
    moved = np.abs(shape(points) - points).max()
    assert np.abs(begin(images[inside]) - wanted).max() < 0.02 * moved


@pytest.mark.parametrize("by", [FAR.shift, FAR.shift - 9j])
def test_attached_layer_is_held_at_its_joint_as_the_source_is_at_its_own(near, by):
    """The joint is beside the source's: it goes along as a rigid body would."""
    attachment = Attachment(parent=9, parent_point=0j)
    source = replace(near[0], anchor=62 + 162j, attachments=(attachment,))
    pose = raised(source)
    assert abs(source.map_of(pose)(np.array([source.anchor]))[0] - source.anchor) < 3
    layer = replace(leg("far leg", 1, FAR.shift), anchor=62 + 162j + by, attachments=(attachment,))
    rig = Rig.of(layer)
    assert len(rig.pins) == 1
    carried = carriage(source, layer).transfer_pose(rig, pose)
    check_pose(layer, carried)
    there = source.map_of(pose)(np.array([source.anchor]))[0] + by
    here = layer.map_of(carried)(np.array([layer.anchor]))[0]
    assert abs(here - there) < 3
