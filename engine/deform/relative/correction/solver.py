"""The smallest correction with which points are where they are wanted.

    minimise ½ |x|²  where  w_i (place_i(x) + t − wanted_i) = 0,

t a translation, 0 where the anchor stays; periods around holes are closed by further rows. A point
of weight w < 1 gives in by (1 − w) / w times its pull, so that it lets go as w falls to 0. Each
step solves the model in which the rows J are linear, exactly, in the few dimensions of the points:

    (J Jᵀ + C) μ + T t = −(r − J x),    Tᵀ μ = 0,    δ = Jᵀ μ − x,

and then what the rows' own curvature changes of it, by conjugate gradients.
"""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from engine.arrays import Complexes, Floats
from engine.deform.relative.correction.corrector import PointCorrector
from engine.deform.relative.correction.frame import BaseFrame, CorrectedFrame
from engine.deform.relative.correction.step_model import PointRows, StepModel

SMALL = 1e-6  # a step in h: where the iteration ends
MET = 1e-9  # of the diagonal: points that are where they are wanted
LONGEST = 1.0  # step in h
MOST_STEPS, MOST_HALVINGS, MOST_RETURNS = 25, 7, 3
NEARER = 0.7  # of the gap: what a step back to the points leaves of it, at most
GAINS = 0.99  # of the merit: what a part of a step leaves of it, at most
FIRMEST = 1.5  # times the largest pull: what the merit takes for each point off its target


class Targets(NamedTuple):
    """Where points are wanted.

    Parameters
    ----------
    moves : complex128, shape (m,)
        From where the base has them.
    weights : float64, shape (m,)
        From 0, free, to 1, held.
    is_anchored : bool
        Whether the anchor stays where it is.
    """

    moves: Complexes
    weights: Floats
    is_anchored: bool


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class PointSolution:
    """A correction.

    Parameters
    ----------
    x : float64, shape (2N,)
        In `Variables`.
    shift : complex
        By which all points are moved, too.
    misses : float64, shape (m,)
        How far points are from where they are wanted.
    steps : int
    """

    x: Floats
    shift: complex
    misses: Floats
    steps: int


def solve(
    corrector: PointCorrector,
    base: BaseFrame,
    targets: Targets,
    start: PointSolution | None = None,
) -> PointSolution:
    """Find the correction of one frame.

    Parameters
    ----------
    corrector : PointCorrector
    base : BaseFrame
        At the nodes of the corrector's paths.
    targets : Targets
    start : PointSolution, optional
        Of a frame that is much the same.
    """
    problem = _Problem(corrector, base, targets)
    if not problem.is_asked:
        nothing = np.zeros(2 * corrector.variables.count)
        return PointSolution(x=nothing, shift=0j, misses=np.abs(targets.moves), steps=0)
    if start is None:
        at = problem.state(np.zeros(2 * corrector.variables.count), 0j)
    else:
        at = problem.state(start.x, start.shift)
    return problem.solved(at)


class _State(NamedTuple):
    """A corrected frame, and what its points lack, (m + holes,), by the roots of their weights."""

    frame: CorrectedFrame
    shift: complex
    lack: Complexes


class _Problem:
    """One frame: its points as rows that are scaled by the roots of their weights."""

    def __init__(self, corrector: PointCorrector, base: BaseFrame, targets: Targets) -> None:
        self.corrector, self.base = corrector, base
        holes = len(corrector.boundary.holes)
        self.count = len(targets.moves)
        self.weights = np.concatenate([targets.weights, np.ones(holes)])
        self.roots = np.sqrt(self.weights)
        self.of_points = np.concatenate([np.ones(self.count), np.zeros(holes)])
        at_rest = np.zeros(2 * corrector.variables.count)
        places = CorrectedFrame.of(corrector, base, at_rest).places()
        # Points are moved from the base's places; periods are closed.
        self.wanted = places * self.of_points
        self.wanted[: self.count] += targets.moves
        self.is_asked = bool(
            (targets.weights * np.abs(targets.moves)).any()
            or np.abs(places[self.count :]).max(initial=0.0) > MET * corrector.boundary.size
        )
        along = (self.roots * self.of_points)[:, None]
        still = np.zeros_like(along)
        both = np.vstack([np.hstack([along, still]), np.hstack([still, along])])
        is_free = not targets.is_anchored and bool(targets.weights.any())
        self.rows = PointRows(self.weights, both if is_free else both[:, :0])

    def state(self, x: Floats, shift: complex) -> _State:
        """Work out what the points lack."""
        frame = CorrectedFrame.of(self.corrector, self.base, x)
        return _State(
            frame, shift, self.roots * (frame.places() + shift * self.of_points - self.wanted)
        )

    def solved(self, at: _State) -> PointSolution:
        """Take steps from a state until they are small."""
        size, firm = self.corrector.boundary.size, 0.0
        held = self.weights == 1.0
        steps = 0
        while steps < MOST_STEPS:
            steps += 1
            model = StepModel(at.frame.x, at.lack, at.frame.rows(), self.rows)
            change, shift = model.step()
            if self._length(change) > SMALL:
                bending = at.frame.bending(-self.roots * model.pulls)
                more, along = model.bent(bending, change)
                change, shift = change + more, shift + along
            firm = max(firm, FIRMEST * float(np.abs(model.pulls).max(initial=0.0)))
            share = min(1.0, LONGEST / max(self._length(change), 1e-300))
            now = self._merit(at, model.soft, firm)
            for _ in range(MOST_HALVINGS):
                tried = self._tried(at, model, change * share, shift * share, share)
                if self._merit(tried, model.soft, firm) <= now * (1 + 1e-12):
                    break
                share /= 2
            # What only parts of steps bring on is out of reach.
            is_stuck = share < 1.0 and self._merit(tried, model.soft, firm) > GAINS * now
            moved = self._length(tried.frame.x - at.frame.x)
            off = np.abs(tried.lack)[held].max(initial=0.0)
            at = tried
            if is_stuck or (moved < SMALL and (off < MET * size or share < 1.0)):
                break
        misses = np.abs(at.frame.places() + at.shift - self.wanted)[: self.count]
        return PointSolution(x=at.frame.x, shift=at.shift, misses=misses, steps=steps)

    def _length(self, change: Floats) -> float:
        return float(np.abs(self.corrector.variables.at_nodes.h_of(change)).max())

    def _tried(
        self, at: _State, model: StepModel, change: Floats, shift: complex, share: float
    ) -> _State:
        """Return the state after a step, with points back on where the model has them."""
        tried = self.state(at.frame.x + change, at.shift + shift)
        aim = (1 - share) * at.lack
        held = self.weights == 1.0
        for _ in range(MOST_RETURNS):
            gap = np.where(held, aim - tried.lack, 0)
            worst = np.abs(gap).max(initial=0.0)
            if worst < MET / 100 * self.corrector.boundary.size:
                break
            back, along = model.restoring(gap)
            nearer = self.state(tried.frame.x + back, tried.shift + along)
            if np.abs(np.where(held, aim - nearer.lack, 0)).max() > NEARER * worst:
                break
            tried = nearer
        return tried

    @staticmethod
    def _merit(at: _State, soft: Floats, firm: float) -> float:
        """Return ½ |x|² and what points lack: by their softness, and from some pull on as much."""
        lack, give = np.abs(at.lack), firm * soft
        near = lack**2 / (2 * np.maximum(soft, 1e-300))
        pulled = np.where(lack <= give, near, firm * (lack - give / 2))
        return 0.5 * float(at.frame.x @ at.frame.x) + float(pulled.sum())
