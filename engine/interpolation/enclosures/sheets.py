"""Quantities on cells of boundary and time as bilinear functions with error bounds.

On its cell, a bilinear function is a mean of its corner values. A function of bilinear functions
differs from the interpolant of its own corner values. The difference is at most an eighth of the
sum of its second derivatives along both sides of the cell.
"""

from typing import Any, NamedTuple, Self

import numpy as np

from engine.arrays import Floats
from engine.interpolation.enclosures.cells import BernsteinPatch


class BilinearPatch(NamedTuple):
    """A quantity on cells (c,).

    `corners` are float64 or complex128 (c, 2, 2), along time and along the place. `error` (c,)
    bounds the distance from the bilinear interpolant; infinite if no bound is known.
    """

    corners: Any
    error: Floats

    @classmethod
    def of(cls, patch: BernsteinPatch[Any]) -> Self:
        """Return a patch as a bilinear one; its distance from the interpolant adds to the error."""
        controls = patch.controls
        corners = controls[:, [0, -1]][:, :, [0, -1]]
        along, over = (np.linspace(0.0, 1.0, controls.shape[axis]) for axis in (2, 1))
        over = over[:, None]
        weights = (1 - over) * (1 - along), (1 - over) * along, over * (1 - along), over * along
        places = ((0, 0), (0, 1), (1, 0), (1, 1))
        flat = sum(
            weight * corners[:, t, s][:, None, None]
            for weight, (t, s) in zip(weights, places, strict=True)
        )
        return cls(corners, patch.error + np.abs(controls - flat).max(axis=(1, 2)))

    @property
    def size(self) -> Floats:
        """The largest absolute value of the interpolant."""
        largest: Floats = np.abs(self.corners).max(axis=(1, 2))
        return largest

    @property
    def changes(self) -> tuple[Floats, Floats]:
        """Largest changes along the place, and over time."""
        along, over = (np.abs(np.diff(self.corners, axis=axis)).max(axis=(1, 2)) for axis in (2, 1))
        return along, over

    @property
    def real(self) -> "BilinearPatch":
        return BilinearPatch(self.corners.real, self.error)

    def plus(self, other: "BilinearPatch") -> "BilinearPatch":
        return BilinearPatch(self.corners + other.corners, self.error + other.error)

    def times(self, factor: float) -> "BilinearPatch":
        return BilinearPatch(factor * self.corners, abs(factor) * self.error)

    def product(self, other: "BilinearPatch") -> "BilinearPatch":
        """Return the product; its second derivatives are twice the products of first ones."""
        bend = sum(a * b for a, b in zip(self.changes, other.changes, strict=True)) / 4
        error = self.size * other.error + other.size * self.error + self.error * other.error
        return BilinearPatch(self.corners * other.corners, bend + error)

    def exponential(self) -> "BilinearPatch":
        """Return the exponential; its absolute value is largest at a corner."""
        grown = np.exp(self.corners)
        bend = sum(change**2 for change in self.changes) / 8
        return BilinearPatch(grown, np.abs(grown).max(axis=(1, 2)) * (bend + np.expm1(self.error)))


def log_modulus_of_metric(trace: BilinearPatch, eta: BilinearPatch) -> BilinearPatch:
    """Return ln |f_z| = ½ ln a², a² = (𝒜 + D) / 2, D² = 𝒜² − 4 |η|², Equation (13).

    Notes
    -----
    With v = |η|², the first derivatives are 1 / (2 D) by 𝒜 and −1 / (2 a² D) by v. The second
    derivatives are −𝒜 / (2 D³), 1 / D³ and −(1 + 2 a² / D) / (2 a⁴ D²).
    """
    squares = np.abs(eta.corners) ** 2
    of_v = 2 * eta.size * eta.error + eta.error**2 + sum(c**2 for c in eta.changes) / 4
    v = BilinearPatch(squares, of_v)
    values = trace.corners
    least = values.min(axis=(1, 2)) - trace.error
    most = values.max(axis=(1, 2)) + trace.error
    discriminant = least**2 - 4 * (squares.max(axis=(1, 2)) + of_v)
    clear = (least > 0) & (discriminant > 0)
    d = np.sqrt(np.where(clear, discriminant, 1.0))
    a2 = (np.where(clear, least, 1.0) + d) / 2
    error = trace.error / (2 * d) + of_v / (2 * a2 * d)
    for by_trace, by_v in zip(trace.changes, v.changes, strict=True):
        error = error + by_trace**2 * most / (16 * d**3) + by_trace * by_v / (4 * d**3)
        error = error + by_v**2 * (1 + 2 * most / d) / (16 * (a2 * d) ** 2)
    inside = np.sqrt(np.maximum(values**2 - 4 * squares, 0.0))
    return BilinearPatch(0.5 * np.log((values + inside) / 2), np.where(clear, error, np.inf))
