"""One step of the solver: its model, solved exactly in the few dimensions of the points."""

from typing import NamedTuple

import numpy as np
import scipy.linalg

from engine.arrays import Complexes, Floats, Indices
from engine.deform.relative.correction.frame import Bending
from engine.deform.relative.correction.limits import Felt

RIDGE = 1e-13  # of the mean of the rows' products
MOST_BENDS = 30  # steps of the conjugate gradients


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
    """The quadratic model around unknowns: the metric M = 1 + R Rᵀ of the walls, and rows J.

    Parameters
    ----------
    x : float64, shape (2N,)
    lack : complex128, shape (m,)
        What the points lack, times the roots of their weights.
    rows : float64, shape (2m, 2N)
        Its derivatives without these roots.
    points : PointRows
    felt : Felt, optional
        The walls.
    """

    def __init__(
        self, x: Floats, lack: Complexes, rows: Floats, points: PointRows, felt: Felt | None
    ) -> None:
        self.rows = np.sqrt(np.tile(points.weights, 2))[:, None] * rows
        self.translations = points.translations
        self.lack = np.concatenate([lack.real, lack.imag])
        self._metric: tuple[Floats, bool] | None = None
        gradient = x
        if felt is not None and len(felt.rows):
            metric = felt.rows.T @ felt.rows
            metric[np.diag_indices_from(metric)] += 1.0
            self._metric = scipy.linalg.cho_factor(metric, lower=True, check_finite=False)
            gradient = x + felt.pressed @ felt.rows
        self.free = -self._inverse(gradient)
        self._spread = self._inverse(self.rows.T)
        self._products = self.rows @ self._spread
        self._scale = float(np.trace(self._products)) / len(self._products)
        self.soft = (1.0 - points.weights) * self._scale
        self.gives, self.pulls = self.soft, np.zeros(len(self.soft), dtype=np.complex128)

    def settle(self, limit: Floats, gives: Floats | None) -> Floats:
        """Find by how much points give in, so that no pull is beyond its limit, and the pulls."""
        self.gives = self.soft if gives is None else np.maximum(self.soft, gives)
        right = -(self.lack + self.rows @ self.free)
        bounded = np.isfinite(limit)
        for _ in range(40):
            self._factor()
            self._pulled, self._shift = self._solve(right)
            real, imaginary = np.split(self._pulled, 2)
            size = np.hypot(real, imaginary)
            wanted = np.maximum(self.soft, np.where(bounded, self.gives * size / limit, 0.0))
            begins = bounded & (size > limit * (1 + 1e-6)) & (self.gives <= self.soft)
            wanted[begins] = np.maximum(wanted[begins], 0.05 * self._scale)
            apart = np.abs(wanted - self.gives) > 1e-3 * self.gives + 1e-9 * self._scale
            if not bounded.any() or not apart.any():
                break
            self.gives = wanted
        self.pulls = real + 1j * imaginary
        return self.gives

    def step(self) -> tuple[Floats, complex]:
        """Return the step in the unknowns and the translation."""
        return self.free + self._spread @ self._pulled, self._shift

    def left(self, change: Floats, shift: complex) -> Complexes:
        """Return what the points lack after a step, by the model."""
        real, imaginary = np.split(self.lack + self.rows @ change, 2)
        moved = self.translations[: len(real), 0] * shift if self.translations.size else 0.0
        return np.asarray(real + 1j * imaginary + moved)

    def restoring(self, gap: Complexes) -> tuple[Floats, complex]:
        """Return the least step that moves the points by so much."""
        pulls, shift = self._solve(np.concatenate([gap.real, gap.imag]), is_held=True)
        return self._spread @ pulls, shift

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
            if total <= 1e-2 * own:
                break
            share = now / total
            found, along = found + share * way, along + share * more
            rest = rest - share * (push + bent)
            turned, shift = self._preconditioned(rest)
            new = float(rest @ turned)
            if new < 1e-4 * first:
                break
            way, more, push, now = (
                turned + new / now * way,
                shift + new / now * more,
                rest + new / now * push,
                new,
            )
        return found, along

    def _preconditioned(self, v: Floats) -> tuple[Floats, complex]:
        y = self._inverse(v)
        pulls, shift = self._solve(-(self.rows @ y))
        return y + self._spread @ pulls, shift

    def _inverse(self, v: Floats) -> Floats:
        if self._metric is None:
            return v
        return np.asarray(scipy.linalg.cho_solve(self._metric, v, check_finite=False))

    def _factor(self) -> None:
        self._by_gives = self._factored(self.gives)

    def _factored(self, gives: Floats) -> tuple[Floats, Indices]:
        count, more = self.translations.shape
        matrix = np.zeros((count + more, count + more))
        matrix[:count, :count] = self._products
        matrix[np.arange(count), np.arange(count)] += np.tile(gives, 2) + RIDGE * self._scale
        matrix[:count, count:] = self.translations
        matrix[count:, :count] = self.translations.T
        factor, pivots = scipy.linalg.lu_factor(matrix, check_finite=False)
        return np.asarray(factor), np.asarray(pivots)

    def _solve(self, right: Floats, *, is_held: bool = False) -> tuple[Floats, complex]:
        count, more = self.translations.shape
        factors = self._factored(np.minimum(self.gives, self.soft)) if is_held else self._by_gives
        found = scipy.linalg.lu_solve(factors, np.append(right, np.zeros(more)), check_finite=False)
        shift = complex(*found[count:]) if more else 0j
        return found[:count], shift
