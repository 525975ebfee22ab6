"""Quantities on cells of boundary and time as bilinear functions, and how far they are off.

What is bilinear is, on its cell, a mean of its values at the corners. A function of bilinear ones
is off the interpolant of its own corners by at most an eighth of its second derivatives along both
sides of the cell, added up.
"""

from typing import Any, NamedTuple, Self

import numpy as np

from engine.arrays import Floats
from engine.interpolation.enclosures.cells import BernsteinPatch


class BilinearPatch(NamedTuple):
    """A quantity on cells (c,).

    Parameters
    ----------
    corners : float64 or complex128, shape (c, 2, 2)
        Along time, and along the place.
    error : float64, shape (c,)
        By how much the truth may be off the bilinear interpolant; infinite where nothing is known.
    """

    corners: Any
    error: Floats

    @classmethod
    def of(cls, patch: BernsteinPatch[Any]) -> Self:
        """Return a patch as a sheet: control values are off the interpolant of its corners."""
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
        """By how much it changes along the place, and over time, at most."""
        along, over = (np.abs(np.diff(self.corners, axis=axis)).max(axis=(1, 2)) for axis in (2, 1))
        return along, over

    @property
    def real(self) -> "BilinearPatch":
        """The real part."""
        return BilinearPatch(self.corners.real, self.error)

    def plus(self, other: "BilinearPatch") -> "BilinearPatch":
        """Return the sum."""
        return BilinearPatch(self.corners + other.corners, self.error + other.error)

    def times(self, factor: float) -> "BilinearPatch":
        """Return a multiple."""
        return BilinearPatch(factor * self.corners, abs(factor) * self.error)

    def product(self, other: "BilinearPatch") -> "BilinearPatch":
        """Return the product: its second derivatives are twice the products of the first ones."""
        bend = sum(a * b for a, b in zip(self.changes, other.changes, strict=True)) / 4
        error = self.size * other.error + other.size * self.error + self.error * other.error
        return BilinearPatch(self.corners * other.corners, bend + error)

    def exponential(self) -> "BilinearPatch":
        """Return the exponential, whose size is largest at a corner."""
        grown = np.exp(self.corners)
        bend = sum(change**2 for change in self.changes) / 8
        return BilinearPatch(grown, np.abs(grown).max(axis=(1, 2)) * (bend + np.expm1(self.error)))


def log_modulus_of_metric(trace: BilinearPatch, eta: BilinearPatch) -> BilinearPatch:
    """Return ln |f_z| = ½ ln a², a² = (𝒜 + D) / 2, D² = 𝒜² − 4 |η|², Equation (13).

    Notes
    -----
    With v = |η|², the first derivatives are 1 / (2 D) by 𝒜 and −1 / (2 a² D) by v; the second ones
    −𝒜 / (2 D³), 1 / D³ and −(1 + 2 a² / D) / (2 a⁴ D²).
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
