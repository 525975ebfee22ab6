"""Ready motions on layers: given, blended in, repeated, given again, and saved."""

from dataclasses import replace

import numpy as np
import pytest
from animations import within
from bodies import JOINTS, drawing
from numpy.testing import assert_allclose
from shapes import regular_polygon

from app.document import (
    Document,
    FrameRange,
    Meshing,
    clip_of,
    find_limbs,
    find_motion_edits,
    is_motion_unedited,
    key_commands,
)
from app.errors import LissomError
from app.motion import Animation, PoseSampler, trace_paths
from app.rigging import Parameters
from app.solving import MotionRequest, start_motion_solve, step_motion_solve
from app.solving.motion_preset.key_poses import find_start_pose
from app.storage import load_project, open_picture, save_project
from engine.errors import EngineError

CHAIN = MotionRequest(motion="wag", kind="chain", joints=JOINTS["chain"])
FEW = Meshing(triangles=1000, detail="coarse")
# Outlines of some of the drawings.
ROUND = regular_polygon(8)
COARSE = {
    "chain": np.array([12 + 142j, 308 + 142j, 308 + 178j, 12 + 178j]),
    "anything": 160 + 160j + 100 * ROUND.real + 130j * ROUND.imag,
}


def given(document: Document, order: MotionRequest) -> Document:
    giving = start_motion_solve(document, document.layers[0].id, order)
    while not giving.is_over:
        assert giving.progress < 1
        assert giving.status_text
        giving = step_motion_solve(giving)
    return giving.command(document)


@pytest.fixture(scope="module")
def scenes(tmp_path_factory) -> dict[str, Document]:
    """Drawings as they were opened, at so few frames a second that each is posed."""
    folder = tmp_path_factory.mktemp("bodies")
    scenes = {}
    for kind in ("chain", "biped-side", "anything"):
        drawing(kind).save(folder / f"{kind}.png")
        opened = open_picture(folder / f"{kind}.png", FEW).document
        if kind in COARSE:
            opened = within(opened, COARSE[kind])
        scenes[kind] = replace(opened, fps=12).with_layer(replace(opened.layers[0], variant="nu"))
    return scenes


@pytest.fixture(scope="module")
def wagging(scenes) -> Document:
    return given(scenes["chain"], CHAIN)


def test_given_motion_loops_exactly_on_a_new_drawing(wagging):
    (layer,) = wagging.layers
    assert (wagging.frames, wagging.loop) == (FrameRange(0, 12), True)
    assert layer.keys[0].pose is layer.keys[-1].pose
    (motion,) = layer.motions
    assert is_motion_unedited(layer, motion)
    assert [layer.handle(each).name for each in motion.joints.values()] == list(motion.joints)
    assert all(layer.is_proven(key.pose) for key in layer.keys)


def test_planted_feet_keep_one_speed_and_shins_their_length(scenes):
    order = MotionRequest(
        motion="walk",
        kind="biped-side",
        joints={**JOINTS["biped-side"], "hip.L": 178 + 128j, "hip.R": 142 + 128j},
        parameters=Parameters(speed=2.0, size=0.4),
    )
    scene = scenes["biped-side"]
    giving = start_motion_solve(scene, scene.layers[0].id, order)
    assert giving.applied.facing == 1
    assert [moment.frame for moment in giving.key_poses] == [0, 2, 3, 4, 6, 8, 9, 10]
    while not giving.is_over:
        giving = step_motion_solve(giving)
    document = giving.command(scene)
    (layer,), clip = document.layers, clip_of(document, 0)
    assert {bone.ends for bone in layer.bones} >= {
        tuple(giving.applied.joints[name] for name in pair)
        for pair in (("hip.L", "knee.L"), ("knee.L", "foot.L"))
    }
    limbs, walk = find_limbs(layer), giving.applied
    sampler = PoseSampler(layer, points=limbs.points)
    animation = Animation(clip, points=limbs.points, sampler=sampler)
    # The left foot stands from the first frame on, for half of the cycle.
    feet, knees = [], []
    for frame in (0, 2, 3, 4, 5, 6):
        placed = limbs.locate(animation.frame(frame).positions)
        feet.append(placed.places[walk.joints["foot.L"]] - walk.ground_velocity * frame)
        knees.append(placed.places[walk.joints["knee.L"]] - walk.ground_velocity * frame)
    assert walk.ground_velocity < 0
    assert_allclose(feet, feet[0], atol=3e-3 * 320)
    rest = abs(JOINTS["biped-side"]["knee.L"] - JOINTS["biped-side"]["foot.L"])
    assert_allclose(np.abs(np.subtract(knees, feet)), rest, rtol=0.03)
    # The next key starts with hips where the preset has them, whatever the legs did with them.
    pose, moment = giving.poses[3], giving.key_poses[3]
    begin = find_start_pose(giving.rig, giving.poses[:4], giving.key_poses)
    for joint in ("hip.L", "hip.R"):
        hip = walk.joints[joint]
        assert pose.targets[hip].position != moment.targets[hip].position
        assert begin.targets[hip].position == moment.targets[hip].position
    assert begin.targets[walk.joints["knee.L"]] == pose.targets[walk.joints["knee.L"]]


