"""What kind of body a shape looks like, and where its joints may be."""

from itertools import pairwise

import numpy as np
import pytest
import shapely
from silhouettes import BODIES, CHILD, FISH, HORSE, KANGAROO, SNAKE, WALKER, dot, drawn

from app.rigging import (
    KINDS,
    find_kind,
    guess_kind,
    guess_near_limbs,
    name_near_limbs,
    near_side,
    suggest_joints,
    track_legs,
    with_tracked_legs,
)
from app.rigging.anatomy.legs import TrackedLeg
from app.rigging.anatomy.lines.near_limbs import NearLimb
from engine.geometry import contains, signed_area


def suggested(loops, kind):
    """Return the joints by their names, all of them inside and of the kind."""
    joints = suggest_joints(loops, find_kind(kind))
    places = np.array(list(joints.values()), dtype=complex)
    assert contains(loops[0], places, holes=loops[1:]).all()
    find_kind(kind).require_joints(joints)
    return joints


@pytest.mark.parametrize("name", BODIES)
@pytest.mark.parametrize("flip", [False, True])
def test_a_kind_is_guessed_from_either_side_and_every_kind_has_joints_inside(name, flip):
    kind, strokes = BODIES[name]
    loops = drawn(*((-np.conj(points) if flip else points, width) for points, width in strokes))
    assert guess_kind(loops).name == kind
    for other in KINDS:
        suggested(loops, other)


def test_a_child_from_the_front_has_its_left_on_the_right_of_the_picture():
    joints = suggested(drawn(*CHILD), "biped-front")
    assert joints.keys() >= set(find_kind("biped-front").usual)
    assert "tail" not in joints
    for side, way in (("L", 1), ("R", -1)):
        assert abs(joints[f"hand.{side}"] - complex(way * 215, 285)) < 25
        assert abs(joints[f"foot.{side}"] - complex(way * 50, 25)) < 35
        assert 30 < way * joints[f"shoulder.{side}"].real < 90
        assert 20 < way * joints[f"hip.{side}"].real < 60
    assert joints["head"].imag > 470
    assert 310 > joints["chest"].imag > joints["hips"].imag + 40


def test_from_the_side_the_leg_ahead_goes_with_the_arm_behind():
    joints = suggested(drawn(*WALKER), "biped-side")
    assert joints["foot.L"].real > 40 > -40 > joints["foot.R"].real
    assert joints["hand.R"].real > 40 > -40 > joints["hand.L"].real
    for ankle in ("foot.L", "foot.R"):
        assert joints[ankle].imag < 50
    for side in "LR":
        root, knee, ankle = (joints[f"{name}.{side}"] for name in ("hip", "knee", "foot"))
        assert root.imag > knee.imag > ankle.imag


def test_a_kangaroo_on_its_tail_has_one_leg_and_a_heel():
    joints = suggested(drawn(*KANGAROO), "biped-side")
    assert "foot.R" not in joints, "there is but one"
    assert abs(joints["foot.L"] - (-45 + 25j)) < 30, "not at its toes"
    assert joints["tail"].real < -240
    assert joints["head"].imag > 420


def test_a_steep_tail_is_no_second_foot():
    loops = drawn(*KANGAROO[:-1], ([-110 + 110j, -190 + 60j, -240 + 12j, -290 + 8j], 40))
    assert guess_kind(loops).name == "biped-side"
    joints = suggested(loops, "biped-side")
    assert "foot.R" not in joints
    assert joints["foot.L"].real > -80


def test_a_horse_has_two_pairs_of_legs_with_the_outer_ones_on_one_side():
    joints = suggested(drawn(*HORSE), "four-legs")
    feet = {"foot.L": -185, "foot.R": -115, "hand.R": 55, "hand.L": 125}
    assert all(abs(joints[name] - complex(x, 25)) < 30 for name, x in feet.items())
    assert joints["hips"].real < -80 < 40 < joints["chest"].real
    assert joints["tail"].real < -220 < 130 < joints["head"].real


def test_legs_whose_feet_touch_are_two():
    loops = drawn(([100j, 250j], 120), ([-40 + 100j, -40, 0], 24), ([40 + 100j, 40, 0], 24))
    assert len(loops) == 2
    joints = suggested(loops, "biped-front")
    assert joints["foot.R"].real < -15 < 15 < joints["foot.L"].real


@pytest.mark.parametrize(("strokes", "head"), [([*SNAKE, dot(245 + 15j, 34)], 240), (FISH, 60)])
def test_a_chain_begins_at_its_head(strokes, head):
    joints = list(suggested(drawn(*strokes), "chain").values())
    assert joints[0].real > head
    assert joints[-1].real < -90
    assert len(joints) >= 4
    steps = np.abs(np.diff(joints))
    assert steps.max() < 1.6 * steps.min()


def test_what_is_anything_has_no_joints():
    assert suggested(drawn(*CHILD), "anything") == {}


