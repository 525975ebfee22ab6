"""Flaps, which a slit goes around, and the trunk below them."""

import numpy as np
import pytest
import shapely

from engine.domain import build_domain, find_closed_cuts, require_domain
from engine.domain.flaps import measure_flap
from engine.geometry import arc_lengths, as_xy, shapely_region

MASK = np.zeros((320, 240), dtype=np.bool_)
MASK[20:300, 30:210] = True


def around(first, last, width=50.0):
    """Return a line down one side of a bar, around its round end, and up its other side."""
    turn = np.exp(1j * np.linspace(np.pi, 2 * np.pi, 24))
    line = np.concatenate(
        [[first], last.real - width / 2 + 1j * last.imag + width / 2 * (1 + turn)]
    )
    line = np.append(line, first + width) if first.imag == 260 else line
    lengths = arc_lengths(line)
    at = np.linspace(0, lengths[-1], 180)
    return np.interp(at, lengths, line)


INNER = around(90 + 260j, 115 + 110j)  # the flap on its right when it is walked backwards
FLAP = shapely.Polygon(as_xy(INNER))


@pytest.fixture(scope="module")
def domain():
    return build_domain(MASK, triangles=4000, detail="normal", cut_lines=[INNER])[0]


def test_a_line_that_begins_and_ends_inside_is_a_thin_hole(domain):
    require_domain(domain)
    assert len(domain.holes) == 1
    assert domain.contains(np.array([115 + 180j, 60 + 180j, 180 + 180j, 115 + 290j])).all()
    assert not domain.contains(np.array([90 + 200j])).any()
    region = shapely_region(domain.outline, domain.loops[1:])
    thin = shapely.Polygon(as_xy(domain.loops[1])).area
    assert thin < 0.01 * region.area


def test_both_sides_reach_the_medial_axis_of_a_flap():
    tangents = np.gradient(INNER)
    inwards = 1j * tangents / np.abs(tangents)
    seen = np.full(len(INNER), 40.0)
    sides = measure_flap(INNER, inwards, seen)
    straight = (INNER.imag > 130) & (INNER.imag < 230)
    # A bar of 50: each side half of it, and a little beyond.
    assert sides.depths[straight].min() > 25
    assert sides.depths[straight].max() < 40
    np.testing.assert_allclose(INNER[sides.opposite[straight]].imag, INNER[straight].imag, atol=4)
    # The narrower side of the trunk continues less far, and both leave no gap.
    seen[INNER.real < 115] = 4.0
    sides = measure_flap(INNER, inwards, seen)
    left = straight & (INNER.real < 115)
    assert sides.depths[left].max() < 20
    both = sides.depths[left] + sides.depths[sides.opposite[left]]
    assert both.min() > 50


def test_trunk_is_whole_below_a_flap(domain):
    seam = find_closed_cuts(domain, [INNER[::-1]])
    places = seam.close_cuts(domain.mesh.vertices)
    painted = seam.find_painted(domain.mesh.vertices)
    parts = shapely.polygons([as_xy(places[each]) for each in seam.underlay.triangles])
    below = shapely.union_all(shapely.buffer(parts, 0.2))
    lower = FLAP.buffer(-1).intersection(shapely.box(0, 0, 300, 225))  # without the slit
    assert lower.difference(below).area < 0.004 * lower.area
    # What is painted is of the trunk, beside the flap; nothing sticks out of the flap.
    further = seam.find_painted(domain.mesh.vertices)[len(domain.mesh.vertices) :]
    points = shapely.points(as_xy(further))
    assert not shapely.contains(FLAP.buffer(-1.5), points).any()
    assert below.difference(FLAP.buffer(1.5)).area < 1
    assert np.isfinite(painted).all()


def test_trunk_below_a_flap_follows_an_affine_map(domain):
    seam = find_closed_cuts(domain, [INNER[::-1]])
    rest = domain.mesh.vertices
    places = seam.close_cuts(rest)
    moved = (0.8 + 0.3j) * rest + 0.1 * rest.conj() + 5
    np.testing.assert_allclose(
        seam.close_cuts(moved), (0.8 + 0.3j) * places + 0.1 * places.conj() + 5, atol=1e-8
    )


def test_limbs_and_flaps_have_one_underlay():
    leg = 180 + 1j * np.linspace(5.0, 110.0, 40)
    both = build_domain(MASK, triangles=4000, detail="normal", cut_lines=[INNER, leg])[0]
    rest = both.mesh.vertices
    flap, limb, joined = (
        find_closed_cuts(both, lines).underlay
        for lines in ([INNER[::-1]], [leg], [INNER[::-1], leg])
    )
    assert len(joined.vertices) == len(flap.vertices) + len(limb.vertices)
    assert len(joined.triangles) == len(flap.triangles) + len(limb.triangles)
    expected = np.concatenate([limb.mirror(rest), flap.mirror(rest)])
    np.testing.assert_allclose(joined.mirror(rest), expected)
