"""The parts that steer a drag: schedule, limits and leash."""

import numpy as np
from deform_shapes import STAR_POINTS, star_boundary
from numpy.testing import assert_allclose

from engine.deform import Handles
from engine.deform.model.barrier import MARGIN, Barrier
from engine.deform.model.barrier_position import (
    place_barrier_bounds,
    stack_distortions,
    tighten_limits,
    widen_limits,
)
from engine.deform.model.objective import Objective
from engine.deform.trust_region import (
    IDLE_AT_REST,
    STEP_RADIUS,
    BarrierSchedule,
    cut_to_radius,
)
from engine.maps import Bounds, Certificate, LocalBounds

BOUNDS = Bounds(k=0.5, sigma_a=2.0, sigma_b=0.5)
BOUNDARY = star_boundary()
A, B = np.array([1.0, 1.2]), np.array([0.1, 0.3])
REACHED = stack_distortions(A, B)


def certificate(k=0.26, sigma_a=1.51, sigma_b=0.89):
    return Certificate(k=k, sigma_a=sigma_a, sigma_b=sigma_b, winding=0, is_certified=True)


def after(schedule, length, error=0.5):
    return schedule.after_step(length=length, error=error, moving=True)


def test_short_steps_raise_the_barrier_and_draw_in_the_leash():
    start = BarrierSchedule()
    short, full = after(start, 0.1), after(start, 1.0)
    assert short.weight > start.weight > full.weight
    assert short.step_radius < start.step_radius
    assert after(short, 1.0).step_radius > short.step_radius
    assert after(start, 0.5).weight == start.weight


def test_a_drag_without_progress_is_at_rest():
    schedule = after(BarrierSchedule(), 1.0)
    for _ in range(IDLE_AT_REST):
        assert not schedule.is_at_rest
        schedule = after(schedule, 0.1)
    assert schedule.is_at_rest
    assert not schedule.for_new_targets().is_at_rest
    progress = after(schedule, 0.1, error=0.4)
    assert progress.idle_steps == 0


def test_a_step_keeps_some_slack_of_the_map():
    walls, required = place_barrier_bounds(BOUNDS, BOUNDARY, REACHED, certificate())
    assert 0.25 < required.k < walls.k[1] < BOUNDS.k
    assert 1.5 < required.sigma_a < walls.sigma_a[1] < BOUNDS.sigma_a
    assert 0.9 > required.sigma_b > walls.sigma_b[1] > BOUNDS.sigma_b
    # A map that has less slack between its samples may keep it.
    walls, required = place_barrier_bounds(BOUNDS, BOUNDARY, REACHED, certificate(k=0.4999))
    assert required.k >= 0.4999
    # A sample between walls and bounds gets walls around it, and another one keeps its own.
    walls, _ = place_barrier_bounds(
        BOUNDS, BOUNDARY, stack_distortions(np.ones(2), np.array([0.49999, 0.1])), certificate()
    )
    assert 0.49999 < walls.k[0] < 0.5
    assert walls.k[1] == BOUNDS.towards_identity(MARGIN).k


def test_limits_close_in_and_never_open():
    wide = widen_limits(certificate(k=0.7, sigma_a=2.5, sigma_b=0.3), BOUNDS)
    assert wide.k > 0.7
    assert wide.sigma_a > 2.5
    assert wide.sigma_b < 0.3
    nearer = tighten_limits(
        BOUNDS, wide, BOUNDARY, stack_distortions(np.array([1.5]), np.array([0.9]))
    )
    assert 0.6 < nearer.k < 0.7
    assert nearer.sigma_a < wide.sigma_a
    assert nearer.sigma_b == BOUNDS.sigma_b
    farther = stack_distortions(np.array([1.6]), np.array([1.1]))
    assert tighten_limits(BOUNDS, nearer, BOUNDARY, farther).k == nearer.k
    assert tighten_limits(BOUNDS, nearer, BOUNDARY, REACHED) == BOUNDS


def test_limits_may_be_far_from_the_identity():
    # A map twice as large under σ_b ≥ 0.95: its walls' slack reaches far beyond 1.
    a, b = np.array([2.0]), np.array([0.01])
    large = certificate(k=0.01, sigma_a=2.02, sigma_b=1.98)
    _, required = place_barrier_bounds(
        LocalBounds(k=0.5, sigma_a=5.0, sigma_b=0.95), BOUNDARY, stack_distortions(a, b), large
    )
    assert 1.0 < required.sigma_b < 1.98
    small = certificate(k=0.01, sigma_a=0.42, sigma_b=0.38)
    _, required = place_barrier_bounds(
        LocalBounds(k=0.5, sigma_a=1.05, sigma_b=0.2),
        BOUNDARY,
        stack_distortions(0.2 * a, b),
        small,
    )
    assert 0.42 < required.sigma_a < 1.0


def leashed(targets, rotations=None, leash=1.0):
    boundary = star_boundary()
    handles = Handles.place(boundary, STAR_POINTS)
    handle_targets = handles.targets(targets, rotations)
    jet = Objective(boundary=boundary, handles=handles, targets=handle_targets).evaluate(
        boundary.cage, 0 * boundary.cage
    )
    near, cut = cut_to_radius(handles, boundary.size, leash, jet, handle_targets)
    return near, cut, STEP_RADIUS * boundary.size * leash


def test_the_leash_is_as_long_as_it_is_paid_out():
    far = STAR_POINTS + 3 + 1j
    for leash in (1.0, 0.25):
        near, cut, length = leashed(far, leash=leash)
        assert cut
        assert_allclose(near.positions, STAR_POINTS + length * np.exp(1j * np.angle(3 + 1j)))
    near, cut, length = leashed(STAR_POINTS + 0.01)
    assert not cut
    assert_allclose(near.positions, STAR_POINTS + 0.01)
    assert np.isnan(near.rotations).all()


def test_common_rotations_are_turned_along_the_circle():
    near, cut, _ = leashed(np.exp(3j) * STAR_POINTS)
    assert cut
    assert np.angle(near.positions[1] / STAR_POINTS[1]) > 0.15
    near, _, _ = leashed(STAR_POINTS, np.array([2.0, *[np.nan] * 5]))
    assert_allclose(near.rotations[0], 0.2)


def test_the_barrier_is_convex_for_a_map_at_its_limits_to_the_last_digit():
    # Rounding can leave a sample at a wall, or beyond it, where the barrier's Hessian has no root.
    rng = np.random.default_rng(0)
    for a in rng.uniform(0.5, 2.0, size=(100, 1)):
        b = rng.uniform(0.1, 0.4, size=1) * a
        k, sigma_a, sigma_b = (b / a).item(), (a + b).item(), (a - b).item()
        at_limits = LocalBounds(k=k, sigma_a=sigma_a, sigma_b=sigma_b)
        held = certificate(k=k, sigma_a=sigma_a, sigma_b=sigma_b)
        walls, required = place_barrier_bounds(at_limits, BOUNDARY, stack_distortions(a, b), held)
        barrier = Barrier(bounds=walls, weight=1e-2)
        assert np.all(barrier.slacks(a, b) > 0)
        bent = barrier.derivatives(a, b)
        assert bent.aa > 0
        assert bent.bb > 0
        assert at_limits.allow(k=required.k, sigma_a=required.sigma_a, sigma_b=required.sigma_b)
