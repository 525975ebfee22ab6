"""Limbs: chains of bones that keep their lengths and follow their ends."""

from dataclasses import replace
from functools import cache
from itertools import pairwise

import numpy as np
import pytest
from animations import still_document
from messages import says

from app.document import Bone, clip_of, find_limbs, with_directed_bones
from app.document.rig.chains import CIRCLE_OF_BONES, TWO_BONES_END, find_chains, require_chains
from app.errors import LissomError
from app.motion import Animation
from app.rigging import bend_side, solve_chain
from app.solving import pose_document
from app.solving.drag import rig
from app.solving.drag.drag_solver import DragSolver
from app.solving.script.keys import NO_END, NO_JOINT
from app.solving.script.pose_script import parse_pose_script

HANDLES = {
    "head": [200, 350],
    "hip": [200, 250],
    "knee": [205, 150],
    "foot": [200, 50],
    "shoulder": [225, 300],
    "elbow": [295, 302],
    "hand": [365, 300],
}
WRISTED = {**HANDLES, "wrist": [335, 301]}
LEG, ARM = ["hip", "knee", "foot"], ["shoulder", "elbow", "hand"]


@cache
def figure():
    """A trunk with one leg and one arm, 400 by 400 pixels, y up in scripts."""
    picture = np.zeros((400, 400, 4), np.uint8)
    for left, right, bottom, top in (
        (150, 250, 220, 380),  # trunk
        (185, 222, 30, 230),  # leg
        (240, 385, 285, 318),  # arm
    ):
        picture[400 - top : 400 - bottom, left:right] = (200, 120, 60, 255)
    return still_document(picture)


def posed(*keys, bones=(LEG, ARM), handles=HANDLES, **fields):
    script = {"schema": 1, "handles": handles, "bones": list(bones), "keys": list(keys), **fields}
    document, notices = pose_document(figure(), parse_pose_script(script), lambda _: None)
    return document.layers[0], notices


def places(layer, key=-1):
    """Return the targets of a key by name."""
    targets = layer.keys[key].pose.targets
    return {handle.name: targets[handle.id].position for handle in layer.handles}


def lengths(layer, chain):
    at, rest = places(layer), {handle.name: handle.position for handle in layer.handles}
    return [
        abs(at[end] - at[start]) / abs(rest[end] - rest[start]) - 1
        for start, end in pairwise(chain)
    ]


def head_error(layer):
    """Return how far the head is off its own rigid motion, in pixels."""
    rest = np.array([160, 200, 240, 200]) + 1j * np.array([370, 370, 370, 340])
    moved = layer.map_of(layer.keys[-1].pose)(rest)
    p, q = rest - rest.mean(), moved - moved.mean()
    turn = np.vdot(p, q)
    return np.abs(q - turn / abs(turn) * p).max()


def test_a_foot_bends_its_leg_and_leaves_the_head_alone():
    layer, notices = posed({"frame": 0}, {"frame": 9, "targets": {"foot": [230, 110]}})
    assert notices == ()
    pose = layer.keys[1].pose
    assert layer.is_proven(pose)
    foot = layer.map_of(pose)(np.array([200 + 50j]))[0]
    assert abs(foot - 230 - 110j) < 0.5
    assert np.abs(lengths(layer, LEG)).max() < 0.01
    assert head_error(layer) < 1.5
    bend = bend_side(*(places(layer)[name] for name in LEG))
    assert bend == bend_side(*(layer.handles[i].position for i in (1, 2, 3)))


def test_a_hand_beyond_reach_straightens_its_arm_and_stays_on_the_circle():
    layer, notices = posed({"frame": 0}, {"frame": 9, "targets": {"hand": [390, 500]}})
    assert notices == (
        "frame 9: 'hand' is 119.2 px from its target, beyond the reach of its bones",
    )
    at, reach = (
        places(layer),
        sum(abs(a - b) for a, b in ((225 + 300j, 295 + 302j), (295 + 302j, 365 + 300j))),
    )
    hand = layer.map_of(layer.keys[1].pose)(np.array([365 + 300j]))[0]
    assert abs(abs(hand - at["shoulder"]) - reach) < 1
    assert abs(np.angle((hand - 225 - 300j) / (165 + 200j))) < 0.02
    assert np.abs(lengths(layer, ARM)).max() < 0.01


