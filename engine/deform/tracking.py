"""One step of a drag, which follows moving targets.

- Each handle is pulled towards a point a little ahead of it, within a trust region. The radius
  shrinks when the bounds cut steps short and grows again when they do not.
- The barrier's weight rises and falls with the same signs, and its Hessian is primal–dual.
- A step is cut until its map is certified with a part of the slack left. Where the certificate
  found a bound broken between two samples, a sample is added, so that the barrier sees it.
"""

from dataclasses import replace
from math import inf
from typing import NamedTuple

import numpy as np

from engine.arrays import Floats
from engine.deform.certified_step import CertifiedStep, add_samples, take_certified_step
from engine.deform.constrained_shape import ConstrainedShape
from engine.deform.handles import HandleTargets
from engine.deform.model.barrier import Barrier
from engine.deform.model.barrier_position import (
    place_barrier_bounds,
    proven_at,
    stack_distortions,
    stack_limits,
    tighten_limits,
)
from engine.deform.model.evaluation import Evaluation
from engine.deform.model.objective import Objective
from engine.deform.state import State, Statistics, Status
from engine.deform.trust_region import (
    BarrierSchedule,
    cut_to_radius,
)
from engine.maps import LocalBounds

# On the way into tightened bounds the barrier's weight is at least this much, and the handles are
# this much softer.
LEAST_TIGHTENING = 0.1
SOFTNESS = 0.003
# A pull with slack stops at bounds by itself, with full steps. The weight would then fall and the
# shape stick to the bounds, so the barrier's weight is at least this much.
LEAST_WITH_SLACK = 0.03


def take_drag_step(shape: ConstrainedShape, state: State, targets: HandleTargets) -> State:
    """Take one step of a drag towards the targets, or of the way into tightened bounds."""
    step = _prepare(shape, state, targets)
    taken = take_certified_step(
        step.objective,
        step.evaluation,
        state.map,
        state.certificate,
        required=step.required,
        preconditioner=state.preconditioner,
    )
    free = step.free
    schedule = step.schedule.after_step(
        length=taken.length,
        error=_excess(shape.bounds.at(state.boundary), taken)
        if step.is_tightening
        else free.target_error(step.evaluation),
        moving=step.has_hit_radius or step.is_tightening,
    )
    boundary, duals = add_samples(
        shape.boundary, state.boundary, step.next_duals(taken), taken.broken_segments
    )
    status = Status.MOVING
    if step.is_tightening:
        status = Status.OUTSIDE if schedule.is_at_rest else Status.TIGHTENING
    return State(
        map=taken.map,
        certificate=taken.certificate,
        limits=step.limits,
        status=status,
        statistics=Statistics(
            energy=float(state.boundary.lengths @ step.evaluation.density),
            objective=free.energy(taken.evaluation),
            target_error=free.target_error(taken.evaluation),
            decrement=-taken.direction.derivative / 2,
            length=taken.length,
            has_hit_radius=step.has_hit_radius,
            optimality=inf,
            active=(),
        ),
        boundary=boundary,
        schedule=schedule,
        duals=duals,
        targets=targets,
        handles=shape.handles,
        preconditioner=taken.preconditioner,
        evaluation=taken.evaluation if boundary is state.boundary else None,
    )


class _Step(NamedTuple):
    """A prepared step.

    `free` is the objective with the full targets and without a barrier. `required` are the bounds
    that the certificate of the step's map must keep.
    """

    evaluation: Evaluation
    free: Objective
    objective: Objective
    barrier: Barrier
    limits: LocalBounds
    required: LocalBounds
    schedule: BarrierSchedule
    has_hit_radius: bool
    is_tightening: bool

    def next_duals(self, taken: CertifiedStep) -> Floats:
        """Return the dual variables after the whole step, whether or not it was taken."""
        whole = taken.length == 1.0
        ahead = (
            taken.evaluation if whole else self.evaluation.advanced(1.0, taken.direction.evaluation)
        )
        a, b = self.evaluation.a, self.evaluation.b
        return self.barrier.next_duals(a, b, ahead.a - a, ahead.b - b)


def _prepare(shape: ConstrainedShape, state: State, targets: HandleTargets) -> _Step:
    """Choose the objective of the next step, and the bounds that it must keep."""
    free = Objective(boundary=state.boundary, handles=shape.handles, targets=targets)
    known = state.evaluation if state.handles is shape.handles else None
    jet = known or free.evaluate(*state.map.columns)
    reached = stack_distortions(jet.a, jet.b)
    limits = tighten_limits(shape.bounds, state.limits, state.boundary, reached)
    walls, required = place_barrier_bounds(limits, state.boundary, reached, state.certificate)
    same = targets.is_same(state.targets)
    schedule = state.schedule if same else state.schedule.for_new_targets()
    tightening = limits is not shape.bounds
    if tightening:
        # Held softly in place, the shape follows its own energy; later the handles pull again.
        handles, leashed = shape.handles.softened(SOFTNESS), False
        targets = HandleTargets(jet.positions, np.full(len(jet.positions), np.nan))
        schedule = replace(schedule, weight=max(schedule.weight, LEAST_TIGHTENING))
    else:
        handles = shape.handles
        if targets.pulls is not None:
            schedule = replace(schedule, weight=max(schedule.weight, LEAST_WITH_SLACK))
        targets, leashed = cut_to_radius(
            handles, shape.boundary.size, schedule.step_radius, jet, targets
        )
    # On the way into the bounds the barrier moves with the map, and dual variables would lag.
    barrier = Barrier(
        bounds=walls, weight=schedule.weight, duals=None if tightening else state.duals
    )
    return _Step(
        evaluation=jet,
        free=free,
        barrier=barrier,
        objective=replace(free, handles=handles, targets=targets, barrier=barrier, secant=True),
        limits=limits,
        required=required,
        schedule=schedule,
        has_hit_radius=leashed,
        is_tightening=tightening,
    )


def _excess(bounds: LocalBounds, taken: CertifiedStep) -> float:
    """Return how far a map is outside its bounds, scaled above any distance of handles."""
    allowed, reached = (
        stack_limits(bounds),
        stack_distortions(taken.evaluation.a, taken.evaluation.b),
    )
    excess = proven_at(taken.certificate, reached) - allowed
    excess[1:] /= np.abs(allowed[1:])
    return 1e3 + float(excess.max())
