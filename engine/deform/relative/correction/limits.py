"""Limits of the distortion as smooth penalties on moduli at samples of the boundary.

With a = |F e^h| and b = |G e^{σh} + q K e^h| the limits are those of ln (a + b), −ln (a − b) and
b / a. What lies beyond a wall, a little inside the limits, is squared; where the base itself is
beyond, the wall is there.
"""

from dataclasses import dataclass
from math import inf, log
from typing import NamedTuple, Self

import numpy as np

from engine.arrays import Complexes, Floats, Indices
from engine.deform.relative.correction.corrector import PointCorrector
from engine.deform.relative.correction.frame import BaseFrame
from engine.maps import Bounds

MARGIN = 0.02  # of the walls inside the limits, in logarithms
FLAT = 1e-9  # of a: b may come so near, whatever the limits


class Felt(NamedTuple):
    """The walls that are passed: ½ |pressed|² is their penalty, and `rows` are its derivatives.

    Parameters
    ----------
    rows : float64, shape (w, 2N)
    pressed : float64, shape (w,)
    """

    rows: Floats
    pressed: Floats

    @property
    def value(self) -> float:
        """The penalty."""
        return 0.5 * float(self.pressed @ self.pressed)


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class LimitWalls:
    """The walls of a frame at samples of the boundary.

    Parameters
    ----------
    corrector : PointCorrector
    base : BaseFrame
        At the samples (p,).
    places : float64, shape (3, p)
        Where the walls are, of ln σ_a, −ln σ_b and k.
    """

    corrector: PointCorrector
    base: BaseFrame
    places: Floats

    @classmethod
    def of(cls, corrector: PointCorrector, base: BaseFrame, bounds: Bounds) -> Self:
        """Put walls inside bounds, or where the base is."""
        a, b = np.abs(base.fz), np.abs(base.g)
        inside = (
            log(bounds.sigma_a) - MARGIN if bounds.sigma_a < inf else inf,
            -log(bounds.sigma_b) - MARGIN if bounds.sigma_b > 0 else inf,
            bounds.k * (1 - MARGIN),
        )
        places = np.maximum(_measures(a, b), np.array(inside)[:, None])
        return cls(corrector=corrector, base=base, places=places)

    def are_passed(self, x: Floats) -> bool:
        """Tell whether unknowns (2N,) lead beyond a wall."""
        at = self._moduli(x)
        return not (at.is_unfolded and bool((_measures(at.a, at.b) <= self.places).all()))

    def felt(self, x: Floats, stiffness: float) -> Felt | None:
        """Return the walls that unknowns (2N,) pass; None where the frame folds."""
        at = self._moduli(x)
        if not at.is_unfolded:
            return None
        beyond = _measures(at.a, at.b) - self.places
        rows, pressed = [], []
        for kind in range(3):
            hot = np.flatnonzero(beyond[kind] > 0)
            root = np.sqrt(stiffness * self.corrector.boundary.lengths[hot])
            rows.append(root[:, None] * self._rows(kind, hot, at))
            pressed.append(root * beyond[kind, hot])
        return Felt(np.vstack(rows), np.concatenate(pressed))

    def _moduli(self, x: Floats) -> "_Moduli":
        values, sign = self.corrector.variables.at_samples, self.base.sign
        conformal, own, factor = self.base.corrected(values, x)
        mixed = values.q_of(x) * factor
        b = np.abs(own + mixed)
        towards = (own + mixed).conj() / np.maximum(b, np.finfo(np.float64).tiny)
        by_h = towards * (sign * own + mixed)
        return _Moduli(a=np.abs(conformal), b=b, by_h=by_h, by_q=towards * factor)

    def _rows(self, kind: int, hot: Indices, at: "_Moduli") -> Floats:
        """Return the derivatives of one measure at some samples."""
        values, (a, b, by_h, by_q) = self.corrector.variables.at_samples, (v[hot] for v in at)
        h, q = values.h[:, hot].T, values.q[:, hot].T
        of_b, of_a = (
            (1 / (a + b), 1 / (a + b)),
            (1 / (a - b), -1 / (a - b)),
            (1 / a, -b / a**2),
        )[kind]
        from_h = ((of_b * by_h)[:, None] * h).real + (of_a * a)[:, None] * h.real
        return np.hstack([from_h, ((of_b * by_q)[:, None] * q).real])


class _Moduli(NamedTuple):
    """a and b at samples (p,); Re (by_h δh + by_q δq) is what b changes by, a Re δh what a does."""

    a: Floats
    b: Floats
    by_h: Complexes
    by_q: Complexes

    @property
    def is_unfolded(self) -> bool:
        """Whether b stays below a."""
        return bool((self.b < (1 - FLAT) * self.a).all())


def _measures(a: Floats, b: Floats) -> Floats:
    """Return ln σ_a, −ln σ_b and k of moduli (p,), float64 (3, p)."""
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.array([np.log(a + b), -np.log(np.maximum(a - b, 0.0)), b / a])
