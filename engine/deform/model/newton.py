"""Projected Newton's method for the objective of a drag."""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from engine.arrays import Booleans, Complexes, Floats
from engine.deform.handles import Handles
from engine.deform.model.energy import RadialDerivatives
from engine.deform.model.evaluation import Evaluation
from engine.deform.model.factors import (
    SHIFT,
    factor_regularised,
    factor_shifted,
    factor_single,
    solve_factored,
)
from engine.deform.model.hessian import (
    Reals,
    hessian_product,
    negative_part,
    projected_hessian,
    single_hessian,
)
from engine.deform.model.objective import Objective

# A step is accepted when it gains at least this part of the first-order gain (Armijo).
SUFFICIENT = 1e-4
# A step stops where this part of the way to the nearest bound is used up.
TO_THE_BARRIER = 0.9
SHORTEST = 1e-6
# Conjugate gradients stop at this relative residual, or after so many rounds. Measured: a smaller
# residual brings drags no nearer to their targets.
REFINED = 0.3
REFINEMENTS = 4
# A factor serves so many steps, as long as it takes at most so many rounds and leaves no more than
# this residual. A factor of another map's Hessian measures the residual less well. Measured: drags
# then get as near to their targets as with a new factor for each step.
SERVES_STEPS = 8
SERVES_ROUNDS = 2
REFINED_LATER = 0.1
# Parts of the negative curvature that are tried to be left in the Hessian.
KEPT_NEGATIVE = (1.0, 0.5, 0.25, 0.1)


