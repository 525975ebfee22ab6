"""One step of the solver: its model, solved exactly in the few dimensions of the rows."""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
import scipy.linalg

from engine.arrays import Complexes, Floats, Indices
from engine.deform.correction.barrier import BarrierModel

RIDGE = 1e-13  # of the mean of the rows' products
MOST_BENDS = 30  # steps of the conjugate gradients
NEARLY = 1e-4  # of the curvature's change: largest remainder
CURVED = 1e-2  # of the metric: the least curvature along which steps are taken
# Rounds in which yielding pulls are found, and how exactly.
ROUNDS, LEFT_TO_GO = 20, 1e-6
CUBIC_ROUNDS = 6  # of Newton's method, from at most twice the residual
TINY = 1e-300

# A symmetric form of the unknowns, as its product with a vector (2N,).
Form = Callable[[Floats], Floats]


class Rows(NamedTuple):
    """Linearized conditions on the unknowns; several rows may form a group.

    Parameters
    ----------
    residual : float64, shape (r,)
    jacobian : float64, shape (r, 2N)
    compliances : float64, shape (r,)
        The remaining residual over the pull.
    group : intp, shape (r,)
        The two coordinates of a point form one group.
    yields : float64, shape (g,)
        The further remaining residual of each group over the cube of its pull.
    translations : float64, shape (r, 2) or (r, 0)
        Derivatives by a translation.
    """

    residual: Floats
    jacobian: Floats
    compliances: Floats
    group: Indices
    yields: Floats
    translations: Floats

    def sizes(self, values: Floats) -> Floats:
        """Return the length of each group, (g,), of values (r,)."""
        squares = np.bincount(self.group, values * values, minlength=len(self.yields))
        return np.asarray(np.sqrt(squares))


class StepModel:
    """The quadratic model around unknowns x.

    A barrier changes the metric, which is otherwise the identity, and the gradient of the
    objective, which is otherwise x.

    Attributes
    ----------
    rows : Rows
    pulls : float64, shape (r,)
        The multipliers of the rows.
    """

    def __init__(self, x: Floats, rows: Rows, walls: BarrierModel | None = None) -> None:
        self.rows = rows
        self._metric: _WalledMetric | None = None
        if walls is None:
            self._slopes, self._down = rows.jacobian, x
        else:
            self._metric = _WalledMetric(walls.hessian_rows)
            self._slopes = self._halved(rows.jacobian.T).T
            self._down = self._halved(x + walls.gradient)
        self._products = self._slopes @ self._slopes.T
        self._ridge = RIDGE * float(np.trace(self._products)) / len(self._products)
        self._find_pulls()

    def _find_pulls(self) -> None:
        """Find the pulls by Newton's method; only those that yield take several rounds."""
        rows, right = self.rows, self._slopes @ self._down - self.rows.residual
        by_cube = rows.yields[rows.group]
        together = rows.group[:, None] == rows.group
        lacks = np.maximum(rows.sizes(rows.residual), TINY)[rows.group]
        pulls = -rows.residual / np.cbrt(np.maximum(by_cube, TINY)) / np.cbrt(lacks) ** 2
        for _ in range(ROUNDS):
            last = np.where(by_cube > 0, pulls, 0.0)
            bent = 2 * together * np.outer(by_cube * last, last)
            soft = rows.compliances + by_cube * rows.sizes(last)[rows.group] ** 2
            self._factor(np.diag(soft) + bent)
            pulls, shift = self._solve(right + bent @ last)
            self._shift = complex(shift)
            change = np.where(by_cube > 0, pulls - last, 0.0)
            if np.abs(change).max() <= LEFT_TO_GO * np.abs(last).max():
                break
        self.pulls = pulls

    def solve_step(self) -> tuple[Floats, complex]:
        return self._whole(self.pulls @ self._slopes - self._down), self._shift

    def restoring_step(self, gap: Floats) -> tuple[Floats, complex]:
        """Return the least step that changes the rows by `gap`."""
        pulls, shift = self._solve(gap)
        return self._whole(pulls @ self._slopes), complex(shift)

    def curvature_corrected(self, bending: Form, step: Floats) -> tuple[Floats, complex]:
        """Return the change of a step by the curvature, by conjugate gradients."""
        rest = -bending(step)
        way, shift = self.solve_along(rest)
        found, along = np.zeros_like(way), 0j * shift
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
            turned, shift = self.solve_along(rest)
            new = float(rest @ turned)
            if new < NEARLY * first:
                break
            way, more, push, now = (
                turned + new / now * way,
                shift + new / now * more,
                rest + new / now * push,
                new,
            )
        return found, complex(along)

    def solve_along(self, v: Floats) -> tuple[Floats, Complexes]:
        """Return the inverse metric, in which the rows hold, times v (2N,) or (2N, k)."""
        half = self._halved(v)
        pulls, shift = self._solve(-(self._slopes @ half))
        return self._whole(half + self._slopes.T @ pulls), shift

    def _halved(self, v: Floats) -> Floats:
        """Return v (2N,) or (2N, r) in unknowns in which the metric is the identity."""
        return v if self._metric is None else self._metric.solve(v, transposed=False)

    def _whole(self, v: Floats) -> Floats:
        """Return a step in the original unknowns."""
        return v if self._metric is None else self._metric.solve(v, transposed=True)

    def _factor(self, soft: Floats) -> None:
        """Factor the matrix of the multipliers, with compliances (r, r)."""
        translations = self.rows.translations
        count, more = translations.shape
        matrix = np.zeros((count + more, count + more))
        matrix[:count, :count] = self._products + soft
        matrix[:count, count:] = translations
        matrix[count:, :count] = translations.T
        diagonal = np.arange(count)
        matrix[diagonal, diagonal] += self._ridge
        self._factors = scipy.linalg.lu_factor(matrix, overwrite_a=True, check_finite=False)

    def _solve(self, right: Floats) -> tuple[Floats, Complexes]:
        count, more = self.rows.translations.shape
        padded = np.concatenate([right, np.zeros((more, *right.shape[1:]))])
        found = scipy.linalg.lu_solve(self._factors, padded, check_finite=False)
        shift = 1j * found[count + 1 :].sum(axis=0) + found[count : count + 1].sum(axis=0)
        return found[:count], np.asarray(shift)


