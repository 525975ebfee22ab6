"""Enclosures on cells of the blended quantities and of their later changes."""

from typing import Any, NamedTuple

import numpy as np

from engine.arrays import Booleans, Floats, Indices
from engine.interpolation.enclosures.cells import BernsteinPatch, BlendChanges
from engine.interpolation.enclosures.pieces import BoundaryBezier, Subdivision
from engine.interpolation.enclosures.sheets import BilinearPatch
from engine.interpolation.inbetweens import Inbetweens
from engine.interpolation.proof.correction import closing_on
from engine.maps import Enclosures

PARTS = 4  # number of initial pieces of time
LEAST = 1.0  # lower bound of the scale to which changes of a quantity are compared


class Cells(NamedTuple):
    """Pieces of the boundary (c,), each from one time to another."""

    piece: Indices
    start: Floats
    end: Floats

    def at(self, which: Booleans | slice) -> "Cells":
        return Cells(self.piece[which], self.start[which], self.end[which])


class CellResults(NamedTuple):
    """Proven bounds of cells, attained corner values, and the cells to cut in time."""

    enclosed: Enclosures
    attained: Enclosures
    by_time: Booleans


class CellEnclosures:
    """Enclosures of a segment's in-betweens on cells; `pieces` may gain halves later."""

    def __init__(self, inbetweens: Inbetweens, pieces: Subdivision) -> None:
        self._pieces = pieces
        self._blend = inbetweens.blend
        self._curves = self._blend.curves(pieces.derivatives(0))
        self._rho = None if inbetweens.scale is None else inbetweens.scale.enclosures()
        constants = self._blend.constants
        self._h, self._d = (
            None if closing is None else closing_on(closing, inbetweens.boundary, pieces, lost)
            for closing, lost in (
                (inbetweens.closing, constants),
                (inbetweens.conformal_closing, None),
            )
        )

    @property
    def cuts(self) -> Floats:
        """Times from 0 to 1 that no cell may cross, float64 (b,)."""
        cuts = np.linspace(0.0, 1.0, PARTS + 1)
        for each in (self._h, self._d):
            cuts = cuts if each is None else np.union1d(cuts, each.breaks)
        return cuts

    def of(self, chosen: Cells) -> CellResults:
        self._catch_up()
        first, second = self._blended(chosen)
        changes, off_in_time = self._changes(chosen)
        enclose = self._blend.enclose
        return CellResults(
            enclose(first, second, changes),
            enclose(
                first.corners(), second.corners(), None if changes is None else changes.corners()
            ),
            self._by_time(off_in_time, first, second, *(changes or ())),
        )

    def _blended(self, chosen: Cells) -> tuple[BernsteinPatch[Any], BernsteinPatch[Any]]:
        first, second = (
            blend_curves(curves.at(chosen.piece), weights.controls_on(chosen.start, chosen.end))
            for curves, weights in zip(self._curves, self._blend.curve_weights, strict=True)
        )
        return first, second

    def _closing(self, chosen: Cells) -> BilinearPatch | None:
        """Return h, which closes periods, minus the constants that it makes up for."""
        return None if self._h is None else BilinearPatch.of(self._h.on(*chosen)[0])

    def _scaled(
        self, chosen: Cells, eta: BilinearPatch, log_fz: BilinearPatch
    ) -> tuple[BilinearPatch, BilinearPatch]:
        """Return conj(η) and ln |f_z| after Ψ is scaled by ρ."""
        if self._rho is None:
            return eta, log_fz
        values, errors = self._rho.linear_enclosures(chosen.start, chosen.end)
        log_rho = BernsteinPatch(np.repeat(values[:, :, None], 2, axis=2), errors)
        rho = BilinearPatch.of(log_rho).exponential()
        eta = eta.product(rho)
        if self._d is not None:
            d, _ = self._d.on(*chosen)
            log_fz = log_fz.plus(BilinearPatch.of(_factor(d, log_rho)))
            rest = BilinearPatch(1.0 - rho.corners, rho.error)
            eta = eta.product(rho.plus(rest.product(BilinearPatch.of(d).exponential())))
        return eta, log_fz

    def _changes(self, chosen: Cells) -> tuple[BlendChanges | None, Floats]:
        """Return the changes of cells by the corrections around holes and by the scaling of Ψ.

        The second value (c,) is the part of the error due to the cells' length in time.
        """
        nothing = np.zeros(len(chosen.piece))
        if self._h is None and self._rho is None:
            return None, nothing
        none = BernsteinPatch(np.zeros((len(nothing), 2, 2)), nothing)
        h, rho, factor, off = none, none, none, nothing
        if self._h is not None:
            known, off = self._h.on(*chosen)
            h = BernsteinPatch(known.controls.real, known.error)
        if self._rho is not None:
            values, errors = self._rho.linear_enclosures(chosen.start, chosen.end)
            rho, off = (
                BernsteinPatch(np.repeat(values[:, :, None], 2, axis=2), errors),
                off + errors,
            )
        if self._d is not None:
            d, _ = self._d.on(*chosen)
            factor = _factor(d, rho)
        return BlendChanges(h, rho, factor), off

    @staticmethod
    def _by_time(off_in_time: Floats, *patches: BernsteinPatch[Any]) -> Booleans:
        """Return which cells to cut in time; the others are cut along the boundary."""
        in_time, in_place = off_in_time.copy(), -off_in_time
        for patch in patches:
            size = np.maximum(np.abs(patch.controls).max(axis=(1, 2)), LEAST)
            in_time += np.abs(np.diff(patch.controls, axis=1)).max(axis=(1, 2), initial=0.0) / size
            along = np.abs(np.diff(patch.controls, axis=2)).max(axis=(1, 2), initial=0.0)
            in_place += (along + patch.error) / size
        more: Booleans = in_time > in_place
        return more

    def _catch_up(self) -> None:
        """Add the pieces created since the last call."""
        since = len(self._curves[0].errors)
        if since < len(self._pieces.halves):
            first, second = self._blend.curves(self._pieces.derivatives(since))
            self._curves = _joined(self._curves[0], first), _joined(self._curves[1], second)


