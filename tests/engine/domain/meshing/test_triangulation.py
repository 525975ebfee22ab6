import numpy as np
import pytest
import shapely
from hypothesis import assume, given, settings, strategies as st
from messages import says
from shapes import regular_polygon, star_polygons

from engine.arrays import Complexes, Floats
from engine.domain.meshing.mesh import Mesh
from engine.domain.meshing.triangulation import triangulate
from engine.errors import EngineError
from engine.geometry.polygon import (
    HOLE_LEAVES,
    as_xy,
    contains,
    diameter,
    edge_vectors,
    is_simple,
    signed_area,
)


def subdivided(corners: list[complex], pieces: int) -> Complexes:
    """Cut every edge of a polygon into equal pieces: many collinear vertices."""
    polygon = np.array(corners, dtype=np.complex128)
    return (polygon[:, None] + np.outer(edge_vectors(polygon), np.arange(pieces) / pieces)).ravel()


def star(points: int, inner: float) -> Complexes:
    radius = np.where(np.arange(2 * points) % 2, inner, 1.0)
    return radius * np.exp(1j * np.pi * np.arange(2 * points) / points)


def comb(teeth: int, width: float, slit: float) -> Complexes:
    right = np.arange(teeth, 0, -1) * (width + slit)
    left = right - width
    tooth = np.column_stack([right, right + 4j, left + 4j, left]).ravel()
    return np.concatenate([[left[-1] - 0.5j, right[0] - 0.5j], tooth])


def exterior(shape: shapely.Geometry) -> Complexes:
    """Return the outer ring, counter-clockwise, of the largest part."""
    part = max(shapely.get_parts(shape), key=shapely.area)
    ring = shapely.get_coordinates(shapely.orient_polygons(part).exterior)[:-1]
    return ring @ [1, 1j]


def spiral(turns: float, half_width: float) -> Complexes:
    t = np.linspace(0, 1, 150)
    middle = (0.15 + 0.85 * t) * np.exp(2j * np.pi * turns * t)
    band = shapely.LineString(as_xy(middle)).buffer(half_width, quad_segs=3)
    return exterior(band.simplify(0.003))


def spike(degrees: float) -> Complexes:
    arm = 3 * np.exp(0.5j * np.radians(degrees))
    return np.array([0, arm.conjugate(), 5 - 1j, 5 + 1j, arm])


def necked(half_width: float) -> Complexes:
    w = half_width
    return np.array(
        [-1 - 1j, -w - w * 1j, w - w * 1j, 1 - 1j, 1 + 1j, w + w * 1j, -w + w * 1j, -1 + 1j]
    )


def slit(width: float) -> Complexes:
    return np.array([0, 10, 10 + 10j, 5 + width + 10j, 5 + 5j, 5 - width + 10j, 10j])


def notched() -> Complexes:
    """Return a rectangle with a zigzag of edges 0.1 % of its diagonal long."""
    tiny = 0.005
    zigzag = [2 + 3 * tiny + 3j, 2 + 2 * tiny + 2.996j, 2 + tiny + 3.002j, 2 + 3j]
    return np.array([0, 4, 4 + 3j, *zigzag, 3j])


@st.composite
def limbs(draw: st.DrawFn) -> Complexes:
    """Draw outlines of random trees of limbs, each of its own width."""
    rng = np.random.default_rng(draw(st.integers(0, 2**32 - 1)))
    width = draw(st.sampled_from([0.003, 0.01, 0.03]))
    joints = [0j]
    parts = []
    for _ in range(draw(st.integers(1, 12))):
        start = joints[rng.integers(len(joints))]
        end = start + rng.uniform(0.2, 0.8) * np.exp(2j * np.pi * rng.random())
        joints.append(end)
        limb = shapely.LineString([(start.real, start.imag), (end.real, end.imag)])
        parts.append(limb.buffer(width * rng.uniform(0.3, 2), quad_segs=2))
    return exterior(shapely.union_all(parts).simplify(width / 5))