class _WalledMetric:
    """A root S Sᵀ = (1 + rowsᵀ rows)⁻¹ of the metric, for rows (w, n) of a barrier.

    With an orthonormal basis Q of the rows' space, and rows = Rᵀ Qᵀ, the metric is
    1 + Q R Rᵀ Qᵀ: it differs from the identity in few dimensions, since few samples are near a
    limit. With L Lᵀ = 1 + R Rᵀ the root is S = 1 + Q (L⁻ᵀ − 1) Qᵀ.
    """

    def __init__(self, rows: Floats) -> None:
        basis, triangle = np.linalg.qr(rows.T)
        self._basis: Floats = basis
        self._root = metric_root(triangle.T)

    def solve(self, v: Floats, *, transposed: bool) -> Floats:
        """Return Sᵀ v, or S v, for v (n,) or (n, r)."""
        parts = self._basis.T @ v
        found: Floats = v + self._basis @ (
            _solved(self._root, parts, transposed=transposed) - parts
        )
        return found


def metric_root(rows: Floats) -> Floats:
    """Return the lower triangle L of 1 + rowsᵀ rows = L Lᵀ, for rows (w, n)."""
    metric, unit = rows.T @ rows, np.eye(rows.shape[1])
    try:
        return np.asarray(np.linalg.cholesky(metric + unit), dtype=np.float64)
    except np.linalg.LinAlgError:
        # Close to a limit, the 1 is lost in the products, but not in the rows.
        return np.asarray(np.linalg.qr(np.vstack([rows, unit]), mode="r"), dtype=np.float64).T


def pulls_against(lacks: Floats, compliances: Floats, yields: Floats) -> Floats:
    """Return the pulls (g,) of groups whose remaining residuals have these lengths."""
    pulls = np.minimum(
        lacks / np.maximum(compliances, TINY), np.cbrt(lacks / np.maximum(yields, TINY))
    )
    for _ in range(CUBIC_ROUNDS):
        squares = yields * pulls**2
        over = np.maximum((compliances + squares) * pulls - lacks, 0.0)
        pulls = pulls - over / np.maximum(compliances + 3 * squares, TINY)
    return np.asarray(pulls)


def work_of_pulls(lacks: Floats, compliances: Floats, yields: Floats, firm: float) -> Floats:
    """Return the work (g,) against remaining residuals; equalities pull with `firm` at most."""
    pulls = pulls_against(lacks, compliances, yields)
    pulls = np.where(yields > 0, pulls, np.minimum(pulls, firm))
    return np.asarray(pulls * (lacks - pulls * (compliances / 2 + yields * pulls**2 / 4)))


def _solved(root: Floats, v: Floats, *, transposed: bool) -> Floats:
    if not len(root):
        return v
    # Without SciPy's checks, which take longer than the solution.
    found, _ = scipy.linalg.lapack.dtrtrs(root.T, v, lower=0, trans=0 if transposed else 1)
    return np.asarray(found)
