"""Deformations of shapes with holes: derivatives of the objective, and some drags."""

from dataclasses import replace

import numpy as np
import pytest
from holed_shapes import (
    DRAGS,
    boundary_of,
    inner_points,
    on_circle,
    plate,
    pulled,
    random_map,
    ring,
)
from messages import says
from numpy.testing import assert_allclose, assert_array_equal

from engine.deform import Deformer, Handles, Status
from engine.deform.model.barrier import Barrier, BarrierBounds
from engine.deform.model.hessian import projected_hessian
from engine.deform.model.objective import Objective
from engine.errors import EngineError
from engine.geometry import Domain
from engine.geometry.polygon import OUTSIDE_OUTLINE
from engine.maps import Boundary, Bounds, HarmonicMap, LocalBounds, certify


def problem(shape, name, seed=3):
    boundary = boundary_of(name, 3)
    handles = Handles.place(boundary, inner_points(shape, 200)[:5])
    handle_targets = handles.targets(
        1.02 * handles.points + 0.01j, [0.3, np.nan, np.nan, -0.2, np.nan]
    )
    walls = BarrierBounds.for_samples(
        LocalBounds(k=0.95, sigma_a=30.0, sigma_b=0.01), len(boundary.points)
    )
    objective = Objective(
        boundary=boundary,
        handles=handles,
        targets=handle_targets,
        barrier=Barrier(bounds=walls, weight=0.2),
    )
    phi, psi = random_map(shape, seed, 0.02).columns
    grown = HarmonicMap.similarity(shape.cage, shape.holes, factor=0.6).columns[0]
    return objective, phi + grown, psi


@pytest.mark.parametrize(("shape", "name"), [(ring(), "ring"), (plate(), "plate")])
def test_derivatives_agree_with_finite_differences(shape, name):
    objective, phi, psi = problem(shape, name)
    boundary, h = objective.boundary, 1e-6
    jet = objective.evaluate(phi, psi)
    radial = objective.radial_derivatives(jet)
    assert np.all(radial.around_a > 0)  # nothing is projected
    # Only at their targets rotations have no projected part.
    objective = replace(objective, targets=objective.handles.targets(objective.targets.positions))
    gradient = objective.gradient(jet, radial)
    hessian = np.triu(projected_hessian(objective, jet, radial))
    hessian = hessian + np.triu(hessian, 1).T
    idle = np.zeros_like(hessian)
    for constant in range(1, 1 + len(boundary.holes)):
        for first in (2 * constant, 2 * (constant + boundary.basis.shape[1] - 1)):
            idle[[first, first + 1], [first, first + 1]] = 1e4
    rng = np.random.default_rng(0)
    for _ in range(4):
        x = rng.normal(size=len(gradient))
        moved = objective.evaluate(*objective.coefficients(x))
        ahead, behind = jet.advanced(h, moved), jet.advanced(-h, moved)
        slope = (objective.value(ahead) - objective.value(behind)) / (2 * h)
        assert_allclose(gradient @ x, slope, rtol=1e-5)
        by_gradient = (
            objective.gradient(ahead, objective.radial_derivatives(ahead))
            - objective.gradient(behind, objective.radial_derivatives(behind))
        ) / (2 * h)
        product = (hessian - idle) @ x
        assert_allclose(product, by_gradient, rtol=0, atol=2e-6 * np.abs(product).max())


def test_steps_never_change_what_is_nothing():
    """The constant on the cage of a hole stays where it is, bit for bit but for rounding."""
    points, targets = DRAGS["kidney"]
    boundary = boundary_of("ring")
    deformer = Deformer(boundary=boundary, handles=Handles.place(boundary, points), bounds=Bounds())
    state = deformer.start()
    for _ in range(5):
        state = deformer.step(state, deformer.handles.targets(targets))
    inner = state.map.phi[48:], state.map.psi[48:]
    for coefficients in inner:
        assert np.abs(coefficients).max() > 1e-4
        assert abs(coefficients.sum()) < 1e-9


