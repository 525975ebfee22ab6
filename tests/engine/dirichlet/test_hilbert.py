from dataclasses import replace

import numpy as np
import pytest
from holed_shapes import Holed, inner_points as points_of, plate, ring
from hypothesis import given, settings, strategies as st
from interpolation_shapes import around, bar, inner_points, letter_l, narrow_u, random_map, spiral
from numpy.testing import assert_allclose
from shapes import star_polygons

from engine.arrays import nbytes_of
from engine.dirichlet.cauchy_integral import CauchyIntegral
from engine.dirichlet.expansions import TERMS
from engine.dirichlet.hilbert import HilbertTransform
from engine.dirichlet.panels import NODES, Panels
from engine.dirichlet.product_integration import is_near, panel_weights
from engine.dirichlet.refinement import Refinement
from engine.geometry import Domain, contains
from engine.geometry.polygon import diameter, edge_vectors
from engine.interpolation import TimeWeights
from engine.interpolation.blends.outline import OutlineMetric
from engine.maps import Bounds


def far_cage(outline):
    """Return a cage that asks for no refinement of its own."""
    centre = outline.mean()
    return centre + 3 * diameter(outline) * np.exp(2j * np.pi * np.arange(8) / 8)


def without_constant(values):
    return values - 1j * values[0].imag


def entire(z):
    """Return some holomorphic functions with their derivatives, each (t, 3)."""
    values = np.column_stack([z**2, np.exp(z), np.sin(2 * z)])
    slopes = np.column_stack([2 * z, np.exp(z), 2 * np.cos(2 * z)])
    return values, slopes


@given(polygon=star_polygons(largest=14), seed=st.integers(0, 100))
@settings(max_examples=12)
def test_holomorphic_functions_are_found_from_their_real_parts(polygon, seed):
    transform = HilbertTransform.on(Domain(polygon, far_cage(polygon)))
    points = inner_points(polygon, 60, seed)
    values, slopes, _ = transform.at(points).extend(entire(transform.nodes)[0].real)
    expected, expected_slopes = entire(points)
    assert_allclose(without_constant(values), without_constant(expected), rtol=0, atol=1e-5)
    # Slopes lose digits next to the corners only.
    distance = np.abs(points[:, None] - polygon).min(axis=1)
    away = distance > 0.1
    assert_allclose(slopes[away], expected_slopes[away], rtol=0, atol=5e-3)


@pytest.mark.parametrize("shape", [bar(), letter_l(), narrow_u(0.1)])
def test_values_are_accurate_on_the_outline_itself(shape):
    outline, cage = shape
    transform = HilbertTransform.on(Domain(outline, cage))
    middles = outline + 0.5 * edge_vectors(outline)
    anywhere = outline + 0.123 * edge_vectors(outline)
    outside = middles * (1 + 1e-15)
    points = np.concatenate([outline, middles, anywhere, outside])
    values, slopes, _ = transform.at(points).extend(entire(transform.nodes)[0].real)
    expected, expected_slopes = entire(points)
    assert_allclose(without_constant(values), without_constant(expected), rtol=0, atol=1e-5)
    count = len(outline)
    assert_allclose(slopes[count:], expected_slopes[count:], rtol=0, atol=2e-3)


def corner_function(z):
    """Return a function with the worst singularity of the letter L's inward corner, z^(2/3)."""
    return (-(z - (1 + 1j)) * np.exp(-0.25j * np.pi)) ** (2 / 3)


def test_singularities_at_inward_corners_are_resolved():
    outline, cage = letter_l()
    transform = HilbertTransform.on(Domain(outline, cage))
    points = inner_points(outline, 200, 0)
    values, _, _ = transform.at(points).extend(corner_function(transform.nodes).real[:, None])
    expected = corner_function(points)[:, None]
    assert_allclose(without_constant(values), without_constant(expected), rtol=0, atol=1e-6)


def metric_data(maps, points):
    """Return what the metric variant asks for: singular near the cage, and no one's real part."""
    columns = zip(*(f.derivatives(points) for f in maps), strict=True)
    fz, fzbar = (np.array(column) for column in columns)
    return OutlineMetric.of(fz, fzbar, TimeWeights.straight(), Bounds()).residuals(np.array([0.5]))


def solutions(shape, coarsenesses):
    outline, cage = shape
    maps = [random_map(shape, seed) for seed in (3, 4)]
    points = np.concatenate([inner_points(outline, 150, 0), outline + 0.3 * edge_vectors(outline)])
    for coarseness in coarsenesses:
        panels = Panels.on(Domain(outline, cage), coarseness=coarseness)
        transform = HilbertTransform.of((outline,), panels)
        values, _, _ = transform.at(points).extend(metric_data(maps, transform.nodes))
        yield len(transform.nodes), without_constant(values)


