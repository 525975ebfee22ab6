"""Harmonic maps around holes, and certificates of them."""

from dataclasses import replace

import numpy as np
import pytest
from holed_shapes import Holed, boundary_of, inner_points, plate, random_map, ring, round_hole
from messages import says
from numpy.testing import assert_allclose, assert_array_equal
from shapes import regular_polygon

from engine.arrays import NOT_FINITE
from engine.errors import EngineError
from engine.geometry import Domain, Hole
from engine.geometry.polygon import FEW_VERTICES, HOLE_LEAVES
from engine.maps import Boundary, Bounds, HarmonicMap, LocalBounds, Span, certify, distortion
from engine.maps.certificate import OTHER_SPAN
from engine.maps.harmonic_map import COEFFICIENT_COUNT

SHAPES = [ring(), plate(2), plate(3)]
NAMES = ["one hole", "two holes", "three holes"]
LOOSE = LocalBounds(k=1.0, sigma_a=100.0, sigma_b=0.0)


def fitted(shape: Holed, values) -> np.ndarray:
    """Return the coefficients of a function that decays around the holes, for the hole cages."""
    samples = np.concatenate(shape.loops)
    span = Span(cage=shape.cage, holes=shape.holes)
    found, *_ = np.linalg.lstsq(
        span.coordinates(samples)[:, : -len(shape.holes)], values(samples), rcond=1e-10
    )
    return found


def holed_map(shape: Holed, phi, psi=None, logs=None) -> HarmonicMap:
    return HarmonicMap(
        cage=shape.cage,
        phi=phi,
        psi=0 * phi if psi is None else psi,
        holes=shape.holes,
        logs=np.zeros(len(shape.holes)) if logs is None else logs,
    )


@pytest.mark.parametrize("shape", SHAPES, ids=NAMES)
def test_logarithms_are_exact(shape):
    points = inner_points(shape)
    rest = HarmonicMap.identity(shape.cage, shape.holes)
    a = np.array([0.3 - 0.2j, -0.1j, 0.05])[: len(shape.holes)]
    f = replace(rest, logs=a)
    away = points[:, None] - np.array([hole.centre for hole in shape.holes])
    assert_allclose(f(points), points + 2 * np.log(np.abs(away)) @ a, rtol=0, atol=1e-13)
    fz, fzbar = f.derivatives(points)
    assert_allclose(fz, 1 + (1 / away) @ a, rtol=0, atol=1e-11)
    assert_allclose(fzbar, (1 / away.conj()) @ a, rtol=0, atol=1e-13)


@pytest.mark.parametrize("conjugate", [False, True])
@pytest.mark.parametrize("shape", SHAPES, ids=NAMES)
def test_the_span_holds_what_decays_around_holes(shape, conjugate):
    """z + a/z and z + conj(a/z) about each hole: as well as so many vertices can."""
    points, a = inner_points(shape), 0.02 + 0.01j

    def decaying(z):
        return sum(a / (z - hole.centre) for hole in shape.holes)

    rest, other = HarmonicMap.identity(shape.cage, shape.holes).phi, fitted(shape, decaying)
    f = holed_map(shape, rest, other) if conjugate else holed_map(shape, rest + other)
    expected = decaying(points).conj() if conjugate else decaying(points)
    assert_allclose(f(points), points + expected, rtol=0, atol=2e-5)
    fz, fzbar = f.derivatives(points)
    slope = sum(-a / (points - hole.centre) ** 2 for hole in shape.holes)
    assert_allclose(fzbar if conjugate else fz - 1, slope.conj() if conjugate else slope, atol=2e-3)


