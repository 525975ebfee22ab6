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

from engine.deform.handles import Wish
from engine.deform.held_shape import HeldShape
from engine.deform.model import MARGIN, Jet, Objective, Walls
from engine.deform.rest import (
    MOST_STEPS,
    WORTH_A_JUMP,
    Search,
    Way,
    advance,
    begin_search,
    exceed_first_rung,
)
from engine.deform.state import State, Statistics, Status
from engine.deform.steering import (
    LEAST_RESTING,
    ROUNDING,
    Schedule,
    common_motion,
    rigidly_aligned,
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


def begin_searches(shape: HeldShape, state: State, wish: Wish, ways: tuple[Way, ...]) -> State:
    """Return the state at the beginning of the searches along these ways."""
    if wish.hands is not None:
        # From where the hands are is found what all ways find, in half the steps.
        ways = (Way.HERE,)
    elif Way.REST in ways and state.map.is_same(shape.at_rest):
        ways = tuple(way for way in ways if way is not Way.HERE)
    state = replace(
        state,
        limits=shape.bounds,
        status=Status.MOVING,
        wish=wish,
        handles=shape.handles,
        boundary=shape.boundary,
        schedule=Schedule(weight=LEAST_RESTING),
        duals=None,
        jet=None,
        ways=ways,
        outcome=None,
        tried=0,
    )
    return replace(state, search=_search(shape, state, wish))


def search_on(shape: HeldShape, state: State, search: Search) -> State:
    """Take one step of a search; at its end begin the next one, or conclude."""
    objective, jet = shape.measured(state, search.wish)
    search, before = advance(search), state.outcome
    if before is None and search.energy < objective.energy(jet):
        state = _showing(state, search)
        jet = objective.jet(*state.map.columns)
    if not search.is_over:
        statistics = _statistics(objective, jet, search, search)
        return replace(state, search=search, statistics=statistics)
    proves = search.has_arrived and before is not None and not before.has_arrived
    worth = 1.0 if proves else 1.0 - WORTH_A_JUMP
    if before is None or search.energy < worth * before.energy:
        before = search
    tried = state.tried + search.steps
    state = replace(state, search=search, outcome=before, tried=tried)
    ways = _further_ways(shape, state, before)
    if not ways:
        return _concluded(state, objective, search, before)
    statistics = _statistics(objective, jet, search, before)
    state = replace(state, ways=ways, statistics=statistics)
    return replace(state, search=_search(shape, state, search.wish))


def _search(shape: HeldShape, state: State, wish: Wish) -> Search:
    """Return the search along the next way, at its beginning."""
    way, outcome = state.ways[0], state.outcome
    first, turn, most = state.map, way.turn, MOST_STEPS
    if way is not Way.HERE:
        if way is Way.WIDENING and outcome is not None:
            turn = outcome.turn
        first = rigidly_aligned(shape.handles, wish, shape.at_rest, turn)
        if way is Way.REST and len(state.ways) > 1:
            most = MOST_STEPS_REST
    elif outcome is not None:
        first, turn = outcome.map, outcome.turn
    elif len(state.ways) > 1:
        most = MOST_STEPS_HERE
    limits = shape.bounds.towards_identity(ROUNDING)
    certificate = certify(first, shape.boundary, limits)
    if not certificate.certified:
        limits = shape.bounds
        certificate = certify(first, shape.boundary, limits)
    search = begin_search(
        Objective(boundary=shape.boundary, handles=shape.handles, wish=wish),
        first,
        certificate,
        inside=shape.bounds.towards_identity(MARGIN),
        limits=limits,
        way=way,
    )
    return replace(
        search,
        turn=turn,
        most=min(most, MOST_IN_ALL - state.tried),
        best=outcome,
    )


def _further_ways(shape: HeldShape, state: State, outcome: Search) -> tuple[Way, ...]:
    """Return the ways that are left to search."""
    if state.tried >= MOST_IN_ALL:
        return ()
    others = tuple(way for way in state.ways[1:] if _may_pay(shape, way, outcome))
    if not others and state.ways[0] is not Way.HERE and not outcome.has_arrived:
        return (Way.HERE,)
    return others


def _may_pay(shape: HeldShape, way: Way, outcome: Search) -> bool:
    """Tell whether a search along a way may find less than the best one so far."""
    if way is Way.REST:
        return not (outcome.has_arrived and not outcome.optimality.active)
    targets, size = outcome.wish.positions, shape.boundary.size
    common = common_motion(shape.handles, shape.handles.points, targets)
    if way.is_turned:
        energy = outcome.energy / shape.boundary.mean_stiffness
        return energy > WOUND and common.misfit > MISFIT * size
    # Handles that are wanted far away, past each other: there are many valleys, and those that wide
    # and widening bounds lead to may differ.
    farthest = float(np.abs(targets - shape.handles.points).max(initial=0.0))
    walls = Walls.at(shape.bounds, shape.boundary)
    return farthest > FAR * size and exceed_first_rung(walls) and common.correlation < TANGLED


def _concluded(state: State, objective: Objective, search: Search, outcome: Search) -> State:
    """Return the state at rest, with the best pose that was found."""
    jet = objective.jet(*state.map.columns)
    if outcome.energy < objective.energy(jet):
        state = _showing(state, outcome)
        jet = objective.jet(*state.map.columns)
    statistics = _statistics(objective, jet, search, outcome)
    status = Status.UNFINISHED
    if outcome.has_arrived and statistics.objective >= (1.0 - ROUGHLY) * outcome.energy:
        status = Status.AT_LIMITS if outcome.optimality.active else Status.CONVERGED
    return replace(state, ways=(), statistics=statistics, status=status)


def _showing(state: State, search: Search) -> State:
    return replace(state, map=search.map, certificate=search.certificate, steps=search.steps)


def _statistics(objective: Objective, jet: Jet, search: Search, outcome: Search) -> Statistics:
    """Return what a step of a search did, and what is known of the outcome."""
    return Statistics(
        energy=float(objective.boundary.lengths @ jet.density),
        objective=objective.energy(jet),
        handle_error=objective.handle_error(jet),
        decrement=search.gain,
        length=search.length,
        leashed=False,
        optimality=outcome.optimality.measure,
        active=outcome.optimality.active,
    )
