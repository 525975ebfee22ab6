"""Holes of the subject that are kept: outlines, cages, and which of them."""

import numpy as np
import pictures
import pytest
from hypothesis import assume, given, settings, strategies as st
from numpy.testing import assert_allclose, assert_array_equal
from outlines import check_hole, check_outline, corners_of, diagonal, notices_of
from scipy import ndimage

from engine.arrays import Booleans, Bytes, Complexes
from engine.domain import build_domain, require_domain
from engine.domain.outline.enclosure import Detail, Enclosure, enclose_subject
from engine.geometry import Hole, contains, signed_area

DETAILS: tuple[Detail, ...] = ("coarse", "normal", "fine")


def plate(*holes: tuple[float, float, float], width: int = 600, height: int = 300) -> Booleans:
    """A plate with round holes: x, y up, and radius."""
    x, y = pictures.plane(width, height)
    mask = np.zeros((height, width), dtype=np.bool_)
    mask[20:-20, 20:-20] = True
    for cx, cy, radius in holes:
        mask &= np.hypot(x - cx, height - y - cy) >= radius
    return mask


def keyhole() -> Booleans:
    """A ring, with an island on a bridge in its hole: the hole winds around the island."""
    x, y = pictures.plane(400, 400)
    radius = np.hypot(x - 200, y - 200)
    bridge = (np.abs(y - 200) < 8) & (x > 200)
    return (radius < 180) & ((radius > 120) | (radius < 90) | bridge)


def kept(mask: Booleans, detail: Detail = "normal") -> Enclosure:
    return enclose_subject(mask, detail=detail, holes="keep")


def check_holes(mask: Booleans, enclosure: Enclosure, *, most: int = 200) -> None:
    """Hold what is kept against all that is required of outlines and cages."""
    check_outline(ndimage.binary_fill_holes(mask), enclosure, most=most)
    total = sum(len(hole.outline) for hole in enclosure.holes) + len(enclosure.outline)
    assert total <= max(most, len(enclosure.outline))
    for hole in enclosure.holes:
        check_hole(hole, diagonal(mask))
        # Every pixel of the subject lies outside, with its corners.
        inside = contains(hole.outline, corners_of(mask))
        assert not inside.any()
    sizes = [-signed_area(hole.outline) for hole in enclosure.holes]
    assert all(size > 0 for size in sizes)


@pytest.mark.parametrize(
    ("mask", "count", "detail"),
    [
        (pictures.ring()[..., 3] > 0, 1, "coarse"),
        (pictures.ring()[..., 3] > 0, 1, "fine"),
        (plate((120, 150, 60), (300, 150, 80), (480, 150, 50)), 3, "normal"),
        (keyhole(), 1, "fine"),
        (keyhole(), 1, "coarse"),
        (pictures.letter("8", 200)[..., 3] > 0, 2, "coarse"),
        (pictures.stick_figure(line=3)[..., 3] > 0, 1, "normal"),
        (pictures.letter("e", 40)[..., 3] > 0, 1, "fine"),
    ],
    ids=[
        "ring, coarse",
        "ring, fine",
        "plate",
        "keyhole, fine",
        "keyhole, coarse",
        "letter",
        "stick figure",
        "small letter",
    ],
)
def test_large_holes_are_kept(mask: Booleans, count: int, detail: Detail) -> None:
    enclosure = kept(mask, detail)
    assert len(enclosure.holes) == count
    check_holes(mask, enclosure)
    assert not any("filled" in notice for notice in notices_of(enclosure))


@pytest.mark.parametrize("name", ["ring", "plate"])
def test_what_lies_around_the_holes_is_the_same_whether_they_are_kept_or_filled(name) -> None:
    mask = {"ring": pictures.ring()[..., 3] > 0, "plate": plate((120, 150, 60))}[name]
    keeping, filling = kept(mask), enclose_subject(mask, detail="normal", holes="fill")
    assert_array_equal(keeping.outline, filling.outline)
    assert_array_equal(keeping.cage, filling.cage)
    assert filling.holes == ()
    assert any("1 hole filled" in notice for notice in notices_of(filling))


@pytest.mark.parametrize(("radius", "count"), [(5, 0), (12, 1)])
def test_small_holes_are_filled_and_reported(radius: float, count: int) -> None:
    # The diagonal is 617 pixels, of which 1.2 % are 7.4.
    mask = plate((150, 150, 70), (400, 150, radius))
    enclosure = kept(mask)
    assert len(enclosure.holes) == 1 + count
    check_holes(mask, enclosure)
    reported = () if count else ("1 hole filled, 0.05% of the subject, too small to stay open",)
    assert notices_of(enclosure) == reported


