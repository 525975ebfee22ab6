"""Steps along curved walls: how far they go, and what they leave."""

from dataclasses import replace

import numpy as np
import pytest
from deform_shapes import search_from_rest
from numpy.testing import assert_allclose, assert_array_equal

from engine.deform import Objective
from engine.deform.interior_point.continuation import advance_search
from engine.deform.interior_point.second_order_correction import (
    KEPT,
    find_corrected_step,
    radial_changes,
)
from engine.deform.model.barrier import Barrier
from engine.deform.model.newton import newton_models


def problem(search):
    """Return what the next step of a search minimises, its barrier, and the map as it sees it."""
    barrier = Barrier(bounds=search.bounds, weight=search.weight, duals=search.duals)
    objective = Objective(
        boundary=search.boundary, handles=search.handles, targets=search.targets, barrier=barrier
    )
    return objective, barrier, objective.evaluate(*search.map.columns)


def slacks(barrier, jet):
    return barrier.slacks(np.abs(jet.f), np.abs(jet.g))


@pytest.mark.parametrize("steps", [6, 10, 14])
def test_a_step_lowers_the_objective_and_leaves_some_of_each_slack(steps):
    objective, barrier, jet = problem(search_from_rest(steps))
    step = find_corrected_step(objective, barrier, jet)
    reached = jet.advanced(1.0, step.change.evaluation)
    assert step.length > 0
    assert step.value == objective.value(reached) < objective.value(jet)
    assert (slacks(barrier, reached) >= KEPT * slacks(barrier, jet)).all()
    assert step.gain > 0


def test_steps_go_where_straight_ones_are_stopped():
    # The same lengths of the same directions without what brings them back: beyond the walls.
    search, beyond = search_from_rest(4), 0
    for _ in range(12):
        objective, barrier, jet = problem(search)
        step = find_corrected_step(objective, barrier, jet)
        straight = jet.advanced(step.length, step.direction.evaluation)
        if (slacks(barrier, straight) < KEPT * slacks(barrier, jet)).any():
            beyond += 1
            # What brings them back is of second order.
            assert_allclose(
                np.linalg.norm(
                    step.change.evaluation.f - step.length * step.direction.evaluation.f
                ),
                0,
                atol=0.2 * np.linalg.norm(step.length * step.direction.evaluation.f),
            )
        search = advance_search(search)
    assert beyond >= 3


def test_a_step_that_is_not_certified_gets_shorter_or_is_given_up():
    objective, barrier, jet = problem(search_from_rest(8))
    step = find_corrected_step(objective, barrier, jet)
    shorter = step.halved()
    assert 0 < shorter.length <= step.length / 2
    reached = jet.advanced(1.0, shorter.change.evaluation)
    assert (slacks(barrier, reached) >= KEPT * slacks(barrier, jet)).all()
    assert objective.value(reached) < objective.value(jet)
    assert shorter.gain == step.gain
    none = step.without_step()
    assert none.length == 0
    assert_array_equal(none.change.phi, 0)


def test_changes_of_a_and_b_are_those_of_their_moduli():
    objective, barrier, jet = problem(search_from_rest(5))
    change = find_corrected_step(objective, barrier, jet).direction
    da, db = radial_changes(jet, change)
    h = 1e-6
    ahead, behind = jet.advanced(h, change.evaluation), jet.advanced(-h, change.evaluation)
    for exact, part in ((da, "f"), (db, "g")):
        moved = np.abs(getattr(ahead, part)) - np.abs(getattr(behind, part))
        assert_allclose(exact, moved / (2 * h), rtol=1e-5, atol=1e-7)


def test_where_the_objective_is_convex_the_first_model_is_its_own():
    search = search_from_rest(0)
    _, barrier, jet = problem(replace(search, weight=1e-9))
    objective = Objective(
        boundary=search.boundary,
        handles=search.handles,
        targets=search.handles.targets(search.handles.points + 0.01),
        barrier=barrier,
    )
    models = list(newton_models(objective, jet))
    assert models[0].exact
    assert not models[-1].exact
    assert find_corrected_step(objective, barrier, jet).convex
