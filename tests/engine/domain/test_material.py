"""Where a drawing is stiff: limbs around bones, what a brush reaches, and what is carried over."""

import numpy as np
import pytest
from interpolation_shapes import subdivided
from numpy.testing import assert_allclose, assert_array_equal

from engine.domain.material.brush import brush_weights
from engine.domain.material.limb import limb_weights
from engine.domain.material.line_ties import DEPTH, BendingPlace, tie_lines
from engine.domain.material.transfer import copy_nearest_stiffness
from engine.errors import EngineError
from engine.geometry import contains

# A trunk, 4 wide and 6 high, with an arm to the right at its top that hangs down along it, .4 away.
CORNERS = np.array([0, 4, 4 + 5j, 4.4 + 5j, 4.4 + 1j, 5.4 + 1j, 5.4 + 6j, 6j])
FIGURE = [subdivided(CORNERS, 0.25)]
HOLE = 2 + 3j + np.exp(-2j * np.pi * np.arange(24) / 24)
ARM = (4.9 + 5.5j, 4.9 + 1.2j)


def test_a_limb_is_as_wide_as_it_is_and_its_joints_stay():
    points = FIGURE[0]
    share = limb_weights(FIGURE, *ARM, points)
    assert share.max() == 1
    on_arm = (points.real >= 4.4) & (points.imag < 4.2) & (points.imag > 2.5)
    assert (share[on_arm] == 1).all()
    # Not the trunk across the gap, nor the tip beyond the bone's end, nor the shoulder.
    assert (share[points.real <= 4] == 0).all()
    assert (share[points.imag <= 1.2] == 0).all()
    assert (share[points.imag >= 5.5] == 0).all()
    turned = np.exp(0.3j) * FIGURE[0] * 50 + 7
    again = limb_weights([turned], *(50 * np.exp(0.3j) * np.array(ARM) + 7), turned)
    assert_allclose(again, share, atol=1e-9)
    assert_allclose(limb_weights(FIGURE, *reversed(ARM), points), share, atol=1e-12)


def test_a_bone_that_begins_in_the_trunk_makes_the_limb_stiff_and_not_the_trunk():
    points = subdivided(np.array([0, 4, 4 + 2j, 9 + 2j, 9 + 3j, 4 + 3j, 4 + 5j, 5j]), 0.25)
    share = limb_weights([points], 3 + 2.5j, 8.8 + 2.5j, points)
    limb = (points.real > 5.5) & (points.real < 7)
    assert (share[limb] == 1).all()
    assert (share[(points.imag < 1.5) | (points.imag > 3.5)] == 0).all()


@pytest.mark.parametrize(
    ("loops", "ends"),
    [
        (FIGURE, (3 + 3j, 4.9 + 3j)),
        (FIGURE, (3 + 3j, 4.2 + 3j)),
        ([FIGURE[0], HOLE], (0.5 + 3j, 3.5 + 3j)),
        (FIGURE, (1 + 1j, 1 + 1j)),
    ],
)
def test_a_bone_that_leaves_the_drawing_is_refused(loops, ends):
    with pytest.raises(EngineError, match=r"The bone leaves the drawing|A bone must connect two"):
        limb_weights(loops, *ends, loops[0])


def test_a_bone_along_the_outline_is_allowed():
    share = limb_weights(FIGURE, 0.5j, 5.5j, FIGURE[0])
    assert share.max() == 1
    assert np.isfinite(share).all()


def test_a_brush_reaches_what_is_seen_within_its_radius():
    points = FIGURE[0]
    share = brush_weights(FIGURE, np.array([4.9 + 3j]), 1.0, 0.5)
    near = np.abs(points - 4.9 - 3j) < 0.6
    assert (share[near] > 0.5).all()
    # Not across the gap, and nothing beyond the radius but the ends of edges that reach into it.
    assert (share[points.real <= 4] == 0).all()
    assert (share[np.abs(points - 4.9 - 3j) > 1.25] == 0).all()
    # From beside the drawing it acts on both sides.
    both = brush_weights(FIGURE, np.array([4.2 + 3j]), 0.5, 0.0)
    assert both[np.isclose(points, 4 + 3j)] == both[np.isclose(points, 4.4 + 3j)] == 1
    assert not brush_weights(FIGURE, np.array([2 + 3j]), 1.0, 0.5).any()
    assert brush_weights([points, HOLE], np.array([2 + 4.2j]), 0.5, 0.5)[len(points) :].max() > 0.9


def test_a_dab_on_a_long_side_reaches_its_ends():
    square = np.array([0, 4, 4 + 4j, 4j])
    share = brush_weights([square], np.array([1.0]), 0.5, 0.0)
    assert_allclose(share, [0.75, 0.25, 0, 0])
    stroke = brush_weights([square], np.array([1.0, 3.0]), 0.5, 0.0)
    assert_allclose(stroke, [0.75, 0.75, 0, 0])


def test_stiffness_is_carried_over_by_place():
    loops = [FIGURE[0], HOLE]
    rng = np.random.default_rng(0)
    stiffness = np.exp(rng.uniform(-3, 4, sum(map(len, loops))))
    every = np.concatenate(loops)
    assert_allclose(copy_nearest_stiffness(loops, stiffness, every), stiffness)
    middles = (loops[0] + np.roll(loops[0], -1)) / 2
    own = stiffness[: len(middles)]
    assert_allclose(
        copy_nearest_stiffness(loops, stiffness, middles),
        np.sqrt(own * np.roll(own, -1)),
        rtol=1e-9,
    )
    near = copy_nearest_stiffness(loops, stiffness, every + 0.01)
    assert_allclose(np.log(near), np.log(stiffness), atol=0.5)
    assert_array_equal(copy_nearest_stiffness(loops, stiffness, np.array([20 + 3j, -5.0])), 1.0)


def test_a_limb_ends_at_a_gap_however_narrow_it_is():
    corners = np.array([0, 4.35, 4.35 + 5j, 4.4 + 5j, 4.4 + 1j, 5.4 + 1j, 5.4 + 6j, 6j])
    points = subdivided(corners, 0.25)
    share = limb_weights([points], *ARM, points)
    assert (share[(points.real <= 4.35) & (points.imag < 4.9)] == 0).all()
    assert (share[(points.real >= 4.4) & (points.imag > 2.5) & (points.imag < 4.2)] == 1).all()


def test_ties_lie_across_the_line_inside_and_turn_with_the_drawing():
    loops = [FIGURE[0], HOLE]
    ties = tie_lines(loops, [BendingPlace(4.9 + 3j, 0.5)])
    ways = ties.ends - ties.starts
    assert contains(loops[0], ties.ends, holes=loops[1:]).all()
    assert_allclose(np.abs(ways), DEPTH * 0.5, rtol=1e-9)
    assert np.abs(ties.starts - 4.9 - 3j).max() < 1.25
    whole = sum(np.abs(np.roll(loop, -1) - loop).sum() for loop in loops)
    assert 0 < ties.shares.sum() < 10 / whole
    turn, shift = 50 * np.exp(0.3j), 7
    again = tie_lines(
        [turn * loop + shift for loop in loops], [BendingPlace(turn * (4.9 + 3j) + shift, 25.0)]
    )
    assert_allclose(again.starts, turn * ties.starts + shift, atol=1e-9)
    assert_allclose(again.ends, turn * ties.ends + shift, atol=1e-9)
    assert_allclose(again.shares, ties.shares, atol=1e-12)


def test_nothing_is_tied_without_joints():
    assert len(tie_lines(FIGURE, []).shares) == 0
