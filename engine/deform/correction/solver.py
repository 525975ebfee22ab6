"""The smallest correction that brings points to their targets.

    minimise ½ |x|²  where  w_i (place_i(x) + t − wanted_i) = 0,

t a translation, 0 where the anchor stays; periods around holes are closed by further rows. A point
of weight w < 1 has the compliance (1 − w) / w, so that its pull vanishes as w falls to 0. Each step
solves the model in which the rows J are linear, exactly, in the few dimensions of the points:

    (J Jᵀ + C) μ + T t = −(r − J x),    Tᵀ μ = 0,    δ = Jᵀ μ − x,

and then the correction by the rows' own curvature, by conjugate gradients. A point with a yield
force F keeps the target error L (|pull| / F)³. Out of reach, where the pull grows, it thus stops
smoothly.
"""

from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from engine.arrays import Floats
from engine.deform.correction.barrier import BarrierState, LimitBarrier
from engine.deform.correction.corrector import PointCorrector
from engine.deform.correction.frame import BaseFrame, CorrectedFrame
from engine.deform.correction.point_targets import PointTargets, require_targets
from engine.deform.correction.step_model import TINY, Form, Rows, StepModel, work_of_pulls
from engine.errors import EngineError

SMALL = 1e-6  # step in h: where the iteration ends
MET = 1e-9  # of the diameter: target error of points that have arrived
LONGEST = 1.0  # longest step in h
MOST_STEPS, MOST_STEPS_AT_WALLS, MOST_HALVINGS, MOST_RETURNS = 25, 60, 12, 3
# The barrier is lowered after a step of which so much was taken, if the step is no longer than
# this.
ENOUGH, CLOSE = 0.5, 0.15
APART = 0.2  # of the distance from a limit: the least that a step leaves
NEARER = 0.7  # of the gap: the largest remainder after a step back to the points
CALM = 1e-4  # step in h: where the iteration ends with a barrier
GAINS, GAINS_AT_WALLS = 0.99, 0.999  # of the merit: the largest remainder after a part of a step
LEVER = 0.25  # of the diameter: the distance at which a rotation is as firm as a point
UNFINISHED = (
    "The correction did not converge in {steps} steps: a point is still {miss:.3g} from its "
    "target. Give targets nearer to the base, or accept the correction as it is (throw=False)."
)
FIRMEST = 1.5  # times the largest pull: the merit's weight of each target error


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class PointSolution:
    """A correction: x (2N,) in `Variables`, a translation, and target errors (m,).

    Parameters
    ----------
    is_limited : bool
        Whether it came near a limit, so that the barrier took part.
    is_finished : bool
        Whether the iteration converged; unreachable points may then still have target errors.
    """

    x: Floats
    shift: complex
    target_errors: Floats
    steps: int
    is_limited: bool = False
    is_finished: bool = True


def solve_correction(
    corrector: PointCorrector,
    base: BaseFrame,
    targets: PointTargets,
    start: PointSolution | None = None,
    walls: LimitBarrier | None = None,
    *,
    throw: bool = True,
) -> PointSolution:
    """Find the correction of one frame.

    Parameters
    ----------
    base : BaseFrame
        At the nodes of the corrector's paths.
    start : PointSolution, optional
        Of a similar frame.
    walls : LimitBarrier, optional
        Limits that the correction keeps.

    Raises
    ------
    EngineError
        If the targets do not match the corrector's points, are not finite or out of range, or the
        iteration does not converge. With `throw=False` the last correction is returned.
    """
    require_targets(targets, len(corrector.points))
    problem = PointProblem(corrector, base, targets, walls)
    is_inside = walls is None or not walls.beyond.any()
    if not problem.is_asked and is_inside and (walls is None or start is None or not start.x.any()):
        nothing = corrector.variables.nothing
        return PointSolution(x=nothing, shift=0j, target_errors=np.abs(targets.offsets), steps=0)
    first = (corrector.variables.nothing, 0j) if start is None else (start.x, start.shift)
    found = problem.solve_steps(problem.state(*first))
    if throw and not found.is_finished:
        raise EngineError(UNFINISHED, steps=found.steps, miss=found.target_errors.max())
    return found


def take_newton_step(
    corrector: PointCorrector, base: BaseFrame, targets: PointTargets, start: PointSolution
) -> PointSolution:
    """Take one whole step of a correction without limits, for a base that follows each step."""
    problem = PointProblem(corrector, base, targets, None)
    step, shift = problem.step_model(problem.state(start.x, start.shift)).solve_step()
    return problem.solution(problem.state(start.x + step, start.shift + shift), 1)


