"""Ready motions loop smoothly, keep lengths, and set feet on the ground."""

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from bodies import body
from numpy.testing import assert_allclose

from app.rigging import (
    MOTIONS,
    Body,
    Parameters,
    Timing,
    bend_straight_legs,
    find_kind,
    find_motion,
    without_side,
)
from app.rigging.motions.stepping import MOST_TURN
from engine.errors import EngineError

USUAL = Parameters()
FITTING = [(name, kind) for name, motion in MOTIONS.items() for kind in motion.kinds]
TRAVELLING = [each for each in FITTING if MOTIONS[each[0]].template_for(each[1]).can_travel]
SIZE = 240.0  # pixels: about that of the bodies
TRUNK = {"hips", "chest", "neck", "hip", "shoulder"}
each_motion = pytest.mark.parametrize(("name", "kind"), FITTING)
each_gait = pytest.mark.parametrize(("name", "kind"), TRAVELLING)


def moments_of(name, of, parameters, shares):
    performed = MOTIONS[name].perform(of, parameters)
    return [performed.pose_at((share + parameters.start) % 1.0, share) for share in shares]


def places(name, kind, shares, parameters=USUAL, of=None):
    moments = moments_of(name, of or body(kind), parameters, shares)
    return {joint: np.array([each.places[joint] for each in moments]) for joint in moments[0][0]}


@each_motion
def test_motions_come_round_smoothly(name, kind):
    count = 480
    rest = body(kind).joints
    moved = places(name, kind, np.arange(count + 1) / count)
    assert max(np.ptp(np.abs(way - rest[joint])) for joint, way in moved.items()) > 0.02 * SIZE
    gait = getattr(MOTIONS[name].template_for(kind), "gait", None)
    is_run = gait is not None and gait.fold > 0
    for joint, way in moved.items():
        assert_allclose(way[-1], way[0], atol=1e-9 * SIZE, err_msg=joint)
        if is_run and without_side(joint) in {"knee", "foot", "elbow", "hand"}:
            continue  # feet hit the ground
        speeds = np.diff(np.concatenate([way, way[1:2]])) * count
        # A knee that snaps, or a jump, changes its velocity at once.
        assert np.abs(np.diff(speeds)).max() < 0.1 * max(np.abs(speeds).max(), SIZE), joint


@pytest.mark.parametrize(("name", "kind"), [each for each in FITTING if each[1] != "anything"])
def test_limbs_keep_their_lengths(name, kind):
    rest, template = body(kind), find_motion(name).template_for(kind)
    moved = places(name, kind, np.linspace(0, 1, 49), Parameters(size=1.2, energy=1.3))
    growing = getattr(template, "growth", {})
    for joint, before in rest.parents.items():
        if before and without_side(joint) not in growing:
            length = abs(rest.joints[joint] - rest.joints[before])
            lengths = np.abs(moved[joint] - moved[before])
            assert_allclose(lengths, length, rtol=1e-9, err_msg=joint)


@each_gait
def test_planted_feet_have_one_ground_speed(name, kind):
    shares = np.linspace(0, 1, 121)
    moments = moments_of(name, body(kind), USUAL, shares)
    seen, steps = set(), []
    for before, after in pairwise(moments):
        for foot in before.standing & after.standing:
            seen.add(foot)
            steps.append(after.places[foot] - before.places[foot])
    assert len(seen) == (4 if kind == "four-legs" else 2)
    assert_allclose(steps, steps[0], atol=1e-9 * SIZE)
    assert steps[0].real * body(kind).facing <= 0


def test_nobody_crouches_for_long_steps():
    rest = body("four-legs")
    # Its front feet are drawn far ahead of the chest.
    ahead = {f"hand.{side}": rest.joints[f"hand.{side}"] + 45 * rest.facing for side in "LR"}
    of = replace(rest, joints={**rest.joints, **ahead})
    moved = places("walk", "four-legs", np.linspace(0, 1, 49), of=of)
    for joint in ("hips", "chest"):
        down = rest.joints[joint].imag - moved[joint].imag
        assert down.max() < 0.1 * (rest.joints["hips"].imag - rest.joints["foot.L"].imag)


@each_gait
def test_travelling_plants_feet_and_gets_on_by_a_stride(name, kind):
    travelling = Parameters(travel=True)
    shares = np.linspace(0, 2, 161)
    moments = moments_of(name, body(kind), travelling, shares)
    for before, after in pairwise(moments):
        for foot in before.standing & after.standing:
            assert_allclose(after.places[foot], before.places[foot], atol=1e-9 * SIZE)
    strides = {
        joint: moments[80].places[joint] - moments[0].places[joint] for joint in moments[0].places
    }
    assert_allclose(list(strides.values()), strides["hips"], atol=1e-9 * SIZE)
    assert strides["hips"].real * body(kind).facing > 0.1 * SIZE
    later = moments[160].places["hips"] - moments[0].places["hips"]
    assert_allclose(later, 2 * strides["hips"], atol=1e-9 * SIZE)


