"""One step of the solver: its model, solved exactly in the few dimensions of its rows."""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
import scipy.linalg

from engine.arrays import Booleans, Floats, Indices

RIDGE = 1e-13  # of the mean of the rows' products
MOST_BENDS = 30  # steps of the conjugate gradients
NEARLY = 1e-4  # of what the curvature changes: what may be left of it
CURVED = 1e-2  # of the metric: the least curvature along which steps are taken
# Rounds in which bounded and one-sided pulls are found, and how exactly.
ROUNDS, LEFT_TO_GO = 8, 1e-3
LEAST_LACK = 1e-9

# A symmetric form of the unknowns, as its product with a vector (2N,).
Form = Callable[[Floats], Floats]


class Rows(NamedTuple):
    """Conditions on the unknowns, linearized; several rows may form a group.

    Parameters
    ----------
    lack : float64, shape (r,)
        The residuals.
    slopes : float64, shape (r, 2N)
        Their derivatives.
    soft : float64, shape (r,)
        Compliance: the residual that is left, over the pull.
    group : intp, shape (r,)
        The two coordinates of a point form one group.
    forces : float64, shape (g,)
        The largest pull of each group; infinite for an equality.
    pushes : bool, shape (r,)
        Inequalities: a negative residual counts for nothing.
    translations : float64, shape (r, 2) or (r, 0)
        Derivatives by a translation.
    """

    lack: Floats
    slopes: Floats
    soft: Floats
    group: Indices
    forces: Floats
    pushes: Booleans
    translations: Floats

    def sizes(self, values: Floats) -> Floats:
        """Return the length of each group, (g,), of values (r,)."""
        squares = np.bincount(self.group, values * values, minlength=len(self.forces))
        return np.asarray(np.sqrt(squares))


class StepModel:
    """The quadratic model around unknowns x.

    A group that would pull with more than its largest force pulls with that force: its rows get the
    compliance residual / force, by iteration (Holland and Welsch 1977). Of the inequalities, those
    that push are found by the primal-dual active set method.

    Attributes
    ----------
    pulls : float64, shape (r,)
        The multipliers of the rows; x + step is their sum with the rows' derivatives.
    """

    def __init__(self, x: Floats, rows: Rows) -> None:
        self._x, self._rows = x, rows
        self._products = rows.slopes @ rows.slopes.T
        self._ridge = RIDGE * float(np.trace(self._products)) / len(self._products)
        self._right = rows.slopes @ x - rows.lack
        self._find_pulls()

    def _find_pulls(self) -> None:
        rows = self._rows
        secant = np.maximum(rows.sizes(rows.lack), LEAST_LACK) / rows.forces
        give = np.zeros(len(rows.forces))
        idle = rows.pushes & (rows.lack <= 0)
        for _ in range(ROUNDS):
            self._factor(~idle, rows.soft + give[rows.group])
            self.pulls, self._shift = self._solve(self._right)
            pushing = np.where(idle, self._residuals() > 0, self.pulls < 0)
            changed = rows.pushes & (idle == pushing)
            idle = rows.pushes & ~pushing
            sizes = rows.sizes(self.pulls)
            over = (give == 0) & (sizes > rows.forces)
            share = np.where(give > 0, sizes / rows.forces, 1.0)
            is_found = (np.abs(share - 1.0) < LEFT_TO_GO).all()
            if is_found and not changed.any() and not over.any():
                break
            give = np.where(over, secant, give * share)

    def _residuals(self) -> Floats:
        """Return the rows' residuals after the step."""
        rows, (step, shift) = self._rows, self.step()
        left = rows.lack + rows.slopes @ step
        if rows.translations.shape[1]:
            left = left + rows.translations @ np.array([shift.real, shift.imag])
        return left

    def step(self) -> tuple[Floats, complex]:
        """Return the step in the unknowns and the translation."""
        return self.pulls @ self._rows.slopes - self._x, self._shift

    def restoring(self, gap: Floats) -> tuple[Floats, complex]:
        """Return the least step that changes the first rows by so much."""
        pulls, shift = self._solve(np.pad(gap, (0, len(self.pulls) - len(gap))))
        return pulls @ self._rows.slopes, shift

    def bent(self, bending: Form, step: Floats) -> tuple[Floats, complex]:
        """Return the change of a step by a curvature, by conjugate gradients."""
        rest = -bending(step)
        way, shift = self._preconditioned(rest)
        found, along = np.zeros_like(way), 0j
        push, more = rest, shift
        now = first = float(rest @ way)
        for _ in range(MOST_BENDS):
            if now <= 0:
                break
            bent = bending(way)
            own = float(way @ push)
            total = own + float(way @ bent)
            if total <= CURVED * own:
                break
            share = now / total
            found, along = found + share * way, along + share * more
            rest = rest - share * (push + bent)
            turned, shift = self._preconditioned(rest)
            new = float(rest @ turned)
            if new < NEARLY * first:
                break
            way, more, push, now = (
                turned + new / now * way,
                shift + new / now * more,
                rest + new / now * push,
                new,
            )
        return found, along

    def _preconditioned(self, v: Floats) -> tuple[Floats, complex]:
        pulls, shift = self._solve(-(self._rows.slopes @ v))
        return v + pulls @ self._rows.slopes, shift

    def _factor(self, active: Booleans, soft: Floats) -> None:
        """Factor the matrix of the pulls of some of the rows."""
        self._active = which = np.flatnonzero(active)
        translations = self._rows.translations[which]
        count, more = translations.shape
        matrix = np.zeros((count + more, count + more))
        matrix[:count, :count] = self._products[np.ix_(which, which)]
        matrix[:count, count:] = translations
        matrix[count:, :count] = translations.T
        diagonal = np.arange(count)
        matrix[diagonal, diagonal] += self._ridge + soft[which]
        self._factors = scipy.linalg.lu_factor(matrix, overwrite_a=True, check_finite=False)

    def _solve(self, right: Floats) -> tuple[Floats, complex]:
        count, more = len(self._active), self._rows.translations.shape[1]
        padded = np.append(right[self._active], np.zeros(more))
        found = scipy.linalg.lu_solve(self._factors, padded, check_finite=False)
        shift = complex(*found[count:]) if more else 0j
        pulls = np.zeros(len(right))
        pulls[self._active] = found[:count]
        return pulls, shift