@pytest.mark.parametrize("shape", SHAPES, ids=NAMES)
def test_maps_are_single_valued_around_every_hole(shape):
    f = random_map(shape, 5)
    x, weights = np.polynomial.legendre.leggauss(24)
    for hole in shape.holes:
        along = (np.roll(hole.outline, -1) - hole.outline)[:, None]
        z = (hole.outline[:, None] + along * (1 + x) / 2).ravel()
        dz = (along * weights / 2).ravel()
        fz, fzbar = f.derivatives(z)
        own = (fz * dz).sum(), (fzbar * dz.conj()).sum()
        assert abs(own[0]) > 1e-3  # each by itself goes on
        assert abs(sum(own)) < 1e-9


def test_constants_on_the_cage_of_a_hole_are_nothing():
    shape = plate()
    f, points = random_map(shape, 1), inner_points(shape)
    shifts = np.concatenate([0 * shape.cage, *(np.full(24, 3 - 1j + j) for j in range(3))])
    same = replace(f, phi=f.phi + shifts, psi=f.psi - 2j * shifts)
    assert_allclose(same(points), f(points), rtol=0, atol=1e-12)
    for one, two in zip(same.derivatives(points), f.derivatives(points), strict=True):
        assert_allclose(one, two, rtol=0, atol=1e-11)


def test_coordinates_and_evaluation_agree():
    shape = plate()
    f, points = random_map(shape, 2), inner_points(shape)
    c = f.coefficients
    values, first = f.span.evaluate(c, points, orders=(0, 1))
    assert_allclose(f.span.coordinates(points) @ c, values, rtol=0, atol=1e-12)
    assert_allclose(f.span.derivatives(points) @ c, first, rtol=0, atol=1e-11)
    assert_allclose(
        f.span.derivatives(points) @ f.span.without_constant(c + 0), first, rtol=0, atol=1e-11
    )


def test_coefficients_must_belong_to_the_cages():
    shape = ring()
    rest = HarmonicMap.identity(shape.cage, shape.holes)
    with pytest.raises(EngineError, match=says(COEFFICIENT_COUNT, count=48 + 36)):
        replace(rest, phi=rest.phi[1:])
    with pytest.raises(EngineError, match="one logarithm for each of the 1 holes, not 0"):
        replace(rest, logs=np.empty(0))
    with pytest.raises(EngineError, match=says(NOT_FINITE, name="logs")):
        replace(rest, logs=np.array([np.nan]))
    with pytest.raises(EngineError, match=says(NOT_FINITE, name="outline of a hole")):
        replace(shape.holes[0], outline=np.full(3, np.nan))


def test_a_map_of_other_holes_is_refused():
    shape = ring()
    boundary = boundary_of("ring")
    other = replace(shape.holes[0], centre=0.1)
    for holes in ((), (other,)):
        with pytest.raises(EngineError, match=says(OTHER_SPAN)):
            certify(HarmonicMap.identity(shape.cage, holes), boundary, LOOSE)


def test_all_loops_are_sampled_with_the_domain_on_the_left():
    shape = plate()
    boundary = boundary_of("plate", 3)
    steps = boundary.points[boundary.next_samples] - boundary.points
    assert_allclose(np.abs(steps), 2 * boundary.half_lengths, rtol=1e-12)
    assert_allclose(boundary.weights.sum(), 1)
    for loop, start, end in zip(
        shape.loops, boundary.starts, [*boundary.starts[1:], len(boundary.points)], strict=True
    ):
        length = np.abs(np.roll(loop, -1) - loop).sum()
        assert_allclose(np.abs(steps[start:end]).sum(), length, rtol=1e-12)
        assert abs(steps[start:end].sum()) < 1e-12
        assert set(loop) <= set(boundary.points[start:end])