@each_motion
def test_a_mirrored_body_does_the_mirror_image(name, kind):
    rest = body(kind)
    low, high = rest.box
    flipped = replace(
        rest,
        joints={joint: -place.conjugate() for joint, place in rest.joints.items()},
        box=(complex(-high.real, low.imag), complex(-low.real, high.imag)),
        facing=-rest.facing,
    )
    shares = np.linspace(0, 1, 13)
    one, other = places(name, kind, shares), places(name, kind, shares, of=flipped)
    for joint, way in one.items():
        assert_allclose(other[joint], -way.conj(), atol=1e-9 * SIZE, err_msg=joint)


def test_mirrored_the_other_arm_waves():
    shares = np.linspace(0, 1, 13)
    usual = places("wave", "biped-front", shares)
    mirrored = places("wave", "biped-front", shares, Parameters(mirrored=True))
    assert np.ptp(usual["hand.R"].imag) > 5 * np.ptp(usual["hand.L"].imag)
    assert np.ptp(mirrored["hand.L"].imag) > 5 * np.ptp(mirrored["hand.R"].imag)
    rest = body("biped-side")
    twice = rest.mirrored().mirrored()
    assert (dict(twice.joints), twice.facing) == (dict(rest.joints), rest.facing)


@pytest.mark.parametrize("drawn", [-75, 0, 60], ids=["lowered", "spread", "raised"])
def test_a_waving_hand_is_up_however_the_arm_is_drawn(drawn):
    rest = body("biped-front")
    shoulder, way = rest.joints["shoulder.R"], -np.exp(-1j * np.radians(drawn))
    arm = {"elbow.R": shoulder + 40 * way, "hand.R": shoulder + 80 * way}
    moved = places(
        "wave", "biped-front", np.arange(9) / 8, of=replace(rest, joints=rest.joints | arm)
    )
    forearm = np.degrees(np.angle(moved["hand.R"] - moved["elbow.R"]))
    assert_allclose(forearm[2:7], [126, 84, 126, 84, 126], atol=1e-6)
    assert (moved["hand.R"] - shoulder)[2:7].imag.min() > 25
    assert_allclose(moved["hand.R"][[0, 8]], arm["hand.R"], atol=1e-9)


def test_of_an_arm_over_the_trunk_and_a_free_one_the_free_one_waves():
    rest = body("biped-side")
    near = {"elbow.R": rest.joints["chest"] - 6j, "hand.R": rest.joints["chest"] - 12j}
    of = replace(rest, joints=rest.joints | near)
    shares = np.linspace(0, 1, 13)
    for mirrored, still in ((False, "hand.R"), (True, "hand.L")):
        moved = places("wave", "biped-side", shares, Parameters(mirrored=mirrored), of=of)
        assert np.ptp(moved[still].imag) < 2


def test_speed_is_of_time_alone_and_start_is_a_share_of_the_cycle():
    walk = MOTIONS["walk"]
    assert walk.frames(USUAL, 24) == 24
    assert walk.frames(Parameters(speed=0.5), 24) == 48
    assert walk.frames(Parameters(speed=4.0), 24) == 12
    shares = np.linspace(0, 0.5, 5)
    fast = places("walk", "biped-side", shares, Parameters(speed=2.0))
    late = places("walk", "biped-side", shares, Parameters(start=0.25))
    for joint, way in places("walk", "biped-side", [*shares, *(shares + 0.25)]).items():
        assert_allclose(fast[joint], way[:5])
        assert_allclose(late[joint], way[5:], atol=1e-9 * SIZE)


@each_motion
def test_cycles_have_few_keys_at_whole_frames(name, kind):
    motion = MOTIONS[name]
    assert kind in motion.kinds
    for frames in (12, 17, 24):
        times = motion.key_times(USUAL, frames)
        assert 4 <= len(times) <= 8
        offsets = [offset for offset, _ in times]
        assert offsets[0] == 0
        assert offsets == sorted(set(offsets))
        assert offsets[-1] < frames


