"""Fewer triangles that show the same: how near they are, in which order, and when they fail."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from app.export.decimation import TOLERANCE, MeshDecimator
from engine.arrays import Complexes, Floats, Integers
from engine.domain import MeshedDomain
from engine.domain.meshing.mesh import Mesh, border_edges
from engine.domain.meshing.triangulation import triangulate
from engine.geometry import Hole

# A bracket around a gap, in pixels.
BRACKET = np.array([0, 120, 120 + 90j, 80 + 90j, 80 + 30j, 40 + 30j, 40 + 90j, 90j]) + 0j


def domain_of(
    outline: Complexes, triangles: int = 5_000, holes: tuple[Hole, ...] = ()
) -> MeshedDomain:
    mesh = triangulate(outline, triangles, holes=[hole.outline for hole in holes])
    return MeshedDomain(outline=outline, cage=outline, mesh=mesh, holes=holes)


def bent(points: Complexes, amount: float) -> Complexes:
    """Points bent the more the farther right they are: |f_zz| goes up to a tenth of the amount."""
    return points + amount * (points / 120) ** 4 * 120


def drawn(mesh: Mesh, triangles: Integers, positions: Complexes) -> Complexes:
    """Where triangles of a mesh show each of its vertices, found by looking at every triangle."""
    places = np.full(len(mesh.vertices), np.nan + 0j)
    inside = np.full(len(mesh.vertices), -np.inf)
    for corners in triangles:
        a, b, c = mesh.vertices[corners]
        weights = barycentric(mesh.vertices, a, b, c)
        deeper = weights.min(axis=0) > inside
        inside[deeper] = weights.min(axis=0)[deeper]
        places[deeper] = positions[corners] @ weights[:, deeper]
    assert inside.min() > -1e-9
    return places


def barycentric(points: Complexes, a: complex, b: complex, c: complex) -> Floats:
    def twice_area(origin: complex, end: complex) -> Floats:
        return ((end - origin).conjugate() * (points - origin)).imag

    parts = np.array([twice_area(b, c), twice_area(c, a), twice_area(a, b)])
    return parts / parts.sum(axis=0)


HOLE = Hole(
    outline=60 + 15j + 8 * np.exp(-2j * np.pi * np.arange(24) / 24),
    cage=60 + 15j + 7 * np.exp(-2j * np.pi * np.arange(24) / 24),
    centre=60 + 15j,
)


@pytest.mark.parametrize("scale", [0.2, 1.0])
@pytest.mark.parametrize("holes", [(), (HOLE,)])
def test_what_does_not_bend_takes_few_triangles_that_cover_the_same(holes, scale):
    domain = domain_of(BRACKET, holes=holes)
    mesh = domain.mesh
    thinning = MeshDecimator(domain, scale)
    affine = (1.2 - 0.3j) * mesh.vertices + 0.2 * mesh.vertices.conj() + 7
    thinning.prepare([mesh.vertices, affine])
    fewer = thinning.triangles(affine, mesh.triangles)
    assert len(fewer) < len(mesh.triangles) / 3
    areas = Mesh(vertices=mesh.vertices, triangles=fewer).areas()
    assert areas.min() > 0
    assert_allclose(areas.sum(), mesh.areas().sum(), rtol=1e-12, atol=0)
    assert_array_equal(border_edges(fewer), border_edges(mesh.triangles))


@pytest.mark.parametrize("scale", [1.0, 1.7])
def test_every_vertex_is_drawn_within_the_tolerance_of_where_it_is(scale):
    mesh = domain_of(BRACKET).mesh
    thinning = MeshDecimator(domain_of(BRACKET), scale)
    poses = [bent(mesh.vertices, amount) for amount in (0.0, 0.06)]
    thinning.prepare(poses)
    for positions in (poses[1], bent(mesh.vertices, -0.09)):
        fewer = thinning.triangles(positions, mesh.triangles)
        assert len(fewer) < len(mesh.triangles)
        off = np.abs(drawn(mesh, fewer, positions) - positions)
        # Single precision, and the shaking before the triangulation.
        assert off.max() * scale <= TOLERANCE + 1e-3


def test_a_pose_that_bends_more_takes_more_triangles_where_it_bends():
    domain = domain_of(BRACKET)
    mesh = domain.mesh
    thinning = MeshDecimator(domain, scale=1.0)
    thinning.prepare([mesh.vertices])
    straight = thinning.triangles(mesh.vertices, mesh.triangles)
    curved = thinning.triangles(bent(mesh.vertices, 0.1), mesh.triangles)
    assert len(curved) > 1.5 * len(straight)
    sides = [(mesh.vertices[each].mean(axis=1).real > 60) for each in (straight, curved)]
    left, right = ((~sides[1]).sum() / (~sides[0]).sum(), sides[1].sum() / sides[0].sum())
    assert right > 2 * left
    # What was found stays for the frames to come, and is the same array.
    assert thinning.triangles(mesh.vertices, mesh.triangles) is curved


def test_triangles_keep_the_order_of_the_meshs_and_follow_another_one():
    domain = domain_of(BRACKET)
    mesh = domain.mesh
    thinning = MeshDecimator(domain, scale=1.0)
    thinning.prepare([mesh.vertices])
    for direction in (1, 1j, -1):
        across = (mesh.vertices[mesh.triangles].mean(axis=1) / direction).real
        painted = mesh.triangles[np.argsort(across)]
        fewer = thinning.triangles(mesh.vertices, painted)
        across = (mesh.vertices[fewer].mean(axis=1) / direction).real
        # By no more than the size of a triangle of the mesh, next to whose middle another one is.
        assert np.diff(across).min() > -4


def test_where_everything_bends_all_triangles_are_drawn():
    domain = domain_of(BRACKET)
    mesh = domain.mesh
    thinning = MeshDecimator(domain, scale=1.0)
    rng = np.random.default_rng(8)
    thinning.prepare([mesh.vertices])
    crumpled = mesh.vertices + rng.normal(size=(2, len(mesh.vertices))).T.copy().view(complex)[:, 0]
    assert thinning.triangles(crumpled, mesh.triangles) is mesh.triangles
    assert thinning.triangles(mesh.vertices, mesh.triangles) is mesh.triangles


def test_where_the_border_is_lost_across_a_gap_all_triangles_are_drawn():
    domain = domain_of(BRACKET)
    mesh = domain.mesh
    # The arms' ends nearly meet: points of one are nearer to the other's border than its own are.
    vertices = mesh.vertices.copy()
    arm = (vertices.real > 60) & (vertices.imag > 30)
    vertices[arm] -= 39.9 * (vertices[arm].imag - 30) / 60
    closed = Mesh(vertices=vertices, triangles=mesh.triangles)
    assert closed.areas().min() > 0
    outline = vertices[: len(BRACKET)]
    thinning = MeshDecimator(replace(domain, outline=outline, mesh=closed), scale=1.0)
    thinning.prepare([vertices])
    assert thinning.triangles(vertices, closed.triangles) is closed.triangles
