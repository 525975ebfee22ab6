"""The solution of a slider's frame, before any points: ρ, r and h at given weights.

Constraints and curb alternate: h is found for the curbed frame, and the curb for the frame with h,
until neither changes the other. Steps are accelerated by the steps before (Anderson 1965).
"""

from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from engine.arrays import Complexes, Floats
from engine.dirichlet import Densities, Refinement
from engine.sliders.constraints import Constraints
from engine.sliders.curb import Curb, OutlinePoses

# The alternation ends when a round changes ln f_z by at most CLOSE on the boundary. After
# MOST_ROUNDS, or before a step above FAR, a change below ACCEPTED will do. Else the weights go back
# towards the first pose.
CLOSE, ACCEPTED, FAR, MOST_ROUNDS = 5e-5, 5e-4, 2.0, 20
REMEMBERED, DISTINCT = 6, 1e-6  # rounds; smaller relative differences of rounds are ignored
BACK, MOST_RETURNS = 0.85, 12


class FrameSolution(NamedTuple):
    """A frame before any points.

    Attributes
    ----------
    weights : float64, shape (q,)
    h : complex128, shape (j,), or None
        Coefficients of the constraints' functions.
    shift : complex
        Translation.
    densities : Densities or None
        Of H[r]; None for r = 0.
    rho, curbed, beyond, share
        As in `PoseFrame`.
    """

    weights: Floats
    h: Complexes | None
    shift: complex
    densities: Densities | None
    rho: float
    curbed: float
    beyond: float
    share: float


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class FrameSolver:
    """Solves frames from the poses on the boundary.

    `constraints` is None without holes and pins.
    """

    outline: OutlinePoses
    constraints: Constraints | None

    def solve(self, weights: Floats) -> FrameSolution:
        """Solve a frame, with weights nearer to the first pose if there is no solution."""
        first = np.zeros_like(weights)
        first[0] = 1.0
        for number in range(MOST_RETURNS):
            share = BACK**number
            found = self._alternate(first + share * (weights - first))
            if found.beyond <= ACCEPTED:
                return found._replace(share=share)
        return self._alternate(first)._replace(share=0.0)

    def _alternate(self, weights: Floats) -> FrameSolution:
        """Alternate between curb and constraints until neither changes the other."""
        constraints, holes = self.constraints, len(self.outline.transform.loops) - 1
        if constraints is None:
            curb = self.outline.curb(weights, None, np.zeros(1))
            return _packed(weights, curb, self._densities(curb), curb.excess)

        def largest(change: Floats) -> float:
            on_boundary = constraints.real_parts(change[holes:])
            return float(np.abs(np.append(change[:holes], on_boundary)).max())

        # The state is what the curb is for: a constant on each hole, and the unknowns of h. On a
        # hole ln |f_z| stays below u + r by a constant (`engine.dirichlet`), which must vanish.
        found = constraints.solve(weights, 1.0, None, None)
        state, step = np.append(np.zeros(holes), found.x), np.zeros(holes + len(found.x))
        states: list[Floats] = []
        misses: list[Floats] = []
        solutions: list[FrameSolution] = []
        while len(solutions) < MOST_ROUNDS and largest(step) <= FAR:
            state = state + step
            constants, x = np.append(0.0, state[:holes]), state[holes:]
            curb = self.outline.curb(weights, constraints.real_parts(x), constants)
            densities, lacking = self._densities(curb), np.zeros(holes)
            if densities is not None:
                lacking = densities.lacking[:, 0]
            if densities is not None or curb.rho < 1.0:
                found = constraints.solve(weights, curb.rho, densities, replace(found, x=x))
            miss = np.append(-lacking, found.x - x)
            change = largest(miss)
            beyond = change + curb.excess if found.is_finished else np.inf
            h = constraints.from_unknowns @ found.x
            solutions.append(_packed(weights, curb, densities, beyond, h, found.shift))
            if change <= CLOSE:
                break
            states, misses = [*states, state][-REMEMBERED:], [*misses, miss][-REMEMBERED:]
            step = _accelerated(np.array(states), np.array(misses))
        return min(solutions, key=lambda solution: solution.beyond)

    def _densities(self, curb: Curb) -> Densities | None:
        """Solve the Dirichlet problem of r."""
        if not curb.residual.any():
            return None
        return Refinement.of(self.outline.transform).solve(curb.residual[:, None])


def _packed(
    weights: Floats,
    curb: Curb,
    densities: Densities | None,
    beyond: float,
    h: Complexes | None = None,
    shift: complex = 0j,
) -> FrameSolution:
    curbed = float(np.abs(curb.residual).max())
    return FrameSolution(weights, h, shift, densities, curb.rho, curbed, beyond, share=1.0)


def _accelerated(states: Floats, misses: Floats) -> Floats:
    """Return a step (n,), from the last states (t, n) and what each of them misses."""
    by_state, by_miss = np.diff(states, axis=0), np.diff(misses, axis=0)
    shares = np.linalg.lstsq(by_miss.T, misses[-1], rcond=DISTINCT)[0]
    return np.asarray(misses[-1] - shares @ (by_state + by_miss))