@pytest.mark.parametrize("name", BODIES)
def test_joints_are_the_same_however_densely_edges_are_sampled(name):
    kind, strokes = BODIES[name]
    loops = drawn(*strokes)
    joints = suggested(loops, kind)
    shares = np.arange(3) / 3
    fine = [
        (loop[:, None] + shares * (np.roll(loop, -1) - loop)[:, None]).ravel() for loop in loops
    ]
    assert guess_kind(fine).name == kind
    others = suggested(fine, kind)
    assert others.keys() == joints.keys()
    for joint, place in joints.items():
        assert abs(others[joint] - place) < 1e-6


def test_corner_that_stays_in_a_disc_of_the_body_is_no_leg():
    body = shapely.Point(0, 0).buffer(34).union(shapely.LineString([(0, 0), (23, -33)]).buffer(5))
    rings = body.exterior, shapely.Point(11, -10).buffer(8).exterior
    outline, hole = (np.array(ring.coords)[:-1] @ [1, 1j] for ring in rings)
    assert signed_area(outline) * signed_area(hole) > 0
    loops = [outline[::-1], hole] if signed_area(outline) < 0 else [outline, hole[::-1]]
    assert guess_kind(loops).name == "anything"


def side_view(near_is_left, *, shade=(150, 150), line=False, drop=0.0):
    """Return the shape of two legs and its picture; the near leg may stand lower."""
    ways = [[100j, -30 + 50j, -40 + 0j], [100j, 30 + 50j, 40 + 0j]]
    near = 0 if near_is_left else 1
    ways[near][-1] -= 1j * drop
    loops = drawn(([100j, 200j], 90), *((way, 24) for way in ways))
    corner = complex(-120, -60)
    rgba = np.full((400, 240, 4), 255, np.uint8)
    rgba[..., :3] = shade[0]
    columns = np.arange(240) + corner.real
    far = columns > 0 if near_is_left else columns < 0
    rgba[:, far, :3] = shade[1]
    if line:
        rgba[round(400 - (75 - corner.imag)) : round(400 - (68 - corner.imag)), far, :3] = 20
    joints = {
        f"{name}.{side}": place
        for side, way in zip("LR", ways, strict=True)
        for name, place in zip(("hip", "knee", "foot"), way, strict=True)
    }
    return loops, joints, rgba, corner


@pytest.mark.parametrize("near_is_left", [True, False])
@pytest.mark.parametrize("sign", [{"shade": (150, 100)}, {"line": True}, {"drop": 12.0}])
def test_near_leg_is_brighter_lower_or_not_crossed_by_a_line(near_is_left, sign):
    (found,) = guess_near_limbs(*side_view(near_is_left, **sign))
    assert found.near == ("foot.L" if near_is_left else "foot.R")
    assert found.is_sure


def test_near_leg_of_a_plain_silhouette_is_not_sure():
    (found,) = guess_near_limbs(*side_view(near_is_left=True))
    assert not found.is_sure


@pytest.mark.parametrize("facing", [1, -1])
def test_near_limbs_are_named_after_the_near_side(facing):
    _, joints, _, _ = side_view(near_is_left=True)
    named = name_near_limbs(joints, [NearLimb("foot.L", is_sure=True)], facing)
    assert named[f"foot.{near_side(facing)}"] == joints["foot.L"]
    assert set(named.values()) == set(joints.values())


def joined_legs(*, has_line):
    """Return a body on two legs that are one block, which a line may part, and its picture."""
    outline = np.array(
        [60, 140, 140 + 150j, 240 + 150j, 240 + 300j, -40 + 300j, -40 + 150j, 60 + 150j]
    )
    rgba = np.full((340, 340, 4), 200, np.uint8)
    if has_line:
        rgba[340 - 170 : 340 - 20, 148:153, :3] = 20
    return [outline], rgba, complex(-50, -20)


def test_a_line_parts_two_legs_of_one_silhouette():
    legs = track_legs(*joined_legs(has_line=True))
    assert [round(leg.foot.real / 10) for leg in legs] == [8, 12]
    for leg in legs:
        assert leg.foot.imag < leg.knee.imag < leg.root.imag <= 180
    assert len(track_legs(*joined_legs(has_line=False))) < 2


@pytest.mark.parametrize("way", [1, -1])
def test_a_pig_without_a_tail_stands_on_four_legs_that_lines_part(way):
    def turned(*places):
        return [way * at.real + 1j * at.imag for at in map(complex, places)]

    body = [([-150 + 200j, 150 + 200j], 170), dot(270 + 230j, 70)]
    joined = [([at + 150j, at + 20j], 90) for at in (-130, 130)]
    loops = drawn(*((turned(*points), width) for points, width in body + joined))
    legs = [
        TrackedLeg(*turned(at + 130j, at + 70j, at + 30j)) for at in (-150, -110, 110, 150)[::way]
    ]
    assert guess_kind(loops).name == "chain", "by its silhouette"
    assert guess_kind(loops, legs).name == "four-legs"
    joints = suggest_joints(loops, find_kind("four-legs"), legs)
    assert way * joints["head"].real > way * joints["chest"].real > 50
    assert way * joints["hips"].real < -50


