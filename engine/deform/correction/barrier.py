"""Limits of the distortion as a barrier, at the samples of the boundary.

With a = |F| e^{Re h} and b = |G e^{σh} + q K e^h| the limits are on ln σ_a = ln (a + b), −ln σ_b =
−ln (a − b) and k = b / a. With the slack d of a limit, each sample adds

    weight · its share of the boundary · (d / width − 1 − ln (d / width))    where d < width,

whose slope is continuous: samples farther from the limits do not change. Limits that are exceeded
at the start are widened, and close in as the samples come inside. Then the weight falls from step
to step, and the width with it. The curvature of the barrier follows from the dual variables of
earlier steps (primal-dual; Wächter and Biegler 2006).
"""

from dataclasses import dataclass, field, replace
from typing import NamedTuple, Self

import numpy as np

from engine.arrays import Complexes, Floats
from engine.deform.correction.corrector import PointCorrector
from engine.deform.correction.frame import BaseFrame
from engine.deform.correction.variables import BasisValues

FOLDED = 10.0  # −ln σ_b where a map begins to fold
ROUND = 1e-12  # least b in a denominator
LEAST = 1e-12  # slack
# The first weight, its factor from step to step, the last weight, and the last width.
FIRST, FALL, LAST, WIDTH = 0.1, 0.05, 0.01, 0.05
# Part of the slack by which widened limits close in; and the slack, over the width, below which
# they stay.
TAKEN, SLIGHT = 0.9, 1e-3
NEAR = 100.0  # times the barrier's own force: largest deviation of a dual variable
FLAT = 1e-9  # of the largest curvature of a sample: counts as 0


class BarrierState(NamedTuple):
    """Slacks, duals and derivatives of a corrected frame at all samples (p,)."""

    slacks: Floats  # (3, p)
    duals: Floats  # (3, p), without the part that the width subtracts
    a: Floats
    g: Complexes
    by_h: Complexes  # derivative of the corrected G by h
    by_q: Complexes


def _none() -> Floats:
    return np.zeros(3)


class BarrierModel(NamedTuple):
    """The barrier at a frame: gradient (2N,), and rows (w, 2N) whose Gram matrix is its Hessian."""

    gradient: Floats
    hessian_rows: Floats


@dataclass(frozen=True, slots=True, eq=False)
class LimitBarrier:
    """A barrier at the samples of the boundary.

    Parameters
    ----------
    base : BaseFrame
        At the samples.
    limits : float64, shape (3,)
        Of ln σ_a, −ln σ_b and k.
    weight, last : float
        Of the whole boundary, now and at the end.
    beyond : float64, shape (3,)
        How much the limits are still widened.
    """

    corrector: PointCorrector
    base: BaseFrame
    limits: Floats
    weight: float = FIRST
    last: float = LAST
    beyond: Floats = field(default_factory=_none)

    @classmethod
    def around(
        cls, corrector: PointCorrector, base: BaseFrame, limits: Floats, scale: float, x: Floats
    ) -> Self:
        """Return a barrier for corrections of this scale that starts around unknowns x."""
        width = scale * WIDTH
        beyond = np.maximum(extremes(corrector, base, x) - limits + width, 0.0)
        first, last = (LAST * (w / WIDTH) ** 2 for w in (max(width, beyond.max()), width))
        return cls(corrector, base, limits, first, last, beyond)

    @property
    def width(self) -> float:
        """Slack at which the barrier begins."""
        return WIDTH * float(np.sqrt(self.weight / LAST))

    @property
    def is_lowest(self) -> bool:
        """Whether the weight is the last one."""
        return self.weight <= self.last and not self.beyond.any()

    def with_lower_weight(self, at: BarrierState) -> tuple["LimitBarrier", BarrierState]:
        """Return the barrier of the next step, and the slacks of its limits."""
        if not self.beyond.any():
            return replace(self, weight=max(FALL * self.weight, self.last)), at
        taken = np.minimum(self.beyond, TAKEN * at.slacks.min(axis=1))
        left, beyond = at.slacks - taken[:, None], self.beyond - taken
        stays = np.where(taken < SLIGHT * self.width, beyond, 0.0)
        walls = replace(self, limits=self.limits + stays, beyond=beyond - stays)
        return walls, at._replace(slacks=left)

    def state(self, x: Floats, last: BarrierState | None = None) -> BarrierState:
        """Evaluate a corrected frame, after a step from `last`."""
        values = self.corrector.variables.at_samples
        conformal, own, mixed, factor = self.base.apply_correction(values, x)
        a, g = np.abs(conformal), own + mixed
        left = (self.limits + self.beyond)[:, None] - log_distortions(a, np.abs(g))
        pushes = self.weight * self.corrector.boundary.barrier_weights / np.maximum(left, LEAST)
        if last is not None:
            follow = self.weight * self.corrector.boundary.barrier_weights / last.slacks
            follow = follow - last.duals * (left - last.slacks) / last.slacks
            pushes = np.clip(follow, pushes / NEAR, pushes * NEAR)
        return BarrierState(left, pushes, a, g, self.base.sign * own + mixed, factor)

    def energy(self, at: BarrierState) -> float:
        """Return the barrier; infinite where a limit is broken."""
        if at.slacks.min() <= 0:
            return np.inf
        part = np.minimum(at.slacks / self.width, 1.0)
        each = (part - 1.0 - np.log(part)) @ self.corrector.boundary.barrier_weights
        return self.weight * float(each.sum())

    def model(self, at: BarrierState) -> BarrierModel:
        """Return the gradient and the convex part of the Hessian of the barrier."""
        values = self.corrector.variables.at_samples
        near = np.flatnonzero(at.slacks.min(axis=0) < self.width)
        left = np.minimum(at.slacks[:, near], self.width)
        weights = self.weight * self.corrector.boundary.barrier_weights[near]
        slopes, forms = _by_both(at.a[near], at.g[near], at.by_h[near], at.by_q[near])
        push = weights * (1.0 / left - 1.0 / self.width)
        firm = at.duals[:, near] * (left < self.width) / left
        slope = np.einsum("kp,kpi->pi", push, slopes)
        form = np.einsum("kp,kpij->pij", push, forms)
        form += np.einsum("kp,kpi,kpj->pij", firm, slopes, slopes)
        sizes, ways = np.linalg.eigh(form)
        sample, way = np.nonzero(sizes > FLAT * np.abs(sizes).max(axis=1, keepdims=True))
        along = np.sqrt(sizes[sample, way])[:, None] * ways[sample, :, way]
        of_h, of_q = (slope[:, k] - 1j * slope[:, k + 1] for k in (0, 2))
        rows_h, rows_q = (along[:, k] - 1j * along[:, k + 1] for k in (0, 2))
        return BarrierModel(
            values.rows_at(near, of_h, of_q).sum(axis=0),
            values.rows_at(near[sample], rows_h, rows_q),
        )