@each_gait
def test_feet_stand_still_on_the_ground_between_keys_at_whole_frames(name, kind):
    """At 17 frames the phases of 8 keys lie between frames."""
    motion, frames = MOTIONS[name], 17
    times = motion.key_times(USUAL, frames)
    shares = [(phase, offset / frames) for offset, phase in times]
    performed = motion.perform(body(kind), USUAL, Timing((*shares, (1.0, 1.0))))
    moments = [performed.pose_at(phase) for _, phase in times]
    for (one, _), (other, _), before, after in zip(
        times, times[1:], moments, moments[1:], strict=False
    ):
        for foot in before.standing & after.standing:
            way = after.places[foot] - before.places[foot]
            ground = -performed.stride * (other - one) / frames
            assert_allclose(way, ground, atol=1e-9 * SIZE)


def standing_body(kind):
    """Return a body whose legs are drawn nearly straight below its hips."""
    rest = body(kind)
    if kind != "biped-side":
        return rest
    legs = {"knee.L": 158 + 97j, "foot.L": 155 + 40j, "knee.R": 155 + 97j, "foot.R": 147 + 40j}
    return replace(rest, joints={**rest.joints, **legs})


@pytest.mark.parametrize(
    ("name", "kind", "least"),
    [
        ("run", "biped-side", 0.08),
        ("run", "biped-front", 0.05),
        ("trot", "four-legs", 0.04),
        ("gallop", "four-legs", 0.05),
    ],
)
def test_runs_have_keys_in_the_air_and_hips_are_highest_there(name, kind, least):
    motion, rest = MOTIONS[name], standing_body(kind)
    moments = [motion.perform(rest, USUAL).pose_at(phase) for phase in motion.phases]
    feet = [foot for foot, _ in motion.template_for(kind).gait.landings]
    leg = rest.limb_length("foot.L")
    flights = [number for number, each in enumerate(moments) if not each.standing]
    assert flights == [3, 7]
    hips = [each.places["hips"].imag for each in moments]
    for flight in flights:
        for foot in feet:
            assert moments[flight].places[foot].imag - rest.joints[foot].imag > least * leg
        assert hips[flight] == max(hips[flight - 3 : flight + 1])
    if kind == "biped-side":
        # Contact, down, push-off and flight. The hips are low after a foot came down until the push
        # off, for which a long leg needs room.
        assert max(hips[1], hips[2]) < min(hips[0], hips[3])
        assert max(hips[5], hips[6]) < min(hips[4], hips[7])
        assert [each.standing for each in moments[:3]] == 3 * [{"foot.L"}]
        assert [each.standing for each in moments[4:7]] == 3 * [{"foot.R"}]


def test_legs_of_a_run_are_long_at_the_push_off_and_apart_in_the_air():
    rest = standing_body("biped-side")
    moments = [MOTIONS["run"].perform(rest, USUAL).pose_at(phase).places for phase in (0.25, 0.375)]
    hip, leg = rest.limb_joints("foot.L")[0], rest.limb_length("foot.L")
    push_off, flight = moments
    assert abs(push_off["foot.L"] - push_off[hip]) > 0.95 * leg
    assert (push_off["foot.L"] - push_off[hip]).real * rest.facing < -0.2 * leg
    assert (flight["foot.R"] - flight["foot.L"]).real * rest.facing > 0.4 * leg


def test_short_arms_swing_less():
    rest = body("biped-side")
    usual = rest.limb_length("hand.L")
    root = rest.joints[rest.limb_joints("hand.L")[0]]
    short = {
        name: root + 0.1 * (place - root) if name.startswith(("elbow", "hand")) else place
        for name, place in rest.joints.items()
    }
    small = replace(rest, joints=short)
    assert small.limb_length("hand.L") < 0.2 * usual
    assert small.limb_length("head") == 0.0

    def swing(of):
        before = of.parents["elbow.L"]
        moved = places("run", "biped-side", np.arange(8) / 8, of=of)
        bones = (moved["elbow.L"] - moved[before]) / (of.joints["elbow.L"] - of.joints[before])
        return np.ptp(np.angle(bones))

    assert swing(small) < 0.4 * swing(rest)


def test_parts_of_a_body_are_delayed_by_a_share_of_the_cycle():
    shares = np.linspace(0, 1, 13)
    usual = places("walk", "biped-side", shares)
    late = places("walk", "biped-side", shares, Parameters(tail_delay=0.25))
    assert_allclose(late["head"], usual["head"])
    # Against the trunk, which turns as a whole.
    usual_tail, late_tail = (
        (each["tail"] - each["hips"]) / (each["chest"] - each["hips"]) for each in (usual, late)
    )
    assert_allclose(late_tail[3:], usual_tail[:-3], atol=1e-9)