def test_bubbles_in_a_soft_contour_are_no_holes() -> None:
    """As a brush with soft bristles leaves them between a line and what it surrounds."""
    side = 300
    y, x = (np.mgrid[: 4 * side, : 4 * side] + 0.5) / 4
    drawn = np.hypot(x - side / 2, y - side / 2) < 0.45 * side
    rng = np.random.default_rng(3)
    for angle in np.linspace(0, 2 * np.pi, 50):
        middle = side * (0.5 + 0.5j + 0.41 * np.exp(1j * angle))
        drawn &= np.hypot(x - middle.real, y - middle.imag) > rng.uniform(0.5, 3.2)
    soft = drawn.reshape(side, 4, side, 4).mean((1, 3))
    enclosure = kept(soft > 0.03)
    assert (enclosure.holes, notices_of(enclosure)) == ((), ())
    assert notices_of(kept(soft > 0.03, "fine")) == ()
    assert notices_of(enclose_subject(soft > 0.03, detail="normal", holes="fill")) == ()
    # A hole that is seen is reported, as ever.
    y, x = np.mgrid[:side, :side] - side // 2
    reported = notices_of(kept((soft > 0.03) & (np.hypot(x, y) > 0.013 * side)))
    assert reported == ("1 hole filled, 0.08% of the subject, too small to stay open",)


def test_the_margin_and_the_cage_leave_the_middle_of_a_small_hole_free() -> None:
    (hole,) = kept(plate((300, 150, 12)), "coarse").holes
    assert_allclose(np.abs(hole.outline - (300 + 150j)), 9, rtol=0, atol=1)
    assert_allclose(np.abs(hole.cage - (300 + 150j)), 6, rtol=0, atol=1.5)
    assert abs(hole.centre - (300 + 150j)) < 0.5


def test_the_largest_holes_are_kept_while_there_are_few_vertices() -> None:
    places = [(60 + 80 * i, 60 + 90 * j, 20 + i + j) for i in range(7) for j in range(3)]
    mask = plate(*places)
    enclosure = kept(mask)
    check_holes(mask, enclosure)
    assert 5 <= len(enclosure.holes) < len(places)
    sizes = sorted((radius for *_, radius in places), reverse=True)
    smallest = min(np.sqrt(-signed_area(hole.outline) / np.pi) for hole in enclosure.holes)
    assert smallest >= 0.6 * sizes[len(enclosure.holes)]
    (reported,) = notices_of(enclosure)
    assert reported.startswith(f"{len(places) - len(enclosure.holes)} holes filled, the largest")
    assert reported.endswith("of the subject, because too many open holes make posing slow")


def test_holes_are_where_they_are_in_the_picture() -> None:
    for size in (60, 600, 1200):
        scale = size / 600
        mask = plate((150, 180, 70), width=600, height=300)
        mask = mask[:: int(1 / scale), :: int(1 / scale)] if scale < 1 else mask
        if scale > 1:
            mask = np.kron(mask, np.ones((int(scale), int(scale)))) > 0
        (hole,) = kept(mask).holes
        assert abs(hole.centre - scale * (150 + 180j)) < max(1.0, 4 * scale)


@settings(max_examples=6)
@given(
    places=st.lists(
        st.tuples(st.floats(40, 560), st.floats(40, 260), st.floats(4, 60)), min_size=1, max_size=5
    ),
    detail=st.sampled_from(DETAILS),
)
def test_random_holes(places: list[tuple[float, float, float]], detail: Detail) -> None:
    mask = plate(*places)
    assume(ndimage.label(mask, np.ones((3, 3)))[1] == 1)
    check_holes(mask, kept(mask, detail))


@pytest.mark.parametrize("picture", [pictures.ring(), pictures.painted(keyhole())])
def test_a_built_domain_with_holes_is_one(picture: Bytes) -> None:
    domain, _ = build_domain(pictures.seen(picture), triangles=3_000, detail="normal", holes="keep")
    require_domain(domain)
    assert len(domain.loops) == len(domain.cages) == 2
    loops: Complexes = np.concatenate(domain.loops)
    assert_array_equal(domain.mesh.vertices[: len(loops)], loops)
    assert 1 - len(domain.holes) == (
        len(domain.mesh.vertices) - len(domain.mesh.edges()) + len(domain.mesh.triangles)
    )
    without, _ = build_domain(
        pictures.seen(picture), triangles=3_000, detail="normal", holes="fill"
    )
    assert without.holes == ()


def test_a_hole_holds_frozen_arrays() -> None:
    for hole in kept(pictures.seen(pictures.ring())).holes:
        assert isinstance(hole, Hole)
        assert not hole.outline.flags.writeable
        assert not hole.cage.flags.writeable
