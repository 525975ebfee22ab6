import numpy as np
import pictures
import pytest
from numpy.testing import assert_allclose
from shapes import regular_polygon

from engine.arrays import Booleans
from engine.domain.outline.curve import limit_growth
from engine.domain.outline.fitting import Candidates, fit_polygon
from engine.domain.outline.gaps import half_gaps
from engine.domain.outline.margin import MarginCurve, curve_at_margin, distance_field
from engine.domain.outline.simplify import choose_vertices
from engine.geometry.polygon import contains, edge_vectors, is_simple


def curve_around(
    mask: Booleans, *, margin: float, closing: float = 0.0, diagonal: float = 300.0
) -> MarginCurve:
    field = distance_field(mask)
    return curve_at_margin(field, margin=margin, offset=margin, closing=closing, diagonal=diagonal)


def test_distances_are_from_the_squares_of_the_mask() -> None:
    mask = np.zeros((9, 9), dtype=np.bool_)
    mask[4, 3] = True  # the square [3, 4] × [4, 5]
    distance = distance_field(mask).distance
    assert distance[4, 3] == distance[5, 4] == 0
    assert_allclose(distance[8, 8], 5, rtol=0, atol=1e-12)
    assert sorted(distance_field(mask).boundary().tolist(), key=abs) == [
        3 + 4j,
        4 + 4j,
        3 + 5j,
        4 + 5j,
    ]


def test_the_room_in_a_gap_is_half_its_width() -> None:
    # A C made of two arcs: the gap between its arms is 0.4 wide.
    x = np.linspace(0, 10, 200)
    curve = np.concatenate(
        [x - 1.2j, 10 - 0.2j - x, 0.2j + x, 10 + 1.2j - x, [-1 + 1.2j, -1 - 1.2j]]
    )
    normals = np.concatenate(
        [np.full(200, -1j), np.full(200, 1j), np.full(200, -1j), np.full(200, 1j)]
    )
    normals = np.append(normals, [-1, -1])
    room = half_gaps(curve, normals, reach=1.0, separation=2.0)
    assert_allclose(room[210:390], np.where(x[10:190] < 7, 0.2, room[210:390]), rtol=0.02, atol=0)
    assert np.isinf(room[:200]).all()


def test_the_margin_shrinks_between_limbs() -> None:
    mask = pictures.limbs(6, 300)[::-1, :, 3] > 0
    middle = np.array([153 + 60j, 153 + 100j])
    curve = curve_around(mask, margin=9.0)
    assert not contains(curve.points, middle).any()
    assert curve.margins.min() < 3 * 0.45
    assert_allclose(curve.margins.max(), 9, rtol=1e-9, atol=0)
    assert np.abs(np.diff(curve.margins)).max() < 1.5


def test_a_gap_below_the_closing_width_is_closed() -> None:
    mask = pictures.limbs(6, 300)[::-1, :, 3] > 0
    middle = np.array([153 + 40j, 153 + 60j, 153 + 100j])
    # Margins of 1 alone would leave a slit of 4.
    assert contains(curve_around(mask, margin=1.0, closing=7.0).points, middle).all()
    assert not contains(curve_around(mask, margin=1.0, closing=5.0).points, middle).any()


def test_a_slit_that_margins_leave_is_closed() -> None:
    # A notch too shallow to count as a gap between limbs: margins of 4.5 leave a slit of 2.
    mask = np.zeros((100, 100), dtype=np.bool_)
    mask[30:70, 20:80] = True
    mask[59:70, 45:56] = False
    inside_slit = np.array([50.5 + 69j])
    assert not contains(curve_around(mask, margin=4.5).points, inside_slit).any()
    assert contains(curve_around(mask, margin=4.5, closing=6.0).points, inside_slit).all()


def test_pockets_behind_a_closed_mouth_are_measured() -> None:
    mask = pictures.ring(100, mouth=2)[::-1, :, 3] > 0
    curve = curve_around(mask, margin=4.0, closing=4.0)
    assert_allclose(curve.enclosed, np.pi * (25 - 4) ** 2, rtol=0.1, atol=0)
    # Here it is a slit that is closed: at this scale no two points count as facing each other.
    mask = pictures.ring(100, mouth=10)[::-1, :, 3] > 0
    curve = curve_around(mask, margin=4.0, closing=6.0, diagonal=4000.0)
    assert_allclose(curve.enclosed, np.pi * (25 - 4) ** 2, rtol=0.1, atol=0)


