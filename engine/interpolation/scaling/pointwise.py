"""The largest ρ within the bounds of a point (Section 7.3, Appendix A).

Around holes the periods of f_z and ρ f_z̄ close together, so the correction depends on ρ. Both
periods are closed for ρ = 1 (F e^h, G e^−h) and for ρ = 0 (F e^(h + d), 0). For other ρ the map is
the mean of both maps with the weights ρ and 1 − ρ. It is closed for every ρ, and

    F_ρ = F e^h (ρ + (1 − ρ) e^d),    G_ρ = ρ G e^−h.
"""

from dataclasses import dataclass, replace
from typing import Self, TypeVar

import numpy as np

from engine.arrays import Booleans, Complexes, Floats, Indices, freeze
from engine.maps import Bounds

NEGLIGIBLE = 1e-9  # f_z̄ / f_z below which no scaling is needed, for any bounds
CEILING = 2.0  # larger ratios are cut off: only ratios below 1 matter
TOO_HIGH = 2e-7  # largest excess of a computed minimum; it is subtracted

type_ = TypeVar("type_", Floats, Complexes)


@dataclass(frozen=True, slots=True, kw_only=True)
class KeyframeExtremes:
    """The largest k and sigma_a and the smallest sigma_b of the keyframes on the whole outline."""

    k: float
    sigma_a: float
    sigma_b: float

    def widened(self, bounds: Bounds) -> "KeyframeExtremes":
        """Return the looser of these and some bounds, with slack to offset `TOO_HIGH`."""
        slack = 5 * TOO_HIGH
        return KeyframeExtremes(
            k=max(self.k * (1 + slack), bounds.k),
            sigma_a=max(self.sigma_a * (1 + slack), bounds.sigma_a),
            sigma_b=min(self.sigma_b * (1 - slack), bounds.sigma_b),
        )


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class PointSamples:
    """The quantities at some points that determine ρ, for q keyframes; `...` is any shape.

    Attributes
    ----------
    log_modulus : float64, shape (q + j, ...)
        ln |f_z|, and the real parts of the modes of h.
    conj_eta : complex128, shape (q, ...)
    k, sigma_a, sigma_b : float64, shape (...)
        The larger k and sigma_a and the smaller sigma_b of the keyframes: Properties 5 to 7.
    conformal : complex128, shape (i, ...)
        The modes of d; none without holes.
    largest_extremes : KeyframeExtremes or None
        Around holes h exceeds a point's own bounds. The bounds are then widened by as much as h and
        d change the map, up to these extremes. None keeps the bounds.
    """

    log_modulus: Floats
    conj_eta: Complexes
    k: Floats
    sigma_a: Floats
    sigma_b: Floats
    conformal: Complexes
    largest_extremes: KeyframeExtremes | None = None

    @classmethod
    def of(cls, fz: Complexes, g: Complexes, h: Complexes, d: Complexes) -> Self:
        """Build the samples from f_z and conj(f_z̄), each (q, ...), and modes (j, ...), (i, ...)."""
        a, b = np.abs(fz), np.abs(g)
        return cls(
            log_modulus=freeze(np.concatenate([np.log(a), h.real])),
            conj_eta=freeze(fz * g),
            k=freeze((b / a).max(axis=0)),
            sigma_a=freeze((a + b).max(axis=0)),
            sigma_b=freeze((a - b).min(axis=0)),
            conformal=freeze(np.array(d)),
        )

    def at(self, chosen: Indices) -> Self:
        """Return some of the points (p,)."""
        return type(self)(
            log_modulus=self.log_modulus.take(chosen, axis=1),
            conj_eta=self.conj_eta.take(chosen, axis=1),
            k=self.k[chosen],
            sigma_a=self.sigma_a[chosen],
            sigma_b=self.sigma_b[chosen],
            conformal=self.conformal.take(chosen, axis=1),
        )

    def with_bounds(self, worst: KeyframeExtremes | None) -> Self:
        """Return the points with the worst bounds of the outline; None keeps their own bounds."""
        if worst is None:
            return self
        k, sigma_a, sigma_b = (np.array([x]) for x in (worst.k, worst.sigma_a, worst.sigma_b))
        return replace(self, k=k, sigma_a=sigma_a, sigma_b=sigma_b)

    def largest_rhos(self, weights: Floats) -> Floats:
        """Return the largest scaling that each point allows at a time, at most `CEILING`.

        `weights` (q + j + i, ...) are those of the keyframes and of the modes. They broadcast with
        the shape of the points.

        Departs from the paper: in these equations and in the denominators of Section 7.3 the bars
        were lost; the factor of ρ is |f_z̄|.
        """
        count = len(self.log_modulus)
        a = np.exp(_total(weights[:count], self.log_modulus))
        b = np.abs(_total(weights[: len(self.conj_eta)], self.conj_eta)) / a
        k, sigma_a, sigma_b = self.k, self.sigma_a, self.sigma_b
        d = _total(weights[count:], self.conformal) if len(self.conformal) else None
        if d is not None and self.largest_extremes is not None:
            keys = len(self.conj_eta)
            h = _total(weights[keys:count], self.log_modulus[keys:])
            change = np.exp(np.abs(h) + np.abs(d.real))
            k = np.minimum(self.largest_extremes.k, k * change * change)
            sigma_a = np.minimum(self.largest_extremes.sigma_a, sigma_a * change)
            sigma_b = np.maximum(self.largest_extremes.sigma_b, sigma_b / change)
        return largest_rho(a, b, d, (k, sigma_a, sigma_b))