def test_refining_keeps_every_loop():
    boundary = boundary_of("plate", 3)
    ends = np.append(boundary.starts[1:], len(boundary.points)) - 1
    finer = boundary.refined(np.concatenate([ends, boundary.starts, [5, 17]]))
    assert len(finer.points) == len(boundary.points) + len(ends) + len(boundary.starts) + 2
    steps = finer.points[finer.next_samples] - finer.points
    assert_allclose(np.abs(steps) / 2, finer.half_lengths, rtol=1e-12)
    assert_array_equal(finer.points[finer.starts], boundary.points[boundary.starts])
    assert_allclose(finer.derivatives, finer.span.derivatives(finer.points), atol=1e-12)
    kernel = finer.span.third_derivative_kernel(finer.points, finer.points[finer.next_samples])
    assert_allclose(finer.third_derivative_kernel, kernel, rtol=1e-12)
    f = random_map(plate(), 4)
    assert_allclose(certify(f, finer, LOOSE).k, certify(f, boundary, LOOSE).k, atol=0.003)


@pytest.mark.parametrize("name", ["ring", "plate"])
@pytest.mark.parametrize("seed", range(4))
def test_certificates_enclose_what_is_anywhere_in_the_domain(name, seed):
    shape, boundary = (ring() if name == "ring" else plate()), boundary_of(name, 3)
    f = random_map(shape, seed, 0.1)
    certificate = certify(f, boundary, LOOSE)
    assert certificate.is_certified
    assert certificate.winding == 0
    along = np.linspace(0, 1, 23)
    dense = (
        boundary.points
        + along[:, None] * (boundary.points[boundary.next_samples] - boundary.points)
    ).ravel()
    fz, fzbar = f.derivatives(np.concatenate([dense, inner_points(shape)]))
    k, sigma_a, sigma_b = (
        getattr(distortion, which)(fz, fzbar) for which in ("k", "sigma_a", "sigma_b")
    )
    assert k.max() <= certificate.k <= k.max() + 0.003
    assert sigma_a.max() <= certificate.sigma_a <= sigma_a.max() * 1.003
    assert sigma_b.min() >= certificate.sigma_b >= sigma_b.min() - 0.003 * sigma_a.max()


def test_a_logarithm_near_the_boundary_is_enclosed():
    """Its second derivative is large there: 2 |a| / d³ must be counted."""
    hole = ring().holes[0]
    off_centre = Hole(outline=hole.outline, cage=hole.cage, centre=0.38)
    boundary = Boundary.sample(Domain(ring().outline, ring().cage, [off_centre]))
    f = replace(HarmonicMap.identity(ring().cage, (off_centre,)), logs=np.array([0.04j]))
    certificate = certify(f, boundary, LOOSE)
    dense = (
        np.linspace(0, 1, 800)[:, None] * np.diff(np.append(hole.outline, hole.outline[0]))
    ) + hole.outline
    fz, fzbar = f.derivatives(dense.ravel())
    assert distortion.k(fz, fzbar).max() <= certificate.k


def test_a_fold_at_a_hole_is_refused():
    """z + conj(a/z) with |a| > r² turns the loop of the hole over; the outline does not see it."""
    shape, boundary = ring(), boundary_of("ring")
    rest = HarmonicMap.identity(shape.cage, shape.holes).phi
    for a, holds in ((0.22, True), (0.28, False)):
        f = holed_map(shape, rest, fitted(shape, lambda z, a=a: a / z))
        fz, fzbar = f.derivatives(shape.outline)
        assert distortion.sigma_b(fz, fzbar).min() > 0.5
        proof = certify(f, boundary, LOOSE)
        assert proof.is_certified is holds
        assert (proof.sigma_b > 0) is holds


def test_a_zero_between_outline_and_hole_is_refused():
    """z² − 2 · 0.75 z: f_z vanishes at 0.75, where no sample is."""
    shape, boundary = ring(), boundary_of("ring")
    fine = 1.08 * regular_polygon(48)
    phi = np.concatenate([fine**2 - 1.5 * fine, np.zeros(36)])
    proof = certify(holed_map(shape, phi), boundary, LOOSE)
    assert proof.winding == 1
    assert not proof.is_certified
    assert proof.k == np.inf


