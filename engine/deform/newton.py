"""Projected Newton's method for the objective of a drag."""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
from scipy.linalg import blas, lapack

from engine.arrays import Complexes, Floats, Singles
from engine.deform.energy import Radial
from engine.deform.objective import Jet, Objective, Reals

# A step is accepted when it gains at least this part of what the gradient promises (Armijo).
SUFFICIENT = 1e-4
# A step stops where this part of the way to the nearest wall is used up.
TO_THE_WALL = 0.9
SHORTEST = 1e-6
# The diagonal is made larger by this part of itself and of a floor, and by more until the
# factorisation succeeds. Next to a wall the largest entries are 1e12 times the least, and no step
# may feel a part of their mean; the floor holds what moves nothing: without handles the whole, and
# around a tiny hole functions of the span that are one and the same. Entries of the energy are
# about 8.
SHIFT, SHIFT_GROWTH = 1e-13, 1e2
FLOOR = 1e5
# In single precision each pivot keeps at least this part of its diagonal, else too few digits of it
# are left. With handles it is some thousandths; with one alone, which leaves a rotation, 1e-7.
LEAST_PIVOT = 1e-4
# Conjugate gradients stop when this part of the step is missing, or after so many: one for a star
# in the open, two to four for drawings and at walls. Measured: with less missing drags get no
# nearer to their wishes.
REFINED = 0.3
REFINEMENTS = 4
# Parts of what the projection removes from the Hessian that are tried to be left in it.
KEPT_NEGATIVE = (1.0, 0.5, 0.25, 0.1)


