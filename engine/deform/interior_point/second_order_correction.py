"""Newton step with second-order correction (Nocedal and Wright, section 15.5).

Bounds are curved, so a straight step along one soon leaves it (the Maratos effect). Where the step
turns F = f_z by an angle θ, it lengthens F by θ² / 2, and a slack of 1e-9 allows for 4e-5 of it. So
the full step is taken, beyond the bounds if need be, and the map is then brought back. Further
steps of the same model restore each slack to its first-order value; each costs a product with the
factors.

Where this fails, the step met bounds that the model ignores, since they hardly press at the map.
Their dual variables are raised to about the amount that outweighs the expected gain, and the step
is solved again.
"""

from dataclasses import dataclass, replace
from typing import NamedTuple, Self

import numpy as np

from engine.arrays import Booleans, Floats
from engine.deform.model.barrier import Barrier
from engine.deform.model.evaluation import Evaluation
from engine.deform.model.hessian import stiffening_hessian
from engine.deform.model.newton import SHORTEST, SUFFICIENT, Direction, Model, newton_models
from engine.deform.model.objective import Objective

# A step leaves at least this part of each slack. Bounds with less than twice that are restored, in
# at most so many corrections; each correction must halve the missing slack.
KEPT = 0.05
CORRECTIONS = 4
HALVED = 0.5
# Each tried length is this part of the one before, or twice it: a full step is doubled as long as
# the objective falls.
SHORTER = 0.7
LONGEST = 64.0
# How often duals of blocking bounds are raised, until so much of the step can be taken; and the
# part of the outweighing amount that the duals are raised to.
DUAL_RAISES = 3
ENOUGH = 0.7
RAISED = 0.5
RAISED_FACTOR = 4.0
# Where the exact Hessian is hardly positive its steps lead far beyond the bounds. After a step
# shorter than this the next, more convex model is tried.
STALLED = 0.08


class CorrectedStep(NamedTuple):
    """A step from a map to a better one within the bounds.

    Parameters
    ----------
    direction : Direction
        Newton's, straight.
    change : Direction
        The corrected step, of any length.
    length : float
        Length of `change` over the direction; 0 where nothing gains.
    value : float
        Of the objective at its end.
    gain : float
        Expected gain of the model's step, before duals are raised.
    convex : bool
        Whether the model is the objective's own, which is convex at the map.
    """

    direction: Direction
    change: Direction
    length: float
    value: float
    start: "_Start"
    gain: float = 0.0
    convex: bool = False

    @property
    def barrier(self) -> Barrier:
        """The barrier with the dual variables that the step was solved with."""
        return self.start.barrier

    def halved(self) -> "CorrectedStep":
        """Return a step of half the length, of the same model."""
        tried, _ = _max_feasible_step(self.start, self.direction, self.length / 2)
        return tried._replace(gain=self.gain, convex=self.convex)

    def without_step(self) -> "CorrectedStep":
        return self._replace(change=self.direction.scaled(0.0), length=0.0)


def find_corrected_step(objective: Objective, barrier: Barrier, jet: Evaluation) -> CorrectedStep:
    """Return a step that lowers the objective.

    Parameters
    ----------
    objective : Objective
        With the barrier.
    jet : Evaluation
        Of the map at the start, strictly within the bounds.
    """
    models = newton_models(objective, jet)
    best = _corrected_where_blocked(_Start.of(next(models), barrier, jet))
    # Another model costs a factorisation, and is built only when needed.
    while best.length <= STALLED and (model := next(models, None)) is not None:
        tried = _corrected_where_blocked(_Start.of(model, barrier, jet))
        if tried.value < best.value:
            best = tried
    return best


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class _Start:
    """Start of a step: the model and the barrier at a map."""

    model: Model
    barrier: Barrier
    evaluation: Evaluation
    value: float
    slacks: Floats
    margins: Floats
    duals: Floats

    @classmethod
    def of(cls, model: Model, barrier: Barrier, jet: Evaluation) -> Self:
        a, b = jet.a, jet.b
        return cls(
            model=model,
            barrier=barrier,
            evaluation=jet,
            value=model.objective.value(jet),
            slacks=barrier.slacks(a, b),
            margins=barrier.margins(a, b),
            duals=barrier.current_duals(a, b),
        )

    def with_raised_duals(self, walls: Booleans, gain: float) -> "_Start":
        """Return the start with the dual variables of some bounds (3, m) raised."""
        a, b = self.evaluation.a, self.evaluation.b
        shares = self.model.objective.boundary.barrier_weights
        enough = np.maximum(RAISED_FACTOR * self.duals, 2 * RAISED * gain / (shares * self.margins))
        barrier = replace(self.barrier, duals=np.where(walls, enough, self.duals))
        stiffer = barrier.derivatives(a, b).plus(
            self.barrier.derivatives(a, b).weighted(-np.ones(len(a)))
        )
        samples = np.flatnonzero(walls.any(axis=0))
        added = stiffening_hessian(
            self.model.objective, self.evaluation, stiffer.weighted(shares), samples
        )
        return replace(
            self,
            model=self.model.stiffened(added),
            barrier=barrier,
            duals=barrier.current_duals(a, b),
        )