def test_a_ring_turned_inside_out_is_refused():
    """1/z is free of folds and zeros, but f_z winds −2 times around the hole."""
    shape, boundary = ring(), boundary_of("ring")
    f = holed_map(shape, fitted(shape, lambda z: 1 / z))
    fz, fzbar = f.derivatives(boundary.points)
    assert distortion.sigma_b(fz, fzbar).min() > 0
    proof = certify(f, boundary, LOOSE)
    assert proof.winding is None
    assert not proof.is_certified


def test_a_tiny_hole_changes_nothing():
    """The same map over the cage alone is certified alike."""
    tiny = ring(0.004)
    boundary = Boundary.sample(tiny.domain)
    whole = Boundary.sample(Domain(tiny.outline, tiny.cage))
    cage = tiny.cage
    alone = HarmonicMap(cage=cage, phi=cage + 0.1 * cage**2, psi=0.1 * cage)
    f = holed_map(tiny, np.append(alone.phi, np.zeros(36)), np.append(alone.psi, np.zeros(36)))
    one, two = certify(f, boundary, Bounds()), certify(alone, whole, Bounds())
    assert one.is_certified
    assert_allclose([one.k, one.sigma_a, one.sigma_b], [two.k, two.sigma_a, two.sigma_b], rtol=1e-9)
    points = inner_points(tiny)
    assert_allclose(f(points), alone(points), atol=1e-13)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"outline": ring().holes[0].outline[::-1]}, "hole 0 runs counter-clockwise"),
        ({"outline": 2.5 * ring().holes[0].outline}, says(HOLE_LEAVES, number=0)),
        ({"cage": 1.3 * ring().holes[0].cage}, "cage of hole 0 is not inside"),
        ({"cage": ring().holes[0].cage[:2]}, says(FEW_VERTICES)),
        ({"centre": 0.45}, "centre of hole 0"),
    ],
)
def test_bad_holes_are_refused(change, message):
    hole = replace(round_hole(0, 0.5, 36), **change)
    with pytest.raises(EngineError, match=message):
        Boundary.sample(Domain(ring().outline, ring().cage, [hole]))


@pytest.mark.parametrize("shape", SHAPES, ids=NAMES)
def test_the_basis_spans_all_and_is_orthonormal_but_for_holes(shape):
    boundary = Boundary.sample(shape.domain)
    basis = boundary.basis
    # Logarithms are scaled, and mixed with nothing: ψ's are the conjugates of φ's.
    count = len(shape.holes)
    logs = basis[-count:]
    assert_array_equal(logs[:, :-count], 0)
    assert_array_equal(logs[:, -count:], np.diag(logs[:, -count:].diagonal().real))
    # Constants come first, and no other column has any in a hole.
    for column, part in enumerate(boundary.span.slices):
        constant = np.zeros(len(basis))
        constant[part] = boundary.size
        assert_array_equal(basis[:, column], constant)
    constants = len(boundary.span.slices)
    others = basis[:, constants:]
    for part in boundary.span.slices[1:]:
        assert_allclose(others[part].sum(axis=0), 0, atol=1e-9 * boundary.size)
    # All other functions have the mean 0, so that no handle is far from one.
    means = (boundary.vertex_coordinates @ others).mean(axis=0)
    assert_allclose(means, 0, atol=1e-9 * boundary.size)
    rows = np.sqrt(boundary.weights)[:, None] * boundary.basis_derivatives
    assert_allclose(boundary.basis_derivatives, boundary.derivatives @ basis, atol=1e-9)
    gram = (rows.conj().T @ rows)[constants:, constants:]
    assert_allclose(gram[:-count, :-count], np.eye(len(gram) - count), atol=1e-9)
    assert_allclose(gram.diagonal()[-count:], 1, rtol=1e-12)
    # A refined boundary keeps it.
    finer = boundary.refined(np.array([3, 17]))
    assert_allclose(finer.basis_derivatives, finer.derivatives @ basis, atol=1e-9)