@st.composite
def uneven_polygons(draw: st.DrawFn) -> Complexes:
    """Draw star-shaped polygons with extra vertices very near to others."""
    polygon = draw(star_polygons(largest=60))
    gap = draw(st.sampled_from([1e-3, 1e-2])) * diameter(polygon)
    rng = np.random.default_rng(len(polygon))
    tilt = 1 + 0.3j * rng.standard_normal(len(polygon))
    near = polygon + gap * tilt * edge_vectors(polygon) / np.abs(edge_vectors(polygon))
    assume(np.all(np.abs(edge_vectors(polygon)) > 3 * gap))
    outline = np.column_stack([polygon, near]).ravel()
    assume(is_simple(outline))
    return outline


SHAPES = {
    "triangle": regular_polygon(3),
    "square": regular_polygon(4),
    "hexagon": regular_polygon(6),
    "60-gon": regular_polygon(60),
    "star": star(10, 0.35),
    "comb": comb(8, 0.3, 0.1),
    "thin comb": comb(8, 0.1, 0.01),
    "very thin comb": comb(8, 0.03, 0.01),
    "spiral": spiral(3, 0.06),
    "thin spiral": spiral(5, 0.02),
    "bar 40:1": subdivided([0, 40, 40 + 1j, 1j], 20) * np.exp(0.3j),
    "corner of 15°": spike(15),
    "corner of 20°": spike(20),
    "corner of 40°": spike(40),
    "neck": necked(0.001),
    "slit": slit(0.001),
    "zigzag": notched(),
}


def interior_angles(outline: Complexes) -> Floats:
    along = edge_vectors(outline)
    return np.degrees(np.angle(-np.roll(along, 1) / along)) % 360


def assert_conforming(outline: Complexes, mesh: Mesh, holes: tuple[Complexes, ...] = ()) -> None:
    """Check everything that is required of any mesh: a valid one, of this outline and holes."""
    loops = (outline, *holes)
    vertices, triangles = mesh.vertices, mesh.triangles.astype(np.int64)
    assert mesh.triangles.dtype == np.int32
    areas = mesh.areas()
    assert areas.min() > 0
    np.testing.assert_allclose(areas.sum(), sum(map(signed_area, loops)), rtol=1e-9)
    np.testing.assert_array_equal(np.unique(triangles), np.arange(len(vertices)))
    assert len(np.unique(vertices)) == len(vertices)
    # Each directed edge once: two triangles at an inner edge, one at a boundary edge.
    size = len(vertices)
    start, end = triangles.ravel(), np.roll(triangles, -1, axis=1).ravel()
    assert len(np.unique(start * size + end)) == len(start)
    border = ~np.isin(start * size + end, end * size + start)
    inner = (len(start) - border.sum()) // 2
    assert len(mesh.edges()) == inner + border.sum()
    assert size - len(mesh.edges()) + len(triangles) == 1 - len(holes)
    # The border has a loop through all vertices of each polygon, in order and on its edges.
    after = np.full(size, -1)
    after[start[border]] = end[border]
    first, walked = 0, 0
    for polygon in loops:
        corners = np.arange(first, first + len(polygon))
        np.testing.assert_array_equal(vertices[corners], polygon)
        loop = [first]
        while (following := int(after[loop[-1]])) != first:
            loop.append(following)
        corner = np.flatnonzero(np.isin(loop, corners))
        np.testing.assert_array_equal(np.array(loop)[corner], corners)
        edge = np.searchsorted(corner, np.arange(len(loop)), side="right") - 1
        offset = (vertices[loop] - polygon[edge]) * edge_vectors(polygon)[edge].conj()
        height = np.abs(offset.imag / np.abs(edge_vectors(polygon)[edge]))
        assert height.max() < 1e-12 * (diameter(outline) + np.abs(outline).max())
        first, walked = first + len(polygon), walked + len(loop)
    assert walked == border.sum()


def assert_well_shaped(outline: Complexes, mesh: Mesh) -> None:
    angles = mesh.smallest_angles()
    assert angles.min() > min(15.0, interior_angles(outline).min()) - 1e-6


