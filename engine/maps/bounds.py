"""The distortion that a person allows, and what a map is held to."""

from dataclasses import dataclass
from math import isfinite

from engine.errors import EngineError


@dataclass(frozen=True, slots=True, kw_only=True)
class Limits:
    """Limits that hold at every point of a shape: k ≤ `k`, σ_a ≤ `sigma_a`, σ_b ≥ `sigma_b`.

    Any numbers. What a person allows are `Bounds`; the solver also holds maps to limits that the
    identity does not keep, as on the way of an enlarged map into tighter bounds.
    """

    k: float
    sigma_a: float
    sigma_b: float

    def allow(self, *, k: float, sigma_a: float, sigma_b: float) -> bool:
        """Tell whether distortions up to these values are within the limits; NaN never is."""
        return bool(k <= self.k and sigma_a <= self.sigma_a and sigma_b >= self.sigma_b)

    def towards_identity(self, fraction: float) -> "Limits":
        """Return the limits moved by a fraction of what lies between them and the identity."""
        rest = 1.0 - fraction
        return Limits(
            k=rest * self.k,
            sigma_a=1.0 + rest * (self.sigma_a - 1.0),
            sigma_b=1.0 + rest * (self.sigma_b - 1.0),
        )


@dataclass(frozen=True, slots=True, kw_only=True)
class Bounds(Limits):
    """Limits that a person sets; the identity, where every drag starts, lies strictly within them.

    Parameters
    ----------
    k : float
        Largest conformal distortion |f_z̄| / |f_z|, between 0 and 1.
    sigma_a : float
        Largest stretch, above 1.
    sigma_b : float
        Smallest stretch, between 0 and 1.

    Raises
    ------
    EngineError
        If the identity is not strictly within the bounds.
    """

    k: float = 0.8
    sigma_a: float = 5.0
    sigma_b: float = 0.2

    def __post_init__(self) -> None:
        if not 0 < self.k < 1:
            raise EngineError(f"The bound on k must be between 0 and 1, not {self.k:g}.")
        if not (self.sigma_a > 1 and isfinite(self.sigma_a)):
            raise EngineError(f"The bound on sigma_a must be above 1, not {self.sigma_a:g}.")
        if not 0 < self.sigma_b < 1:
            raise EngineError(
                f"The bound on sigma_b must be between 0 and 1, not {self.sigma_b:g}."
            )