@pytest.mark.parametrize(
    "shape", [letter_l(), narrow_u(0.04), pytest.param(spiral(), marks=pytest.mark.long)]
)
def test_the_error_falls_with_a_high_order_as_panels_shorten(shape):
    (_, reference), *others = solutions(shape, (0.5, 1.0, 2.0, 4.0, 8.0))
    errors = np.array([np.abs(values - reference).max() for _, values in others])
    counts = np.array([count for count, _ in others])
    assert errors[0] < 5e-6
    # Against the number of nodes, of which corners and gaps need some however long panels may be.
    order, _ = np.polyfit(np.log(counts), np.log(errors), 1)
    assert order < -3


def test_the_nodes_that_the_shape_asks_for_are_enough():
    (_, reference), (_, values) = solutions(letter_l(), (0.6, 1.0))
    assert_allclose(values, reference, rtol=0, atol=1e-8)


def test_the_number_of_nodes_comes_from_the_shape():
    # The cage is far, so that the gap alone asks for more.
    wide, narrow = (
        len(Panels.on(Domain(outline, far_cage(outline))))
        for outline in (narrow_u(gap)[0] for gap in (0.2, 0.01))
    )
    assert narrow > 1.25 * wide
    outline, _ = letter_l()
    far, near = (len(Panels.on(Domain(outline, around(outline, offset)))) for offset in (0.2, 0.01))
    assert near > 1.5 * far


@pytest.mark.parametrize(
    ("coarseness", "nodes"), [(0.5, 4_500), pytest.param(0.25, 9_000, marks=pytest.mark.long)]
)
def test_any_number_of_nodes_is_taken_and_memory_grows_with_it(coarseness, nodes):
    # Four times the panels, four times the memory; a matrix would take sixteen times.
    outline, cage = spiral()
    coarse, fine = (
        HilbertTransform.of((outline,), Panels.on(Domain(outline, cage), coarseness=each))
        for each in (8 * coarseness, coarseness)
    )
    more = len(fine.nodes) / len(coarse.nodes)
    assert more > 3
    assert len(fine.nodes) > nodes
    assert fine.nbytes < 1.5 * more * coarse.nbytes
    points = inner_points(outline, 60, 0)
    values, _, _ = fine.at(points).extend(entire(fine.nodes)[0].real)
    expected, _ = entire(points)
    assert_allclose(without_constant(values), without_constant(expected), rtol=0, atol=1e-7)


def test_panels_tile_the_outline():
    outline, cage = spiral()
    panels = Panels.on(Domain(outline, cage))
    lengths = panels.differentials().sum(axis=1)
    assert_allclose(np.abs(lengths).sum(), np.abs(edge_vectors(outline)).sum(), rtol=1e-12, atol=0)
    starts = np.where(panels.forward, panels.origin, panels.origin + panels.span)
    assert_allclose(np.roll(starts, -1), starts + lengths, rtol=0, atol=1e-13)
    # ∮ dζ / (ζ − z) = 2πi inside.
    ones = np.ones((panels.nodes.size, 1))
    points = inner_points(outline, 50, 2)
    values, slopes = CauchyIntegral.of(panels, points)(ones)
    assert_allclose(values, 1, rtol=0, atol=1e-10)
    assert_allclose(slopes, 0, rtol=0, atol=1e-7)


def test_halved_panels_tile_the_same_outline():
    outline, cage = spiral()
    whole = Panels.on(Domain(outline, cage), coarseness=4.0)
    chosen = np.random.default_rng(0).random(len(whole)) < 0.5
    chosen[~whole.forward] = True
    panels = whole.halved(chosen)
    assert len(panels) == len(whole) + chosen.sum()
    starts = np.where(panels.forward, panels.origin, panels.origin + panels.span)
    along = panels.differentials().sum(axis=1)
    assert_allclose(np.roll(starts, -1), starts + along, rtol=0, atol=1e-13)
    transform = HilbertTransform.of((outline,), panels)
    points = inner_points(outline, 60, 0)
    values = transform.at(points).extend(entire(transform.nodes)[0].real).values
    assert_allclose(
        without_constant(values), without_constant(entire(points)[0]), rtol=0, atol=1e-6
    )