def test_feet_that_stand_stay_while_knees_bend_when_a_walk_travels(scenes):
    order = MotionRequest(
        motion="walk",
        kind="biped-side",
        joints={**JOINTS["biped-side"], "hip.L": 178 + 128j, "hip.R": 142 + 128j},
        parameters=Parameters(speed=2.0, size=0.4, travel=True),
    )
    giving = start_motion_solve(scenes["biped-side"], 0, order)
    while len(giving.poses) < 4:
        giving = step_motion_solve(giving)
    foot = giving.applied.joints["foot.L"]
    wanted = giving.key_poses[0].targets[foot].position
    assert_allclose([pose.targets[foot].position for pose in giving.poses], wanted, atol=1e-9)


def test_a_nodding_neck_does_not_carry_the_body_along(scenes):
    joints = dict(JOINTS["biped-side"])
    joints["neck"] = joints["chest"] + 0.3 * (joints["head"] - joints["chest"])
    order = MotionRequest(motion="nod", kind="biped-front", joints=joints)
    solve = start_motion_solve(scenes["biped-side"], scenes["biped-side"].layers[0].id, order)
    while not solve.is_solved:
        solve = step_motion_solve(solve)
    hips, neck = (solve.applied.joints[name] for name in ("hips", "neck"))
    planned = [moment.targets for moment in solve.key_poses]
    assert np.ptp([targets[neck].position.imag for targets in planned]) > 3
    assert_allclose(
        [pose.targets[hips].position for pose in solve.poses],
        [targets[hips].position for targets in planned],
        atol=0.8,
    )


def test_edits_by_hand_stay_when_a_motion_is_applied_with_other_settings(wagging):
    layer = wagging.layers[0]
    (motion,) = layer.motions
    handle = motion.joints["joint.4"]
    key = layer.keys[2]
    target = replace(key.pose.targets[handle], position=key.pose.targets[handle].position + 9j)
    pose = replace(key.pose, targets={**key.pose.targets, handle: target})
    edited = key_commands.replace_key_pose(layer.id, key.frame, pose)(wagging)
    edits = find_motion_edits(edited.layers[0], motion)
    assert {number: dict(ways) for number, ways in edits.shifts.items()} == {2: {handle: 9j}}
    kept = {"edits": edits, "edited_start": motion.start, "edited_period": 12}
    again = replace(CHAIN, handles=motion.joints, parameters=Parameters(size=0.8), **kept)
    after = given(edited, again)
    plain = given(wagging, replace(again, edits=None))
    ways = [
        one.pose.targets[handle].position - other.pose.targets[handle].position
        for one, other in zip(after.layers[0].keys, plain.layers[0].keys, strict=True)
    ]
    assert_allclose(ways[2], 9j, atol=1.0)
    assert_allclose(ways[:2] + ways[3:-1], 0, atol=1e-6)
    twice = find_motion_edits(after.layers[0], after.layers[0].motions[0])
    assert set(twice.shifts) == {2}