@pytest.mark.parametrize("kind", ["biped-side", "four-legs"])
def test_from_the_side_the_trunk_is_one_rigid_part(kind):
    rest = body(kind)
    own = rest.joints
    hip = {f"hip.{side}": 0.8 * own["hips"] + 0.2 * own[f"foot.{side}"] for side in "LR"}
    neck = {"neck": (own["chest"] + own["head"]) / 2}
    rest = replace(rest, joints={**own, **hip, **neck})
    leaning = Parameters(lean=10.0)
    moved = places("walk", kind, np.linspace(0, 1, 25), leaning, of=rest)
    trunk = [name for name in rest.joints if without_side(name) in TRUNK]
    assert len(trunk) >= 5
    for one, other in pairwise(trunk):
        apart = abs(rest.joints[other] - rest.joints[one])
        assert_allclose(np.abs(moved[other] - moved[one]), apart, atol=1e-9 * SIZE)


def test_a_leaning_trunk_leans_the_way_that_the_body_faces():
    shares = np.linspace(0, 1, 13)
    rest = body("biped-side")
    usual = places("walk", "biped-side", shares)
    leaning = places("walk", "biped-side", shares, Parameters(lean=20.0))
    assert ((leaning["chest"] - usual["chest"]).real * rest.facing > 0.02 * SIZE).all()
    assert_allclose(leaning["hips"].real, usual["hips"].real, atol=1e-9 * SIZE)


@pytest.mark.parametrize(
    ("name", "kind", "joints", "parameters", "said"),
    [
        ("slither", "biped-side", None, USUAL, "'slither' is not a motion for 'biped-side'"),
        ("walk", "biped-side", {"hips": 0j, "head": 1j}, USUAL, "'walk' needs foot.L, foot.R"),
        (
            "nod",
            "biped-side",
            None,
            Parameters(travel=True),
            "'nod' has no steps, so it cannot travel",
        ),
    ],
)
def test_what_does_not_fit_is_refused(name, kind, joints, parameters, said):
    rest = body(kind)
    if joints is not None:
        rest = Body(kind=find_kind(kind), joints=joints, box=rest.box)
    with pytest.raises(EngineError, match=said):
        MOTIONS[name].perform(rest, parameters)


def test_parameters_have_ranges():
    for given in ({"speed": 0.0}, {"size": 3.0}, {"energy": -1.0}, {"start": 1.0}):
        with pytest.raises(EngineError, match=next(iter(given))):
            Parameters(**given)
    with pytest.raises(EngineError, match="There is no kind of body 'centaur'"):
        find_kind("centaur")
    with pytest.raises(EngineError, match="'chain' has no joint 'wing'"):
        Body(kind=find_kind("chain"), joints={"wing": 0j}, box=(0j, 1 + 1j))


def test_the_first_bone_of_a_tail_swings_and_springs_move_the_others():
    rest = body("four-legs")
    tip, hips = rest.joints["tail"], rest.joints["hips"]
    between = {f"tail.{n}": hips + n / 4 * (tip - hips) for n in (1, 2, 3)}
    chained = replace(rest, joints={**rest.joints, **between})
    assert chained.tail == ("tail.1", "tail.2", "tail.3", "tail")
    shares = np.linspace(0, 1, 97)
    moved = places("walk", "four-legs", shares, of=chained)
    base = (moved["tail.1"] - moved["hips"]) / (moved["chest"] - moved["hips"])
    assert_allclose(base, (between["tail.1"] - hips) / (rest.joints["chest"] - hips), atol=1e-9)
    turned = [
        np.angle((moved[other] - moved[one]) / (chained.joints[other] - chained.joints[one]))
        for one, other in pairwise(chained.tail)
    ]
    assert np.ptp(turned[0]) > 0.1
    assert_allclose(turned[1:], [turned[0]] * 2, atol=1e-9)
    following = find_motion("walk").perform(chained, Parameters()).following
    assert [(each.joint, each.root, each.swings) for each in following] == [
        ("tail.3", "tail.2", 1),
        ("tail", "tail.2", 1),
    ]
    assert 0 < following[0].delay < following[1].delay < 0.25
    assert find_motion("wag").perform(chained, Parameters()).following[0].swings == 2
    assert not find_motion("walk").perform(rest, Parameters()).following


def test_legs_that_are_one_above_their_crotch_part_before_they_close():
    rest = body("four-legs")
    shares = np.linspace(0, 1, 49)
    free = places("walk", "four-legs", shares)
    room = dict.fromkeys(("foot.L", "foot.R"), 0.3 * SIZE)
    tight = places("walk", "four-legs", shares, of=replace(rest, crotch_room=room))
    assert np.ptp(tight["foot.L"].real) < np.ptp(free["foot.L"].real)
    drawn_apart = abs(rest.joints["foot.L"].real - rest.joints["foot.R"].real)
    nearest = np.abs(tight["foot.L"].real - tight["foot.R"].real).min()
    assert nearest > drawn_apart - 0.05 * SIZE