def test_a_hard_drag_is_certified_at_each_step_and_comes_to_rest():
    points, targets = DRAGS["swirl"]
    boundary = boundary_of("ring")
    deformer = Deformer(boundary=boundary, handles=Handles.place(boundary, points), bounds=Bounds())
    handle_targets = deformer.handles.targets(targets)
    state = deformer.start()
    for _ in range(150):
        state = deformer.step(state, handle_targets)
        assert state.certificate.is_certified
        if state.status.is_final:
            break
    assert state.status in (Status.CONVERGED, Status.AT_LIMITS)
    assert state.statistics.optimality <= 1e-5
    assert certify(state.map, boundary, Bounds()).is_certified
    assert abs(state.map.logs[0]) > 1e-5
    assert state.statistics.target_error < 0.02


def test_three_holes_bend():
    state = pulled("bent")
    assert state.status.is_final
    assert state.certificate.is_certified
    assert state.statistics.target_error < 0.02


def test_a_hole_gives_where_a_filled_one_resists():
    """Squeezed by the same handles, a ring has less energy than the disc it encloses."""
    shape = ring(sides=24)
    points, targets = on_circle(0.8, [0, 180]), on_circle(0.55, [0, 180])
    energies = []
    for holes in (shape.holes, ()):
        boundary = Boundary.sample(Domain(shape.outline, shape.cage, holes))
        deformer = Deformer(
            boundary=boundary, handles=Handles.place(boundary, points), bounds=Bounds()
        )
        state, _ = deformer.settle(deformer.start(), deformer.handles.targets(targets))
        energies.append(state.statistics.energy - 2)
    assert energies[0] < 0.7 * energies[1]


def test_a_tiny_hole_hardly_matters():
    points, targets = DRAGS["egg"]
    targets = (points + targets) / 2
    placed = []
    tiny = ring(0.002)
    for holes in (tiny.holes, ()):
        boundary = Boundary.sample(Domain(tiny.outline, tiny.cage, holes))
        deformer = Deformer(
            boundary=boundary, handles=Handles.place(boundary, points), bounds=Bounds()
        )
        state, steps = deformer.settle(deformer.start(), deformer.handles.targets(targets))
        assert steps <= 40
        placed.append(state.map(inner_points(ring())))
    assert_allclose(placed[0], placed[1], rtol=0, atol=2e-3)


def test_a_shape_elsewhere_deforms_alike():
    points, targets = DRAGS["egg"]
    factor, shift = 300j, 500 - 200j
    still = ring(sides=24)
    moved = still.moved(factor, shift)
    maps = []
    for shape, p, t in (
        (still, points, targets),
        (moved, factor * points + shift, factor * targets + shift),
    ):
        boundary = Boundary.sample(shape.domain)
        deformer = Deformer(boundary=boundary, handles=Handles.place(boundary, p), bounds=Bounds())
        state, _ = deformer.settle(deformer.start(), deformer.handles.targets(t))
        places = inner_points(still)
        maps.append(state.map(places if shape is not moved else factor * places + shift))
    assert_allclose(factor * maps[0] + shift, maps[1], rtol=0, atol=1e-3 * abs(factor))


def test_handles_stand_on_the_shape_and_not_in_its_holes():
    with pytest.raises(EngineError, match=says(OUTSIDE_OUTLINE)):
        Handles.place(boundary_of("ring"), np.array([0.1 + 0.1j]))
    assert len(Handles.place(boundary_of("ring"), np.array([0.5 + 0j])).points) == 1


def test_the_same_drag_gives_the_same_map():
    points, targets = DRAGS["crescent"]
    boundary = boundary_of("ring")
    found = []
    for _ in range(2):
        deformer = Deformer(
            boundary=boundary, handles=Handles.place(boundary, points), bounds=Bounds()
        )
        state = deformer.start()
        for _ in range(4):
            state = deformer.step(state, deformer.handles.targets(targets))
        found.append(state.map)
    for name in ("phi", "psi", "logs"):
        assert_array_equal(getattr(found[0], name), getattr(found[1], name))