class ProblemState(NamedTuple):
    """A corrected frame, and the residuals of its points and rotations, (r,)."""

    frame: CorrectedFrame
    shift: complex
    residual: Floats
    barrier: BarrierState | None


class PointProblem:
    """One frame: its points as rows that are scaled by the roots of their weights."""

    def __init__(
        self,
        corrector: PointCorrector,
        base: BaseFrame,
        targets: PointTargets,
        walls: LimitBarrier | None,
    ) -> None:
        self.corrector, self.base, self.walls = corrector, base, walls
        self.gains = GAINS if walls is None else GAINS_AT_WALLS
        holes = len(corrector.boundary.holes)
        self.count = count = len(targets.offsets)
        places = CorrectedFrame.of(corrector, base, corrector.variables.nothing).places()
        self.of_points = np.concatenate([np.ones(count), np.zeros(holes)])
        # Targets are offsets from the base's positions; periods are closed.
        self.wanted = places * self.of_points
        self.wanted[:count] += targets.offsets
        turns = np.zeros(0) if targets.rotations is None else targets.rotations
        self.turned = np.flatnonzero(~np.isnan(turns))
        self.turns = turns[self.turned]
        weights = np.concatenate([targets.weights, np.ones(holes)])
        self.roots = np.sqrt(weights)
        give = np.zeros(count) if targets.compliances is None else targets.compliances
        self.loose = np.concatenate([1.0 - weights, 1.0 - weights, 0 * self.turns])
        self.give = np.concatenate([give, np.zeros(holes), give, np.zeros(holes), 0 * self.turns])
        forces = np.full(count, np.inf) if targets.yield_forces is None else targets.yield_forces
        size = corrector.boundary.size
        by_turn = (LEVER * size * forces[self.turned]) ** -3 / LEVER
        self.yields = np.concatenate([size / forces**3, np.zeros(holes), by_turn])
        own = np.arange(count + holes)
        self.group = np.concatenate([own, own, count + holes + np.arange(len(self.turned))])
        self.is_asked = bool(
            (targets.weights * np.abs(targets.offsets)).any()
            or self.turns.any()
            or np.abs(places[count:]).max(initial=0.0) > MET * size
        )
        along = (self.roots * self.of_points)[:, None]
        still = np.zeros_like(along)
        both = np.vstack([np.hstack([along, still]), np.hstack([still, along])])
        both = np.vstack([both, np.zeros((len(self.turned), 2))])
        is_free = not targets.is_anchored and bool(targets.weights.any())
        self.translations = both if is_free else both[:, :0]
        # Rows without compliance that do not yield.
        self.held = (self.loose == 0) & (self.give == 0) & (self.yields == 0)[self.group]

    def state(self, x: Floats, shift: complex, last: BarrierState | None = None) -> ProblemState:
        """Evaluate the residuals and the barrier, after a step from `last`."""
        walls = None if self.walls is None else self.walls.state(x, last)
        return self._without_barrier(x, shift)._replace(barrier=walls)

    def _without_barrier(self, x: Floats, shift: complex) -> ProblemState:
        frame = CorrectedFrame.of(self.corrector, self.base, x)
        lack = self.roots * (frame.places() + shift * self.of_points - self.wanted)
        turned = self.corrector.variables.at_points.h_of(x).imag[self.turned] - self.turns
        return ProblemState(frame, shift, np.concatenate([lack.real, lack.imag, turned]), None)

    def constraint_rows(self, at: ProblemState) -> Rows:
        """Return the linearized rows around a state."""
        none = np.zeros(len(self.turned), np.complex128)
        # Im h = Re (−i h).
        turning = self.corrector.variables.at_points.rows_at(self.turned, none - 1j, none)
        points = np.tile(self.roots, 2)[:, None] * at.frame.constraint_rows()
        scale = float(np.vdot(points, points)) / len(points)
        return Rows(
            at.residual,
            np.vstack([points, turning]),
            self.loose * scale + self.give,
            self.group,
            self.yields,
            self.translations,
        )

    def step_model(self, at: ProblemState) -> StepModel:
        pushed = None if self.walls is None or at.barrier is None else self.walls.model(at.barrier)
        return StepModel(at.frame.x, self.constraint_rows(at), pushed)

    def solve_steps(self, at: ProblemState) -> PointSolution:
        """Take steps from a state until they are small."""
        size, firm = self.corrector.boundary.size, 0.0
        h_of = self.corrector.variables.at_nodes.h_of
        most, small = (MOST_STEPS, SMALL) if self.walls is None else (MOST_STEPS_AT_WALLS, CALM)
        steps, is_finished = 0, True
        while steps < most:
            steps += 1
            model = self.step_model(at)
            rows = model.rows
            change, shift = model.solve_step()
            length = np.abs(of_change := h_of(change)).max()
            if length > SMALL:
                more, along = model.curvature_corrected(self._bending(at, model.pulls), change)
                # The curvature may change a step by at most the step itself.
                part = min(1.0, length / max(np.abs(of_more := h_of(more)).max(), TINY))
                change, shift = change + part * more, shift + part * along
                length = np.abs(of_change + part * of_more).max()
            firm = max(firm, FIRMEST * float(rows.sizes(model.pulls).max()))
            share = min(1.0, LONGEST / max(length, TINY))
            now = self._merit(at, rows.compliances, firm)
            for _ in range(MOST_HALVINGS):
                tried = self._tried(at, model, change * share, shift * share, share)
                merit = self._merit(tried, rows.compliances, firm)
                if merit <= now * (1 + 1e-12) and self._keeps_distance(at, tried):
                    break
                share /= 2
            # Part of a step never reaches these targets.
            if np.isinf(merit):
                break
            is_stuck = share < 1.0 and merit > self.gains * now
            moved = np.abs(h_of(tried.frame.x - at.frame.x)).max()
            off = np.abs(tried.residual)[self.held].max(initial=0.0)
            at = tried
            if self.walls is not None and at.barrier is not None and not self.walls.is_lowest:
                if is_stuck or (share > ENOUGH and moved < CLOSE):
                    self.walls, left = self.walls.with_lower_weight(at.barrier)
                    at = at._replace(barrier=left)
                continue
            if is_stuck or (moved < small and (off < MET * size or share < 1.0)):
                break
        else:
            is_finished = False
        return replace(self.solution(at, steps), is_finished=is_finished)

    def solution(self, at: ProblemState, steps: int) -> PointSolution:
        misses = np.abs(at.frame.places() + at.shift - self.wanted)[: self.count]
        return PointSolution(x=at.frame.x, shift=at.shift, target_errors=misses, steps=steps)

    def _bending(self, at: ProblemState, pulls: Floats) -> Form:
        """Return the curvature of the rows with pulls."""
        real, imaginary, _ = np.split(pulls, [len(self.roots), 2 * len(self.roots)])
        return at.frame.curvature(-self.roots * (real + 1j * imaginary)).__call__

    def _tried(
        self, at: ProblemState, model: StepModel, change: Floats, shift: complex, share: float
    ) -> ProblemState:
        """Return the state after a step, with points back at the model's positions."""
        tried = self.state(at.frame.x + change, at.shift + shift, at.barrier)
        if tried.barrier is not None and tried.barrier.slacks.min() <= 0:
            return tried
        found = self.restored(tried, model, (1 - share) * at.residual)
        if self.walls is None or found is tried:
            return found
        return found._replace(barrier=self.walls.state(found.frame.x, at.barrier))

    def restored(self, tried: ProblemState, model: StepModel, aim: Floats) -> ProblemState:
        """Return a state, without a barrier, whose held rows are closer to the residuals `aim`."""
        for _ in range(MOST_RETURNS):
            gap = np.where(self.held, aim - tried.residual, 0)
            worst = np.abs(gap).max(initial=0.0)
            if worst < MET / 100 * self.corrector.boundary.size:
                break
            back, along = model.restoring_step(gap)
            nearer = self._without_barrier(tried.frame.x + back, tried.shift + along)
            if np.abs(np.where(self.held, aim - nearer.residual, 0)).max() > NEARER * worst:
                break
            tried = nearer
        return tried

    def _keeps_distance(self, at: ProblemState, tried: ProblemState) -> bool:
        """Return whether a step takes no more than a part of the way to a limit."""
        if self.walls is None or at.barrier is None or tried.barrier is None:
            return True
        now = np.minimum(at.barrier.slacks, self.walls.width)
        return bool((tried.barrier.slacks >= APART * now).all())

    def _merit(self, at: ProblemState, soft: Floats, firm: float) -> float:
        """Return ½ |x|², the barrier and the work of the pulls; equalities pull with `firm`."""
        count = len(self.yields)
        lacks = np.sqrt(np.bincount(self.group, at.residual**2, minlength=count))
        own = np.zeros(count)
        own[self.group] = soft
        pulled = float(work_of_pulls(lacks, own, self.yields, firm).sum())
        total = 0.5 * float(at.frame.x @ at.frame.x) + pulled
        if self.walls is not None and at.barrier is not None:
            total += self.walls.energy(at.barrier)
        return total