def largest_rho(
    a: Floats, b: Floats, d: Complexes | None, limits: tuple[Floats | float, ...]
) -> Floats:
    """Return the largest ρ within limits of k, σ_a and σ_b for |F_1| = a, |G_1| = b, F_0 = F_1 e^d.

    Without d, ρ scales G alone.
    """
    k, sigma_a, sigma_b = limits
    # ρ_k, ρ_a and ρ_b of Section 7.3 have the same denominator |f_z̄|.
    slack = np.minimum(
        k * a,  # Equation (16)
        np.minimum(
            sigma_a - a,  # Equation (17)
            a - sigma_b,  # Equation (18)
        ),
    )
    ratios = np.full(slack.shape, CEILING)
    np.divide(slack, b, out=ratios, where=b > np.maximum(NEGLIGIBLE * a, slack / CEILING))
    if d is not None:
        bounds = np.array([np.broadcast_to(each, a.shape) for each in limits])
        tight = _tight(ratios, a, d, bounds)
        ratios[tight] = _with_conformal(a[tight], b[tight], d[tight], bounds[:, tight])
    return ratios


def _tight(ratios: Floats, a: Floats, d: Complexes, bounds: Floats) -> Booleans:
    """Mark the points where d may change the ratio, with the shape of `a`; there |F_0| ≠ |F_1| = a.

    With ε ≥ |e^d − 1|, |F_ρ| differs from |F_1| by at most ε |F_1|. If the bounds have this room,
    every ρ keeps them, and the ratio stays above 1.
    """
    most = np.expm1(np.abs(d).max(initial=0.0))
    _, sigma_a, sigma_b = bounds
    tight: Booleans = ratios * (1 - most) < 1.0
    tight |= (a * (1 + most) > sigma_a) | (a * (1 - most) < sigma_b)
    return tight


def _with_conformal(a: Floats, b: Floats, d: Complexes, bounds: Floats) -> Floats:
    """Return the largest ρ at points (n,) with |F_1| = a, |G_1| = b and F_0 = F_1 e^d.

    The bounds (3, n) are those of k, sigma_a and sigma_b. |F_ρ|² and each condition are quadratic
    in ρ. A bound that the map for ρ = 0 exceeds gives no ρ and is ignored.
    """
    # a² |e^d|², and the products of a e^d and a − a e^d.
    k, sigma_a, sigma_b = bounds
    squared, grown = a * a, np.exp(d.real)
    f0 = squared * grown * grown
    f1 = squared * grown * np.cos(d.imag) - f0
    f2 = squared - f0 - 2.0 * f1
    quadratics = (
        (-k * k * f0, -k * k * f1, b * b - k * k * f2),
        (f0 - sigma_a**2, f1 + sigma_a * b, f2 - b * b),
        (sigma_b**2 - f0, sigma_b * b - f1, b * b - f2),
    )
    inverse = np.full(a.shape, 1.0 / CEILING)
    with np.errstate(invalid="ignore"):
        for c0, c1, c2 in quadratics:
            # The first ρ with c0 + 2 c1 ρ + c2 ρ² > 0. Without a solution the root is NaN, which
            # `fmax` ignores.
            root = c1 + np.sqrt(c1 * c1 - c2 * c0)
            root = np.divide(root, -c0, out=np.zeros_like(root), where=c0 < 0)
            np.fmax(inverse, root, out=inverse)
    return 1.0 / inverse


def _total(weights: Floats, values: type_) -> type_:
    """Return the weighted sum of values (n, c) at times (n, s, 1), or (n, c, p) at (n, c, 1)."""
    if values.ndim == 2:
        flat: Floats = weights[..., 0].T @ values.view(np.float64)
        return flat.view(values.dtype)
    total: type_ = sum(w * value for w, value in zip(weights, values, strict=True))
    return total
