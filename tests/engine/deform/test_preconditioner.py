from dataclasses import replace

import numpy as np
import pytest
from deform_shapes import STAR_POINTS, star_boundary
from numpy.testing import assert_allclose, assert_array_equal

from engine.deform import Handles, Objective, newton_direction
from engine.deform.model.barrier import Barrier, BarrierBounds
from engine.deform.model.newton import newton_models, preconditioned_direction
from engine.maps import Bounds


@pytest.fixture(scope="module")
def maps():
    """Two maps near each other, as an objective with a barrier sees them, and the factor of one."""
    boundary = star_boundary()
    handles = Handles.place(boundary, STAR_POINTS)
    walls = BarrierBounds.for_samples(Bounds(), len(boundary.points))
    objective = Objective(
        boundary=boundary,
        handles=handles,
        targets=handles.targets(1.02 * STAR_POINTS + 0.01j),
        barrier=Barrier(bounds=walls, weight=0.2),
    )
    noise = np.random.default_rng(3).normal(size=(4, len(boundary.cage)))
    phi, psi = boundary.cage + 0.002 * noise[0], 0.1 * boundary.cage + 0.002j * noise[1]
    first = objective.evaluate(phi, psi)
    second = objective.evaluate(1.05 * phi + 0.002 * noise[2], psi + 0.002 * noise[3])
    _, factored = preconditioned_direction(objective, first, None)
    return objective, second, factored


def missed(maps, direction):
    """Return what is missing of the step of the whole Hessian, in its norm."""
    objective, jet, _ = maps
    exact = list(newton_models(objective, jet))[-1].direction()
    return np.sqrt(max(0.0, 1.0 - direction.derivative / exact.derivative))


def test_a_step_by_the_factor_of_another_map_tends_to_the_same(maps, monkeypatch):
    objective, jet, factored = maps
    later, kept = preconditioned_direction(objective, jet, factored)
    assert kept.factor is factored.factor
    assert missed(maps, later) < 0.1
    monkeypatch.setattr("engine.deform.model.newton.REFINED_LATER", 1e-5)
    monkeypatch.setattr("engine.deform.model.newton.REFINEMENTS", 30)
    refined, _ = preconditioned_direction(objective, jet, factored)
    assert missed(maps, refined) < 1e-3


def test_a_factor_that_takes_too_many_rounds_is_made_anew(maps, monkeypatch):
    objective, jet, factored = maps
    monkeypatch.setattr("engine.deform.model.newton.REFINED_LATER", 1e-12)
    direction, kept = preconditioned_direction(objective, jet, factored)
    assert_array_equal(direction.phi, newton_direction(objective, jet).phi)
    assert kept.factor is not factored.factor


def test_a_factor_serves_its_own_handles_only(maps):
    objective, jet, factored = maps
    turned = objective.handles.targets(objective.targets.positions, np.zeros(len(STAR_POINTS)))
    softened = objective.handles.softened(0.5)
    for other in (replace(objective, handles=softened), replace(objective, targets=turned)):
        assert not factored.can_serve(other)
        direction, _ = preconditioned_direction(other, jet, factored)
        assert_array_equal(direction.phi, newton_direction(other, jet).phi)


def test_a_factor_serves_a_few_steps(maps, monkeypatch):
    objective, jet, factored = maps
    monkeypatch.setattr("engine.deform.model.newton.SERVES_STEPS", 3)
    _, second = preconditioned_direction(objective, jet, factored)
    direction, third = preconditioned_direction(objective, jet, second)
    assert third is None
    assert_allclose(direction.derivative, newton_direction(objective, jet).derivative, rtol=0.05)
