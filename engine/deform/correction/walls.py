"""Limits of the distortion as conditions on a correction, at the samples of the boundary.

With a = |F| e^{Re h} and b = |G e^{σh} + q K e^h| they are on ln σ_a = ln (a + b), −ln σ_b =
−ln (a − b) and k = b / a. Where one is beyond its wall it is pushed back, the more stiffly the more
of the boundary the sample stands for.
"""

from dataclasses import dataclass
from typing import NamedTuple, Self

import numpy as np

from engine.arrays import Complexes, Floats, Indices
from engine.deform.correction.corrector import PointCorrector
from engine.deform.correction.frame import BaseFrame
from engine.deform.correction.variables import Values

NEAR = 0.01
FOLDED = 10.0  # −ln σ_b where a map begins to fold
ROUND, SQUEEZED = 1e-12, 1e-3  # the least b, and a − b over a, that are divided by


class WallState(NamedTuple):
    """The quantities at all samples (p,) of a corrected frame, and what they are made of."""

    beyond: Floats  # (3, p), positive where a wall is passed
    a: Floats
    g: Complexes
    by_h: Complexes  # derivative of the corrected G by h
    by_q: Complexes


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class LimitWalls:
    """LimitWalls at the samples of the boundary.

    Parameters
    ----------
    corrector : PointCorrector
    base : BaseFrame
        At the samples.
    limits : float64, shape (3, p)
        Of ln σ_a, −ln σ_b and k.
    stiffness : float
        Of the whole boundary.
    """

    corrector: PointCorrector
    base: BaseFrame
    limits: Floats
    stiffness: float = 1.0

    @classmethod
    def around(cls, corrector: PointCorrector, base: BaseFrame, limits: Floats) -> Self:
        """Return walls at limits (3,), or where the base is beyond them at itself."""
        own = quantities(np.abs(base.fz), np.abs(base.g))
        return cls(corrector=corrector, base=base, limits=np.maximum(limits[:, None], own))

    def state(self, x: Floats) -> WallState:
        """Work a corrected frame out."""
        values = self.corrector.variables.at_samples
        conformal, own, factor = self.base.corrected(values, x)
        mixed = factor * values.q_of(x)
        a, g = np.abs(conformal), own + mixed
        beyond = quantities(a, np.abs(g)) - self.limits
        return WallState(beyond, a, g, self.base.sign * own + mixed, factor)

    def soft(self, which: Indices) -> Floats:
        """Return how much walls give in, over their pushes."""
        weights = self.corrector.boundary.shares[which]
        return np.asarray(1.0 / (self.stiffness * weights))

    def near(self, at: WallState) -> tuple[Indices, Indices]:
        """Return the kinds and samples of quantities that count in the next step."""
        kinds, which = np.nonzero(at.beyond > -NEAR)
        return kinds, which

    def energy(self, at: WallState) -> float:
        """Return what the walls that are passed add to ½ |x|²."""
        passed = np.maximum(at.beyond, 0.0) ** 2 @ self.corrector.boundary.shares
        return self.stiffness / 2 * float(passed.sum())

    def rows(self, at: WallState, near: tuple[Indices, Indices]) -> Floats:
        """Return the derivatives (w, 2N) of some quantities, by their kinds and samples."""
        values = _of(self.corrector.variables.at_samples, near[1])
        bend = _Bend.of(at, near)
        by_a, by_b = bend.by_a, bend.by_b
        of_h = by_a * bend.a + by_b * bend.frame * bend.by_h
        of_q = by_b * bend.frame * bend.by_q
        return np.hstack([(values.h * of_h).real.T, (values.q * of_q).real.T])

    def bending(self, at: WallState, near: tuple[Indices, Indices], pushes: Floats) -> "WallForm":
        """Return the second derivative of the sum of pushes (w,) times these quantities."""
        values = _of(self.corrector.variables.at_samples, near[1])
        return WallForm(values, _Bend.of(at, near), pushes)


class _Bend(NamedTuple):
    """The first and second derivatives of quantities (w,) by a and b, and what these depend on."""

    a: Floats
    b: Floats
    frame: Complexes  # conj(g) / |g|
    g: Complexes
    by_h: Complexes
    by_q: Complexes
    by_a: Floats
    by_b: Floats
    by_aa: Floats
    by_ab: Floats
    by_bb: Floats

    @classmethod
    def of(cls, at: WallState, near: tuple[Indices, Indices]) -> Self:
        kinds, which = near
        a, g = at.a[which], at.g[which]
        b = np.maximum(np.abs(g), ROUND)
        total, rest = a + b, np.maximum(a - b, SQUEEZED * a)
        zero = np.zeros_like(a)
        firsts = [[1 / total, 1 / total], [-1 / rest, 1 / rest], [-b / a**2, 1 / a]]
        seconds = [
            [-1 / total**2, -1 / total**2, -1 / total**2],
            [1 / rest**2, -1 / rest**2, 1 / rest**2],
            [2 * b / a**3, -1 / a**2, zero],
        ]
        by_a, by_b = (np.choose(kinds, [each[k] for each in firsts]) for k in range(2))
        aa, ab, bb = (np.choose(kinds, [each[k] for each in seconds]) for k in range(3))
        return cls(a, b, g.conj() / b, g, at.by_h[which], at.by_q[which], by_a, by_b, aa, ab, bb)


class WallForm(NamedTuple):
    """A symmetric form of the unknowns: how walls that are pushed at are curved."""

    values: Values
    bend: _Bend
    pushes: Floats

    def __call__(self, x: Floats) -> Floats:
        """Return the form's product with a vector."""
        at, frame = self.bend, self.bend.frame
        h, q = self.values.h_of(x), self.values.q_of(x)
        change = at.by_h * h + at.by_q * q
        da, db = at.a * h.real, (frame * change).real
        turn = -1j * (frame * change).imag / at.b * frame
        ca, cb = at.by_aa * da + at.by_ab * db, at.by_ab * da + at.by_bb * db
        along = at.by_b * turn + cb * frame
        of_h = at.by_a * at.a * h.real + ca * at.a + along * at.by_h
        of_h = of_h + at.by_b * frame * (at.g * h + at.by_q * q)
        of_q = along * at.by_q + at.by_b * frame * at.by_q * h
        return self.values.against(self.pushes * of_h, self.pushes * of_q)


def quantities(a: Floats, b: Floats) -> Floats:
    """Return ln σ_a, −ln σ_b and k, (3, p), of |f_z| and |f_z̄|; large where a map folds."""
    folds = b >= a
    rest = np.where(folds, 1.0, a - b)
    small = np.where(folds, FOLDED + (b - a) / a, -np.log(np.maximum(rest, np.exp(-FOLDED))))
    return np.array([np.log(a + b), small, b / a])


def _of(values: Values, which: Indices) -> Values:
    return Values(
        np.ascontiguousarray(values.h[:, which]), np.ascontiguousarray(values.q[:, which])
    )