@pytest.mark.parametrize("shape", [Holed(*letter_l(), holes=(), anchor=0.5 + 0.5j), ring()])
def test_panels_that_are_cut_resolve_what_varies_fast_there(shape):
    transform = HilbertTransform.on(shape.domain)
    panels, inner = transform.panels, points_of(shape, 60)
    points = np.concatenate([inner, *shape.loops])
    refinement = Refinement.of(transform)
    # The longest panel of each loop, and of those that touch no corner.
    length = np.abs(panels.span)
    groups = [
        *np.split(np.arange(len(panels)), panels.starts[1:]),
        np.flatnonzero(panels.power == 1),
    ]
    cut = [group[length[group].argmax()] for group in groups if len(group)]
    # A pole outside, nearer to each than it is long.
    poles = [
        transform.centre
        + panels.origin[i]
        + (0.4 - 0.3j * (1 if panels.forward[i] else -1)) * panels.span[i]
        for i in cut
    ]
    assert not contains(shape.outline, np.array(poles), holes=shape.loops[1:]).any()

    def function(z):
        return 1e-3 / (z[:, None] - poles)

    uncut = transform.at(points).extend(function(transform.nodes).real)
    for _ in range(3):
        chosen = np.zeros(len(refinement.panels), dtype=np.bool_)
        for whole in cut:
            chosen[np.flatnonzero(refinement.whole == whole)[-1]] = True
        refinement = refinement.halved(chosen)
    given = function(refinement.nodes).real
    found = refinement.solve(given).at(transform.at(points))
    slopes = -1e-3 / (inner[:, None] - poles) ** 2
    assert_allclose(found.derivatives[: len(inner)], slopes, rtol=0, atol=2e-4)
    assert_allclose(
        without_constant(found.values), without_constant(function(points)), rtol=0, atol=1e-4
    )
    assert_allclose(found.lacking, 0.0, rtol=0, atol=1e-5)
    off = without_constant(uncut.values) - without_constant(function(points))
    assert np.abs(off).max() > 5e-4


@pytest.mark.parametrize("shape", [Holed(*spiral(), holes=(), anchor=0j), ring()])
def test_far_from_the_origin_nothing_is_lost_but_the_rounding_of_coordinates(shape):
    far = 1e8 * (1 + 0.3j)
    holes = [
        replace(hole, outline=hole.outline + far, cage=hole.cage + far, centre=hole.centre + far)
        for hole in shape.holes
    ]
    transform = HilbertTransform.on(Domain(shape.outline + far, shape.cage + far, holes))
    middles = [loop + 0.5 * edge_vectors(loop) for loop in shape.loops]
    points = far + np.concatenate([*shape.loops, *middles, points_of(shape, 60)])
    values, slopes, _ = transform.at(points).extend(entire(transform.nodes - far)[0].real)
    expected, expected_slopes = entire(points - far)
    assert_allclose(without_constant(values), without_constant(expected), rtol=0, atol=1e-5)
    corners = sum(map(len, shape.loops))
    assert_allclose(slopes[corners:], expected_slopes[corners:], rtol=0, atol=2e-3)


@pytest.mark.parametrize("power", [1, 3])
def test_panel_integrals_are_exact_for_polynomials_in_the_parameter(power):
    rng = np.random.default_rng(0)
    w = np.concatenate(
        [
            rng.uniform(-0.3, 1.3, 30) + 1j * 10.0 ** rng.uniform(-6, 0, 30),
            3 * rng.normal(size=10) + 5j,
        ]
    )
    tau = (1 + np.polynomial.legendre.leggauss(NODES)[0]) / 2
    weights, slope_weights = panel_weights(w, power)
    # ∫ τ^(3 power) q τ^(q−1) / (τ^q − w) dτ = ∫ x³ / (x − w) dx over [0, 1], x = τ^q.
    logarithm = np.log((1 - w) / -w)
    expected = 1 / 3 + w / 2 + w**2 + w**3 * logarithm
    assert_allclose(weights @ tau ** (3 * power), expected, rtol=1e-10, atol=1e-10)
    slopes = 3 * (1 / 2 + w + w**2 * logarithm)
    assert_allclose(slope_weights @ tau ** (3 * power), slopes, rtol=1e-7, atol=1e-7)


def test_far_from_a_panel_plain_quadrature_is_as_good():
    w = np.array([0.5 + 4j, -6.0 + 0.1j, 9.0 - 1j])
    x, weights = np.polynomial.legendre.leggauss(NODES)
    for power in (1, 3):
        assert not is_near(w, power).any()
        tau = (1 + x) / 2
        plain = weights / 2 * power * tau ** (power - 1) / (tau**power - w[:, None])
        assert_allclose(panel_weights(w, power)[0], plain, rtol=0, atol=1e-11)