class Direction(NamedTuple):
    """A Newton direction.

    Parameters
    ----------
    phi, psi : complex128, shape (n,)
        The change of the coefficients, those of logarithms included; psi_0 stays.
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
        return Direction(
            factor * self.phi,
            factor * self.psi,
            self.jet.scaled(factor),
            factor * self.derivative,
        )

    def plus(self, other: "Direction") -> "Direction":
        """Return the sum of two directions."""
        return Direction(
            self.phi + other.phi,
            self.psi + other.psi,
            self.jet.advanced(1.0, other.jet),
            self.derivative + other.derivative,
        )


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Model:
    """A positive quadratic model of the objective at a map, its Hessian factored.

    Parameters
    ----------
    objective : Objective
    gradient : float64, shape (u,)
    hessian : float64, shape (u, u)
        Its upper triangle.
    factor : float64, shape (u, u)
        Cholesky's, in its lower triangle as LAPACK sees it.
    exact : bool
        Whether nothing was projected: the objective itself is convex at the map.
    """

    objective: Objective
    gradient: Floats
    hessian: Floats
    factor: Floats
    exact: bool

    def stiffened(self, added: Floats) -> "Model":
        """Return the model with a positive semidefinite matrix added to its Hessian."""
        hessian = self.hessian + added
        return replace(self, hessian=hessian, factor=_factor_shifted(hessian))

    def direction(self, gradient: Floats | None = None) -> Direction:
        """Return the step to the minimum, or to that of another `gradient` (u,)."""
        solution = _solution(self.factor, self.gradient if gradient is None else gradient)
        return _direction(self.objective, self.gradient, solution, self.objective.change(solution))


def newton_direction(objective: Objective, jet: Jet) -> Direction:
    """Solve for the step that minimises the projected quadratic model of the objective.

    By the method of conjugate gradients over all samples, with a sketch as preconditioner (Nocedal
    and Wright, algorithm 5.3). A sketch misses what shows between its samples only: by itself it
    would lead a drag into walls, and never come to rest. One in single precision does as well.
    """
    radial = objective.radial(jet)
    gradient = objective.gradient(jet, radial)
    sketch = objective.single_hessian(jet, radial)
    factor: Reals | None = None if sketch is None else _factor_single(sketch)
    if factor is None:
        factor = _factor_shifted(objective.hessian(jet, radial))
    left, ahead = gradient, _solution(factor, gradient)
    solution, measured = np.zeros_like(gradient), None
    first = before = float(left @ ahead)
    for _ in range(REFINEMENTS):
        change = objective.change(ahead)
        curved = objective.product(jet, radial, change)
        curvature = float(ahead @ curved)
        if not curvature > 0:
            break
        length = before / curvature
        solution, left = solution + length * ahead, left - length * curved
        measured = measured.advanced(length, change) if measured else change.scaled(length)
        following = _solution(factor, left)
        now = float(left @ following)
        if now < REFINED**2 * first:
            break
        ahead, before = following + now / before * ahead, now
    return _direction(objective, gradient, solution, measured or objective.change(solution))


def newton_models(objective: Objective, jet: Jet) -> Iterator[Model]:
    """Yield quadratic models of the objective at a map, all positive, the last one projected.

    Those before leave in the Hessian all that the projection removes, or parts of it, where it
    stays positive: near a minimum steps are Newton's own, and far from it they follow bent valleys
    that the projection crawls along.
    """
    radial = objective.radial(jet)
    hessian = objective.hessian(jet, radial)
    removed = objective.negative_part(jet, radial)
    for part in KEPT_NEGATIVE:
        bent = hessian.copy()
        bent[: len(removed), : len(removed)] -= part * removed
        factor = _factor(bent, SHIFT)
        if factor is not None:
            gradient = objective.gradient(jet, radial)
            yield Model(
                objective=objective,
                gradient=gradient,
                hessian=bent,
                factor=factor,
                exact=part == 1.0,
            )
    yield _model(objective, jet, radial, hessian)


def _model(objective: Objective, jet: Jet, radial: Radial, hessian: Floats) -> Model:
    return Model(
        objective=objective,
        gradient=objective.gradient(jet, radial),
        hessian=hessian,
        factor=_factor_shifted(hessian),
        exact=False,
    )


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


def _factor_shifted(hessian: Floats) -> Floats:
    """Factor a positive semidefinite matrix, given by its upper triangle, with a shift it needs."""
    shift = SHIFT
    # Twelve tries reach far beyond any diagonal: then the numbers themselves are at their end.
    for _ in range(12):
        factor = _factor(hessian, shift)
        if factor is not None:
            return factor
        shift *= SHIFT_GROWTH
    # Nothing helps: an infinite Hessian, whose steps are 0.
    return np.diag(np.full(len(hessian), np.inf))


def _factor(hessian: Floats, shift: float) -> Floats | None:
    """Factor a matrix given by its upper triangle, with a part of its diagonal and a floor added.

    None if it is not positive.
    """
    shifted = hessian.copy()
    np.fill_diagonal(shifted, (1.0 + shift) * hessian.diagonal() + shift * FLOOR)
    # Seen as Fortran order the upper triangle is the lower one.
    factor, failed = lapack.dpotrf(shifted.T, lower=1, clean=0, overwrite_a=1)
    return None if failed else factor


def _factor_single(hessian: Singles) -> Singles | None:
    """Factor in place a matrix given by its upper triangle, or None if too many digits are lost."""
    diagonal = hessian.diagonal().copy()
    factor: Singles
    factor, failed = lapack.spotrf(hessian.T, lower=1, clean=0, overwrite_a=1)
    if failed or np.any(factor.diagonal() ** 2 < LEAST_PIVOT * diagonal):
        return None
    return factor


def _solution(factor: Reals, wanted: Floats) -> Floats:
    """Return the solution (u,) for what is wanted (u,), of a factored matrix."""
    trsv = blas.strsv if factor.dtype == np.float32 else blas.dtrsv
    # Two solves with vectors: `dpotrs` takes three times as long for one.
    half = trsv(factor, wanted, lower=1)
    solution: Floats = trsv(factor, half, lower=1, trans=1, overwrite_x=1).astype(np.float64)
    return solution


def _direction(objective: Objective, gradient: Floats, solution: Floats, change: Jet) -> Direction:
    """Return the direction that is the negative of a solution (u,), measured as a change."""
    phi, psi = objective.coefficients(-solution)
    return Direction(phi, psi, change.scaled(-1.0), -float(gradient @ solution))