def test_a_side_says_which_way_a_joint_bends():
    keys = [
        {"frame": 9, "targets": {"hand": [340, 330]}, "side": {"elbow": side}} for side in (1, -1)
    ]
    left, right = (posed({"frame": 0}, key)[0] for key in keys)
    assert [bend_side(*(places(layer)[n] for n in ARM)) for layer in (left, right)] == [1, -1]
    # The side stays in later keys.
    later = {"frame": 18, "targets": {"hand": [330, 340]}}
    after, _ = posed({"frame": 0}, keys[1], later)
    assert bend_side(*(places(after)[name] for name in ARM)) == -1


def test_an_elbow_turns_both_bones_of_its_arm():
    layer, _ = posed({"frame": 0}, {"frame": 9, "targets": {"elbow": [285, 335]}})
    at = places(layer)
    turns = [
        np.angle((at[end] - at[start]) / (layer.handles[j].position - layer.handles[i].position))
        for (start, end), (i, j) in zip(pairwise(ARM), ((4, 5), (5, 6)), strict=True)
    ]
    assert turns == pytest.approx([np.angle(60 + 35j) - np.angle(70 + 2j)] * 2, abs=0.03)


def test_a_hip_carries_the_body_and_the_foot_stays():
    layer, _ = posed({"frame": 0}, {"frame": 9, "targets": {"hip": [210, 230]}})
    at = places(layer)
    assert abs(at["head"] - 210 - 330j) < 1
    assert abs(at["shoulder"] - 235 - 280j) < 1
    assert abs(at["foot"] - 200 - 50j) < 0.5
    assert np.abs(lengths(layer, LEG)).max() < 0.01
    assert head_error(layer) < 1.5


def test_an_arm_of_three_bones_reaches_its_goal():
    handles = {**HANDLES, "wrist": [335, 301]}
    chain = ["shoulder", "elbow", "wrist", "hand"]
    layer, _ = posed(
        {"frame": 0}, {"frame": 9, "targets": {"hand": [330, 345]}}, bones=[chain], handles=handles
    )
    hand = layer.map_of(layer.keys[1].pose)(np.array([365 + 300j]))[0]
    assert abs(hand - 330 - 345j) < 1
    assert np.abs(lengths(layer, chain)).max() < 0.05


def test_one_bone_turns_around_its_root():
    handles = {name: place for name, place in HANDLES.items() if name != "elbow"}
    key = {"frame": 9, "targets": {"hand": [360, 345]}}
    layer, _ = posed({"frame": 0}, key, bones=[["shoulder", "hand"]], handles=handles)
    at = places(layer)
    assert abs(at["hand"] - at["shoulder"]) == pytest.approx(140, abs=2.5)
    assert np.angle(at["hand"] - 225 - 300j) == pytest.approx(np.angle(135 + 45j), abs=0.03)


@pytest.mark.parametrize(
    ("fields", "message"),
    [
        ({"bones": [["hip", "knee"], ["foot", "knee"]]}, says(TWO_BONES_END, handle="knee")),
        (
            {"bones": [["hip", "knee", "foot"], ["foot", "hip"]]},
            says(CIRCLE_OF_BONES, bones="hip – knee – foot – hip"),
        ),
        ({"bones": [["hip", "knee", "foot"], ["hip", "knee"]]}, "another chain has too"),
        ({"bones": [["hip"]]}, "at least two handles from root to end"),
        ({"bones": [["hip", "hip"]]}, "connects 'hip' to itself"),
        ({"bones": [["hip", "knee", "hip"]]}, "names 'hip' twice"),
        ({"bones": [["hip", 3]]}, "must be a text, not 3"),
        ({"bones": [["hip", "toe"]]}, "names the handle 'toe', which does not exist"),
        ({"bones": [["hand", "foot"]]}, "bone from 'hand' to 'foot': The bone leaves the drawing"),
        ({"keys": [{"frame": 0, "side": {"knee": 2}}]}, "must be 1 or -1, not 2"),
        (
            {"keys": [{"frame": 0, "side": {"foot": 1}}]},
            says(NO_JOINT, where="keys[0]", name="foot"),
        ),
        (
            {"keys": [{"frame": 0, "angle": {"head": 1}}]},
            says(NO_END, where="keys[0]", name="head"),
        ),
    ],
)
def test_wrong_bones_of_a_script_are_refused_by_name(fields, message):
    script = {"schema": 1, "handles": HANDLES, "bones": [LEG], "keys": [{"frame": 0}], **fields}
    with pytest.raises(LissomError, match=message):
        pose_document(figure(), parse_pose_script(script), lambda _: None)