def test_growth_is_limited_round_the_whole_curve() -> None:
    values = np.full(10, 9.0)
    values[1] = 1.0
    limited = limit_growth(values, np.arange(11.0), 0.5)
    assert_allclose(limited, [1.5, 1, 1.5, 2, 2.5, 3, 3.5, 3, 2.5, 2], rtol=0, atol=1e-12)


def test_few_and_even_vertices_are_chosen_on_a_circle() -> None:
    # A chord over the angle a passes 1 - cos(a / 2) inside. With the tolerance 0.05 at most 36
    # degrees are allowed, and n + 3 n (mean square of that / 0.05²) is least for n = 14 or 15.
    circle = regular_polygon(360)
    tolerance = np.full(360, 0.05)
    chosen = choose_vertices(circle, tolerance, tolerance, shortest=0.0, longest=9.0)
    assert 14 <= len(chosen) <= 15
    assert np.ptp(np.diff(chosen)) <= 2


def test_edges_keep_to_their_lengths() -> None:
    circle = regular_polygon(360)
    tolerance = np.full(360, 1.0)
    chosen = choose_vertices(circle, tolerance, tolerance, shortest=0.1, longest=0.3)
    lengths = np.abs(np.diff(circle[np.append(chosen, chosen[0])]))
    assert 0.1 <= lengths.min() <= lengths.max() <= 0.3


def test_inner_and_outer_tolerances_are_distinct() -> None:
    # Chords of a circle run inside it: only the inner tolerance counts.
    circle = regular_polygon(360)
    narrow, wide = np.full(360, 0.001), np.full(360, 0.1)
    assert len(choose_vertices(circle, narrow, wide, shortest=0, longest=9)) > 60
    assert len(choose_vertices(circle, wide, narrow, shortest=0, longest=9)) < 15


@pytest.mark.parametrize("claimed", [1.0, 20.0])
def test_a_polygon_that_cuts_corners_is_fitted_again(claimed: float) -> None:
    # Tolerances follow from the margins; too large ones must not leave out any corner.
    circle = 100 * regular_polygon(700)
    curve = MarginCurve(
        points=1.01 * circle,
        margins=np.full(700, claimed),
        enclosed=0.0,
        skin=circle,
        deep=1.0,
    )
    polygon = fit_polygon(Candidates.on(curve, 283.0), circle[::5])
    assert polygon is not None
    assert contains(polygon, circle[::5]).all()


@pytest.mark.parametrize(("narrowest", "wave"), [(3.0, 12.0), (2.0, 8.0)])
def test_a_polygon_that_crosses_itself_is_fitted_again(narrowest: float, wave: float) -> None:
    # A wavy slit with a wide end, and tolerances much wider than it is.
    x = np.arange(0, 100, 0.5)
    gap = narrowest + 20 * np.abs(x / 50 - 1) ** 4
    middle = x + 1j * wave * np.sin(x / 6)
    frame = [100 + 50j, -20 + 50j, -20 - 50j, 100 - 50j]
    points = np.concatenate([middle + 0.5j * gap, frame, (middle - 0.5j * gap)[::-1]])
    curve = MarginCurve(
        points=points, margins=np.full(len(points), 11.0), enclosed=0.0, skin=points, deep=1.0
    )
    polygon = fit_polygon(Candidates.on(curve, 200.0), np.array([-10 + 0j]))
    assert polygon is not None
    assert is_simple(polygon)


def test_a_polygon_that_turns_back_is_fitted_again() -> None:
    # The end of a slit of width 1: one vertex would be sharper than 20 degrees.
    slit = [50 + 0.5j, 0 + 0.5j, 0 - 0.5j, 50 - 0.5j]
    points = np.array([50 + 50j, -50 + 50j, -50 - 50j, 50 - 50j, *slit[::-1]])
    curve = MarginCurve(
        points=points, margins=np.full(len(points), 2.0), enclosed=0.0, skin=points, deep=1.0
    )
    polygon = fit_polygon(Candidates.on(curve, 141.0), np.array([-10 + 0j]))
    assert polygon is not None
    along = edge_vectors(polygon)
    assert np.abs(np.degrees(np.angle(along / np.roll(along, 1)))).max() <= 160
