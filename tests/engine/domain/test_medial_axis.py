"""Handles are suggested at the tips of limbs, in the middle of the body, and around holes."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from shapes import regular_polygon

from engine.domain import suggest_handles
from engine.domain.medial_axis import medial_axis
from engine.geometry import contains

BAR = np.array([0, 400, 400 + 60j, 60j])


def star(points, inner):
    radii = np.where(np.arange(2 * points) % 2 == 0, 100.0, inner)
    return radii * np.exp(1j * np.pi * np.arange(2 * points) / points)


def capsule(length, radius):
    """A bar with round ends, around 0."""
    cap = length / 2 + radius * np.exp(1j * np.linspace(-np.pi / 2, np.pi / 2, 24))
    return np.concatenate([cap, -cap])


def test_the_axis_of_a_rectangle_is_its_middle_line():
    axis = medial_axis([BAR])
    within = (axis.places.real > 40) & (axis.places.real < 360)
    assert_allclose(axis.places[within].imag, 30, rtol=0, atol=1.0)
    assert_allclose(axis.radii[within], 30, rtol=0, atol=1.0)
    assert len(axis.links) == len(axis.places) - 1, "a tree"


@pytest.mark.parametrize(("points", "inner"), [(3, 30), (5, 45), (8, 60)])
@pytest.mark.parametrize("turn", [1.0, np.exp(0.3j)])
def test_a_star_is_held_at_its_tips_and_in_its_middle(points, inner, turn):
    outline = turn * star(points, inner)
    middle, *tips = suggest_handles([outline])
    assert abs(middle) < 8
    assert len(tips) == points
    ends = outline[::2]
    nearest = np.abs(np.array(tips)[:, None] - ends).argmin(axis=1)
    assert sorted(nearest) == list(range(points))
    assert_allclose(np.abs(np.array(tips) - ends[nearest]), 0, rtol=0, atol=20)


@pytest.mark.parametrize("outline", [BAR - 200 - 30j, capsule(340, 30)])
def test_a_bar_is_held_at_its_ends_and_in_its_middle(outline):
    middle, *tips = suggest_handles([outline])
    assert_allclose(middle, 0, rtol=0, atol=3)
    assert_allclose(sorted(tips, key=lambda tip: tip.real), [-170, 170], rtol=0, atol=12)


@pytest.mark.parametrize("outline", [100 * regular_polygon(48), 80 * regular_polygon(4)])
def test_what_has_no_limbs_is_held_in_its_middle(outline):
    assert_allclose(suggest_handles([outline]), [0], rtol=0, atol=2)


def test_a_ring_is_held_all_around():
    ring = [200 * regular_polygon(64), 120 * regular_polygon(48)[::-1]]
    handles = suggest_handles(ring)
    assert len(handles) == 4
    assert_allclose(np.abs(handles), 160, rtol=0, atol=3)
    between = np.diff(np.sort(np.angle(handles)), append=np.sort(np.angle(handles))[0] + 2 * np.pi)
    assert between.max() < np.radians(110)


def test_a_large_head_is_not_taken_for_the_body():
    """A figure with a head wider than its body: arms, legs and head are limbs of the body."""
    head = 300j + 130 * np.exp(1j * np.linspace(-np.pi / 2 + 0.3, 3 * np.pi / 2 - 0.3, 40))
    body = np.array([-40 + 150j, -220 + 150j, -220 + 90j, -60 + 90j, -60 - 60j, -60 - 260j])
    legs = np.array([-10 - 260j, -10 - 60j])
    left = np.concatenate([body, legs])
    figure = np.concatenate([head, left, -left.conj()[::-1]])
    middle, *tips = suggest_handles([figure])
    assert -60 < middle.imag < 160
    assert len(tips) == 5
    assert contains(figure, np.array([middle, *tips])).all()