def test_it_is_given_again_in_another_way_until_it_is_edited(wagging):
    layer = wagging.layers[0]
    again = replace(CHAIN, handles=layer.motions[0].joints)
    slower = replace(again, parameters=Parameters(speed=0.5, size=0.5))
    twice = given(given(wagging, slower), again)
    assert twice.layers[0].handles == layer.handles
    assert [key.frame for key in twice.layers[0].keys] == [key.frame for key in layer.keys]
    for one, other in zip(twice.layers[0].keys, layer.keys, strict=True):
        assert one.pose.targets == other.pose.targets
    moved = key_commands.replace_key_pose(layer.id, 4, layer.keys[0].pose)(wagging)
    assert not is_motion_unedited(moved.layers[0], layer.motions[0])


def test_second_motion_blends_in_when_it_begins_in_the_first(wagging):
    second = replace(CHAIN, motion="slither", first=9, repeat_count=2)
    scene = given(wagging, second)
    moved = scene.layers[0]
    first, slither = moved.motions[0], moved.motions[-1]
    assert (slither.first, slither.start, slither.last) == (9, 12, 48)
    # The former lost its end, and is forgotten.
    assert first is slither
    assert moved.keys[-1].frame < slither.start + 18
    assert [(each.first, each.last, each.until) for each in moved.cycles] == [(12, 30, 48)]
    paths = trace_paths(clip_of(scene, moved.id))
    speeds = np.abs(np.diff(paths.positions, axis=0)).max(axis=1)
    assert speeds[9:12].max() < 2 * max(speeds[:9].max(), speeds[12:].max())
    assert_allclose(paths.positions[12], paths.positions[30], atol=1e-6 * 320)


def test_it_survives_saving(wagging, tmp_path):
    save_project(tmp_path / "wag.lissom", wagging, thumbnail=None)
    read = load_project(tmp_path / "wag.lissom").layers[0]
    assert read.motions == wagging.layers[0].motions
    assert is_motion_unedited(read, read.motions[0])


def test_motion_out_of_reach_is_reported_with_a_size_in_reach(scenes):
    order = MotionRequest(
        motion="breathe", kind="anything", joints={}, parameters=Parameters(size=2.0)
    )
    tight = scenes["anything"].layers[0]
    bounds = replace(tight.bounds, k=0.05, sigma_a=1.05, sigma_b=0.95)
    scene = scenes["anything"].with_layer(replace(tight, bounds=bounds))
    giving = start_motion_solve(scene, tight.id, order)
    while not giving.is_over:
        giving = step_motion_solve(giving)
    (notice,) = giving.notices
    assert "miss their targets" in notice
    assert giving.reachable_size is not None
    assert 0 < giving.reachable_size < 2
    fits = replace(order, parameters=Parameters(size=giving.reachable_size))
    smaller = start_motion_solve(scene, tight.id, fits)
    worst = max(frame for _, frame in giving.target_errors.values())
    assert worst > 0
    while smaller.key_poses[len(smaller.poses)].frame <= worst:
        smaller = step_motion_solve(smaller)
    assert not smaller.target_errors


def test_what_cannot_be_given_is_refused(scenes):
    chain, identity = scenes["chain"], scenes["chain"].layers[0].id
    with pytest.raises(EngineError, match="There is no motion preset 'dance'"):
        MotionRequest(motion="dance", kind="chain", joints={})
    with pytest.raises(LissomError, match=r"the joint 'joint.2' at \(5, 5\) is not on the drawing"):
        start_motion_solve(
            chain, identity, replace(CHAIN, joints={**JOINTS["chain"], "joint.2": 5 + 5j})
        )
    few = {name: JOINTS["chain"][name] for name in ("joint.1", "joint.2")}
    with pytest.raises(EngineError, match=r"'wag' needs joint\.3"):
        start_motion_solve(chain, identity, replace(CHAIN, joints=few))