def distortion_slopes(a: Floats, g: Complexes, by_h: Complexes, by_q: Complexes) -> Floats:
    """Return the derivatives of ln σ_a, −ln σ_b and k by Re h, Im h, Re q and Im q, (3, p, 4)."""
    return _by_both(a, g, by_h, by_q)[0]


def _by_both(a: Floats, g: Complexes, by_h: Complexes, by_q: Complexes) -> tuple[Floats, Floats]:
    """Return the derivatives of the quantities (3, p) by Re h, Im h, Re q and Im q.

    Returns
    -------
    slopes : float64, shape (3, p, 4)
    forms : float64, shape (3, p, 4, 4)
    """
    b = np.maximum(np.abs(g), ROUND)
    total, rest = a + b, a - b
    frame, zero = g.conj() / b, np.zeros_like(a)
    u, v = frame * by_h, frame * by_q
    of_a = np.stack([a, zero, zero, zero], axis=-1)
    of_b = np.stack([u.real, -u.imag, v.real, -v.imag], axis=-1)
    turn = np.stack([u.imag, u.real, v.imag, v.real], axis=-1)
    # Re of conj(g) / |g| times the second derivative of g, which is g δh² + 2 K e^h δh δq.
    own = np.zeros((len(a), 4, 4))
    own[:, 0, 0], own[:, 1, 1] = b, -b
    own[:, 0, 2] = own[:, 2, 0] = v.real
    own[:, 1, 3] = own[:, 3, 1] = -v.real
    own[:, 0, 3] = own[:, 3, 0] = own[:, 1, 2] = own[:, 2, 1] = -v.imag
    form_a = of_a[:, :, None] * np.array([1.0, 0, 0, 0])
    form_b = own + turn[:, :, None] * turn[:, None] / b[:, None, None]
    by_a = np.stack([1 / total, -1 / rest, -b / a**2])
    by_b = np.stack([1 / total, 1 / rest, 1 / a])
    by_aa = np.stack([-1 / total**2, 1 / rest**2, 2 * b / a**3])
    by_ab = np.stack([-1 / total**2, -1 / rest**2, -1 / a**2])
    by_bb = np.stack([-1 / total**2, 1 / rest**2, zero])
    slopes = by_a[..., None] * of_a + by_b[..., None] * of_b
    both = of_a[:, :, None] * of_b[:, None]
    parts = (
        (by_a, form_a),
        (by_b, form_b),
        (by_aa, of_a[:, :, None] * of_a[:, None]),
        (by_ab, both + both.swapaxes(1, 2)),
        (by_bb, of_b[:, :, None] * of_b[:, None]),
    )
    forms = sum(by[..., None, None] * form for by, form in parts)
    return slopes, np.asarray(forms)


def extremes(corrector: PointCorrector, base: BaseFrame, x: Floats | None = None) -> Floats:
    """Return the largest ln σ_a, −ln σ_b and k at the samples, (3,); without x, of the base."""
    if x is None:
        return np.asarray(log_distortions(np.abs(base.fz), np.abs(base.g)).max(axis=1))
    return corrected_extremes(corrector.variables.at_samples, base, x)


def corrected_extremes(values: BasisValues, base: BaseFrame, x: Floats) -> Floats:
    """Return the largest ln σ_a, −ln σ_b and k, (3,), for unknowns of these functions."""
    conformal, own, mixed, _ = base.apply_correction(values, x)
    a, b = np.abs(conformal), np.abs(own + mixed)
    return np.asarray(log_distortions(a, b).max(axis=1))


def log_distortions(a: Floats, b: Floats) -> Floats:
    """Return ln σ_a, −ln σ_b and k, (3, p), of |f_z| and |f_z̄|; large where a map folds."""
    folds = b >= a
    rest = np.where(folds, 1.0, a - b)
    small = np.where(folds, FOLDED + (b - a) / a, -np.log(np.maximum(rest, np.exp(-FOLDED))))
    return np.array([np.log(a + b), small, b / a])
