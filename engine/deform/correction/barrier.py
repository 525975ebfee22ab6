"""Limits of the distortion as a barrier, at the samples of the boundary.

With a = |F| e^{Re h} and b = |G e^{σh} + q K e^h| they are on ln σ_a = ln (a + b), −ln σ_b =
−ln (a − b) and k = b / a. With d what is left of a limit, each sample adds

    weight · its share of the boundary · (d / width − 1 − ln (d / width))    where d < width,

which has no jump in its slope: what keeps farther from the limits is not changed. Limits that are
exceeded at first are wide enough for that, and close in behind what comes inside; then the weight
falls from step to step, and the width with it. How firm the barrier is taken to be follows from the
pushes that the steps before found (primal-dual; Wächter and Biegler 2006).
"""

from dataclasses import dataclass, field, replace
from typing import NamedTuple, Self

import numpy as np

from engine.arrays import Complexes, Floats
from engine.deform.correction.corrector import PointCorrector
from engine.deform.correction.frame import BaseFrame

FOLDED = 10.0  # −ln σ_b where a map begins to fold
ROUND = 1e-12  # the least b that is divided by
LEAST = 1e-12  # of what is left
# The weight at first, how it falls, and at last; and the width at last.
FIRST, FALL, LAST, WIDTH = 1.0, 0.3, 0.01, 0.05
# Of what is left of limits that are too wide: by how much they close in; and of the width: with how
# little they stay where they are.
TAKEN, SLIGHT = 0.9, 1e-3
NEAR = 100.0  # times what the barrier itself pushes with: what pushes may be off it
FLAT = 1e-9  # of the largest curvature of a sample: what counts for nothing


class BarrierState(NamedTuple):
    """What is left of the limits at all samples (p,) of a corrected frame, and what it is of."""

    slacks: Floats  # (3, p)
    duals: Floats  # (3, p), without what the width takes off
    a: Floats
    g: Complexes
    by_h: Complexes  # derivative of the corrected G by h
    by_q: Complexes


def _none() -> Floats:
    return np.zeros(3)


class BarrierModel(NamedTuple):
    """The barrier around a frame: its slope (2N,), and rows (w, 2N) whose squares curve it."""

    gradient: Floats
    hessian_rows: Floats


@dataclass(frozen=True, slots=True, eq=False)
class LimitBarrier:
    """A barrier at the samples of the boundary.

    Parameters
    ----------
    corrector : PointCorrector
    base : BaseFrame
        At the samples.
    limits : float64, shape (3,)
        Of ln σ_a, −ln σ_b and k.
    weight, last : float
        Of the whole boundary, now and at last.
    beyond : float64, shape (3,)
        By how much limits are still too wide.
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
        """Return a barrier for corrections of some scale that starts around unknowns x."""
        width = scale * WIDTH
        beyond = np.maximum(extremes(corrector, base, x) - limits + width, 0.0)
        first, last = (LAST * (w / WIDTH) ** 2 for w in (max(width, beyond.max()), width))
        return cls(corrector, base, limits, first, last, beyond)

    @property
    def width(self) -> float:
        """What is left of a limit where the barrier begins."""
        return WIDTH * float(np.sqrt(self.weight / LAST))

    @property
    def is_lowest(self) -> bool:
        """Whether it is not lowered any more."""
        return self.weight <= self.last and not self.beyond.any()

    def with_lower_weight(self, at: BarrierState) -> tuple["LimitBarrier", BarrierState]:
        """Return the barrier of the next step, and what it leaves of its limits."""
        if not self.beyond.any():
            return replace(self, weight=max(FALL * self.weight, self.last)), at
        taken = np.minimum(self.beyond, TAKEN * at.slacks.min(axis=1))
        left, beyond = at.slacks - taken[:, None], self.beyond - taken
        stays = np.where(taken < SLIGHT * self.width, beyond, 0.0)
        walls = replace(self, limits=self.limits + stays, beyond=beyond - stays)
        return walls, at._replace(slacks=left)

    def state(self, x: Floats, last: BarrierState | None = None) -> BarrierState:
        """Work a corrected frame out, after a step from a last one."""
        values = self.corrector.variables.at_samples
        conformal, own, factor = self.base.apply_correction(values, x)
        mixed = factor * values.q_of(x)
        a, g = np.abs(conformal), own + mixed
        left = (self.limits + self.beyond)[:, None] - log_distortions(a, np.abs(g))
        pushes = self.weight * self.corrector.boundary.barrier_weights / np.maximum(left, LEAST)
        if last is not None:
            follow = self.weight * self.corrector.boundary.barrier_weights / last.slacks
            follow = follow - last.duals * (left - last.slacks) / last.slacks
            pushes = np.clip(follow, pushes / NEAR, pushes * NEAR)
        return BarrierState(left, pushes, a, g, self.base.sign * own + mixed, factor)

    def energy(self, at: BarrierState) -> float:
        """Return the barrier; infinite where a limit is not kept."""
        if at.slacks.min() <= 0:
            return np.inf
        part = np.minimum(at.slacks / self.width, 1.0)
        each = (part - 1.0 - np.log(part)) @ self.corrector.boundary.barrier_weights
        return self.weight * float(each.sum())

    def model(self, at: BarrierState) -> BarrierModel:
        """Return the slope and the convex part of the curvature of the barrier."""
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
        h, q = values.h[:, near], values.q[:, near]
        of_h, of_q = (slope[:, k] - 1j * slope[:, k + 1] for k in (0, 2))
        rows_h, rows_q = (along[:, k] - 1j * along[:, k + 1] for k in (0, 2))
        return BarrierModel(
            np.concatenate([(h @ of_h).real, (q @ of_q).real]),
            np.hstack([(h[:, sample] * rows_h).real.T, (q[:, sample] * rows_q).real.T]),
        )


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


def extremes(corrector: PointCorrector, base: BaseFrame, x: Floats) -> Floats:
    """Return the largest ln σ_a, −ln σ_b and k of a corrected frame at the samples, (3,)."""
    values = corrector.variables.at_samples
    conformal, own, factor = base.apply_correction(values, x)
    a, b = np.abs(conformal), np.abs(own + factor * values.q_of(x))
    return np.asarray(log_distortions(a, b).max(axis=1))


def log_distortions(a: Floats, b: Floats) -> Floats:
    """Return ln σ_a, −ln σ_b and k, (3, p), of |f_z| and |f_z̄|; large where a map folds."""
    folds = b >= a
    rest = np.where(folds, 1.0, a - b)
    small = np.where(folds, FOLDED + (b - a) / a, -np.log(np.maximum(rest, np.exp(-FOLDED))))
    return np.array([np.log(a + b), small, b / a])
