"""An arm over the trunk is rigged and posed by hand: the trunk stays whole and still."""

from pathlib import Path

import numpy as np
import pytest
from overlapping_legs import JOINTS, NEAR_ARM, SKIN, draw_arm, limb
from shapely import Point, contains_xy

from app.cut_out import subject_mask, texture
from app.document import Meshing, Target, key_commands
from app.document.settings import ExportSettings
from app.export import ExportRequest, FrameRenderer, plan_export
from app.motion import Evaluator
from app.render.gpu.context import create_context
from app.solving import (
    DragSolver,
    MotionRequest,
    Rig,
    find_limb_cuts,
    find_rest_body,
    rig_body,
    start_motion_solve,
)
from app.solving.motion_preset.joint_guess import guess_joints, guess_layer_kind
from app.solving.motion_preset.limb_cuts import part_limbs
from app.storage import open_picture

TRUNK = Point(140, 340).buffer(46).union(Point(140, 262).buffer(42)).convex_hull
WALK = MotionRequest(motion="walk", kind="biped-side", joints=JOINTS, facing=1)


@pytest.fixture(scope="module")
def drawn(tmp_path_factory):
    """The drawing as it was opened, its picture, and its joints with those of the arm."""
    path = tmp_path_factory.mktemp("person") / "person.png"
    draw_arm("lines").save(path)
    opened = open_picture(path, Meshing(triangles=3000, detail="normal"))
    rgba = opened.pictures[0].rgba
    joints = guess_joints(opened.document.layers[0], "biped-side", rgba).joints
    arm = {name: joints[name] for name in ("shoulder.R", "elbow.R", "hand.R")}
    return opened.document, rgba, JOINTS | arm


@pytest.fixture(scope="module")
def rigged(drawn):
    document, rgba, joints = drawn
    request = MotionRequest(motion="walk", kind="biped-side", joints=joints, facing=1)
    cuts = find_limb_cuts(document.layer(0), find_rest_body(document.layer(0), request), rgba)
    parted = part_limbs(document, 0, cuts, rgba)
    request = MotionRequest(motion="walk", kind="biped-side", joints=cuts.joints, facing=1)
    return rig_body(parted, 0, find_rest_body(parted.layer(0), request), {})


def test_arm_is_a_flap_that_covers_the_trunk_and_a_chain_in_front(rigged):
    document, joints = rigged
    layer = document.layer(0)
    (line,) = [each for each in layer.cut_out.cut_lines if each.covered == "left"]
    assert layer.domain.contains(line.points[[0, -1]]).all()
    assert len(layer.domain.holes) == 1
    assert {"shoulder.R", "elbow.R", "hand.R"} <= joints.keys()
    assert layer.handle(joints["hand.R"]).depth > 0
    assert any(bone.is_between((joints["elbow.R"], joints["hand.R"])) for bone in layer.bones)


def test_guess_is_the_same_when_the_limbs_are_parted_already(drawn, rigged):
    document, rgba, _ = drawn
    before, after = document.layer(0), rigged[0].layer(0)
    assert guess_layer_kind(after, rgba) == guess_layer_kind(before, rgba)
    one, other = (guess_joints(layer, "biped-side", rgba).joints for layer in (before, after))
    assert one.keys() == other.keys()
    assert max(abs(one[name] - other[name]) for name in one) < 3


def test_trunk_is_whole_and_still_when_the_hand_is_dragged(drawn, rigged):
    _, rgba, _ = drawn
    document, joints = rigged
    layer = document.layer(0)
    pose, hand = layer.keys[0].pose, joints["hand.R"]
    rest = layer.handle(hand).position
    targets = dict(pose.targets) | {hand: Target(position=rest + 55 + 25j)}
    solved = DragSolver.begin(Rig.of(layer), pose).step_towards(targets, 200).make_pose(targets)
    moved = layer.map_of(solved)
    assert abs(moved(np.array([rest]))[0] - rest - 55 - 25j) < 2
    beside = np.array([100 + 300j, 104 + 260j, 174 + 330j, 172 + 280j, 140 + 378j])
    there = moved(beside)
    assert np.abs(there - beside).max() < 6
    shown = frame(key_commands.insert_key(0, 10, solved)(document), rgba, 10)
    x, y = np.meshgrid(np.arange(300) + 0.5, 519.5 - np.arange(520))
    inside = contains_xy(TRUNK.buffer(-6), x, y)
    assert (shown[inside, 3] == 255).all()
    # Where the hand was, the trunk's colour is seen, with hardly any of the hand's line.
    uncovered = contains_xy(limb(*NEAR_ARM[1:]).buffer(2), x, y) & (y < 275)
    away = np.abs(shown[uncovered, :3].astype(float) - SKIN).max(axis=1)
    assert (away > 40).mean() < 0.05


def frame(document, rgba, time):
    """Return a frame of a document on clear ground."""
    layer = document.layer(0)
    settings = ExportSettings(format="picture", framing="canvas")
    evaluator, context = Evaluator.exact(document), create_context()
    plan = plan_export(
        document, ExportRequest(out=Path("a.png"), settings=settings, project="arm"), evaluator
    )
    cut = texture(rgba, subject_mask(rgba, layer.cut_out))
    renderer = FrameRenderer(context, document, {0: cut}, evaluator, plan)
    shown = renderer.draw(renderer.pose(time))
    renderer.release()
    context.release()
    return shown


def test_arm_is_parted_once(drawn):
    document, rgba, joints = drawn
    request = MotionRequest(motion="walk", kind="biped-side", joints=joints, facing=1)
    solve = start_motion_solve(document, 0, request, rgba)
    lines = solve.document.layer(0).cut_out.cut_lines
    again = start_motion_solve(solve.document, 0, request, rgba)
    assert again.document.layer(0).cut_out.cut_lines == lines


def test_walk_swings_the_arm_against_the_near_leg(drawn):
    document, rgba, joints = drawn
    request = MotionRequest(motion="walk", kind="biped-side", joints=joints, facing=1)
    solve = start_motion_solve(document, 0, request, rgba)
    ids = solve.applied.joints
    hand, foot, hips = (
        np.array([each.targets[ids[name]].position for each in solve.key_poses])
        for name in ("hand.R", "foot.R", "hips")
    )
    swing, step = (hand - hips).real, (foot - hips).real
    assert np.ptp(swing) > 40
    assert np.corrcoef(swing, step)[0, 1] < -0.5