def test_chains_are_found_from_roots_on():
    bones = [Bone(ends=ends) for ends in ((3, 4), (1, 2), (2, 3), (3, 5), (8, 9))]
    assert [chain.handles for chain in find_chains(bones)] == [(1, 2, 3), (8, 9), (3, 4), (3, 5)]
    require_chains(bones, {})
    soft = Bone(ends=(1, 3), stiffness=0.5)
    assert len(find_chains([*bones, soft])) == 4


def test_bones_of_earlier_versions_get_their_directions_from_the_drawing():
    layer, _ = posed({"frame": 0}, bones=[])
    hip, knee, foot = (handle.id for handle in layer.handles[1:4])
    bones = tuple(Bone(ends=ends, is_directed=False) for ends in ((foot, knee), (knee, hip)))
    old = with_directed_bones(type(layer)(**{**_fields(layer), "bones": bones}))
    assert {bone.ends for bone in old.bones} == {(hip, knee), (knee, foot)}
    assert with_directed_bones(old) is old


def _fields(layer):
    return {name: getattr(layer, name) for name in layer.__dataclass_fields__}


@pytest.mark.parametrize("count", [1, 2, 3, 5])
@pytest.mark.parametrize("share", [0.5, 0.9, 1.5])
def test_a_chain_reaches_what_it_can_and_keeps_its_lengths(count, share):
    rng = np.random.default_rng(count)
    lengths = rng.uniform(0.5, 1.5, count)
    start = np.cumsum(lengths * np.exp(1j * rng.uniform(-0.6, 0.6, count))).tolist()
    goal = share * lengths.sum() * np.exp(0.8j)
    found = solve_chain(0j, lengths, goal, start, 1)
    assert np.abs(np.diff([0j, *found])) == pytest.approx(lengths, rel=1e-6)
    assert abs(np.angle(found[-1] / goal)) < 1e-6
    if count > 1:
        assert abs(found[-1]) == pytest.approx(min(abs(goal), lengths.sum()), rel=1e-4)


@pytest.mark.parametrize("chain", [LEG, ARM])
def test_a_body_held_by_the_root_alone_does_not_turn(chain):
    handles = {name: HANDLES[name] for name in chain}
    goal = {"foot": [300, 90], "hand": [350, 235]}[chain[-1]]
    layer, _ = posed(
        {"frame": 0}, {"frame": 9, "targets": {chain[-1]: goal}}, bones=[chain], handles=handles
    )
    body = find_limbs(layer).body
    moved = layer.map_of(layer.keys[-1].pose)(body)
    turn = np.angle(np.vdot(body - body.mean(), moved - moved.mean()))
    assert abs(np.degrees(turn)) < 2
    assert abs(places(layer)[chain[-1]] - complex(*goal)) < 1


def bends_of(places):
    ways = np.diff(places)
    return np.angle(ways[1:] / ways[:-1])


@pytest.mark.parametrize("goal", [500 + 260j, 150 + 300j, 320 - 200j])
def test_all_joints_of_a_chain_share_a_bend_and_keep_their_sides(goal):
    lengths, drawn = [270.0, 260.0, 140.0, 100.0], np.radians([100.0, -55.0, -75.0, -25.0])
    start = np.cumsum(lengths * np.exp(1j * np.cumsum(drawn)))
    found = np.array([0, *solve_chain(0j, lengths, goal, start.tolist(), 1)])
    assert abs(found[-1] - goal) < 1e-5
    assert np.all(bends_of(found) <= 0)
    bends = np.array([np.angle(found[1]), *bends_of(found)])
    # Nothing that keeps the end where it is changes less: the change is a sum of both rows.
    arms = 1j * (found[-1] - found[:-1])
    rows = np.array([arms.real, arms.imag])
    free = (bends < -1e-9) | (np.arange(4) == 0)
    rest = np.linalg.lstsq(rows[:, free].T, (bends - drawn)[free])[1]
    assert rest == pytest.approx(0, abs=1e-9)


