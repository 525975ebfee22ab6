"""The order of the searches for the minimum once the targets rest.

The first search starts from the present map, which is often near the minimum. Where bounds hold it
back, the next starts from the shape at rest, since a map that met bounds early hardly leaves them.
If much energy remains, two more start a quarter turn to either side of the aligning rotation.
Handles without a common rotation leave a choice between valleys. The last search widens the bounds
step by step (homotopy), from the best rotation.

The first search is shown as it runs. Of all others only the best result is shown, at the end.
"""

from dataclasses import replace

import numpy as np

from engine.deform.constrained_shape import ConstrainedShape
from engine.deform.handles import HandleTargets
from engine.deform.interior_point.continuation import advance_search, begin_search
from engine.deform.interior_point.homotopy import exceed_first_level
from engine.deform.interior_point.search import MOST_STEPS, WORTH_A_JUMP, Search, StartingPoint
from engine.deform.model.barrier import MARGIN, BarrierBounds
from engine.deform.model.barrier_position import ROUNDING
from engine.deform.model.evaluation import Evaluation
from engine.deform.model.objective import Objective
from engine.deform.state import State, Statistics, Status
from engine.deform.trust_region import (
    LEAST_RESTING,
    BarrierSchedule,
    align_rigidly,
    fit_rigid_motion,
)
from engine.maps import certify

# Steps of all searches together; of the first search from the present map, which is near rest or
# caught by bounds; and of the search from the shape at rest while other searches remain.
MOST_IN_ALL = 250
MOST_STEPS_HERE = 60
MOST_STEPS_REST = 90
# The shown map may be this part below a proven minimum: it may be nearer to the bounds than
# searches go.
ROUGHLY = 1e-3
# Targets this far (of L) from the handles at rest may be tangled, when a common rotation leads less
# than this part of the way. Measured: random drags of .15 L are no tangles, most handles that
# change places or meet in a point are.
FAR = 0.15
TANGLED = 0.8
# A shape may be wound up when it has more energy than this (2 at rest), and no common motion brings
# the handles nearer to their targets than this (of L, root mean square).
WOUND = 3.0
MISFIT = 0.12


def begin_searches(
    shape: ConstrainedShape, state: State, targets: HandleTargets, ways: tuple[StartingPoint, ...]
) -> State:
    if targets.pulls is not None or targets.aims is not None:
        # From the handles' present positions one search finds the same minimum as all, in half the
        # steps. A search from elsewhere could bend a limb to the other side.
        ways = (StartingPoint.HERE,)
    elif StartingPoint.REST in ways and state.map.is_same(shape.rest_map):
        ways = tuple(way for way in ways if way is not StartingPoint.HERE)
    state = replace(
        state,
        limits=shape.bounds,
        status=Status.MOVING,
        targets=targets,
        handles=shape.handles,
        boundary=shape.boundary,
        schedule=BarrierSchedule(weight=LEAST_RESTING),
        duals=None,
        evaluation=None,
        starting_points=ways,
        outcome=None,
        search_steps=0,
    )
    return replace(state, search=_search(shape, state, targets))


def advance_searches(shape: ConstrainedShape, state: State, search: Search) -> State:
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


def _search(shape: ConstrainedShape, state: State, targets: HandleTargets) -> Search:
    """Return the search from the next starting point, at its beginning."""
    way, outcome = state.starting_points[0], state.outcome
    first, turn, most = state.map, way.rotation, MOST_STEPS
    if way is not StartingPoint.HERE:
        if way is StartingPoint.WIDENING and outcome is not None:
            turn = outcome.start_rotation
        first = align_rigidly(shape.handles, targets, shape.rest_map, turn)
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
        Objective(boundary=shape.boundary, handles=shape.handles, targets=targets),
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
    """Whether a search from this starting point may find less energy than the best so far."""
    if way is StartingPoint.REST:
        return not (outcome.has_converged and not outcome.optimality.active)
    targets, size = outcome.targets.positions, shape.boundary.size
    common = fit_rigid_motion(shape.handles, shape.handles.points, targets)
    if way.is_rotated:
        energy = outcome.energy / shape.boundary.mean_stiffness
        return energy > WOUND and common.misfit > MISFIT * size
    # Targets far away, past each other, mean many valleys: wide bounds and widening bounds may lead
    # to different ones.
    farthest = float(np.abs(targets - shape.handles.points).max(initial=0.0))
    walls = BarrierBounds.at(shape.bounds, shape.boundary)
    return farthest > FAR * size and exceed_first_level(walls) and common.correlation < TANGLED


def _concluded(state: State, objective: Objective, search: Search, outcome: Search) -> State:
    """Return the state at rest, with the best pose of all searches."""
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
    """Return the statistics of one search step and of the best outcome so far."""
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
