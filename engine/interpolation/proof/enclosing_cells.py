"""How cells are enclosed: the quantities that a variant blends, and what becomes of them."""

from typing import Any, NamedTuple

import numpy as np

from engine.arrays import Booleans, Floats, Indices
from engine.interpolation.enclosing import Changes, EdgeCurves, Patch, Subdivision
from engine.interpolation.inbetweens import Inbetweens
from engine.interpolation.proof.correction import Correction
from engine.maps import Enclosures

PARTS = 4  # into which time is cut at first
LEAST = 1.0  # what the changes of a quantity are compared with, at least


class Cells(NamedTuple):
    """Pieces of the boundary (c,), from one time to another."""

    piece: Indices
    start: Floats
    end: Floats

    def at(self, which: Booleans | slice) -> "Cells":
        """Return some of them."""
        return Cells(self.piece[which], self.start[which], self.end[which])


class Enclosed(NamedTuple):
    """What is proven of cells, what is attained at their corners, and which to cut across time."""

    enclosed: Enclosures
    attained: Enclosures
    by_time: Booleans


class CellEnclosures:
    """Enclosures of an interval's in-betweens on cells.

    Parameters
    ----------
    inbetweens : Inbetweens
    pieces : Subdivision
        Of the boundary; it may grow later on.
    """

    def __init__(self, inbetweens: Inbetweens, pieces: Subdivision) -> None:
        self._pieces = pieces
        self._blend = inbetweens.blend
        self._curves = self._blend.curves(pieces.derivatives(0))
        self._rho = None if inbetweens.scale is None else inbetweens.scale.enclosures()
        constants = self._blend.constants
        self._h, self._d = (
            None if closing is None else Correction(closing, inbetweens.boundary, pieces, lost)
            for closing, lost in (
                (inbetweens.closing, constants),
                (inbetweens.conformal_closing, None),
            )
        )

    @property
    def cuts(self) -> Floats:
        """The times, from 0 to 1, over which no cell may reach, float64 (b,)."""
        cuts = np.linspace(0.0, 1.0, PARTS + 1)
        for each in (self._h, self._d):
            cuts = cuts if each is None else np.union1d(cuts, each.breaks)
        return cuts

    def of(self, chosen: Cells) -> Enclosed:
        """Enclose cells."""
        self._catch_up()
        first, second = (
            _patch(curves.at(chosen.piece), course.controls_on(chosen.start, chosen.end))
            for curves, course in zip(self._curves, self._blend.courses, strict=True)
        )
        changes = self._changes(chosen)
        enclose = self._blend.enclose
        return Enclosed(
            enclose(first, second, changes),
            enclose(
                first.corners(), second.corners(), None if changes is None else changes.corners()
            ),
            _varies_more_in_time(first, second, changes),
        )

    def _changes(self, chosen: Cells) -> Changes | None:
        """Return what the corrections around holes and the scaling of Ψ do to cells."""
        if self._h is None and self._rho is None:
            return None
        none = Patch(np.zeros((len(chosen.piece), 2, 2)), np.zeros(len(chosen.piece)))
        h = none if self._h is None else self._h.on(*chosen)
        rho = none
        if self._rho is not None:
            values, errors = self._rho.chords(chosen.start, chosen.end)
            rho = Patch(np.repeat(values[:, :, None], 2, axis=2), errors)
        factor = none if self._d is None else _factor(self._d.on(*chosen), rho)
        return Changes(Patch(h.controls.real, h.error), rho, factor)

    def _catch_up(self) -> None:
        """Learn the pieces that were added since."""
        since = len(self._curves[0].errors)
        if since < len(self._pieces.halves):
            first, second = self._blend.curves(self._pieces.derivatives(since))
            self._curves = _joined(self._curves[0], first), _joined(self._curves[1], second)


def _factor(d: Patch[np.complex128], log_rho: Patch[np.float64]) -> Patch[np.float64]:
    """Return ln |w|, w = ρ + (1 − ρ) e^d, of which f_z is that for ρ = 1 times w."""
    controls = np.exp(log_rho.controls)
    least = np.exp(log_rho.controls.min(axis=(1, 2)) - log_rho.error)
    most = np.minimum(np.exp(log_rho.controls.max(axis=(1, 2)) + log_rho.error), 1.0)
    size = d.highest.max(axis=(1, 2))
    clear = 1.0 - (1.0 - least) * np.expm1(size)  # |w| at least
    clear = np.where(clear > 0, clear, np.nan)
    across = np.hypot(*(np.ptp(part, axis=(1, 2)) for part in (d.controls.real, d.controls.imag)))
    error = (1.0 - least) * np.exp(size) * (across + 2 * d.error) / clear
    error += np.expm1(size) * (most - least) / clear
    factor = controls + (1.0 - controls) * np.exp(d.controls)
    return Patch(np.log(np.abs(factor)), error)


def _patch(curves: EdgeCurves[Any], weights: Floats) -> Patch[Any]:
    """Blend curves (c, q, b) by weights (c, d, q)."""
    return Patch(
        weights @ curves.controls,
        (np.abs(weights) @ curves.errors[..., None])[..., 0].max(axis=1),
    )


def _varies_more_in_time(
    first: Patch[Any], second: Patch[Any], changes: Changes | None
) -> Booleans:
    """Tell along which side cells are to be cut."""
    in_time, in_place = np.zeros((2, len(first.error)))
    for patch in (first, second, *(() if changes is None else changes)):
        size = np.maximum(np.abs(patch.controls).max(axis=(1, 2)), LEAST)
        in_time += np.abs(np.diff(patch.controls, axis=1)).max(axis=(1, 2), initial=0.0) / size
        along = np.abs(np.diff(patch.controls, axis=2)).max(axis=(1, 2), initial=0.0)
        in_place += (along + patch.error) / size
    if changes is not None:
        # What is off the chord of ρ is so in time.
        in_time += changes.rho.error
        in_place -= changes.rho.error
    more: Booleans = in_time > in_place
    return more


def _joined(one: EdgeCurves[Any], other: EdgeCurves[Any]) -> EdgeCurves[Any]:
    return EdgeCurves(
        np.concatenate([one.controls, other.controls]), np.concatenate([one.errors, other.errors])
    )