def test_fast_evaluation_agrees_with_the_sum_over_all_panels():
    outline, cage = narrow_u()
    panels = Panels.on(Domain(outline, cage))
    # Smooth along the outline: the two differentiate what jumps between panels differently.
    densities = np.cos(
        panels.nodes.reshape(-1, 1).real * [3, 5, 7] + panels.nodes.reshape(-1, 1).imag
    )
    points = inner_points(outline, 400, 3)
    values, slopes = CauchyIntegral.of(panels, points)(densities)
    direct, direct_slopes = np.zeros((2, len(points), 3), dtype=complex)
    for panel in range(len(panels)):
        w = (points - panels.origin[panel]) / panels.span[panel]
        weights, slope_weights = panel_weights(w, int(panels.power[panel]))
        own = densities[panel * NODES : (panel + 1) * NODES] / (2j * np.pi)
        sign = 1 if panels.forward[panel] else -1
        direct += sign * weights @ own
        direct_slopes += sign / panels.span[panel] * (slope_weights @ own)
    assert_allclose(values, direct, rtol=0, atol=1e-9)
    assert_allclose(slopes, direct_slopes, rtol=0, atol=1e-6)
    # In single precision only what is not close is less accurate.
    values, slopes = CauchyIntegral.of(panels, points, single=True)(densities)
    assert_allclose(values, direct, rtol=0, atol=1e-6)
    assert_allclose(slopes, direct_slopes, rtol=0, atol=1e-5)


def test_single_precision_keeps_close_weights_and_takes_half_the_memory():
    outline, cage = narrow_u()
    panels = Panels.on(Domain(outline, cage))
    # Towards where two panels meet on an edge: the large weights of both cancel.
    straight = panels.power == 1
    ends, along = (panels.origin + panels.span)[straight], panels.span[straight]
    depths = 10.0 ** np.arange(-8.0, -2.0)[:, None]
    points = (ends + 1j * depths * along / np.abs(along)).ravel()
    densities = np.exp(panels.nodes.reshape(-1, 1).real)
    single, double = (CauchyIntegral.of(panels, points, single=each) for each in (True, False))
    (values, slopes), (exact, exact_slopes) = single(densities), double(densities)
    assert_allclose(values, exact, rtol=0, atol=1e-6)
    assert_allclose(slopes, exact_slopes, rtol=0, atol=3e-5)
    many = inner_points(outline, 4000, 3)
    single, double = (CauchyIntegral.of(panels, many, single=each) for each in (True, False))
    assert nbytes_of(single) < 0.65 * nbytes_of(double)
    # A far pair takes two rows of powers and not the matrix that they stand for.
    pairs = sum(len(each.sources) for each in double.expansions.m2l)
    held = nbytes_of(double.expansions.m2l)
    assert held < 0.15 * pairs * 16 * TERMS**2


def around_holes(shape):
    """Return single-valued functions that are singular in the holes, (functions, constants)."""
    rng = np.random.default_rng(0)

    def values(z):
        columns = [np.exp(z)]
        for hole in shape.holes:
            columns += [0.1 / (z - hole.centre), 0.02 / (z - hole.centre) ** 2 + z**2]
        return np.column_stack(columns)

    count = 1 + 2 * len(shape.holes)
    return values, rng.normal(size=(len(shape.holes), count))


@pytest.mark.parametrize("shape", [ring(), plate(3)])
def test_around_holes_functions_are_found_from_real_parts_but_for_a_constant_each(shape):
    # What is given is off by a constant around each hole: exactly that comes back as lacking.
    transform = HilbertTransform.on(shape.domain)
    function, constants = around_holes(shape)
    given = function(transform.nodes).real
    for constant, mean in zip(constants, transform.means, strict=True):
        given[mean > 0] += constant
    points = np.concatenate([points_of(shape, 150), *shape.loops])
    values, slopes, lacking = transform.at(points).extend(given)
    assert_allclose(lacking, constants, rtol=0, atol=1e-6)
    expected = function(points)
    assert_allclose(without_constant(values), without_constant(expected), rtol=0, atol=1e-5)
    h = 1e-5
    inner = points_of(shape, 150)
    wanted = (function(inner + h) - function(inner - h)) / (2 * h)
    assert_allclose(slopes[: len(inner)], wanted, rtol=0, atol=5e-3)


def test_fitted_polynomials_stay_within_limits_between_nodes():
    outline, cage = letter_l()
    panels = HilbertTransform.on(Domain(outline, cage)).panels
    values = np.sin(9 * panels.checked.real)
    low, high = 0.0 * values - 0.5, 0.0 * values + 0.5
    fitted, excess = panels.fit_within(values, low, high, np.zeros(len(panels)))
    clipped = np.clip(values[:, :NODES], -0.5, 0.5) - values[:, :NODES]
    assert np.abs(values + panels.interpolate(clipped)).max() > 0.502
    assert np.abs(values + panels.interpolate(fitted)).max() < 0.50002
    assert excess < 2e-5
    assert_allclose(fitted, clipped, rtol=0, atol=0.02)


def test_polynomials_within_limits_are_fitted_by_nothing():
    panels = HilbertTransform.on(Domain(*bar())).panels
    values = panels.checked.real
    fitted, excess = panels.fit_within(values, values - 0.1, values + 0.1, np.zeros(len(panels)))
    assert excess == 0.0
    assert not fitted.any()
