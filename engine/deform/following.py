"""One step of a drag, which follows the hand.

- Each handle is pulled by a leash, towards a point a little ahead of where it is. The leash is
  shortened when the bounds cut steps short and lengthened again when they do not: the trust region.
- The barrier's weight rises and falls with the same signs, and its Hessian is primal–dual.
- A step is cut until its map is certified with a part of the slack left, and where the certificate
  found a bound broken between two samples, a sample is added: the barrier then sees it.
"""

from dataclasses import replace
from math import inf
from typing import NamedTuple

import numpy as np

from engine.arrays import Floats
from engine.deform.certified_step import CertifiedStep, add_samples, take_certified_step
from engine.deform.handles import Wish
from engine.deform.held_shape import HeldShape
from engine.deform.model import Barrier, Jet, Objective
from engine.deform.state import State, Statistics, Status
from engine.deform.steering import (
    Schedule,
    as_rows,
    cut_to_leash,
    distortions,
    place_walls,
    proven_at,
    tightening_limits,
)
from engine.maps import Limits

# On the way into tightened bounds the barrier weighs at least this much, and the handles are this
# much softer.
LEAST_TIGHTENING = 0.1
SOFTNESS = 0.003
# A hand that gives in stops at bounds by itself, with full steps, after which the weight would fall
# and the shape stick to them: the barrier weighs at least this much.
LEAST_GIVING = 0.03


def follow_hand(shape: HeldShape, state: State, wish: Wish) -> State:
    """Take one step of a drag towards a wish, or of the way into tightened bounds."""
    step = _prepare(shape, state, wish)
    taken = take_certified_step(
        step.objective,
        step.jet,
        state.map,
        state.certificate,
        required=step.required,
        preconditioner=state.preconditioner,
    )
    free = step.free
    schedule = step.schedule.after(
        length=taken.length,
        shortfall=_excess(shape.bounds.at(state.boundary), taken)
        if step.tightening
        else free.handle_error(step.jet),
        moving=step.leashed or step.tightening,
    )
    boundary, duals = add_samples(
        shape.boundary, state.boundary, step.next_duals(taken), taken.broken
    )
    status = Status.MOVING
    if step.tightening:
        status = Status.OUTSIDE if schedule.at_rest else Status.TIGHTENING
    return State(
        map=taken.map,
        certificate=taken.certificate,
        limits=step.limits,
        status=status,
        statistics=Statistics(
            energy=float(state.boundary.lengths @ step.jet.density),
            objective=free.energy(taken.jet),
            handle_error=free.handle_error(taken.jet),
            decrement=-taken.direction.derivative / 2,
            length=taken.length,
            leashed=step.leashed,
            optimality=inf,
            active=(),
        ),
        boundary=boundary,
        schedule=schedule,
        duals=duals,
        wish=wish,
        handles=shape.handles,
        preconditioner=taken.preconditioner,
        jet=taken.jet if boundary is state.boundary else None,
    )


class _Step(NamedTuple):
    """A step as it is prepared.

    `free` is the objective of the whole wish, without a barrier; `required` is what the certificate
    of the step's map is tested for.
    """

    jet: Jet
    free: Objective
    objective: Objective
    barrier: Barrier
    limits: Limits
    required: Limits
    schedule: Schedule
    leashed: bool
    tightening: bool

    def next_duals(self, taken: CertifiedStep) -> Floats:
        """Return the dual variables after the whole step, be it taken or not."""
        whole = taken.length == 1.0
        ahead = taken.jet if whole else self.jet.advanced(1.0, taken.direction.jet)
        a, b = self.jet.a, self.jet.b
        return self.barrier.next_duals(a, b, ahead.a - a, ahead.b - b)


def _prepare(shape: HeldShape, state: State, wish: Wish) -> _Step:
    """Choose what the next step minimises, and what it must keep."""
    free = Objective(boundary=state.boundary, handles=shape.handles, wish=wish)
    known = state.jet if state.handles is shape.handles else None
    jet = known or free.jet(*state.map.columns)
    reached = distortions(jet.a, jet.b)
    limits = tightening_limits(shape.bounds, state.limits, state.boundary, reached)
    walls, required = place_walls(limits, state.boundary, reached, state.certificate)
    same = wish.is_same(state.wish)
    schedule = state.schedule if same else state.schedule.for_new_wish()
    tightening = limits is not shape.bounds
    if tightening:
        # Held softly where it is, the shape gives in to its energy; later handles pull again.
        handles, leashed = shape.handles.softened(SOFTNESS), False
        wish = Wish(jet.positions, np.full(len(jet.positions), np.nan))
        schedule = replace(schedule, weight=max(schedule.weight, LEAST_TIGHTENING))
    else:
        handles = shape.handles
        if wish.hands is not None:
            schedule = replace(schedule, weight=max(schedule.weight, LEAST_GIVING))
        wish, leashed = cut_to_leash(handles, shape.boundary.size, schedule.leash, jet, wish)
    # On the way into the bounds the walls move with the map, and dual variables would lag.
    barrier = Barrier(
        walls=walls, weight=schedule.weight, duals=None if tightening else state.duals
    )
    return _Step(
        jet=jet,
        free=free,
        barrier=barrier,
        objective=replace(free, handles=handles, wish=wish, barrier=barrier, secant=True),
        limits=limits,
        required=required,
        schedule=schedule,
        leashed=leashed,
        tightening=tightening,
    )


def _excess(bounds: Limits, taken: CertifiedStep) -> float:
    """Return by how much a map is outside its bounds; more than any distance of handles."""
    allowed, reached = as_rows(bounds), distortions(taken.jet.a, taken.jet.b)
    excess = proven_at(taken.certificate, reached) - allowed
    excess[1:] /= np.abs(allowed[1:])
    return 1e3 + float(excess.max())
