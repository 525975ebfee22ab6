"""Handles are suggested on the body, at tips and joints of its limbs, and around holes."""

import re

import numpy as np
import pytest
from numpy.testing import assert_allclose
from shapes import regular_polygon
from silhouettes import drawn

from app.rigging import suggest_handles
from app.rigging.anatomy.anatomy import Anatomy
from app.rigging.anatomy.medial_axis import medial_axis
from engine.geometry import contains


def suggested(*loops):
    """Return the places by their names."""
    handles = suggest_handles(loops)
    found = {handle.name: handle.place for handle in handles}
    assert len(found) == len(handles), "different names"
    assert contains(loops[0], np.array(list(found.values())), holes=loops[1:]).all()
    return found


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
    handles = suggested(outline)
    assert abs(handles["body"]) < 8
    tips = [place for name, place in handles.items() if re.search("tip|foot", name)]
    assert len(tips) == points
    ends = outline[::2]
    nearest = np.abs(np.array(tips)[:, None] - ends).argmin(axis=1)
    assert sorted(nearest) == list(range(points))
    assert_allclose(np.abs(np.array(tips) - ends[nearest]), 0, rtol=0, atol=20)


@pytest.mark.parametrize("outline", [BAR - 200 - 30j, capsule(340, 30)])
def test_a_bar_is_held_at_its_ends_and_in_its_middle(outline):
    middle, *tips = suggested(outline).values()
    assert_allclose(middle, 0, rtol=0, atol=3)
    assert_allclose(sorted(tips, key=lambda tip: tip.real), [-170, 170], rtol=0, atol=12)


@pytest.mark.parametrize("outline", [100 * regular_polygon(48), 80 * regular_polygon(4)])
def test_what_has_no_limbs_is_held_in_its_middle(outline):
    ((name, place),) = suggested(outline).items()
    assert name == "body"
    assert_allclose(place, 0, rtol=0, atol=2)


def test_a_ring_is_held_all_around():
    ring = [200 * regular_polygon(64), 120 * regular_polygon(48)[::-1]]
    handles = list(suggested(*ring).values())
    assert len(handles) == 4
    assert_allclose(np.abs(handles), 160, rtol=0, atol=3)
    between = np.diff(np.sort(np.angle(handles)), append=np.sort(np.angle(handles))[0] + 2 * np.pi)
    assert between.max() < np.radians(110)


def figure(*, spread=40, boots=40, head=70):
    """A person: a trunk, a head on a neck, arms that bend and legs that end in boots."""
    sides = [
        np.array([x + 1j * y for x, y in points])
        for points in (
            [(0, 260), (110, 230), (150, 120)],
            [(20, 60), (spread, -60), (spread, -180)],
            [(spread, -200), (spread + boots / 4, -200)],
        )
    ]
    strokes = [
        (np.array([60j, 260j]), 90),
        (np.array([260j, 400j]), 40),
        (np.array([420j, 421j]), 2 * head),
    ]
    for side, width in zip(sides, (30, 44, 2 * boots), strict=True):
        strokes += [(side, width), (-side.conj(), width)]
    return drawn(*strokes)


@pytest.mark.parametrize("angle", [0.0, 0.15])
def test_a_person_has_hands_elbows_knees_feet_a_neck_and_a_head_above_the_face(angle):
    turn = np.exp(1j * angle)
    handles = suggested(*(turn * loop for loop in figure(spread=90)))
    at = {name: place / turn for name, place in handles.items()}
    assert at.keys() >= {"chest", "hips", "neck", "head", "left foot", "right foot"}
    assert abs(at["neck"].real) < 15
    assert 300 < at["neck"].imag < 380
    assert abs(at["head"].real) < 20
    assert at["head"].imag > 420 + 0.5 * 70, "a face is below"
    assert at["chest"].imag > at["hips"].imag + 50
    for side, sign in (("left", -1), ("right", 1)):
        assert abs(at[f"{side} foot"] - (sign * 95 - 200j)) < 45
        assert abs(at[f"{side} knee"] - (sign * 90 - 70j)) < 50
    elbows = [place for name, place in at.items() if "bend" in name]
    assert len(elbows) == 2
    for elbow in elbows:
        assert abs(complex(abs(elbow.real), elbow.imag) - (110 + 230j)) < 45


