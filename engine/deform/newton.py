"""Projected Newton's method for the objective of a drag."""

from typing import NamedTuple

import numpy as np
from scipy.linalg import lapack

from engine.arrays import Complexes, Floats
from engine.deform.objective import Jet, Objective

# A step is accepted when it gains at least this part of what the gradient promises (Armijo).
SUFFICIENT = 1e-4
# A step stops where this part of the way to the nearest wall is used up.
TO_THE_WALL = 0.9
SHORTEST = 1e-6
# Added to the diagonal, relative to its mean; multiplied until the factorisation succeeds.
SHIFT, SHIFT_GROWTH = 1e-10, 1e2


class Direction(NamedTuple):
    """A Newton direction.

    Parameters
    ----------
    phi, psi : complex128, shape (n,)
        The change of the coefficients; psi_0 stays.
    jet : Jet
        The same change, measured.
    derivative : float
        Of the objective along the direction, negative. Half its size is the gain that the quadratic
        model expects.
    """

    phi: Complexes
    psi: Complexes
    jet: Jet
    derivative: float

    def scaled(self, factor: float) -> "Direction":
        """Return the direction times a factor."""
        jet = Jet(*(factor * part for part in self.jet))
        return Direction(factor * self.phi, factor * self.psi, jet, factor * self.derivative)


def newton_direction(objective: Objective, jet: Jet) -> Direction:
    """Solve for the step that minimises the projected quadratic model of the objective."""
    radial = objective.radial(jet)
    gradient = objective.gradient(jet, radial)
    solution = _solve(objective.hessian(jet, radial), gradient)
    derivative = -float(gradient @ solution)
    # The unknowns are the conjugates (see `objective`).
    change = -solution.view(np.complex128).conj()
    n = len(objective.boundary.cage)
    phi, psi = change[:n], np.concatenate([[0.0], change[n:]])
    return Direction(phi, psi, objective.jet(phi, psi), derivative)


def line_search(
    objective: Objective, jet: Jet, direction: Direction, value: float, longest: float = 1.0
) -> float:
    """Return the largest tried length, at most `longest`, that gains enough; 0 if none does.

    Parameters
    ----------
    objective : Objective
    jet : Jet
        Of the map at the start.
    direction : Direction
    value : float
        Of the objective at the start.
    """
    length = longest
    rounding = 1e-13 * abs(value)
    while length > SHORTEST:
        # The wall must be farther than the step, not only beyond it.
        if length < 1.0 and not objective.within(jet.advanced(length / TO_THE_WALL, direction.jet)):
            length *= 0.7
            continue
        reached = objective.value(jet.advanced(length, direction.jet))
        if reached <= value + SUFFICIENT * length * direction.derivative + rounding:
            return length
        length *= 0.5 if np.isfinite(reached) else 0.7
    return 0.0


def _solve(hessian: Floats, gradient: Floats) -> Floats:
    """Solve with the upper triangle of a positive semidefinite matrix; 0 if nothing helps."""
    diagonal = hessian.diagonal().copy()
    shift = SHIFT * float(diagonal.mean())
    # Twelve tries reach far beyond any diagonal: then the numbers themselves are at their end.
    for _ in range(12):
        shifted = hessian.copy()
        np.fill_diagonal(shifted, diagonal + shift)
        # Seen as Fortran order the upper triangle is the lower one.
        factor, failed = lapack.dpotrf(shifted.T, lower=1, overwrite_a=1)
        if not failed:
            solution, _ = lapack.dpotrs(factor, gradient, lower=1)
            return np.ascontiguousarray(solution)
        shift *= SHIFT_GROWTH
    return np.zeros_like(gradient)
