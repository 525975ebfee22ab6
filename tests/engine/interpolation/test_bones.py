"""Bones between two keyframes."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from engine.interpolation import (
    ChainOfBones,
    InteriorKnot,
    SegmentBones,
    Tangent,
    TimeWeights,
)

BODY = np.array([-1, -1 + 1j, -2 + 0.5j, -1 - 1j])
UPPER = np.array([0.2, 0.5, 0.8], complex)
LOWER = np.array([1.2, 1.6, 2.0], complex)
REST = [BODY, UPPER, LOWER]
CHAIN = ChainOfBones(parent=0, parts=(1, 2), joints=(0j, 1 + 0j, 2 + 0j), end=7)


def posed(upper, lower, body=0.0, lack=0.0):
    """Return the points with angles of both bones, and the body turned and moved."""
    turn = np.exp(1j * body)
    knee = np.exp(1j * upper)
    bent = knee + np.exp(1j * (upper + lower)) * (LOWER - 1)
    limbs = np.concatenate([np.exp(1j * upper) * UPPER, bent])
    limbs = limbs + lack * np.array([0.1, -0.2, 0.1, -0.05, 0.1, -0.05])
    return turn * np.concatenate([BODY, limbs]) + 0.3 * body


def bones(*ends):
    return SegmentBones(rest=REST, places=np.array(ends), chains=[CHAIN])


def lengths(wanted):
    """Return the spans of both shafts, and the gap of the knee."""
    upper, lower = wanted[4:7], wanted[7:]
    ways = (upper[2] - upper[0]) / 0.6, (lower[2] - lower[0]) / 0.8
    knees = upper[0] + 0.8 * ways[0], lower[0] - 0.2 * ways[1]
    return abs(ways[0]), abs(ways[1]), abs(knees[0] - knees[1])


def test_bones_change_nothing_at_keys():
    ends = posed(0.2, 0.4, lack=1.0), posed(1.2, -0.9, 0.5, lack=-1.0)
    known = bones(*ends)
    for time, places in zip((0.0, 1.0), ends, strict=True):
        assert_allclose(known.wanted(time, places, {}), places, atol=1e-12)


@pytest.mark.parametrize("time", [0.1, 0.5, 0.8])
def test_bones_turn_by_blended_angles_on_their_moving_body(time):
    known = bones(posed(0.2, 0.4), posed(1.2, -0.9, 0.5))
    base = posed(0.0, 0.0, 0.35)  # where the base has the limb does not matter
    wanted = known.wanted(time, base, {})
    assert_allclose(wanted[:4], base[:4])
    assert_allclose(lengths(wanted), [1, 1, 0], atol=1e-12)
    blended = posed(0.2 + time * 1.0, 0.4 - time * 1.3, 0.35)
    assert_allclose(wanted, blended, atol=1e-12)


@pytest.mark.parametrize("time", [0.2, 0.6])
def test_two_bones_reach_a_pinned_end(time):
    known = bones(posed(0.9, -1.5), posed(0.5, -1.2))
    goal = posed(0.9, -1.5)[-1] + 0.1j * time
    wanted = known.wanted(time, posed(0.7, -1.3), {7: goal})
    assert_allclose(lengths(wanted), [1, 1, 0], atol=1e-12)
    assert abs(wanted[-1] - goal) < 1e-12
    # Beyond reach the bones are straight towards the goal, without a jump at the longest reach.
    far, near = (known.wanted(time, posed(0.7, -1.3), {7: far + 0j}) for far in (2.0001, 1.9999))
    assert_allclose(far[-1], 2.0, atol=1e-3)
    assert np.abs(far - near).max() < 0.02


def test_bones_go_through_a_keyframe_at_one_velocity():
    """Segments of 8 and 12 frames with a tangent at the key between; the second swings back."""
    keys = [posed(0.2, -2.9), posed(1.4, -1.2, 0.3), posed(0.9, 2.6, 0.5)]  # across half a turn
    tangent = Tangent(InteriorKnot(8.0, 12.0), 1.0, 1.0)
    ends = (1.0, tangent), (tangent, 1.0)
    before, after = (
        SegmentBones(
            rest=REST,
            places=np.array(keys),
            chains=[CHAIN._replace(end_part=None)],
            revolutions=(0, 0),
            time_weights=TimeWeights.between(*each),
        )
        for each in ends
    )
    assert_allclose(before.wanted(0.0, keys[0], {}), keys[0], atol=1e-12)
    for segment, time in ((before, 1.0), (after, 0.0)):
        assert_allclose(segment.wanted(time, keys[1], {}), keys[1], atol=1e-12)
    assert_allclose(after.wanted(1.0, keys[2], {}), keys[2], atol=1e-12)
    step = 1e-5
    here = keys[1]
    arriving = (here - before.wanted(1 - step, here, {})) / (8 * step)
    leaving = (after.wanted(step, here, {}) - here) / (12 * step)
    assert np.abs(leaving[4:]).max() > 0.05
    assert_allclose(arriving, leaving, atol=1e-4)
    straight = SegmentBones(rest=REST, places=np.array(keys[:2]), chains=[CHAIN])
    corner = (here - straight.wanted(1 - step, here, {})) / (8 * step)
    assert np.abs(corner - leaving).max() > 0.05


def test_an_end_with_an_angle_keeps_the_whole_turns_of_its_body():
    foot = np.array([2.0, 2.3, 2.3 + 0.2j])
    chain = CHAIN._replace(end_part=3, has_own_angle=True)
    at = [
        np.concatenate([places, np.exp(1j * turn) * (foot - 2) + places[-1]])
        for places, turn in ((posed(0.2, 0.4), 0.5), (posed(0.3, 0.4), 0.9), (posed(0.1, 0.3), 1.5))
    ]
    weights = TimeWeights.between(1.0, Tangent(InteriorKnot(1.0, 1.0), 1.0, 1.0))
    known = SegmentBones(
        rest=[*REST, foot],
        places=np.array(at),
        chains=[chain],
        revolutions=(1, 0),
        time_weights=weights,
    )
    half = known.wanted(0.5, at[0], {})
    turn = np.vdot(foot - foot.mean(), half[-3:] - half[-3:].mean())
    expected = weights(0.5) @ np.array([0.5, 0.9 + 2 * np.pi, 1.5 + 2 * np.pi])
    assert_allclose(turn / abs(turn), np.exp(1j * expected), atol=1e-9)


def test_a_pinned_end_turns_between_its_own_keyframes_only():
    """A foot that stands in one segment and rolls in the next does not roll before."""
    foot = np.array([2.0, 2.3, 2.3 + 0.2j])
    at = [
        np.concatenate([posed(0.2, 0.4), np.exp(1j * turn) * (foot - 2) + posed(0.2, 0.4)[-1]])
        for turn in (0.5, 0.5, 1.5)
    ]
    known = SegmentBones(
        rest=[*REST, foot],
        places=np.array(at),
        chains=[CHAIN._replace(end_part=3, has_own_angle=True)],
        revolutions=(0, 0),
        time_weights=TimeWeights.between(1.0, Tangent(InteriorKnot(1.0, 1.0), 1.0, 1.0)),
    )
    for pinned, rolls in (({7: at[0][-3]}, False), ({}, True)):
        end = known.wanted(0.5, at[0], pinned)[-3:]
        turned = np.angle(np.vdot(foot - foot.mean(), end - end.mean())) - 0.5
        assert (abs(turned) > 0.01) == rolls