@each_motion
def test_parameters_of_parts_are_offered_where_they_change_the_motion(name, kind):
    rest, shares = body(kind), np.arange(8) / 8
    offered = MOTIONS[name].template_for(kind).part_parameters(kind, rest.joints)
    usual = places(name, kind, shares)
    for parameter, value in (
        ("lean", 20.0),
        ("head_delay", 0.2),
        ("arm_delay", 0.2),
        ("tail_delay", 0.2),
    ):
        other = places(name, kind, shares, Parameters(**{parameter: value}))
        moved = max(np.abs(other[joint] - way).max() for joint, way in usual.items())
        assert (moved > 1e-6) == (parameter in offered), parameter


@pytest.mark.parametrize("facing", [1, -1])
def test_straight_legs_are_bent_to_their_usual_side_and_pairs_bend_alike(facing):
    rest = body("biped-side")
    root = rest.joints["hips"] - 10j
    hips = dict.fromkeys(("hip.L", "hip.R"), root)
    feet = dict.fromkeys(("foot.L", "foot.R"), root - 100j)

    def bent(left, right):
        """Return the knees of legs that are drawn with them so far ahead."""
        drawn = {"knee.L": root - 50j + left * facing, "knee.R": root - 50j + right * facing}
        joints = {**rest.joints, **hips, **feet, **drawn}
        moved = bend_straight_legs(replace(rest, joints=joints, facing=facing))
        assert {name: at for name, at in moved.items() if "knee" not in name} == {
            name: at for name, at in joints.items() if "knee" not in name
        }
        return [(moved[f"knee.{side}"] - root + 50j).real * facing for side in "LR"]

    assert bent(-2, -1) == pytest.approx([1, 1], abs=0.1)
    assert bent(-2, -30) == pytest.approx([-2, -30], abs=1e-9)
    assert bent(2, -30) == pytest.approx([-1, -30], abs=0.1)


def test_knees_bend_outwards_from_the_front():
    rest = body("biped-front")
    feet = {side: rest.joints[f"foot.{side}"] for side in "LR"}
    inwards = {f"knee.{side}": 0.3 * at.real + 1j * (at.imag + 40) for side, at in feet.items()}
    joints = {**rest.joints, **inwards}
    moved = places("walk", "biped-front", np.arange(8) / 8, of=replace(rest, joints=joints))
    for side, foot in feet.items():
        root = moved.get(f"hip.{side}", moved["hips"])
        bent = ((moved[f"knee.{side}"] - root) / (moved[f"foot.{side}"] - root)).imag
        assert (bent * np.sign(foot.real - rest.joints["hips"].real) > 0).all()


def test_steps_are_as_large_as_legs_can_turn():
    def swing(size):
        """Return the largest turns of upper legs, and the lengths of steps."""
        moved = places("walk", "biped-side", np.arange(48) / 48, Parameters(size=size, energy=0))
        turns, steps = [], []
        for side in "LR":
            root = f"hip.{side}" if f"hip.{side}" in rest.joints else "hips"
            bone = rest.joints[f"knee.{side}"] - rest.joints[root]
            turned = np.angle((moved[f"knee.{side}"] - moved[root]) / bone)
            turns.append(np.abs(turned).max())
            steps.append(np.ptp(moved[f"foot.{side}"].real))
        return max(turns), max(steps)

    rest = body("biped-side")
    turn, step = swing(1.0)
    assert turn < MOST_TURN + 0.1
    # Whoever asks for more gets more.
    assert swing(1.3)[1] > step
    assert swing(0.5)[1] == pytest.approx(step / 2, rel=1e-6)


def test_a_thick_chain_bends_less_where_its_links_meet():
    joints = {f"joint.{number + 1}": complex(100 * number) for number in range(4)}
    bends = []
    for half_width in (5.0, 100.0, 200.0):
        box = (complex(-50, -half_width), complex(350, half_width))
        chain = Body(kind=find_kind("chain"), joints=joints, box=box)
        moved = places("slither", "chain", np.linspace(0, 1, 33), of=chain)
        links = np.diff(np.array([moved[name] for name in joints]), axis=0)
        bends.append(np.abs(np.angle(links[1:] / links[:-1])).max())
    assert bends[0] > 0.6
    assert_allclose(bends[1:], [0.3, 0.15], rtol=0.02)
