from dataclasses import replace

import numpy as np
import pytest
from deform_shapes import STAR_POINTS, star_boundary
from numpy.testing import assert_allclose

from engine.deform import Handles
from engine.deform.model.barrier import DUAL_RANGE, Barrier, BarrierBounds
from engine.deform.model.energy import symmetric_dirichlet, symmetric_dirichlet_derivatives
from engine.deform.model.hessian import (
    hessian_product,
    negative_part,
    projected_hessian,
    single_hessian,
)
from engine.deform.model.newton import line_search, newton_direction, newton_models
from engine.deform.model.objective import Objective
from engine.maps import Bounds

WALLS = Bounds(k=0.7, sigma_a=3.0, sigma_b=0.15)
COUNT = 200
RNG = np.random.default_rng(0)
A = RNG.uniform(0.6, 1.8, COUNT)
B = A * RNG.uniform(0.02, 0.65, COUNT)
B = np.minimum(B, A - 0.2)


def densities():
    dirichlet = (symmetric_dirichlet, symmetric_dirichlet_derivatives)
    all_walls = Barrier(bounds=BarrierBounds.for_samples(WALLS, COUNT), weight=0.3)
    pairs = {"symmetric Dirichlet": dirichlet, "barrier": (all_walls.value, all_walls.derivatives)}
    # One wall at a time: the others are far away.
    for name, walls in {
        "k": Bounds(k=0.7, sigma_a=1e6, sigma_b=1e-9),
        "sigma_a": Bounds(k=1 - 1e-9, sigma_a=3.0, sigma_b=1e-9),
        "sigma_b": Bounds(k=1 - 1e-9, sigma_a=1e6, sigma_b=0.15),
    }.items():
        one = Barrier(bounds=BarrierBounds.for_samples(walls, COUNT), weight=2.0)
        pairs[name] = (one.value, one.derivatives)
    return pairs


@pytest.mark.parametrize(("value", "derivatives"), densities().values(), ids=densities())
def test_radial_derivatives_agree_with_finite_differences(value, derivatives):
    h = 1e-5
    exact = derivatives(A, B)
    ahead_a, behind_a = derivatives(A + h, B), derivatives(A - h, B)
    ahead_b, behind_b = derivatives(A, B + h), derivatives(A, B - h)
    tolerance = {"rtol": 2e-5, "atol": 2e-5}
    assert_allclose(exact.a, (value(A + h, B) - value(A - h, B)) / (2 * h), **tolerance)
    assert_allclose(exact.b_per_b * B, (value(A, B + h) - value(A, B - h)) / (2 * h), **tolerance)
    assert_allclose(exact.aa, (ahead_a.a - behind_a.a) / (2 * h), **tolerance)
    assert_allclose(exact.ab, (ahead_b.a - behind_b.a) / (2 * h), **tolerance)
    by_b = (ahead_b.b_per_b * (B + h) - behind_b.b_per_b * (B - h)) / (2 * h)
    assert_allclose(exact.bb, by_b, **tolerance)


