"""The near arm of a body from the side, drawn over the trunk."""

from functools import cache

import numpy as np
import pytest
import shapely
from overlapping_legs import BENT_ARM, JOINTS, NEAR_ARM, draw_arm, limb, rgba_of

from app.cut_out import build_picture_domain
from app.rigging import find_near_arm, move_off_arm, trace_near_arm, with_near_arm
from engine.geometry import as_xy, shapely_region

ARMS = {"straight": NEAR_ARM, "bent": BENT_ARM, "none": ()}


@cache
def found(style="lines", arm="straight", corner=0j):
    """Return the arm that is found in a drawing, and its domain."""
    rgba = rgba_of(draw_arm(style, ARMS[arm]))
    domain, _ = build_picture_domain(rgba, triangles=1000, detail="normal")
    joints = {name: place + corner for name, place in JOINTS.items()}
    loops = domain.moved(corner).loops
    return find_near_arm(loops, joints, 1, rgba, corner), domain


@pytest.mark.parametrize("arm", ["straight", "bent"])
@pytest.mark.parametrize(("style", "ink"), [("lines", 2.0), ("flat", 0.0)])
def test_contour_goes_around_the_arm_beside_its_ink(style, ink, arm):
    near, domain = found(style, arm)
    assert near is not None
    shape = limb(*ARMS[arm]).buffer(ink)
    points = shapely.points(as_xy(near.contour[domain.contains(near.contour)]))
    away = shapely.distance(shape.exterior, points)
    assert np.median(away) < 2
    assert np.quantile(away, 0.95) < 5
    # The arm is inside the closed contour, the shoulder apart.
    whole = shapely.Polygon(as_xy(near.contour))
    lower = limb(*ARMS[arm][1:]).buffer(-2)
    assert whole.intersection(lower).area > 0.97 * lower.area
    # Down the side behind, and up the side ahead: the arm is on its right.
    assert not shapely.is_ccw(whole.exterior)


@pytest.mark.parametrize("arm", ["straight", "bent"])
def test_joints_are_in_the_middle_of_the_arm(arm):
    near, _ = found(arm=arm)
    shoulder, elbow, hand = (complex(x, y) for x, y, _ in ARMS[arm])
    assert abs(near.joints[0] - shoulder) < 25
    assert abs(near.joints[1] - elbow) < 14
    assert abs(near.joints[2] - hand) < 10


def test_contour_is_the_same_wherever_the_picture_lies():
    here, _ = found()
    there, _ = found(corner=300 - 40j)
    np.testing.assert_allclose(there.contour, here.contour + 300 - 40j, atol=1e-6)


def test_no_arm_is_found_on_a_bare_trunk():
    assert found("lines", "none")[0] is None
    assert found("flat", "none")[0] is None


def test_arm_is_traced_again_around_its_joints():
    near, domain = found()
    shoulder, elbow, _ = near.joints
    axis = np.array([shoulder + 0.4 * (shoulder - elbow), *near.joints])
    again = trace_near_arm(domain.loops, axis, rgba_of(draw_arm("lines")), 0j)
    away = np.abs(np.array(again.joints) - np.array(near.joints))
    assert away.max() < 6


def test_joints_below_the_arm_move_beside_it_and_a_hip_along_its_leg():
    near, domain = found()
    hidden = JOINTS | {"hip.R": near.joints[2]}
    moved = move_off_arm(with_near_arm(hidden, near, 1), near, domain.loops, "R")
    flap = shapely.Polygon(as_xy(near.contour)).buffer(2)
    region = shapely_region(domain.outline)
    for name, place in moved.items():
        point = shapely.Point(place.real, place.imag)
        is_of_arm = name in {"shoulder.R", "elbow.R", "hand.R"}
        assert flap.contains(point) == is_of_arm
        assert region.contains(point)
    leg = (moved["hip.R"] - hidden["knee.R"]) / (hidden["hip.R"] - hidden["knee.R"])
    assert abs(leg.imag) < 1e-9
    assert 0 < leg.real < 1
    assert moved["head"] == JOINTS["head"]


def test_an_arm_beyond_the_trunk_is_the_same_arm_or_the_far_one():
    near, _ = found(arm="bent")
    names = ("shoulder", "elbow", "hand")
    forearm = dict(zip(names, (180 + 290j, 192 + 288j, 206 + 286j), strict=True))
    same = with_near_arm(JOINTS | {f"{name}.L": at for name, at in forearm.items()}, near, 1)
    assert same["hand.R"] == near.joints[2]
    assert "hand.L" not in same
    far = dict(zip(names, (90 + 340j, 70 + 300j, 40 + 280j), strict=True))
    both = with_near_arm(JOINTS | {f"{name}.R": at for name, at in far.items()}, near, 1)
    assert both["hand.R"] == near.joints[2]
    assert both["hand.L"] == far["hand"]
    third = JOINTS | {f"{n}.{s}": at + (s == "L") for s in "LR" for n, at in far.items()}
    assert with_near_arm(third, near, 1) == third
