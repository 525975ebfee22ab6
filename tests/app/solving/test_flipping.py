"""Flipped poses: mirror images where the drawing is one, and never worse than its bounds."""

import numpy as np
import pytest
from animations import still_document
from invariants import check_pose
from PIL import Image, ImageDraw

from app.document import handle_commands
from app.solving import Rig, flip_poses, flip_targets
from app.solving.drag.drag_solver import DragSolver

MIDDLE = 80.0
NAMES = {"arm.L": 22 + 60j, "arm.R": 138 + 60j, "hip": 80 + 20j}


def layer_of(places, *, symmetric=True):
    """A drawing with an arm on either side, or on one only."""
    picture = Image.new("RGBA", (160, 120))
    pen = ImageDraw.Draw(picture)
    pen.rectangle((60, 20, 99, 110), fill=(200, 120, 60, 255))
    pen.rectangle((10 if symmetric else 60, 50, 149, 69), fill=(90, 140, 200, 255))
    document = still_document(np.array(picture))
    for name, place in places.items():
        document = handle_commands.add_handle(0, place, name=name)(document)
    return document.layers[0]


def posed(layer, **moves):
    """Pull handles, by name, by these distances."""
    rig = Rig.of(layer)
    pose = layer.keys[0].pose
    names = {handle.name: handle.id for handle in layer.handles}
    targets = dict(pose.targets)
    for name, way in moves.items():
        identity = names[name.replace("_", ".")]
        old = targets[identity]
        targets[identity] = type(old)(position=old.position + way)
    return rig, DragSolver.begin(rig, pose).step_towards(targets, 600).make_pose(targets)


@pytest.fixture(scope="module")
def raised():
    layer = layer_of(NAMES)
    return layer, *posed(layer, arm_L=10 + 30j)


def test_a_symmetric_drawing_is_posed_as_its_mirror_image(raised):
    layer, rig, pose = raised
    assert layer.axis == MIDDLE
    (flipped,) = flip_poses(rig, [pose], layer.axis)
    check_pose(layer, flipped)
    assert flipped.certificate.is_certified
    points = layer.domain.mesh.vertices
    mirrored = 2 * MIDDLE - layer.map_of(pose)(2 * MIDDLE - points.conj()).conj()
    # The cage is not symmetric, so that the same targets lead to slightly other maps.
    apart = np.abs(layer.map_of(flipped)(points) - mirrored)
    moved = np.abs(layer.map_of(pose)(points) - points)
    assert apart.max() < 0.1 * moved.max()


def test_pairs_exchange_their_targets_and_twice_is_nothing(raised):
    layer, rig, pose = raised
    left, right, hip = (handle.id for handle in layer.handles)
    targets = flip_targets(layer, pose, layer.axis)
    assert targets[right].position == pytest.approx(NAMES["arm.R"] - 10 + 30j, abs=1e-9)
    assert targets[left].position == pytest.approx(NAMES["arm.L"], abs=1e-9)
    assert targets[hip].position == pytest.approx(NAMES["hip"], abs=1e-9)
    (flipped,) = flip_poses(rig, [pose], layer.axis)
    again = flip_targets(layer, flipped, layer.axis)
    for identity, target in pose.targets.items():
        assert again[identity].position == pytest.approx(target.position, abs=1e-6)


@pytest.mark.parametrize("axis", [80.0, 20.0, 300.0])
@pytest.mark.parametrize("symmetric", [True, False])
def test_a_drawing_at_rest_stays_at_rest(symmetric, axis):
    layer = layer_of({"hip": 80 + 20j, "arm.R": 138 + 60j}, symmetric=symmetric)
    targets = flip_targets(layer, layer.keys[0].pose, axis)
    for handle in layer.handles:
        assert targets[handle.id].position == pytest.approx(handle.position, abs=1e-9)


def test_what_is_turned_as_a_whole_is_turned_the_other_way():
    layer = layer_of({"hip": 70 + 20j, "arm.L": 90 + 90j, "arm.R": 138 + 60j}, symmetric=False)
    turn, centre = np.exp(0.4j), 80 + 60j
    cage = layer.domain.cage
    pose = layer.keys[0].pose
    turned = type(pose)(
        targets={
            handle.id: type(pose.targets[handle.id])(
                position=centre + turn * (handle.position - centre), rotation=0.4
            )
            for handle in layer.handles
        },
        phi=centre + turn * (cage - centre),
        psi=np.zeros_like(cage),
        certificate=pose.certificate,
    )
    targets = flip_targets(layer, turned, MIDDLE)
    for handle in layer.handles:
        expected = centre + turn.conjugate() * (handle.position - centre)
        assert targets[handle.id].position == pytest.approx(expected, abs=1e-9)
        assert targets[handle.id].rotation == -0.4


def test_handles_are_pairs_by_their_places_and_alone_on_a_symmetric_drawing_follow_the_shape():
    by_place = {"handle 1": 22 + 60j, "handle 2": 137 + 61j, "handle 3": 80 + 20j}
    layer = layer_of(by_place)
    one, two, _ = (handle.id for handle in layer.handles)
    _, pose = posed(layer, **{"handle 1": 10 + 30j})
    targets = flip_targets(layer, pose, MIDDLE)
    moved = targets[two].position - layer.handle(two).position
    assert abs(moved - (-10 + 30j)) < 2
    layer = layer_of({"handle 1": 22 + 60j, "handle 3": 80 + 20j})
    _, pose = posed(layer, **{"handle 1": 10 + 30j})
    targets = flip_targets(layer, pose, MIDDLE)
    # It does what the other arm does, though no handle is there.
    (there,) = layer.map_of(pose)(np.array([138 + 60j]))
    assert targets[one].position == pytest.approx(2 * MIDDLE - there.conjugate(), abs=1e-9)