FINE = {"60-gon", "very thin comb", "thin spiral", "corner of 15°", "zigzag"}


@pytest.mark.parametrize(
    ("name", "count"),
    [
        *((name, 1_000) for name in SHAPES),
        *(
            pytest.param(name, 20_000, marks=() if name in FINE else pytest.mark.long)
            for name in SHAPES
        ),
    ],
)
def test_named_shapes(name: str, count: int) -> None:
    mesh = triangulate(SHAPES[name], count)
    assert_conforming(SHAPES[name], mesh)
    assert_well_shaped(SHAPES[name], mesh)
    assert abs(len(mesh.triangles) - count) <= 0.05 * count


@pytest.mark.parametrize(
    ("name", "count"),
    [
        ("comb", 100_000),
        *((name, 40_000) for name in ("hexagon", "star", "spiral", "bar 40:1", "zigzag")),
    ],
)
def test_ordinary_meshes_are_nearly_equilateral(name: str, count: int) -> None:
    mesh = triangulate(SHAPES[name], count)
    angles = mesh.smallest_angles()
    assert angles.mean() > 57.5
    assert np.quantile(angles, 0.01) > 37
    assert angles.min() > min(24.0, interior_angles(SHAPES[name]).min() - 1e-6)


@pytest.mark.parametrize("name", ["hexagon", "60-gon", "corner of 40°", "slit", "zigzag", "neck"])
def test_coarse_meshes_are_still_good(name: str) -> None:
    assert triangulate(SHAPES[name], 1_000).smallest_angles().mean() > 53


@settings(max_examples=10)
@given(outline=star_polygons(largest=60), count=st.sampled_from([1_000, 3_000]))
def test_star_shaped_polygons(outline: Complexes, count: int) -> None:
    mesh = triangulate(outline, count)
    assert_conforming(outline, mesh)
    assert_well_shaped(outline, mesh)
    assert abs(len(mesh.triangles) - count) <= 0.05 * count


@settings(max_examples=10)
@given(outline=limbs(), count=st.sampled_from([1_000, 3_000]))
def test_trees_of_limbs(outline: Complexes, count: int) -> None:
    mesh = triangulate(outline, count)
    assert_conforming(outline, mesh)
    assert_well_shaped(outline, mesh)


@settings(max_examples=8)
@given(outline=uneven_polygons(), count=st.sampled_from([1_000, 3_000]))
def test_edges_of_very_mixed_lengths(outline: Complexes, count: int) -> None:
    mesh = triangulate(outline, count)
    assert_conforming(outline, mesh)
    assert_well_shaped(outline, mesh)


@pytest.mark.parametrize("move", [1e4 - 3e3j, 0j])
@pytest.mark.parametrize("scale", [1e-7, 1e-3, 1.0, 1e4])
def test_place_and_scale_do_not_matter(move: complex, scale: float) -> None:
    outline = scale * (SHAPES["neck"] + move)
    mesh = triangulate(outline, 5_000)
    assert_conforming(outline, mesh)
    assert_well_shaped(outline, mesh)
    assert abs(len(mesh.triangles) - 5_000) <= 250


def hole(centre: complex, radius: float, sides: int) -> Complexes:
    """A regular polygon, clockwise."""
    return centre + radius * regular_polygon(sides)[::-1]


HOLED = {
    "ring": (regular_polygon(60), (hole(0, 0.5, 40),)),
    "thin ring": (regular_polygon(60), (hole(0, 0.97, 50),)),
    "off the centre": (regular_polygon(60), (hole(0.55 + 0.1j, 0.35, 24),)),
    "pin holes": (
        subdivided([-3 - 1j, 3 - 1j, 3 + 1j, -3 + 1j], 12),
        (hole(-1.1, 0.28, 26), hole(0, 0.003, 12), hole(0.02, 0.004, 12), hole(1.1, 0.5, 5)),
    ),
    "squares": (regular_polygon(4), (0.5 * regular_polygon(4)[::-1],)),
}