def test_tracked_legs_replace_the_silhouettes_and_leave_a_raised_limb_as_an_arm():
    legs = [TrackedLeg(at + 100j, at + 50j, at) for at in (0.0, 30.0)]
    joints = {"hips": 20 + 140j, "chest": 20 + 180j, "hip.R": 160j, "foot.R": -40 + 130j}
    found = with_tracked_legs(joints, find_kind("biped-side"), legs, 1)
    assert found["foot.L"] == 30
    assert found["foot.R"] == 0
    assert found["hand.L"] == -40 + 130j
    assert found["hips"].imag > 100
    mirrored = with_tracked_legs(joints, find_kind("biped-side"), legs, -1)
    assert mirrored["foot.L"] == 0
    assert with_tracked_legs(joints, find_kind("four-legs"), legs, 1) == joints


def test_a_tail_that_leans_on_the_ground_is_no_leg_though_lines_part_it():
    joints = suggest_joints(drawn(*KANGAROO), find_kind("biped-side"))
    tail = [at for name, at in joints.items() if name.startswith("tail")]
    foot = (tail[0] + tail[-1]) / 2
    legs = [TrackedLeg(tail[0] + 40j, tail[0], foot), TrackedLeg(200j, 100j, -40 + 30j)]
    assert with_tracked_legs(joints, find_kind("biped-side"), legs, 1) == joints


@pytest.mark.parametrize("way", [1, -1])
def test_hips_in_a_near_thigh_move_into_the_trunk_beside_it(way):
    def turned(*places):
        return [way * at.real + 1j * at.imag for at in map(complex, places)]

    # A dog in mid-step: the silhouette shows the fork of its legs within the near thigh.
    legs = [
        TrackedLeg(*turned(*leg))
        for leg in (
            (280 + 458j, 251 + 266j, 168 + 92j),
            (328 + 312j, 359 + 196j, 334 + 78j),
            (646 + 302j, 622 + 200j, 586 + 102j),
            (691 + 404j, 726 + 241j, 754 + 78j),
        )[::way]
    ]
    hips, chest, neck = turned(302 + 326j, 661 + 420j, 760 + 498j)
    joints = {"hips": hips, "chest": chest, "neck": neck}
    found = with_tracked_legs(joints, find_kind("four-legs"), legs, way)
    assert found["hips"].imag == 458
    assert 350 < way * found["hips"].real < 400
    assert found["chest"] == chest, "above the root of its leg"


def test_two_legs_in_one_branch_of_the_silhouette_are_no_tail_but_the_legs():
    legs = [TrackedLeg(at + 270j, at + 180j, at + 100j) for at in (340.0, 385.0)]
    joints = {"hips": 362 + 364j, "tail.1": 362 + 219j, "tail.2": 361 + 117j, "tail": 300 + 70j}
    found = with_tracked_legs(joints, find_kind("biped-side"), legs, -1)
    assert found["foot.L"] == legs[0].foot
    assert found["foot.R"] == legs[1].foot
    assert not any(name.startswith("tail") for name in found)
    # A tail that begins above the legs stays.
    high = {**joints, "tail.1": 362 + 300j}
    assert "tail" in with_tracked_legs(high, find_kind("biped-side"), legs, -1)


def test_an_upright_mirrored_body_has_both_short_feet_and_lines_part_no_four_legs():
    body = [([200j, 460j], 340), dot(660j, 240)]
    feet = [([at * 70 + 40j, at * 130 - 10j], 60) for at in (-1, 1)]
    flippers = [([at * 150 + 470j, at * 215 + 350j, at * 235 + 260j], 60) for at in (-1, 1)]
    loops = drawn(*body, *feet, *flippers)
    lines = [TrackedLeg(at + 500j, at + 350j, at + 150j) for at in (-110.0, 0.0, 110.0)]
    assert guess_kind(loops, lines).name == "biped-front"
    joints = suggest_joints(loops, find_kind("biped-front"), lines)
    for limb in ("foot", "hand"):
        left, right = joints[f"{limb}.L"], joints[f"{limb}.R"]
        assert left.real > 50
        assert abs(left + right.conjugate()) < 40


def test_a_long_thin_tail_has_a_chain_from_its_base_outside_the_body():
    horse = drawn(*HORSE, ([-150 + 210j, -300 + 150j, -420 + 170j], 24))
    joints = suggested(horse, "four-legs")
    tail = [at for name, at in joints.items() if name.startswith("tail")]
    assert len(tail) > 2
    assert list(joints)[-1] != "tail"
    assert all(other.real < one.real for one, other in pairwise(tail))
