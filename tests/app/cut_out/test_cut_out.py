"""Strokes of a brush, masks, and what is left of a picture that they are applied to."""

import itertools

import numpy as np
import pictures
import pytest
from messages import says
from numpy.testing import assert_array_equal

from app.cut_out import CutLine, CutOut, Mask, Stroke, subject_mask
from app.cut_out.cut_out import paint
from app.cut_out.mask import ALL_REMOVED
from engine.errors import EngineError

SIZE = (90, 60)  # width, height


def centres(width, height):
    """The centres of pixels (h, w), y up."""
    x, y = pictures.plane(width, height)
    return x + 1j * (height - y)


def distance(points, way):
    """The distance of points from a polyline."""
    way = np.asarray(way, dtype=complex)
    if len(way) == 1:
        return np.abs(points - way[0])
    nearest = np.full(points.shape, np.inf)
    for start, end in itertools.pairwise(way):
        along = end - start
        share = np.clip(
            ((points - start) * np.conj(along)).real / max(abs(along) ** 2, 1e-12), 0, 1
        )
        nearest = np.minimum(nearest, np.abs(points - start - share * along))
    return nearest


def drawn(way, radius, *, keeps=True, size=SIZE):
    kept = np.full(size[::-1], not keeps)
    paint(kept, Stroke(points=np.array(way, dtype=complex), radius=radius, keeps=keeps))
    return kept == keeps


@pytest.mark.parametrize("keeps", [True, False])
@pytest.mark.parametrize("radius", [0.5, 1.0, 7.3, 25.0])
@pytest.mark.parametrize(
    "way",
    [
        [40.3 + 21.8j],
        [10 + 10j, 70 + 44.5j],
        [5 + 50j, 80 + 50j, 20 + 5j, 20 + 5j, 60 + 12j],
        [-40 + 30j, 130 + 70j],
    ],
)
def test_a_stroke_covers_what_is_within_its_radius(way, radius, keeps):
    covered = drawn(way, radius, keeps=keeps)
    away = distance(centres(*SIZE), way)
    assert not covered[away > radius].any()
    assert covered[away <= radius - 0.25].all()


def test_strokes_beside_the_picture_change_nothing():
    assert not drawn([-50 - 50j, -20 + 200j], 10.0).any()
    assert not drawn([1e4 + 1e4j], 3.0).any()


def test_long_strokes_are_drawn_in_parts(monkeypatch):
    way = [5 + 5j, 85 + 55j, 5 + 55j]
    whole = drawn(way, 6.0)
    monkeypatch.setattr("app.cut_out.cut_out.AT_ONCE", 20)
    assert_array_equal(drawn(way, 6.0), whole)


def test_later_strokes_lie_over_earlier_ones():
    rgba = pictures.on_plain(pictures.blob(100), (255, 255, 255))
    middle = np.array([50 + 50j])
    strokes = (
        Stroke(points=middle, radius=20.0, keeps=False),
        Stroke(points=middle, radius=10.0, keeps=True),
        Stroke(points=np.array([3 + 3j]), radius=2.0, keeps=True),
    )
    plain, brushed = subject_mask(rgba).mask, subject_mask(rgba, CutOut(strokes=strokes)).mask
    away = np.abs(centres(100, 100) - 50 - 50j)
    assert brushed[away < 9.5].all()
    assert not brushed[(away > 10) & (away < 19.5)].any()
    assert brushed[95:99, 1:5].any()
    rest = (away > 20) & (np.abs(centres(100, 100) - 3 - 3j) > 2)
    assert_array_equal(brushed[rest], plain[rest])


def test_what_is_fully_transparent_cannot_be_kept():
    rgba = pictures.star(5, 120)
    everything = Stroke(points=np.array([60 + 60j]), radius=200.0, keeps=True)
    assert_array_equal(
        subject_mask(rgba, CutOut(strokes=(everything,))).mask, subject_mask(rgba).mask
    )


def test_brush_that_removes_everything_is_refused():
    everything = Stroke(points=np.array([60 + 60j]), radius=200.0, keeps=False)
    with pytest.raises(EngineError, match=says(ALL_REMOVED)):
        subject_mask(pictures.star(5, 120), CutOut(strokes=(everything,)))


@pytest.mark.parametrize("size", [(1, 1), (7, 3), (8, 8), (13, 5)])
def test_a_mask_keeps_every_pixel(size):
    kept = np.random.default_rng(0).random(size[::-1]) < 0.5
    mask = Mask.of(kept)
    assert mask.size == size
    assert mask.bits.nbytes == -(-size[0] * size[1] // 8)
    assert_array_equal(mask.kept, kept)


@pytest.mark.parametrize(
    ("make", "reported"),
    [
        (lambda: Mask(bits=np.zeros(3, np.uint8), size=(8, 8)), "3 bytes"),
        (lambda: Stroke(points=np.array([]), radius=1.0, keeps=True), "at least 1"),
        (lambda: Stroke(points=np.array([1j]), radius=0.0, keeps=True), "radius"),
        (lambda: Stroke(points=np.array([1j]), radius=np.nan, keeps=True), "radius"),
        (lambda: Stroke(points=np.array([np.inf]), radius=1.0, keeps=True), "finite"),
        (lambda: Stroke(points=np.array([1e6]), radius=1.0, keeps=True), "farther"),
        (lambda: CutOut(tolerance=256), "tolerance"),
        (lambda: CutOut(background=(0, 0, 256)), "levels"),
        (lambda: CutOut(background=(0, 0)), "levels"),
        (lambda: CutOut(background="red"), "background"),
        (lambda: CutOut(background=[255, 0, 0]), "background"),
        (lambda: CutOut(toggled_holes=(complex(np.nan, 0),)), "holes"),
        (lambda: CutOut(holes="open"), "holes"),
        (
            lambda: CutOut(
                strokes=(Stroke(points=np.array([-1e5, 1e5] * 5000), radius=4000.0, keeps=True),)
            ),
            "too many strokes",
        ),
    ],
)
def test_a_cut_out_that_is_none_is_refused(make, reported):
    with pytest.raises(EngineError, match=reported):
        make()


@pytest.mark.parametrize(
    ("points", "message"),
    [
        ([1j], "at least 2"),
        ([0, np.nan], "finite"),
        ([0, 1e7], "from the picture"),
    ],
)
def test_lines_that_are_none_are_refused(points, message: str) -> None:
    with pytest.raises(EngineError, match=message):
        CutLine(points=np.array(points, dtype=np.complex128))