@pytest.mark.parametrize(
    ("name", "count"), [*((name, 1_000) for name in HOLED), ("thin ring", 20_000)]
)
def test_holes_are_left_out(name: str, count: int) -> None:
    outline, holes = HOLED[name]
    mesh = triangulate(outline, count, holes=holes)
    assert_conforming(outline, mesh, holes)
    assert mesh.smallest_angles().min() > 20
    assert abs(len(mesh.triangles) - count) <= 0.05 * count


@settings(max_examples=10)
@given(outline=star_polygons(), size=st.floats(0.01, 0.9), turn=st.floats(0, 6.3))
def test_holes_of_any_size_in_star_shaped_polygons(
    outline: Complexes, size: float, turn: float
) -> None:
    holes = (size * 0.5 * np.cos(np.pi / 5) * hole(0, 1, 9) * np.exp(1j * turn),)
    assume(contains(outline, 1.05 * holes[0]).all())
    mesh = triangulate(outline, 2_000, holes=holes)
    assert_conforming(outline, mesh, holes)
    assert mesh.smallest_angles().min() > 14


@pytest.mark.parametrize(
    ("holes", "message"),
    [
        ([0.3 * regular_polygon(5)], "runs counter-clockwise; give its vertices clockwise"),
        ([hole(0.9, 0.3, 9)], says(HOLE_LEAVES, number=0)),
        ([hole(0, 0.3, 9), hole(0.3, 0.3, 9)], says(HOLE_LEAVES, number=1)),
        ([hole(0, 0.3, 9), hole(0, 0.1, 9)], says(HOLE_LEAVES)),
        ([hole(0, 0.3, 5)[[0, 2, 4, 1, 3]]], "outline of hole 0 crosses"),
    ],
)
def test_holes_that_are_none_are_refused(holes: list[Complexes], message: str) -> None:
    with pytest.raises(EngineError, match=message):
        triangulate(regular_polygon(30), 1_000, holes=holes)


def test_triangles_grow_away_from_short_edges() -> None:
    mesh = triangulate(SHAPES["zigzag"], 1_000)
    longest = np.abs(np.diff(mesh.vertices[mesh.edges()], axis=1))[:, 0]
    assert longest.min() < 0.01
    distance = np.abs(mesh.vertices[mesh.edges()].mean(axis=1) - (2 + 3j))
    assert np.all(longest < 0.02 + 1.2 * distance)
    # Away from the zigzag all are as long as if it were not there.
    far = longest[distance > 1]
    assert far.min() > 0.07
    assert far.max() < 0.3


@pytest.mark.parametrize(
    ("count", "least"), [(60_000, 58), pytest.param(1_000_000, 59, marks=pytest.mark.long)]
)
def test_meshes_may_have_many_triangles(count: int, least: float) -> None:
    mesh = triangulate(SHAPES["star"], count)
    assert abs(len(mesh.triangles) - count) <= 0.02 * count
    assert mesh.areas().min() > 0
    np.testing.assert_allclose(mesh.areas().sum(), signed_area(SHAPES["star"]), rtol=1e-9)
    assert len(mesh.vertices) - len(mesh.edges()) + len(mesh.triangles) == 1
    assert mesh.smallest_angles().mean() > least


def test_the_same_outline_gives_the_same_mesh() -> None:
    first, second = (triangulate(SHAPES["comb"], 3_000) for _ in range(2))
    np.testing.assert_array_equal(first.vertices, second.vertices)
    np.testing.assert_array_equal(first.triangles, second.triangles)


@pytest.mark.parametrize(
    ("outline", "message"),
    [
        (regular_polygon(5)[::-1], "clockwise"),
        (regular_polygon(5)[[0, 2, 4, 1, 3]], "crosses"),
        (np.array([0, 1, 1 + 1j, 1j, 1e-8j]), "edge of length 1e-08"),
    ],
)
def test_bad_outlines_are_refused(outline: Complexes, message: str) -> None:
    with pytest.raises(EngineError, match=message):
        triangulate(outline, 1_000)
