"""One step of the solver: its model, solved exactly in the few dimensions of the points."""

from typing import NamedTuple

import numpy as np
import scipy.linalg

from engine.arrays import Complexes, Floats, Indices
from engine.deform.relative.correction.frame import Bending

RIDGE = 1e-13  # of the mean of the rows' products
MOST_BENDS = 30  # steps of the conjugate gradients
NEARLY = 1e-4  # of what the curvature changes: what may be left of it
CURVED = 1e-2  # of the metric: the least curvature along which steps are taken


class PointRows(NamedTuple):
    """What of the points' rows is the same in all steps.

    Parameters
    ----------
    weights : float64, shape (m,)
    translations : float64, shape (2m, 2) or (2m, 0)
        How a translation moves the points, times the roots of their weights.
    """

    weights: Floats
    translations: Floats


class StepModel:
    """The quadratic model around unknowns, with linear rows of the points.

    Parameters
    ----------
    x : float64, shape (2N,)
    lack : complex128, shape (m,)
        What the points lack, times the roots of their weights.
    rows : float64, shape (2m, 2N)
        Its derivatives without these roots.
    points : PointRows

    Attributes
    ----------
    pulls : complex128, shape (m,)
        The multipliers of the rows.
    soft : float64, shape (m,)
        By how much points give in, over their pulls.
    """

    def __init__(self, x: Floats, lack: Complexes, rows: Floats, points: PointRows) -> None:
        self._x, self._translations = x, points.translations
        self._rows = np.sqrt(np.tile(points.weights, 2))[:, None] * rows
        products = self._rows @ self._rows.T
        scale = float(np.trace(products)) / len(products)
        self.soft = (1.0 - points.weights) * scale
        count, more = self._translations.shape
        matrix = np.zeros((count + more, count + more))
        matrix[:count, :count] = products
        matrix[:count, count:] = self._translations
        matrix[count:, :count] = self._translations.T
        diagonal = np.arange(count)
        matrix[diagonal, diagonal] += RIDGE * scale
        self._held = _factored(matrix)
        matrix[diagonal, diagonal] += np.tile(self.soft, 2)
        self._soft = _factored(matrix)
        right = self._rows @ x - np.concatenate([lack.real, lack.imag])
        self._pulled, self._shift = self._solve(self._soft, right)
        real, imaginary = np.split(self._pulled, 2)
        self.pulls = real + 1j * imaginary

    def step(self) -> tuple[Floats, complex]:
        """Return the step in the unknowns and the translation."""
        return self._pulled @ self._rows - self._x, self._shift

    def restoring(self, gap: Complexes) -> tuple[Floats, complex]:
        """Return the least step that moves the points by so much."""
        pulls, shift = self._solve(self._held, np.concatenate([gap.real, gap.imag]))
        return pulls @ self._rows, shift

    def bent(self, bending: Bending, step: Floats) -> tuple[Floats, complex]:
        """Return what the curvature of the points changes of a step, by conjugate gradients."""
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
        pulls, shift = self._solve(self._soft, -(self._rows @ v))
        return v + pulls @ self._rows, shift

    def _solve(self, factors: tuple[Floats, Indices], right: Floats) -> tuple[Floats, complex]:
        count, more = self._translations.shape
        found = scipy.linalg.lu_solve(factors, np.append(right, np.zeros(more)), check_finite=False)
        shift = complex(*found[count:]) if more else 0j
        return found[:count], shift


def _factored(matrix: Floats) -> tuple[Floats, Indices]:
    factor, pivots = scipy.linalg.lu_factor(matrix, check_finite=False)
    return np.asarray(factor), np.asarray(pivots)
