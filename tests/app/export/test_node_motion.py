"""Motions of whole layers in models: within their tolerance, with jumps, and as nodes of glTF."""

import numpy as np
import pytest
from chains import chain
from hypothesis import given, strategies as st
from models import PIXELS, exported, read, values

from app.document import TRANSFORM, VISIBILITY, Transform, rest_pose
from app.export.node_motion import build_node_motion
from app.motion import ParentTransforms
from engine.geometry import IDENTITY_MOTION, Similarity

POINTS = np.array([0j, 100 + 0j, 100 + 50j, 50j])
PIVOT = 10 + 20j


def turning(time, speed=0.3, growth=0.05):
    factor = np.exp((1j * speed + growth) * time)
    return Similarity(complex(factor), complex(3 * time + 1j * time**2) - factor * PIVOT)


@given(st.floats(-0.9, 0.9), st.floats(-0.1, 0.1), st.sampled_from([0.05, 0.5, 5.0]))
def test_motion_stays_within_its_tolerance_at_all_times(speed, growth, tolerance):
    def placement(time):
        return turning(time, speed, growth)

    motion = build_node_motion(placement, POINTS, PIVOT, np.arange(0, 12.5, 0.5), tolerance)
    for time in np.linspace(0, 12, 97):
        error = np.abs(motion.at(time).apply(POINTS) - placement(time).apply(POINTS)).max()
        assert error <= tolerance * 1.01
    assert np.abs(np.diff(motion.values[:, 2])).max(initial=0) <= np.pi


def test_full_turns_are_kept_and_even_motion_needs_few_times():
    motion = build_node_motion(
        lambda time: Similarity(
            complex(np.exp(0.5j * time)), complex(-np.exp(0.5j * time) * PIVOT)
        ),
        POINTS,
        PIVOT,
        np.arange(0, 25.0, 0.5),
        0.05,
    )
    assert motion.values[-1, 2] == pytest.approx(0.5 * 24.5)
    assert len(motion.times) <= 17, "readers take the short way between two"


def test_resting_layer_has_no_motion_and_a_jump_is_one():
    times = np.arange(0, 4.5, 0.5)
    assert build_node_motion(lambda _: IDENTITY_MOTION, POINTS, PIVOT, times, 0.05) is None
    motion = build_node_motion(
        lambda time: Similarity(1.0, 40.0 if time >= 2 else 0j), POINTS, PIVOT, times, 0.05
    )
    assert motion.at(1.9).shift == pytest.approx(0)
    assert motion.at(2.0).shift == pytest.approx(40)


def as_node(gltf, number, seconds):
    """Translation in pixels, factor of the rotation, and scale of a node, as readers have them."""
    node = gltf.nodes[number]
    found = {name: np.array(getattr(node, name)) for name in ("translation", "rotation", "scale")}
    for channel in gltf.animations[0].channels:
        if channel.target.node == number and channel.target.path in found:
            sampler = gltf.animations[0].samplers[channel.sampler]
            times = values(gltf, sampler.input).ravel()
            table = values(gltf, sampler.output).reshape(len(times), -1)
            found[channel.target.path] = np.array(
                [np.interp(seconds, times, column) for column in table.T]
            )
    x, y, _ = PIXELS * found["translation"]
    *_, sine, cosine = found["rotation"]
    turn = 2 * np.arctan2(sine, cosine)
    return complex(x, y), np.exp(1j * turn) * found["scale"][0]


def test_attached_layers_that_turn_are_nodes_without_shapes(tmp_path):
    document = chain(count=3)
    for layer in document.layers:
        # No pose of their own: the transforms alone move them.
        rest = [rest_pose(layer.domain, layer.handles)] * len(layer.keys)
        document = document.with_layer(layer.with_poses(rest))
    for number in (1, 2):
        keys = (
            TRANSFORM.key(0, Transform()),
            TRANSFORM.key(24, Transform(4j, 1.2 * number, 1 + 0.2 * number)),
        )
        document = document.with_layer(document.layer(number).with_keys_of(TRANSFORM, keys))
    seen = (VISIBILITY.key(0, value=True), VISIBILITY.key(30, value=False))
    document = document.with_layer(document.layer(2).with_keys_of(VISIBILITY, seen))
    light, maker = exported(document, tmp_path / "a.glb")
    gltf = read(tmp_path / "a.glb")
    assert all(not len(shape.motion.targets) for shape in maker.meshes)
    joints = ParentTransforms(light)
    origin = complex(*gltf.asset.extras["origin"])
    for number, layer in enumerate(light.layers[1:], 1):
        shape = maker.meshes[number]
        (node,) = [i for i, each in enumerate(gltf.nodes) if each.mesh == number]
        for frame in (0, 7.25, 24, 40):
            place, factor = as_node(gltf, node, frame / light.fps)
            points = shape.motion.base
            wanted = joints.placement(layer.id, frame).apply(points)
            got = place + origin + factor * (points - shape.node.pivot)
            assert np.abs(got - wanted).max() < 0.3
    # The hidden layer has a node around it, whose scale hides it.
    around = [each for each in gltf.nodes if each.children]
    assert [each.name for each in around] == ["2"]
    assert len(gltf.scenes[0].nodes) == 3