def test_a_straight_chain_bends_to_its_side():
    for count, side in ((2, 1), (2, -1), (3, 1), (3, -1)):
        start = [complex(i + 1) for i in range(count)]
        found = solve_chain(0j, [1.0] * count, 0.7 * count, start, side)
        assert bend_side(0j, *found[:2]) == side
        assert abs(found[-1] - 0.7 * count) < 1e-6


def test_limbs_keep_their_lengths_between_keys():
    keys = [{"frame": 0}, {"frame": 24, "targets": {"hip": [215, 215]}}]
    layer, _ = posed(*keys)
    limbs = find_limbs(layer)
    points = np.concatenate([shaft.points for shaft in limbs.shafts[:2]])
    clip = clip_of(figure().with_layer(layer), layer.id)
    free = replace(clip, layer=replace(layer, bones=()))
    worst = []
    for each in (clip, free):
        places = Animation(each, points=points).base.frame(12.0).positions
        spans = abs(places[4::5] - places[::5]) / abs(points[4::5] - points[::5])
        worst.append(np.abs(spans - 1).max())
    assert worst[0] < 0.02
    assert worst[0] < 0.5 * worst[1]


def test_a_key_with_a_side_alone_bends_the_limb_where_it_is():
    for chain, handles in ((ARM, HANDLES), (["shoulder", "elbow", "wrist", "hand"], WRISTED)):
        first = {"frame": 9, "targets": {"hand": [345, 320]}}
        layer, _ = posed({"frame": 0}, first, bones=[chain], handles=handles)
        triple = chain[:3] if len(chain) == 3 else [chain[0], chain[1], chain[3]]
        side = bend_side(*(places(layer)[name] for name in triple))
        keys = [{"frame": 0}, first, {"frame": 18, "side": {"elbow": -side}}]
        after, _ = posed(*keys, bones=[chain], handles=handles)
        assert bend_side(*(places(after)[name] for name in triple)) == -side
        assert abs(places(after)["hand"] - places(layer)["hand"]) < 1


@pytest.mark.long
@pytest.mark.parametrize("bend", [50, 70, 90, 110, 130])
@pytest.mark.parametrize("chain", [ARM, LEG])
def test_limbs_fold_and_leave_the_rest_alone(chain, bend):
    rest = [complex(*HANDLES[name]) for name in chain]
    first, second = np.diff(rest)
    side = -bend_side(*rest) if bend_side(*rest) else 1
    turn = side * np.radians(bend) - np.angle(second / first)
    goal = complex(rest[0] + first * np.exp(-0.5j * turn) + second * np.exp(0.5j * turn))
    layer, notices = posed(
        {"frame": 0}, {"frame": 9, "targets": {chain[2]: [goal.real, goal.imag]}}, bones=[chain]
    )
    thousandth = 0.4  # of the picture's size
    # Next to a limb that is folded up, the limits hold others a little off.
    assert not [each for each in notices if repr(chain[2]) in each]
    moved = layer.map_of(layer.keys[1].pose)
    end = moved(np.array([rest[2]]))[0]
    assert abs(end - goal) < thousandth
    others = [handle for handle in layer.handles if handle.name not in chain]
    wanted = [layer.keys[1].pose.targets[each.id].position for each in others]
    missed = np.abs(moved(np.array([each.position for each in others])) - wanted)
    assert missed.max() < 5 * thousandth
    assert np.abs(lengths(layer, chain)).max() < 0.02
    # The sharpest folds press on the trunk.
    assert head_error(layer) < (6 if bend <= 90 else 12) * thousandth
    assert layer.is_proven(layer.keys[1].pose)


def test_limbs_are_solved_once_for_each_target(monkeypatch):
    layer, _ = posed({"frame": 0})
    solved, solve = [], rig.solve_limbs
    monkeypatch.setattr(rig, "solve_limbs", lambda *a: solved.append(a[-1]) or solve(*a))
    pose, hand = layer.keys[0].pose, next(h.id for h in layer.handles if h.name == "hand")
    drag = DragSolver.begin(rig.Rig.of(layer), pose)
    for place in (365 + 290j, 360 + 285j):
        moved = replace(pose.targets[hand], position=place)
        for _ in range(3):
            targets = {**pose.targets, hand: moved}
            drag = drag.step_towards(targets, 1)
            drag.make_pose(targets)
    assert [targets[hand].position for targets in solved] == [365 + 290j, 360 + 285j]