@pytest.mark.parametrize(("value", "derivatives"), densities().values(), ids=densities())
def test_the_projection_clears_the_only_negative_eigenvalue(value, derivatives):
    # The exact Hessian of h(|F|, |G|) by (Re F, Im F, Re G, Im G), by differences of the gradient.
    rng = np.random.default_rng(1)
    f, g = A * np.exp(1j * rng.normal(size=COUNT)), B * np.exp(1j * rng.normal(size=COUNT))

    def gradient(x):
        f, g = x[0] + 1j * x[1], x[2] + 1j * x[3]
        radial = derivatives(np.abs(f), np.abs(g))
        by_f, by_g = radial.a * f / np.abs(f), radial.b_per_b * g
        return np.array([by_f.real, by_f.imag, by_g.real, by_g.imag])

    x, h = np.array([f.real, f.imag, g.real, g.imag]), 1e-5
    steps = h * np.eye(4)[:, :, None]
    exact = np.array([(gradient(x + s) - gradient(x - s)) / (2 * h) for s in steps])
    values, vectors = np.linalg.eigh(np.moveaxis(exact, 2, 0))
    scale = np.abs(values).max(axis=1)
    assert np.all(values[:, 1] > -1e-6 * scale)
    clipped = np.einsum("pij,pj,pkj->pik", vectors, np.maximum(values, 0), vectors)
    radial = derivatives(A, B)
    by = np.zeros((COUNT, 4, 4))
    frames = np.array([f / A, 1j * f / A, g / B, 1j * g / B])
    for row, frame in enumerate(frames):
        by[:, row, 2 * (row // 2)] = frame.real
        by[:, row, 2 * (row // 2) + 1] = frame.imag
    middle = np.zeros((COUNT, 4, 4))
    middle[:, 0, 0], middle[:, 1, 1] = radial.aa, np.maximum(radial.a / A, 0)
    middle[:, 2, 2], middle[:, 3, 3] = radial.bb, radial.b_per_b
    middle[:, 0, 2] = middle[:, 2, 0] = radial.ab
    projected = np.einsum("pri,prs,psj->pij", by, middle, by)
    assert_allclose(projected, clipped, rtol=0, atol=1e-5 * scale.max())
    if np.isfinite(value(A, B)).all():
        assert np.count_nonzero(radial.a < 0) > 0


def test_the_densities_are_smooth_where_the_map_is_conformal():
    a, b = np.full(COUNT, 1.3), np.zeros(COUNT)
    for _, derivatives in densities().values():
        radial = derivatives(a, b)
        assert_allclose(radial.b_per_b, radial.bb, rtol=1e-12)
        assert_allclose(radial.ab, 0, atol=1e-12)


def test_energy_and_barrier_are_infinite_outside():
    one = np.array([1.0])
    barrier = Barrier(bounds=BarrierBounds.for_samples(WALLS, 1), weight=1.0)
    assert symmetric_dirichlet(one, np.array([0.0])) == 2
    assert np.isinf(symmetric_dirichlet(one, one))
    for a, b in [(1.0, 0.71), (2.5, 0.51), (0.3, 0.16)]:
        assert np.isinf(barrier.value(np.array([a]), np.array([b])))


def test_dual_variables_follow_the_slack():
    walls = BarrierBounds.for_samples(WALLS, COUNT)
    barrier = Barrier(bounds=walls, weight=0.3)
    central = barrier.weight / barrier.margins(A, B)
    assert_allclose(barrier.current_duals(A, B), central, rtol=1e-14)
    # A step that goes nowhere from central duals leaves them; one into the wall raises them.
    assert_allclose(barrier.next_duals(A, B, 0 * A, 0 * B), central, rtol=1e-12)
    assert np.all(barrier.next_duals(A, B, 0 * A, 0.01 * B) > central)
    wild = replace(barrier, duals=np.full((3, COUNT), 1e9))
    assert_allclose(wild.current_duals(A, B), DUAL_RANGE * central)
    with_exact = replace(barrier, duals=central).derivatives(A, B)
    assert_allclose(with_exact, barrier.derivatives(A, B), rtol=1e-12, atol=1e-12)


def test_margins_change_as_their_derivatives_say():
    barrier = Barrier(bounds=BarrierBounds.for_samples(WALLS, COUNT), weight=0.3)
    da, db, h = np.cos(np.arange(COUNT)), np.sin(np.arange(COUNT)), 1e-6
    ahead, behind = barrier.margins(A + h * da, B + h * db), barrier.margins(A - h * da, B - h * db)
    changes = barrier.margin_changes(A, B, da, db)
    assert_allclose(changes, (ahead - behind) / (2 * h), rtol=0, atol=1e-8)
    factors = np.array([[0.3], [2.0], [-1.0]]) * np.ones(COUNT)
    by_a, b_per_b = barrier.margin_gradient(A, factors)
    assert_allclose(by_a * da + b_per_b * B * db, (factors * changes).sum(axis=0), rtol=1e-12)


def problem(*, rotations=None, barrier=True, seed=3):
    boundary = star_boundary()
    handles = Handles.place(boundary, STAR_POINTS, [1, 2, 1, 1, 0.5, 1])
    handle_targets = handles.targets(1.02 * STAR_POINTS + 0.01j, rotations)
    all_walls = BarrierBounds.for_samples(WALLS, len(boundary.points))
    walls = Barrier(bounds=all_walls, weight=0.2) if barrier else None
    objective = Objective(boundary=boundary, handles=handles, targets=handle_targets, barrier=walls)
    rng = np.random.default_rng(seed)
    n = len(boundary.cage)
    noise = rng.normal(size=(2, n)) + 1j * rng.normal(size=(2, n))
    # Swollen, so that h_a > 0 at all samples and nothing is projected.
    phi = 1.5 * boundary.cage + 0.002 * noise[0]
    psi = 0.1 * boundary.cage + 0.002 * noise[1]
    return objective, phi, psi, rng


@pytest.mark.parametrize("rotations", [None, np.array([0.3, np.nan, -0.2, np.nan, np.nan, 3.0])])
@pytest.mark.parametrize("barrier", [True, False])
def test_gradient_agrees_with_finite_differences(rotations, barrier):
    objective, phi, psi, rng = problem(rotations=rotations, barrier=barrier)
    jet = objective.evaluate(phi, psi)
    gradient = objective.gradient(jet, objective.radial_derivatives(jet))
    n = len(phi)
    for _ in range(5):
        x = rng.normal(size=4 * n - 2)
        moved = objective.evaluate(*objective.coefficients(x))
        h = 1e-6
        ahead = objective.value(jet.advanced(h, moved))
        behind = objective.value(jet.advanced(-h, moved))
        assert_allclose(gradient @ x, (ahead - behind) / (2 * h), rtol=1e-5)


@pytest.mark.parametrize("barrier", [True, False])
def test_hessian_is_exact_where_nothing_is_projected(barrier):
    objective, phi, psi, rng = problem(barrier=barrier)
    jet = objective.evaluate(phi, psi)
    assert np.all(objective.radial_derivatives(jet).around_a > 0)
    assert_products(objective, jet, len(phi), rng)


def test_hessian_of_rotations_is_exact_at_their_targets():
    objective, phi, psi, rng = problem()
    jet = objective.evaluate(phi, psi)
    handle_targets = objective.handles.targets(jet.positions, np.angle(jet.fz))
    objective = Objective(
        boundary=objective.boundary, handles=objective.handles, targets=handle_targets, barrier=None
    )
    assert_products(objective, jet, len(phi), rng)


def test_hessian_of_rotations_is_the_projection():
    objective, phi, psi, _ = problem(barrier=False)
    jet = objective.evaluate(phi, psi)
    handles = objective.handles
    turned = np.full(6, np.nan)
    turned[2] = np.angle(jet.fz[2]) - 0.4
    both = [
        np.triu(
            projected_hessian(
                replace(objective, targets=handles.targets(jet.positions, r)),
                jet,
                objective.radial_derivatives(jet),
            )
        )
        for r in (None, turned)
    ]
    difference = both[1] - both[0]
    difference = difference + np.triu(difference, 1).T
    stiffness = 2 * handles.lever**2 * handles.stiffness[2]
    exact = 2 * stiffness * np.array([[0, -0.4], [-0.4, 1.0]])
    values, vectors = np.linalg.eigh(exact)
    kept = values[1] * np.outer(vectors[:, 1], vectors[:, 1])
    row = handles.basis_derivatives[2] / jet.fz[2]
    rows = np.array([row.view(float), (-1j * row).view(float)])
    n = len(phi)
    # The sums over the samples, which cancel here, are in single precision.
    assert_allclose(difference[: 2 * n, : 2 * n], rows.T @ kept @ rows, atol=1e-4)
    assert_allclose(difference[2 * n :], 0, atol=1e-12)


def assert_products(objective, jet, n, rng, *, removed=0.0, tolerance=1e-6):
    """Compare the Hessian less what is `removed` from that of the map with differences."""
    hessian = np.triu(projected_hessian(objective, jet, objective.radial_derivatives(jet)))
    hessian = hessian + np.triu(hessian, 1).T
    hessian[: 2 * n, : 2 * n] -= removed
    h = 1e-6
    for _ in range(3):
        x = rng.normal(size=4 * n - 2)
        moved = objective.evaluate(*objective.coefficients(x))
        ahead, behind = jet.advanced(h, moved), jet.advanced(-h, moved)
        by_gradient = (
            objective.gradient(ahead, objective.radial_derivatives(ahead))
            - objective.gradient(behind, objective.radial_derivatives(behind))
        ) / (2 * h)
        product = hessian @ x
        assert_allclose(product, by_gradient, rtol=0, atol=tolerance * np.abs(product).max())


@pytest.mark.parametrize("barrier", [True, False])
def test_the_hessian_without_its_projection_is_exact(barrier):
    # A shrunk map, where the projection removes something at most samples, and turned handles.
    objective, phi, psi, rng = problem(barrier=barrier)
    jet = objective.evaluate(0.6 * phi, 0.3 * psi)
    n = len(phi)
    turned = np.where(np.arange(6) % 2, np.nan, np.angle(jet.fz) - 0.4)
    objective = replace(objective, targets=objective.handles.targets(jet.positions, turned))
    radial = objective.radial_derivatives(jet)
    assert np.count_nonzero(radial.around_a < 0) > 100
    # But for the tiny stiffness against turning as a whole.
    negative = negative_part(objective, jet, radial)
    assert_products(objective, jet, n, rng, removed=negative, tolerance=1e-5)


def test_samples_that_were_added_change_the_hessian_hardly():
    objective, phi, psi, _ = problem(barrier=False)
    jet = objective.evaluate(phi, psi)
    hessian = np.triu(projected_hessian(objective, jet, objective.radial_derivatives(jet)))
    boundary = objective.boundary.refined(np.arange(0, len(objective.boundary.points), 3))
    walls = Barrier(bounds=BarrierBounds.for_samples(WALLS, len(boundary.points)), weight=1e-9)
    finer = replace(objective, boundary=boundary, barrier=walls)
    jet = finer.evaluate(phi, psi)
    assert_allclose(
        np.triu(projected_hessian(finer, jet, finer.radial_derivatives(jet))),
        hessian,
        rtol=1e-5,
        atol=1e-3,
    )


def test_single_precision_serves_where_handles_hold_a_shape_and_no_wall_is_near():
    objective, phi, psi, _ = problem()
    jet = objective.evaluate(phi, psi)
    radial = objective.radial_derivatives(jet)
    single, double = (
        single_hessian(objective, jet, radial),
        projected_hessian(objective, jet, radial),
    )
    assert single.dtype == np.float32
    assert_allclose(np.triu(single), np.triu(double), rtol=1e-5, atol=1e-3)
    alone = Handles.place(objective.boundary, STAR_POINTS[:1])
    free = replace(objective, handles=alone, targets=alone.targets(STAR_POINTS[:1]))
    assert single_hessian(free, jet, free.radial_derivatives(jet)) is None
    radial.aa[7] *= 1e6
    assert single_hessian(objective, jet, radial) is None


@pytest.mark.parametrize("barrier", [True, False])
def test_a_newton_step_is_that_of_the_whole_hessian(barrier):
    rotations = np.array([0.3, np.nan, -0.2, np.nan, np.nan, 3.0])
    objective, phi, psi, rng = problem(rotations=rotations, barrier=barrier)
    jet = objective.evaluate(phi, psi)
    radial = objective.radial_derivatives(jet)
    hessian = np.triu(projected_hessian(objective, jet, radial))
    hessian = hessian + np.triu(hessian, 1).T
    x = rng.normal(size=len(hessian))
    product = hessian_product(objective, jet, radial, objective.evaluate_change(x))
    assert_allclose(product, hessian @ x, rtol=0, atol=1e-5 * np.abs(product).max())
    exact = list(newton_models(objective, jet))[-1].direction().evaluation.f
    direction = newton_direction(objective, jet).evaluation.f
    assert_allclose(direction, exact, rtol=0, atol=2e-4 * np.abs(exact).max())


def test_newton_finds_the_free_minimum_in_30_steps():
    boundary = star_boundary()
    handles = Handles.place(boundary, STAR_POINTS)
    targets = STAR_POINTS * np.exp(1j * np.array([0, 0.9, 0, -0.6, 0, 0.5]))
    objective = Objective(boundary=boundary, handles=handles, targets=handles.targets(targets))
    phi, psi = boundary.cage.copy(), np.zeros_like(boundary.cage)
    for steps in range(31):  # noqa: B007 - the count is the point
        jet = objective.evaluate(phi, psi)
        direction = newton_direction(objective, jet)
        if -direction.derivative < 1e-8 * objective.value(jet):
            break
        length, _ = line_search(objective, jet, direction, objective.value(jet))
        assert length > 0
        phi, psi = phi + length * direction.phi, psi + length * direction.psi
    assert steps <= 30
    assert 2 < objective.value(jet) < 5


@pytest.mark.parametrize("size", [1e160, 1e300])
def test_a_trial_step_may_lead_farther_than_numbers_reach(size):
    objective, phi, psi, _ = problem()
    far = objective.evaluate(size * phi, size * psi)
    assert objective.energy(far) == np.inf
    assert objective.value(far) == np.inf
