import numpy as np
import pytest
from hypothesis import given, strategies as st
from numpy.testing import assert_allclose
from shapes import points_inside_disc, regular_polygon, star_polygons

from engine.errors import EngineError
from engine.maps.cauchy import cauchy_coordinates, cauchy_derivatives, edge_logarithms, evaluate

CAGE = regular_polygon(12, 1.3) * (1 + 0.2j) + 4 - 3j
INSIDE = points_inside_disc(0.9, 60, seed=1) + 4 - 3j


@given(star_polygons(), st.integers(0, 1000))
def test_coordinates_sum_to_one_and_reproduce_z(cage, seed):
    # The inscribed disc of these polygons has at least this radius.
    points = points_inside_disc(0.2, 20, seed)
    coordinates = cauchy_coordinates(cage, points)
    assert_allclose(coordinates.sum(axis=1), 1.0, rtol=0, atol=1e-13)
    assert_allclose(coordinates @ cage, points, rtol=0, atol=1e-13)
    assert_allclose(cauchy_derivatives(cage, points) @ cage, 1.0, rtol=0, atol=1e-12)


@pytest.mark.parametrize("degree", [2, 3, 5])
def test_polynomials_are_reproduced_to_second_order_in_the_edges(degree):
    # The boundary values are interpolated linearly along each edge: halving the edges divides the
    # error by four.
    points = points_inside_disc(0.7, 50, seed=2)
    errors = []
    for n in (32, 64, 128, 256):
        cage = regular_polygon(n)
        (values,) = evaluate(cage, (cage**degree)[:, None], points, orders=(0,))
        errors.append(np.abs(values[:, 0] - points**degree).max())
    orders = np.log2(np.array(errors[:-1]) / errors[1:])
    assert_allclose(orders, 2.0, rtol=0, atol=0.15)


def test_derivatives_agree_with_finite_differences():
    h = 1e-4
    for direction in (1, 1j):
        step = h * direction
        coordinates = [cauchy_coordinates(CAGE, INSIDE + j * step) for j in (-2, -1, 1, 2)]
        first = (8 * (coordinates[2] - coordinates[1]) - (coordinates[3] - coordinates[0])) / 12
        assert_allclose(cauchy_derivatives(CAGE, INSIDE), first / step, rtol=0, atol=1e-9)
        derivatives = [cauchy_derivatives(CAGE, INSIDE + j * step) for j in (-2, -1, 1, 2)]
        second = (8 * (derivatives[2] - derivatives[1]) - (derivatives[3] - derivatives[0])) / 12
        (expected,) = evaluate(CAGE, np.eye(12) + 0j, INSIDE, orders=(2,))
        assert_allclose(expected, second / step, rtol=0, atol=1e-8)


def test_evaluation_equals_the_products_with_the_coordinates():
    rng = np.random.default_rng(3)
    coefficients = rng.normal(size=(12, 5)) + 1j * rng.normal(size=(12, 5))
    values, second, first = evaluate(CAGE, coefficients, INSIDE, orders=(0, 2, 1))
    assert_allclose(values, cauchy_coordinates(CAGE, INSIDE) @ coefficients, rtol=0, atol=1e-13)
    assert_allclose(first, cauchy_derivatives(CAGE, INSIDE) @ coefficients, rtol=0, atol=1e-13)
    (each,) = evaluate(CAGE, np.eye(12) + 0j, INSIDE, orders=(2,))
    assert_allclose(second, each @ coefficients, rtol=0, atol=1e-12)


def test_blocks_do_not_show():
    cage = regular_polygon(200)
    points = points_inside_disc(0.9, 3000, seed=4)
    values, first = evaluate(cage, (cage**2)[:, None], points, orders=(0, 1))
    assert_allclose(values[:, 0], cauchy_coordinates(cage, points) @ cage**2, rtol=0, atol=1e-13)
    assert_allclose(first[:, 0], cauchy_derivatives(cage, points) @ cage**2, rtol=0, atol=1e-11)


@given(
    star_polygons(), st.complex_numbers(min_magnitude=0.1, max_magnitude=100), st.integers(0, 99)
)
def test_coordinates_do_not_change_under_similarities(cage, factor, seed):
    points = points_inside_disc(0.2, 10, seed)
    moved = cauchy_coordinates(factor * cage + 7j, factor * points + 7j)
    assert_allclose(moved, cauchy_coordinates(cage, points), rtol=0, atol=1e-11)


def test_the_angles_of_all_edges_add_up_to_one_turn():
    assert_allclose(edge_logarithms(CAGE, INSIDE).sum(axis=1), 2j * np.pi, rtol=0, atol=1e-13)


def test_a_point_on_a_cage_vertex_is_refused():
    with pytest.raises(EngineError, match="vertex of the cage"):
        cauchy_coordinates(CAGE, CAGE[:1])