def _corrected_where_blocked(start: _Start) -> CorrectedStep:
    """Solve for a step; where a bound that the model ignored blocks it, raise its dual, repeat."""
    direction = start.model.direction()
    tried, stops = _max_feasible_step(start, direction, 1.0)
    best, gain, convex = tried, -direction.derivative / 2, start.model.exact
    for _ in range(DUAL_RAISES):
        if tried.length >= ENOUGH or stops is None:
            break
        start = start.with_raised_duals(stops, -tried.direction.derivative / 2)
        tried, stops = _max_feasible_step(start, start.model.direction(), 1.0)
        if tried.value < best.value:
            best = tried
    return best._replace(gain=gain, convex=convex)


def _max_feasible_step(
    start: _Start, direction: Direction, longest: float
) -> tuple[CorrectedStep, Booleans | None]:
    """Return the longest gaining step along a direction, and the bounds that block longer ones."""
    length, stops = longest, None
    rounding = 1e-13 * abs(start.value)
    while length > SHORTEST:
        change, beyond = _corrected_change(start, direction.scaled(length))
        if change is not None:
            value = start.model.objective.value(start.evaluation.advanced(1.0, change.evaluation))
            if value <= start.value + SUFFICIENT * length * direction.derivative + rounding:
                step = CorrectedStep(direction, change, length, value, start)
                return (_doubled(step) if longest == length == 1.0 else step), stops
        elif stops is None:
            stops = beyond
        length *= SHORTER
    return CorrectedStep(direction, direction.scaled(0.0), 0.0, start.value, start), stops


def _doubled(step: CorrectedStep) -> CorrectedStep:
    """Double a full step as long as the objective falls."""
    start = step.start
    while step.length < LONGEST:
        change, _ = _corrected_change(start, step.direction.scaled(2 * step.length))
        if change is None:
            break
        value = start.model.objective.value(start.evaluation.advanced(1.0, change.evaluation))
        if not value < step.value:
            break
        step = step._replace(change=change, length=2 * step.length, value=value)
    return step


def _corrected_change(start: _Start, change: Direction) -> tuple[Direction | None, Booleans]:
    """Return a change corrected back within the bounds, or the bounds (3, m) that it breaks."""
    a, b = start.evaluation.a, start.evaluation.b
    objective, barrier = start.model.objective, start.barrier
    # Margins after the change to first order, and their least allowed values.
    da, db = radial_changes(start.evaluation, change)
    left = np.maximum(
        start.margins + barrier.margin_changes(a, b, da, db), 2 * KEPT * start.margins
    )
    missing = np.inf
    for count in range(CORRECTIONS + 1):
        slacks, sums = _slacks_at(start, start.evaluation.advanced(1.0, change.evaluation))
        share = slacks / start.slacks
        beyond: Booleans = share < KEPT
        if not beyond.any():
            return change, beyond
        before, missing = missing, KEPT - float(share.min())
        if count == CORRECTIONS or not missing < HALVED * before:
            break
        low = share < 2 * KEPT
        restored = np.where(low, (start.duals / start.margins) * (left - slacks * sums), 0.0)
        by_a, b_per_b = barrier.margin_gradient(a, -objective.boundary.barrier_weights * restored)
        samples = np.flatnonzero(low.any(axis=0))
        gradient = objective.sampled_gradient(start.evaluation, by_a, b_per_b, samples)
        change = change.plus(start.model.direction(gradient))
    return None, beyond


def _slacks_at(start: _Start, jet: Evaluation) -> tuple[Floats, Floats]:
    """Return u − b and u + b (3, m) of each bound at another map.

    Their product is c; the second is kept positive beyond the bounds, where c must be negative.
    """
    b = jet.b
    u = start.barrier.distances(jet.a)
    return u - b, np.maximum(u + b, 0.1 * start.margins / start.slacks)


def radial_changes(jet: Evaluation, change: Direction) -> tuple[Floats, Floats]:
    """Return the first-order changes of a and b."""
    a, b = jet.a, jet.b
    da = (jet.f.conj() * change.evaluation.f).real / a
    db = (jet.g.conj() * change.evaluation.g).real / np.maximum(b, np.finfo(np.float64).tiny)
    return da, db
