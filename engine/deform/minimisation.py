"""How the searches for the minimum follow each other once the hand rests.

First from the present map, which is often near it; then, where bounds hold it back, from the shape
at rest, since a map that has met bounds early hardly leaves them. Where that leaves much energy, it
starts once more turned by a quarter, to either side, against the rotation that aligns it: handles
that do not agree on a rotation leave a choice between valleys. Last come walls that widen, from the
best turn.

The first search is shown as it goes. Of all others the best is shown, once, at the end.
"""

from dataclasses import replace

import numpy as np

from engine.deform.constrained_shape import ConstrainedShape
from engine.deform.handles import HandleTargets
from engine.deform.interior_point import (
    MOST_STEPS,
    WORTH_A_JUMP,
    Search,
    StartingPoint,
    advance_search,
    begin_search,
    exceed_first_level,
)
from engine.deform.model import MARGIN, BarrierBounds, Evaluation, Objective
from engine.deform.state import State, Statistics, Status
from engine.deform.trust_region import (
    LEAST_RESTING,
    ROUNDING,
    BarrierSchedule,
    align_rigidly,
    fit_rigid_motion,
)
from engine.maps import certify

# Steps of all ways together; of the first one from the present map, which is near rest or caught by
# bounds; and of the one from the shape at rest as long as others are left.
MOST_IN_ALL = 250
MOST_STEPS_HERE = 60
MOST_STEPS_REST = 90
# What is shown may be this part below a proven minimum: it may be nearer to the bounds than
# searches go.
ROUGHLY = 1e-3
# Handles that are wanted this far (of L) from where they are at rest may be in a tangle: when a
# rotation of them all leads less than this part of the way. Measured: random drags of .15 L are no
# tangles, most handles that change places or meet in a point are.
FAR = 0.15
TANGLED = 0.8
# A shape may be wound up when it has more energy than this, 2 at rest, and no common motion brings
# the handles nearer to their targets than this (of L, root mean square).
WOUND = 3.0
MISFIT = 0.12


def begin_searches(
    shape: ConstrainedShape, state: State, wish: HandleTargets, ways: tuple[StartingPoint, ...]
) -> State:
    """Return the state at the beginning of the searches along these ways."""
    if wish.pulls is not None:
        # From where the hands are is found what all ways find, in half the steps.
        ways = (StartingPoint.HERE,)
    elif StartingPoint.REST in ways and state.map.is_same(shape.rest_map):
        ways = tuple(way for way in ways if way is not StartingPoint.HERE)
    state = replace(
        state,
        limits=shape.bounds,
        status=Status.MOVING,
        targets=wish,
        handles=shape.handles,
        boundary=shape.boundary,
        schedule=BarrierSchedule(weight=LEAST_RESTING),
        duals=None,
        evaluation=None,
        starting_points=ways,
        outcome=None,
        search_steps=0,
    )
    return replace(state, search=_search(shape, state, wish))


def advance_searches(shape: ConstrainedShape, state: State, search: Search) -> State:
    """Take one step of a search; at its end begin the next one, or conclude."""
    objective, jet = shape.measure_state(state, search.targets)
    search, before = advance_search(search), state.outcome
    if before is None and search.energy < objective.energy(jet):
        state = _showing(state, search)
        jet = objective.evaluate(*state.map.columns)
    if not search.is_over:
        statistics = _statistics(objective, jet, search, search)
        return replace(state, search=search, statistics=statistics)
    proves = search.has_converged and before is not None and not before.has_converged
    worth = 1.0 if proves else 1.0 - WORTH_A_JUMP
    if before is None or search.energy < worth * before.energy:
        before = search
    tried = state.search_steps + search.steps
    state = replace(state, search=search, outcome=before, search_steps=tried)
    ways = _further_starting_points(shape, state, before)
    if not ways:
        return _concluded(state, objective, search, before)
    statistics = _statistics(objective, jet, search, before)
    state = replace(state, starting_points=ways, statistics=statistics)
    return replace(state, search=_search(shape, state, search.targets))


