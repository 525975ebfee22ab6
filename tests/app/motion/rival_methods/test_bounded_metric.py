"""Blended and flattened metrics: facts of Chen, Weber, Keren and Ben-Chen (2013)."""

import numpy as np
import pytest
from hypothesis import given, settings, strategies as st
from interpolation_shapes import bar, boundary_of, letter_l, random_map
from meshed_shapes import k_of, meshed_bar, s_to_u, stretched_pair
from numpy.testing import assert_allclose

from app.motion import prepare_baseline
from app.motion.rival_methods.flattening import Flattening, _angles, edge_lengths
from engine.domain.meshing.triangulation import triangulate
from engine.interpolation import prepare
from engine.maps import distortion

MESH = meshed_bar()


def prepared(maps, mesh=MESH, **options):
    return prepare_baseline("sig13", maps, mesh.vertices, mesh.triangles, **options)


def k_of_lengths(domain, lengths):
    """Return k of the affine maps from the domain's triangles to such with given lengths."""
    at = domain.points[domain.corners]
    edge = np.roll(at, -1, axis=1) - at
    # |J e|² = 𝒜 |e|² + 2 Re(conj(η) e²), linear in 𝒜 and η.
    rows = np.stack([np.abs(edge) ** 2, 2 * (edge**2).real, 2 * (edge**2).imag], axis=-1)
    trace, x, y = np.linalg.solve(rows, lengths[..., None] ** 2)[..., 0].T
    eta = np.hypot(x, y)
    large = np.sqrt((trace + 2 * eta) / (trace - 2 * eta))
    return (large - 1) / (large + 1)


@given(seed=st.integers(0, 1000), time=st.floats(0.05, 0.95))
@settings(max_examples=3)
def test_the_blended_metric_keeps_the_conformal_bound_in_every_triangle(seed, time):
    maps = [random_map(bar(), 2 * seed + i, k=0.6) for i in range(2)]
    mesh = triangulate(bar()[0], 300)
    between = prepared(maps, mesh)
    domain = between.domain
    ends = np.max([k_of(*domain.derivatives(f(mesh.vertices))) for f in maps], axis=0)
    k = k_of_lengths(domain, between.segments[0].blended_lengths(time))
    assert np.all(k <= ends + 1e-9)
    frame = between.frame(time)
    assert frame.angle_defect <= 1e-8
    assert np.all(np.abs(frame.fz) > np.abs(frame.fzbar))


def test_what_flattening_adds_to_the_conformal_distortion_of_a_triangle_dies_with_its_size():
    maps, excess = s_to_u(), []
    for count in (200, 3200):
        mesh = meshed_bar(count)
        between = prepared(maps, mesh)
        frame = between.frame(0.5)
        before = k_of_lengths(between.domain, between.segments[0].blended_lengths(0.5))
        excess.append((k_of(frame.fz, frame.fzbar) - before).max())
        assert frame.angle_defect <= 1e-8
    assert excess[1] < excess[0] / 2
    assert excess[1] < 0.015


@pytest.mark.parametrize("time", [0.25, 0.5, 0.8])
def test_lengths_on_the_border_are_those_of_the_blended_metric(time):
    between = prepared(stretched_pair())
    domain, frame = between.domain, between.frame(time)
    start, end = domain.corners, np.roll(domain.corners, -1, axis=1)
    outer = np.setdiff1d(np.arange(start.size), domain.counterparts.ravel())
    found = np.abs(frame.positions[end] - frame.positions[start]).ravel()[outer]
    blended = between.segments[0].blended_lengths(time).ravel()[outer]
    assert_allclose(found, blended, rtol=1e-8, atol=0)


def test_it_lies_near_the_metric_variant():
    shape = letter_l()
    maps = [random_map(shape, seed, k=0.4) for seed in (3, 8)]
    mesh = triangulate(shape[0], 3000)
    between = prepared(maps, mesh)
    metric = prepare(
        maps,
        boundary_of(shape),
        mesh.vertices,
        variant="metric",
        triangles=mesh.triangles,
        anchor=mesh.vertices[between.domain.anchor],
    )
    for time in (0.25, 0.5, 0.75):
        apart = np.abs(between.frame(time).positions - metric.frame(time).positions).max()
        assert apart < 0.03 * metric.sampled_domain.diameter


def test_the_lengths_differ_from_the_blend_by_a_factor_of_each_end():
    between = prepared(s_to_u())
    domain, frame = between.domain, between.frame(0.5)
    start, end = domain.corners, np.roll(domain.corners, -1, axis=1)
    found = np.abs(frame.positions[end] - frame.positions[start])
    ratio = np.log(found / between.segments[0].blended_lengths(0.5)).ravel()
    rows = np.zeros((ratio.size, len(domain.points)))
    rows[np.arange(ratio.size), start.ravel()] = rows[np.arange(ratio.size), end.ravel()] = 0.5
    logarithms, *_ = np.linalg.lstsq(rows, ratio, rcond=None)
    assert_allclose(rows @ logarithms, ratio, rtol=0, atol=1e-7)
    assert_allclose(logarithms[domain.border], 0, rtol=0, atol=1e-7)
    assert np.abs(logarithms).max() > 0.01


def test_of_affine_keyframes_the_metric_is_blended_linearly_and_is_flat_already():
    keys = [MESH.vertices, (1.5 + 1j) * MESH.vertices + 0.8j * MESH.vertices.conj()]
    frame = prepared(keys).frame(0.3)
    trace = np.abs(frame.fz) ** 2 + np.abs(frame.fzbar) ** 2
    assert_allclose(trace, 0.7 + 0.3 * (1.5**2 + 1 + 0.8**2), rtol=1e-9, atol=0)
    eta = distortion.eta(frame.fz, frame.fzbar)
    assert_allclose(eta, 0.3 * 0.8j * (1.5 - 1j), rtol=0, atol=1e-9)


def test_the_hessian_is_the_derivative_of_the_angle_defects():
    mesh = meshed_bar(80)
    domain = prepared([f(mesh.vertices) for f in s_to_u()], mesh).domain
    flattening = Flattening.on(domain)
    lengths = edge_lengths(domain, s_to_u()[1](mesh.vertices))

    def moved(step, vertex):
        factor = np.ones(len(domain.points))
        factor[vertex] = np.exp(step / 2)
        ends = factor[domain.corners] * np.roll(factor[domain.corners], -1, axis=1)
        return flattening._defects(_angles(lengths * ends)[0])

    hessian = flattening._hessian(_angles(lengths)[1]).toarray()
    h = 1e-5
    for column, vertex in enumerate(flattening.inner):
        differences = (moved(h, vertex) - moved(-h, vertex)) / (2 * h)
        assert_allclose(hessian[:, column], differences, rtol=0, atol=1e-8)
