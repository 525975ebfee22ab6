"""The smallest correction with which points are where they are wanted.

    minimise ½ |x|²  where  w_i (place_i(x) + t − wanted_i) = 0,

t a translation, 0 where the anchor stays; periods around holes are closed by further rows. A point
of weight w < 1 gives in by (1 − w) / w times its pull, so that it lets go as w falls to 0. Each
step solves the model in which the rows J are linear, exactly, in the few dimensions of the points:

    (J M⁻¹ Jᵀ + C) μ + T t = −(r − J M⁻¹ g),    Tᵀ μ = 0,    δ = M⁻¹ (Jᵀ μ − g),

and then what the rows' own curvature changes of it, by conjugate gradients. Only where a limit of
the distortion is passed, or a pull would be too large, it is solved again with walls (`limits`
beside this module), which get stiffer, and points that give in beyond their largest pull.
"""

from dataclasses import dataclass
from math import inf
from typing import NamedTuple

import numpy as np

from engine.arrays import Complexes, Floats
from engine.deform.relative.correction.corrector import PointCorrector
from engine.deform.relative.correction.frame import BaseFrame, CorrectedFrame
from engine.deform.relative.correction.limits import Felt, LimitWalls
from engine.deform.relative.correction.step_model import PointRows, StepModel

SMALL = 1e-6  # a step in h: where the iteration ends
MET = 1e-11  # of the diagonal: points that are where they are wanted
LONGEST = 1.0  # step in h
MOST_STEPS, MOST_HALVINGS = 40, 7
STIFFNESSES = (50.0, 300.0, 2000.0)  # of the walls, one after the other
LARGEST_PULL = 0.5  # of a point where walls are felt


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
    is_held_back : bool
        Whether a limit is reached.
    """

    x: Floats
    shift: complex
    misses: Floats
    steps: int
    is_held_back: bool


def solve(
    corrector: PointCorrector,
    base: BaseFrame,
    targets: Targets,
    walls: LimitWalls | None = None,
    start: PointSolution | None = None,
) -> PointSolution:
    """Find the correction of one frame.

    Parameters
    ----------
    corrector : PointCorrector
    base : BaseFrame
        At the nodes of the corrector's paths.
    targets : Targets
    walls : LimitWalls, optional
        Not to be passed.
    start : PointSolution, optional
        Of a frame that is much the same.
    """
    problem = _Problem(corrector, base, targets)
    count = 2 * corrector.variables.count
    if not problem.is_asked:
        return PointSolution(
            x=np.zeros(count),
            shift=0j,
            misses=np.zeros(len(targets.moves)),
            steps=0,
            is_held_back=False,
        )
    at = problem.state(
        np.zeros(count) if start is None else start.x, 0j if start is None else start.shift
    )
    if start is None or not start.is_held_back:
        found, steps = problem.solved(at)
        is_inside = np.abs(found.pulls).max(initial=0.0) <= LARGEST_PULL
        if walls is None or (is_inside and not walls.are_passed(found.x)):
            return problem.found(found, steps, is_held_back=False)
        at = problem.state(np.zeros(count), 0j)
    steps = 0
    for stiffness in STIFFNESSES:
        at, more = problem.solved(at, walls, stiffness)
        steps += more
    return problem.found(at, steps, is_held_back=True)


class _State(NamedTuple):
    """A corrected frame, and what the points lack there, complex128 (m + holes,), by their roots.

    `pulls` are those of the step that led there.
    """

    frame: CorrectedFrame
    shift: complex
    lack: Complexes
    pulls: Complexes

    @property
    def x(self) -> Floats:
        """The unknowns."""
        return self.frame.x


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

    def state(self, x: Floats, shift: complex, pulls: Complexes | None = None) -> _State:
        """Work out what the points lack."""
        frame = CorrectedFrame.of(self.corrector, self.base, x)
        lack = self.roots * (frame.places() + shift * self.of_points - self.wanted)
        return _State(frame, shift, lack, np.zeros_like(lack) if pulls is None else pulls)

    def found(self, at: _State, steps: int, *, is_held_back: bool) -> PointSolution:
        """Pack the end of a search."""
        misses = np.abs(at.frame.places() + at.shift - self.wanted)[: self.count]
        return PointSolution(
            x=at.x, shift=at.shift, misses=misses, steps=steps, is_held_back=is_held_back
        )

    def solved(
        self, at: _State, walls: LimitWalls | None = None, stiffness: float = 0.0
    ) -> tuple[_State, int]:
        """Take steps from a state until they are small."""
        most = np.where(self.of_points > 0, LARGEST_PULL, inf) if walls is not None else inf
        limit = np.broadcast_to(np.asarray(most, dtype=np.float64), self.roots.shape)
        heavy, size = 0.0, self.corrector.boundary.size
        small = SMALL if walls is None else 100 * SMALL
        gives: Floats | None = None
        for step in range(1, MOST_STEPS + 1):
            felt = None if walls is None else walls.felt(at.x, stiffness)
            model = StepModel(at.x, at.lack, at.frame.rows(), self.rows, felt)
            gives = model.settle(limit, gives)
            change, shift = model.step()
            if self._size(change) > small:
                bending = at.frame.bending(-self.roots * model.pulls)
                more, along = model.bent(bending, change)
                change, shift = change + more, shift + along
            heavy = max(heavy, 1.5 * float(np.abs(model.pulls).max(initial=0.0)))
            cap = np.minimum(limit, heavy)
            length = min(1.0, LONGEST / max(self._size(change), 1e-300))
            now = self._merit(at, felt, model.soft, cap)
            for _ in range(MOST_HALVINGS):
                tried = self._tried(at, model, change, shift, length)
                ahead = None if walls is None else walls.felt(tried.x, stiffness)
                is_unfolded = walls is None or ahead is not None
                if is_unfolded and self._merit(tried, ahead, model.soft, cap) <= now * (1 + 1e-12):
                    break
                length /= 2
            moved = self._size(tried.x - at.x)
            held = model.gives <= model.soft
            off = np.abs(tried.lack - (1 - length) * at.lack)[held & (self.weights == 1.0)]
            at = tried._replace(pulls=model.pulls)
            if moved < small and (length < 1.0 or off.max(initial=0.0) < MET * size or step > 8):
                break
        return at, step

    def _size(self, change: Floats) -> float:
        return float(np.abs(self.corrector.variables.at_nodes.h_of(change)).max())

    def _tried(
        self, at: _State, model: StepModel, change: Floats, shift: complex, length: float
    ) -> _State:
        """Return the state after a part of a step, with points back on where the model has them."""
        tried = self.state(at.x + length * change, at.shift + length * shift)
        aim = (1 - length) * at.lack + length * model.left(change, shift)
        held = model.gives <= model.soft
        for _ in range(3):
            gap = np.where(held, aim - tried.lack, 0)
            worst = np.abs(gap).max(initial=0.0)
            if worst < MET / 10 * self.corrector.boundary.size:
                break
            back, along = model.restoring(gap)
            nearer = self.state(tried.x + back, tried.shift + along)
            if np.abs(np.where(held, aim - nearer.lack, 0)).max() > 0.7 * worst:
                break
            tried = nearer
        return tried

    def _merit(self, at: _State, felt: Felt | None, soft: Floats, cap: Floats) -> float:
        """Return ½ |x|² with the walls' penalty and that of what points lack."""
        lack, give = np.abs(at.lack), cap * soft
        near = lack**2 / (2 * np.maximum(soft, 1e-300))
        pulled = np.where(lack <= give, near, cap * (lack - give / 2))
        wall = 0.0 if felt is None else felt.value
        return 0.5 * float(at.x @ at.x) + float(pulled.sum()) + wall
