import numpy as np
import pictures
import pytest
from hypothesis import given, settings, strategies as st
from messages import says
from numpy.testing import assert_allclose
from outlines import check_outline, diagonal, interior_angles, notices_of
from scipy import ndimage
from scipy.spatial import cKDTree

from engine.arrays import Bytes, Complexes
from engine.domain.mask.parts import FRAGMENTED
from engine.domain.outline import enclosure, fitting
from engine.domain.outline.enclosure import LARGEST_OUTLINE, Detail, Enclosure, enclose_subject
from engine.domain.outline.fitting import Candidates
from engine.errors import EngineError
from engine.geometry.polygon import as_xy, contains, signed_area


def outlined(rgba: Bytes, detail: Detail = "normal") -> Enclosure:
    return enclose_subject(pictures.seen(rgba), detail=detail)


# Painted when a test asks for them.
PICTURES = {
    "blob": pictures.blob,
    "large blob": lambda: pictures.blob(1024, 9),
    "letters": lambda: pictures.letter("R&g", 200),
    "small letter": lambda: pictures.letter("g", 40),
    "tiny letter": lambda: pictures.letter("A", 14),
    "hairlines": lambda: pictures.stick_figure(line=1),
    "thick lines": lambda: pictures.stick_figure(800, line=4),
    "diagonal hairline": lambda: pictures.painted(np.eye(300, dtype=np.bool_)),
    "star": lambda: pictures.star(5),
    "needles": lambda: pictures.star(9, inner=0.15),
    "gear": lambda: pictures.star(24, inner=0.7),
    "ring": pictures.ring,
    "nearly closed ring": lambda: pictures.ring(mouth=3),
    "C": lambda: pictures.ring(mouth=30),
    "few dots": lambda: pictures.dots(5),
    "many dots": lambda: pictures.dots(60),
    "glow": pictures.glow,
    "wide glow over the border": lambda: pictures.glow(width=0.4),
    "noise": lambda: pictures.noise(0.6),
    "ragged cloud": lambda: pictures.cloud(300, 1),
    "icon of 48": lambda: pictures.star(5, 48),
    "icon of 12": lambda: pictures.star(5, 12),
    "icon of 8": lambda: pictures.painted(np.ones((8, 8), dtype=np.bool_)),
    "whole picture": lambda: np.full((50, 80, 4), 200, dtype=np.uint8),
    "checkerboard": lambda: pictures.painted(np.indices((128, 128)).sum(axis=0) // 8 % 2 == 0),
}


@pytest.mark.parametrize("name", PICTURES)
def test_outline_and_cage_are_sound(name: str) -> None:
    mask = pictures.seen(PICTURES[name]())
    check_outline(mask, enclose_subject(mask, detail="normal"))


@pytest.mark.parametrize(
    ("name", "detail"),
    [
        ("letters", "coarse"),
        ("letters", "fine"),
        ("hairlines", "fine"),
        ("needles", "coarse"),
        ("ragged cloud", "fine"),
        ("icon of 48", "coarse"),
    ],
)
def test_outlines_of_every_detail_are_sound(name: str, detail: Detail) -> None:
    mask = pictures.seen(PICTURES[name]())
    check_outline(mask, enclose_subject(mask, detail=detail))


strokes = st.tuples(
    *[st.floats(0.1, 0.9)] * 4,
    st.floats(0.004, 0.1),
)


@settings(max_examples=10)
@given(
    ends=st.lists(strokes, min_size=1, max_size=7),
    size=st.sampled_from([64, 200, 400]),
    detail=st.sampled_from(["coarse", "normal", "fine"]),
)
def test_random_unions_of_strokes(
    ends: list[tuple[float, float, float, float, float]], size: int, detail: Detail
) -> None:
    mask = pictures.capsules(size, ends)[..., 3] > 0
    rows, columns = np.nonzero(mask)
    if len(rows) and max(np.ptp(rows), np.ptp(columns)) >= 7:
        check_outline(mask, enclose_subject(mask, detail=detail))


def test_points_are_pixels_of_the_picture_with_y_up() -> None:
    mask = np.zeros((100, 300), dtype=np.bool_)
    mask[10:30, 200:280] = True  # near the upper right corner
    points = enclose_subject(mask, detail="normal").outline
    margin = 0.8  # pixels: the least one of small subjects
    assert_allclose(points.real.min(), 200 - margin, rtol=0, atol=0.2)
    assert_allclose(points.real.max(), 280 + margin, rtol=0, atol=0.2)
    assert_allclose(points.imag.min(), 70 - margin, rtol=0, atol=0.2)
    assert_allclose(points.imag.max(), 90 + margin, rtol=0, atol=0.2)


def test_the_margin_is_what_the_detail_says() -> None:
    mask = pictures.blob(900, depth=0.0)[..., 3] > 0
    rows, columns = np.nonzero(mask)
    tree = cKDTree(np.column_stack([columns + 0.5, mask.shape[0] - rows - 0.5]))
    for detail, share in (("coarse", 0.012), ("normal", 0.006), ("fine", 0.003)):
        points = enclose_subject(mask, detail=detail).outline  # type: ignore[arg-type]
        distance, _ = tree.query(as_xy(points))
        assert_allclose(distance - 0.5, share * diagonal(mask), rtol=0, atol=0.6)


@pytest.mark.parametrize(
    ("gap", "size"),
    [(3, 200), (3, 1024), (5, 400), (12, 200)],
)
def test_limbs_a_few_pixels_apart_stay_separate(gap: int, size: int) -> None:
    mask = pictures.limbs(gap, size)[..., 3] > 0
    outline = enclose_subject(mask, detail="normal")
    check_outline(mask, outline)
    for share in (0.5, 0.7, 0.88):
        middle = size // 2 + gap / 2 + 1j * (size - share * size)
        assert not contains(outline.outline, np.array([middle])).any()
        assert not contains(outline.cage, np.array([middle])).any()


def test_a_nearly_closed_ring_stays_open_or_says_so() -> None:
    wide, shut = outlined(pictures.ring(mouth=8)), outlined(pictures.ring(mouth=0))
    centre = np.array([150 + 150j])
    assert not contains(wide.outline, centre).any()
    assert contains(shut.outline, centre).all()
    assert len(shut.holes) == 1
    filled = enclose_subject(pictures.seen(pictures.ring(mouth=0)), detail="normal", holes="fill")
    assert notices_of(filled) == ("1 hole filled, 30.89% of the subject",)


def test_closed_gap_is_reported() -> None:
    outline = outlined(pictures.ring(1024, mouth=2))
    assert contains(outline.outline, np.array([512 + 512j])).all()
    assert any("bridges gaps of" in notice for notice in notices_of(outline))


def test_parts_are_joined_by_the_shortest_bridges() -> None:
    mask = np.zeros((200, 400), dtype=np.bool_)
    for left in (20, 150, 340):
        mask[80:120, left : left + 40] = True
    outline = enclose_subject(mask, detail="normal")
    check_outline(mask, outline)
    assert notices_of(outline) == ("3 parts joined by invisible bridges",)
    # Each bridge is as straight and narrow as it can be.
    between = np.array([100, 105 + 30j, 105 - 30j, 265, 265 + 30j]) + 100j
    assert contains(outline.outline, between).tolist() == [True, False, False, True, False]


def test_holes_and_specks_are_reported() -> None:
    rgba = pictures.blob(300, depth=0.0)
    rgba[140:150, 100:110, 3] = 0
    rgba[140:150, 180:186, 3] = 0
    rgba[5, 5] = rgba[290, 8] = 255
    outline = outlined(rgba)
    assert notices_of(outline) == (
        "2 specks dropped (0.01% of the subject)",
        "1 hole filled, 0.17% of the subject, too small to stay open",
    )
    assert len(outline.holes) == 1
    assert not contains(outline.outline, np.array([5.5 + 294.5j])).any()


def test_icons_get_smooth_sides() -> None:
    # A disc of 48 pixels: a staircase would turn left and right by 90 or 45 degrees.
    points = outlined(pictures.blob(48, depth=0.0)).outline
    turns = 180 - interior_angles(points)
    assert turns.min() > -5
    assert turns.max() < 30


@pytest.mark.parametrize("scale", [6, pytest.param(18, marks=pytest.mark.long)])
def test_pictures_of_many_megapixels_are_outlined_alike(scale: int) -> None:
    rgba = np.kron(pictures.blob(250, 7), np.ones((scale, scale, 1), dtype=np.uint8))
    mask = pictures.seen(rgba)
    outline = enclose_subject(mask, detail="normal")
    small = outlined(pictures.blob(250, 7))
    few = mask[:: scale // 2, :: scale // 2]
    check_outline(few, enclose_subject(few, detail="normal"))
    rows, columns = np.nonzero(mask & ~ndimage.binary_erosion(mask))
    assert contains(outline.outline, columns + 0.5 + 1j * (mask.shape[0] - rows - 0.5)).all()
    assert_allclose(
        signed_area(outline.outline) / scale**2, signed_area(small.outline), rtol=0.02, atol=0
    )


def test_hairlines_of_large_pictures_are_not_lost() -> None:
    mask = np.zeros((3000, 3000), dtype=np.bool_)
    mask[1400:1600, 1400:1600] = True
    mask[1501, 100:2900] = mask[100:2900, 1503] = True
    check_outline(mask, enclose_subject(mask, detail="normal"))


def test_an_intricate_drawing_keeps_to_few_vertices() -> None:
    outline = outlined(pictures.blob(900, 20, 0.3))
    assert len(outline.outline) <= 200
    assert any(notice.startswith("the margin was widened") for notice in notices_of(outline))


@pytest.mark.parametrize("density", [0.01, 0.1, 0.3])
def test_scattered_noise_is_too_fragmented(density: float) -> None:
    with pytest.raises(EngineError, match=says(FRAGMENTED)):
        outlined(pictures.noise(density))


@pytest.fixture
def fitted(monkeypatch: pytest.MonkeyPatch) -> list[tuple[int, int]]:
    """The least number of edges, and that found, of every curve that a polygon is fitted to."""
    record: list[tuple[int, int]] = []

    def fit_polygon(candidates: Candidates, corners: Complexes) -> Complexes | None:
        polygon = fitting.fit_polygon(candidates, corners)
        record.append((candidates.fewest_edges, 0 if polygon is None else len(polygon)))
        return polygon

    monkeypatch.setattr(enclosure, "fit_polygon", fit_polygon)
    return record


def test_a_curve_that_few_vertices_cannot_follow_is_not_fitted(fitted) -> None:
    # Several drafts would take over a thousand vertices each before the spiral is fused.
    result = outlined(pictures.spiral(300, 10))
    ((least, found),) = fitted
    assert least <= found == len(result.outline) <= 200
    assert any("fused" in notice for notice in notices_of(result))


def test_where_every_curve_is_intricate_the_simplest_one_is_fitted(fitted, monkeypatch) -> None:
    monkeypatch.setattr(enclosure, "MOST_VERTICES", 3)
    result = outlined(pictures.blob())
    ((least, found),) = fitted
    assert 3 < least <= found == len(result.outline)
    assert "the margin was widened 2.0 times for an outline of few vertices" in notices_of(result)


@pytest.mark.parametrize("name", ["needles", "ragged cloud", "hairlines"])
def test_no_polygon_has_fewer_edges_than_foreseen(name: str, fitted) -> None:
    outlined(PICTURES[name](), "fine")
    assert all(least <= found for least, found in fitted if found)


def test_fused_limbs_are_reported() -> None:
    reported = notices_of(outlined(pictures.spiral(200, 20)))
    (fused,) = [notice for notice in reported if "fused" in notice]
    share = int(fused.split("along ")[1].split("%")[0])
    # All of the arm's two sides, but for its outermost turn.
    assert 80 <= share <= 95
    for apart in (pictures.limbs(12, 400), pictures.spiral(300, 4), pictures.star(7)):
        assert not any("fused" in notice for notice in notices_of(outlined(apart)))


@pytest.mark.long
def test_gaps_are_closed_before_an_outline_has_more_vertices_than_it_may() -> None:
    result = outlined(pictures.spiral(600, 10))
    assert len(result.outline) <= LARGEST_OUTLINE
    assert any("fused" in notice for notice in notices_of(result))