class Direction(NamedTuple):
    """A Newton direction.

    Parameters
    ----------
    phi, psi : complex128, shape (n,)
        The change of the coefficients, including the logarithms; psi_0 stays.
    evaluation : Evaluation
        Of the same change.
    derivative : float
        Of the objective along the direction, negative. Half its size is the gain that the quadratic
        model expects.
    """

    phi: Complexes
    psi: Complexes
    evaluation: Evaluation
    derivative: float

    def scaled(self, factor: float) -> "Direction":
        return Direction(
            factor * self.phi,
            factor * self.psi,
            self.evaluation.scaled(factor),
            factor * self.derivative,
        )

    def plus(self, other: "Direction") -> "Direction":
        return Direction(
            self.phi + other.phi,
            self.psi + other.psi,
            self.evaluation.advanced(1.0, other.evaluation),
            self.derivative + other.derivative,
        )


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Model:
    """A positive quadratic model of the objective at a map, its Hessian factored.

    Parameters
    ----------
    gradient : float64, shape (u,)
    hessian : float64, shape (u, u)
        Its upper triangle.
    factor : float64, shape (u, u)
        Cholesky factor, in the lower triangle in LAPACK's order.
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
        return replace(self, hessian=hessian, factor=factor_shifted(hessian))

    def direction(self, gradient: Floats | None = None) -> Direction:
        """Return the step to the minimum, or to that of another `gradient` (u,)."""
        solution = solve_factored(self.factor, self.gradient if gradient is None else gradient)
        return _direction(
            self.objective, self.gradient, solution, self.objective.evaluate_change(solution)
        )


class Preconditioner(NamedTuple):
    """A factored Hessian that serves several steps in a row.

    Far from the bounds a step changes the map little, and its Hessian as well.

    Parameters
    ----------
    rotation_constraints : bool, shape (h,)
        Which handles had a prescribed rotation.
    factor : float32 or float64, shape (u, u)
    served_steps : int
        Steps that used the factor.
    """

    handles: Handles
    rotation_constraints: Booleans
    factor: Reals
    served_steps: int = 0

    def can_serve(self, objective: Objective) -> bool:
        """Whether the objective has the same handles and rotation constraints."""
        return self.handles is objective.handles and np.array_equal(
            self.rotation_constraints, objective.rotation_constraints
        )

    def after_step(self, rounds: int) -> "Preconditioner | None":
        """Return the preconditioner for the next step, or None if a new factor pays.

        `rounds` are the rounds of conjugate gradients of the last step.
        """
        served = self.served_steps + 1
        pays = rounds <= SERVES_ROUNDS and served < SERVES_STEPS
        return self._replace(served_steps=served) if pays else None


def newton_direction(objective: Objective, jet: Evaluation) -> Direction:
    """Solve for the step that minimises the projected quadratic model of the objective."""
    direction, _ = preconditioned_direction(objective, jet, None)
    return direction


def preconditioned_direction(
    objective: Objective, jet: Evaluation, earlier: Preconditioner | None
) -> tuple[Direction, Preconditioner | None]:
    """Solve for Newton's step with an earlier factor; return the preconditioner of the next step.

    By preconditioned conjugate gradients (Nocedal and Wright, algorithm 5.3). Factors in single
    precision do as well.
    """
    radial = objective.radial_derivatives(jet)
    gradient = objective.gradient(jet, radial)
    if earlier is not None and earlier.can_serve(objective):
        direction, rounds = _refined(
            objective, jet, radial, gradient, earlier.factor, missing=REFINED_LATER
        )
        if rounds <= REFINEMENTS:
            return direction, earlier.after_step(rounds)
    single = single_hessian(objective, jet, radial)
    factor: Reals | None = None if single is None else factor_single(single)
    if factor is None:
        factor = factor_shifted(projected_hessian(objective, jet, radial))
    direction, rounds = _refined(objective, jet, radial, gradient, factor, missing=REFINED)
    return direction, Preconditioner(
        objective.handles, objective.rotation_constraints, factor
    ).after_step(rounds)


def _refined(
    objective: Objective,
    jet: Evaluation,
    radial: RadialDerivatives,
    gradient: Floats,
    factor: Reals,
    *,
    missing: float,
) -> tuple[Direction, int]:
    """Return the step of conjugate gradients to the relative residual `missing`, and its rounds.

    If that takes too many rounds, one more than the rounds taken.
    """
    left, ahead = gradient, solve_factored(factor, gradient)
    solution, measured = np.zeros_like(gradient), None
    first = before = float(left @ ahead)
    rounds = REFINEMENTS + 1
    for done in range(1, REFINEMENTS + 1):
        change = objective.evaluate_change(ahead)
        curved = hessian_product(objective, jet, radial, change)
        curvature = float(ahead @ curved)
        if not curvature > 0:
            break
        length = before / curvature
        solution, left = solution + length * ahead, left - length * curved
        measured = measured.advanced(length, change) if measured else change.scaled(length)
        following = solve_factored(factor, left)
        now = float(left @ following)
        if now < missing**2 * first:
            rounds = done
            break
        ahead, before = following + now / before * ahead, now
    measured = measured or objective.evaluate_change(solution)
    return _direction(objective, gradient, solution, measured), rounds


def newton_models(objective: Objective, jet: Evaluation) -> Iterator[Model]:
    """Yield positive definite quadratic models of the objective at a map, the last one projected.

    Earlier models keep all or part of the negative curvature, where the Hessian stays positive.
    Near a minimum their steps are Newton's own. Far from it they follow bent valleys that the
    projected model crawls along.
    """
    radial = objective.radial_derivatives(jet)
    hessian = projected_hessian(objective, jet, radial)
    gradient, removed = objective.gradient(jet, radial), negative_part(objective, jet, radial)
    for part in (*KEPT_NEGATIVE, 0.0):
        bent = hessian.copy()
        bent[: len(removed), : len(removed)] -= part * removed
        factor = factor_regularised(bent, SHIFT) if part else factor_shifted(hessian)
        if factor is not None:
            yield Model(
                objective=objective,
                gradient=gradient,
                hessian=bent,
                factor=factor,
                exact=part == 1.0,
            )


def line_search(
    objective: Objective, jet: Evaluation, direction: Direction, value: float, longest: float = 1.0
) -> tuple[float, Evaluation]:
    """Return the largest tried length, at most `longest`, that gains enough, and its evaluation.

    The length is 0 if none does. `value` is the objective at the start.
    """
    length = longest
    rounding = 1e-13 * abs(value)
    while length > SHORTEST:
        # The bound must be farther than the step, not only beyond it.
        if length < 1.0 and not objective.is_within(
            jet.advanced(length / TO_THE_BARRIER, direction.evaluation)
        ):
            length *= 0.7
            continue
        reached = jet.advanced(length, direction.evaluation)
        there = objective.value(reached)
        if there <= value + SUFFICIENT * length * direction.derivative + rounding:
            return length, reached
        length *= 0.5 if np.isfinite(there) else 0.7
    return 0.0, jet


def _direction(
    objective: Objective, gradient: Floats, solution: Floats, change: Evaluation
) -> Direction:
    """Return the direction that is the negative of a solution (u,), with its evaluation."""
    phi, psi = objective.coefficients(-solution)
    return Direction(phi, psi, change.scaled(-1.0), -float(gradient @ solution))
