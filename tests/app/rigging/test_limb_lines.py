"""The line between two limbs that overlap in a drawing."""

import numpy as np
import pytest
import shapely
from overlapping_legs import (
    FAR_LEG,
    FRONT_ARMS,
    FRONT_TRUNK,
    JOINTS,
    NEAR_LEG,
    SHOULDER,
    draw_front,
    draw_long_toes,
    draw_person,
    limb,
    rgba_of,
)

from app.cut_out import build_picture_domain
from app.rigging import (
    find_arm_line,
    find_kind,
    find_limb_line,
    suggest_joints,
    track_legs,
    with_shoulders,
)
from engine.geometry import as_xy, distance_to_boundary

LIMBS = [[JOINTS[f"{name}.{side}"] for name in ("hip", "knee", "foot")] for side in "RL"]


def line_of(style, limbs=LIMBS, *, corner=0j):
    rgba = rgba_of(draw_person(style))
    domain, _ = build_picture_domain(rgba, triangles=1000, detail="normal")
    moved = [np.array(each) + corner for each in limbs]
    found = find_limb_line(domain.moved(corner).loops, *moved, rgba, corner)
    assert found is None or found.far_side == "right"
    return None if found is None else found.points, domain


@pytest.mark.parametrize(("style", "ink"), [("lines", 2.0), ("flat", 0.0)])
def test_line_follows_the_near_leg_outside_its_ink_when_legs_overlap(style, ink):
    line, domain = line_of(style)
    assert line is not None
    near, far = limb(*NEAR_LEG).buffer(ink), limb(*FAR_LEG).buffer(ink)
    points = shapely.points(as_xy(line))
    # Where the far leg is on both sides of the near leg's edge.
    on_far = shapely.contains(far.buffer(-3), points)
    assert np.ptp(line[on_far].imag) > 80
    assert shapely.distance(near.exterior, points[on_far]).max() < 5
    assert shapely.distance(near.exterior, points[on_far]).mean() < 3
    assert line[-1].imag > 215
    # It begins near the outline, so that the knife parts the legs.
    assert distance_to_boundary(domain.outline, line[:1]) < 12


def test_line_is_the_same_wherever_the_picture_lies():
    line, _ = line_of("lines")
    moved, _ = line_of("lines", corner=40 - 25j)
    assert line is not None
    assert moved is not None
    np.testing.assert_allclose(moved - (40 - 25j), line, atol=1e-6)


def test_line_stays_in_the_gap_when_nothing_tells_the_legs_apart():
    line, _ = line_of("plain")
    legs = shapely.union(limb(*NEAR_LEG), limb(*FAR_LEG)).buffer(-8)
    assert line is None or not shapely.contains(legs, shapely.points(as_xy(line))).any()


def test_no_line_is_found_when_the_legs_are_apart():
    away = [[at - 160 for at in LIMBS[0]], LIMBS[1]]
    assert line_of("lines", [away[1], [at + 500 for at in away[1]]])[0] is None


@pytest.mark.parametrize("has_lines", [True, False])
def test_lowered_arms_turn_in_their_shoulders_where_a_line_parts_them_from_the_trunk(has_lines):
    rgba = rgba_of(draw_front(has_lines=has_lines))
    domain, _ = build_picture_domain(rgba, triangles=1000, detail="normal")
    kind = find_kind("biped-front")
    at_armpits = suggest_joints(domain.loops, kind)
    joints = with_shoulders(at_armpits, kind, domain.loops, rgba, 0j)
    if not has_lines:
        assert joints == at_armpits
        return
    assert abs(joints["shoulder.R"] - SHOULDER) < 20
    assert joints["shoulder.R"].imag > at_armpits["shoulder.R"].imag + 15
    assert joints["hand.R"] == at_armpits["hand.R"]
    found = find_arm_line(domain.loops, joints, "R", rgba, 0j)
    assert found is not None
    line = found.points
    arm, trunk = (limb(*discs).buffer(2) for discs in (FRONT_ARMS[0], FRONT_TRUNK))
    points = shapely.points(as_xy(line))
    inside = points[domain.contains(line)]
    assert line[-1].imag < joints["shoulder.R"].imag - 15
    assert shapely.distance(trunk.exterior, inside).max() < 14
    assert shapely.distance(arm, inside).max() < 9


@pytest.mark.parametrize("arms_in_front", [False, True])
def test_what_is_in_front_keeps_its_outline_where_an_arm_is_parted(arms_in_front):
    rgba = rgba_of(draw_front(has_lines=True, arms_in_front=arms_in_front))
    domain, _ = build_picture_domain(rgba, triangles=1000, detail="normal")
    kind = find_kind("biped-front")
    joints = with_shoulders(suggest_joints(domain.loops, kind), kind, domain.loops, rgba, 0j)
    for number, side in enumerate("RL"):
        found = find_arm_line(domain.loops, joints, side, rgba, 0j)
        assert found is not None
        discs = FRONT_ARMS[number], FRONT_TRUNK
        arm, trunk = (limb(*each).buffer(1) for each in discs)
        front, behind = (arm, trunk) if arms_in_front else (trunk, arm)
        points = shapely.points(as_xy(found.points))
        on_both = points[shapely.contains(behind, points)]
        assert len(on_both) > 10
        # The end of the line, where the outlines are round, may lie in the ink.
        assert np.median(shapely.contains(front, on_both)) == 0


def test_ankle_is_no_toe_that_shows_beside_the_near_foot():
    rgba = rgba_of(draw_long_toes())
    domain, _ = build_picture_domain(rgba, triangles=1000, detail="normal")
    legs = track_legs(domain.loops, rgba, 0j)
    assert len(legs) == 2
    for leg, joints in zip(legs, LIMBS, strict=True):
        assert abs(leg.foot - joints[-1]) < 20


def test_line_leads_around_the_near_toes_so_that_they_keep_their_outline():
    rgba = rgba_of(draw_long_toes())
    domain, _ = build_picture_domain(rgba, triangles=1000, detail="normal")
    found = find_limb_line(domain.loops, *LIMBS, rgba, 0j)
    assert found is not None
    near = limb(*NEAR_LEG[:-1], (184, 28, 12)).buffer(2)
    toes = found.points[(found.points.imag < 50) & (found.points.imag > 18)]
    # Their upper side is level: the line follows it over the far ankle to the tip.
    assert np.ptp(toes.real) > 20
    away = shapely.distance(near.exterior, shapely.points(as_xy(toes)))
    assert away.max() < 4
    assert not shapely.contains(near.buffer(-2.5), shapely.points(as_xy(toes))).any()