def _factor(
    d: BernsteinPatch[np.complex128], log_rho: BernsteinPatch[np.float64]
) -> BernsteinPatch[np.float64]:
    """Return ln |w|, w = ρ + (1 − ρ) e^d, by which f_z for ρ = 1 is multiplied.

    Between its corner values the error is an eighth of its second derivatives along both sides of
    the cell. The errors of d and ln ρ, times its first derivatives, are added.
    """
    rho = np.exp(log_rho.controls)
    least = np.exp(log_rho.controls.min(axis=(1, 2)) - log_rho.error)
    most = np.minimum(np.exp(log_rho.controls.max(axis=(1, 2)) + log_rho.error), 1.0)
    size = d.highest.max(axis=(1, 2))
    clear = 1.0 - (1.0 - least) * np.expm1(size)  # |w| at least
    clear = np.where(clear > 0, clear, np.nan)
    by_d, by_rho = (1.0 - least) * np.exp(size) / clear, most * np.expm1(size) / clear
    by_both = most * np.exp(size) / clear**2
    along, over, over_rho = (
        np.abs(np.diff(patch.controls, axis=axis)).max(axis=(1, 2))
        for patch, axis in ((d, 2), (d, 1), (log_rho, 1))
    )
    bend = by_d * (1 + by_d) * (along**2 + over**2) + by_rho * (1 + by_rho) * over_rho**2
    bend += 2 * by_both * over * over_rho
    error = bend / 8 + by_d * d.error + by_rho * log_rho.error
    return BernsteinPatch(np.log(np.abs(rho + (1.0 - rho) * np.exp(d.controls))), error)


def blend_curves(curves: BoundaryBezier[Any], weights: Floats) -> BernsteinPatch[Any]:
    """Blend curves (c, q, b) by weights (c, d, q)."""
    return BernsteinPatch(
        weights @ curves.controls,
        (np.abs(weights) @ curves.errors[..., None])[..., 0].max(axis=1),
    )


def _joined(one: BoundaryBezier[Any], other: BoundaryBezier[Any]) -> BoundaryBezier[Any]:
    return BoundaryBezier(
        np.concatenate([one.controls, other.controls]), np.concatenate([one.errors, other.errors])
    )