def test_boots_that_touch_have_a_handle_each():
    loops = figure(spread=38)
    assert len(loops) == 2, "between the legs"
    handles = suggested(*loops)
    left, right = handles["left foot"], handles["right foot"]
    assert left.real < -10 < 10 < right.real
    assert max(left.imag, right.imag) < -160
    assert {"left knee", "right knee"} <= handles.keys()
    assert not any(name.startswith("around") for name in handles)


def test_a_handle_of_a_cup_is_no_pinch():
    bow = 80 * np.exp(1j * np.linspace(-2, 2, 30)) + 120
    handles = suggested(*drawn((np.array([-80j, 80j]), 200), (bow, 24)))
    assert any(place.real > 170 for place in handles.values()), "around the hole"


def test_four_feet_are_numbered_from_the_left():
    legs = [(np.array([x + 0j, x - 160j]), 30) for x in (-150, -90, 90, 150)]
    handles = suggested(*drawn((np.array([-140, 140 + 0j]), 90), *legs))
    feet = [handles[f"foot {number}"] for number in (1, 2, 3, 4)]
    assert_allclose([foot.real for foot in feet], [-150, -90, 90, 150], rtol=0, atol=15)


def test_long_arms_have_more_joints():
    arms = [
        (400 * np.linspace(0, 1, 20) * np.exp(1j * angle), 24)
        for angle in 2 * np.pi * (np.arange(6) + 0.4) / 6
    ]
    handles = suggested(*drawn((np.array([0, 1 + 0j]), 120), *arms))
    assert sum("bend a" in name for name in handles) == 6
    assert sum("bend b" in name for name in handles) == 6


def test_a_large_head_is_not_taken_for_the_body():
    """A figure with a head wider than its body: arms, legs and head are limbs of the body."""
    head = 300j + 130 * np.exp(1j * np.linspace(-np.pi / 2 + 0.3, 3 * np.pi / 2 - 0.3, 40))
    body = np.array([-40 + 150j, -220 + 150j, -220 + 90j, -60 + 90j, -60 - 60j, -60 - 260j])
    legs = np.array([-10 - 260j, -10 - 60j])
    left = np.concatenate([body, legs])
    figure = np.concatenate([head, left, -left.conj()[::-1]])
    handles = suggested(figure)
    assert -60 < handles["chest"].imag < 200
    assert handles["head"].imag > 330
    assert {"left foot", "right foot", "neck"} <= handles.keys()
    assert sum("tip" in name for name in handles) == 2


@pytest.mark.parametrize(
    ("width", "head", "up"),
    [(100, 90, 110), (80, 100, 140), (80, 105, 150), (100, 110, 130), (80, 120, 160)],
)
def test_limbs_that_leave_a_body_at_its_neck_belong_to_it(width, head, up):
    """On a short body the disc of a large head reaches near the middle, where the neck is then."""
    strokes = [(np.array([0, 60j]), width), (np.array([60j, 1j * up]), 40)]
    strokes += [(1j * up + np.array([0, 1]), 2 * head)]
    for side in (1, -1):
        strokes += [(np.array([side * 20, side * 60 - 200j]), 34)]
        strokes += [(np.array([50j, side * 200 + 10j]), 28)]
    loops = drawn(*strokes)
    body = Anatomy(loops)
    assert body.neck == body.middle
    handles = suggested(*loops)
    assert {"head", "left foot", "left knee", "right foot", "right knee"} <= handles.keys()
    assert sum("tip" in name for name in handles) == 2