def _search(shape: ConstrainedShape, state: State, wish: HandleTargets) -> Search:
    """Return the search along the next way, at its beginning."""
    way, outcome = state.starting_points[0], state.outcome
    first, turn, most = state.map, way.rotation, MOST_STEPS
    if way is not StartingPoint.HERE:
        if way is StartingPoint.WIDENING and outcome is not None:
            turn = outcome.start_rotation
        first = align_rigidly(shape.handles, wish, shape.rest_map, turn)
        if way is StartingPoint.REST and len(state.starting_points) > 1:
            most = MOST_STEPS_REST
    elif outcome is not None:
        first, turn = outcome.map, outcome.start_rotation
    elif len(state.starting_points) > 1:
        most = MOST_STEPS_HERE
    limits = shape.bounds.towards_identity(ROUNDING)
    certificate = certify(first, shape.boundary, limits)
    if not certificate.is_certified:
        limits = shape.bounds
        certificate = certify(first, shape.boundary, limits)
    search = begin_search(
        Objective(boundary=shape.boundary, handles=shape.handles, targets=wish),
        first,
        certificate,
        inside=shape.bounds.towards_identity(MARGIN),
        limits=limits,
        way=way,
    )
    return replace(
        search,
        start_rotation=turn,
        max_steps=min(most, MOST_IN_ALL - state.search_steps),
        best=outcome,
    )


def _further_starting_points(
    shape: ConstrainedShape, state: State, outcome: Search
) -> tuple[StartingPoint, ...]:
    """Return the ways that are left to search."""
    if state.search_steps >= MOST_IN_ALL:
        return ()
    others = tuple(way for way in state.starting_points[1:] if _may_pay(shape, way, outcome))
    if (
        not others
        and state.starting_points[0] is not StartingPoint.HERE
        and not outcome.has_converged
    ):
        return (StartingPoint.HERE,)
    return others


def _may_pay(shape: ConstrainedShape, way: StartingPoint, outcome: Search) -> bool:
    """Tell whether a search along a way may find less than the best one so far."""
    if way is StartingPoint.REST:
        return not (outcome.has_converged and not outcome.optimality.active)
    targets, size = outcome.targets.positions, shape.boundary.size
    common = fit_rigid_motion(shape.handles, shape.handles.points, targets)
    if way.is_rotated:
        energy = outcome.energy / shape.boundary.mean_stiffness
        return energy > WOUND and common.misfit > MISFIT * size
    # Handles that are wanted far away, past each other: there are many valleys, and those that wide
    # and widening bounds lead to may differ.
    farthest = float(np.abs(targets - shape.handles.points).max(initial=0.0))
    walls = BarrierBounds.at(shape.bounds, shape.boundary)
    return farthest > FAR * size and exceed_first_level(walls) and common.correlation < TANGLED


def _concluded(state: State, objective: Objective, search: Search, outcome: Search) -> State:
    """Return the state at rest, with the best pose that was found."""
    jet = objective.evaluate(*state.map.columns)
    if outcome.energy < objective.energy(jet):
        state = _showing(state, outcome)
        jet = objective.evaluate(*state.map.columns)
    statistics = _statistics(objective, jet, search, outcome)
    status = Status.UNFINISHED
    if outcome.has_converged and statistics.objective >= (1.0 - ROUGHLY) * outcome.energy:
        status = Status.AT_LIMITS if outcome.optimality.active else Status.CONVERGED
    return replace(state, starting_points=(), statistics=statistics, status=status)


def _showing(state: State, search: Search) -> State:
    return replace(state, map=search.map, certificate=search.certificate, steps=search.steps)


def _statistics(
    objective: Objective, jet: Evaluation, search: Search, outcome: Search
) -> Statistics:
    """Return what a step of a search did, and what is known of the outcome."""
    return Statistics(
        energy=float(objective.boundary.lengths @ jet.density),
        objective=objective.energy(jet),
        target_error=objective.target_error(jet),
        decrement=search.gain,
        length=search.length,
        has_hit_radius=False,
        optimality=outcome.optimality.measure,
        active=outcome.optimality.active,
    )
