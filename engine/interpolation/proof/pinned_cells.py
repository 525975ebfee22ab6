"""How cells of in-betweens with pins are enclosed: by sheets of F e^h and G e^{σh} + q K e^h."""

import numpy as np

from engine.arrays import Complexes, Floats, ratio
from engine.errors import EngineError
from engine.interpolation.added.pins import FoldedPins
from engine.interpolation.enclosing import (
    EdgeCurves,
    Patch,
    Sheet,
    Subdivision,
    along_mean,
    log_modulus_of_metric,
)
from engine.interpolation.inbetweens import Inbetweens
from engine.interpolation.proof.correction import Correction
from engine.interpolation.proof.enclosing_cells import CellEnclosures, CellResults, Cells, patch_of
from engine.maps import Enclosures


class PinnedCellEnclosures(CellEnclosures):
    """Enclosures on cells of in-betweens whose handles stay.

    Parameters
    ----------
    inbetweens : Inbetweens
        With pins; its points begin with the samples of the boundary.
    pieces : Subdivision
    """

    def __init__(self, inbetweens: Inbetweens, pieces: Subdivision, pins: FoldedPins) -> None:
        super().__init__(inbetweens, pieces)
        sites, boundary, known = inbetweens.sites, inbetweens.boundary, pins.pins
        count = len(boundary.points)
        if not np.array_equal(sites.points[:count], boundary.points):
            raise EngineError("Pins are proven with the in-betweens of the boundary's samples.")
        self._sign, self._is_metric = inbetweens.blend.sign, not inbetweens.blend.is_closed_form
        self._pin_h, self._pin_q = (
            Correction(functions, known.series, boundary, pieces)
            for functions in (known.h, known.q)
        )
        passage, places = inbetweens.passage, sites.paths.places[:count]
        logs = [key.log_fz[places] for key in passage.keyframes]
        # log F of the keyframes where pieces begin, and how it goes on.
        self._logs = np.array(logs).T + 2j * np.pi * np.asarray(passage.sheets)
        self._course = passage.course
        self._log_changes = pieces.derivatives(0).log_change()

    @property
    def cuts(self) -> Floats:
        """The times, from 0 to 1, over which no cell may reach, float64 (b,)."""
        return np.union1d(super().cuts, self._pin_h.breaks)

    def of(self, chosen: Cells) -> CellResults:
        """Enclose cells."""
        self._catch_up()
        first, second = self._blended(chosen)
        (h, off), (q, more) = self._pin_h.on(*chosen), self._pin_q.on(*chosen)
        low, a, b, share = self._frame(chosen, first, second, Sheet.of(h), Sheet.of(q))
        error = a.error + b.error
        k = share.size + share.error
        sigma_a = (np.abs(a.corners) + np.abs(b.corners)).max(axis=(1, 2)) + error
        sigma_b = (low - np.abs(b.corners)).min(axis=(1, 2)) - error
        is_known = np.isfinite(k + sigma_a + sigma_b)
        moduli = np.abs(a.corners).ravel(), np.abs(b.corners).ravel()
        return CellResults(
            Enclosures(
                np.where(is_known, k, np.inf),
                np.where(is_known, sigma_a, np.inf),
                np.where(is_known, sigma_b, -np.inf),
            ),
            Enclosures(ratio(moduli[1], moduli[0]), sum(moduli), moduli[0] - moduli[1]),
            self._by_time(off + more, first, second, h, q),
        )

    def _frame(
        self,
        chosen: Cells,
        first: Patch[np.float64],
        second: Patch[np.complex128],
        h: Sheet,
        q: Sheet,
    ) -> tuple[Floats, Sheet, Sheet, Sheet]:
        """Return |f_z| at least, |f_z| and conj(f_z̄), up to a phase, and their ratio."""
        log_l = Sheet.of(self._log_l(chosen))
        if self._sign == 0:
            a = Sheet.of(first).product(h.exponential())
            b = Sheet.of(second).product(h.times(-1.0).exponential())
            b = b.plus(q.product(log_l.plus(h).exponential()))
            low = along_mean(a.corners, (1, 2))
            most = ratio(b.size + b.error, np.maximum(low.min(axis=(1, 2)) - a.error, 0.0))
            return low, a, b, Sheet(most[:, None, None] * np.ones((1, 2, 2)), 0 * most)
        closing = self._closing(chosen)
        if self._sign > 0:
            log_a = Sheet.of(first).plus(h.real)
            if closing is not None:
                log_a, q = log_a.plus(closing.real), q.product(closing.times(-2.0).exponential())
            a = log_a.exponential()
            share = Sheet.of(second).plus(q)
            return a.corners, a, share.product(a), share
        eta = Sheet.of(second)
        log_a = log_modulus_of_metric(Sheet.of(first), eta) if self._is_metric else Sheet.of(first)
        if closing is not None:
            log_a = log_a.plus(closing.real)
        eta, log_a = self._scaled(chosen, eta, log_a)
        log_a = log_a.plus(h.real)
        total = eta.plus(q.product(log_l.plus(h).times(2.0).exponential()))
        a = log_a.exponential()
        b = total.product(log_a.times(-1.0).exponential())
        return a.corners, a, b, total.product(log_a.times(-2.0).exponential())

    def _log_l(self, chosen: Cells) -> Patch[np.complex128]:
        """Return the blend of the keyframes' log F."""
        known = self._log_changes.at(chosen.piece)
        controls = known.controls + self._logs[chosen.piece][:, :, None]
        weights = self._course.controls_on(chosen.start, chosen.end)
        return patch_of(EdgeCurves(controls, known.errors), weights)

    def _catch_up(self) -> None:
        """Learn the pieces that were added since."""
        super()._catch_up()
        since = len(self._logs)
        if since == len(self._pieces.halves):
            return
        own = self._pieces.derivatives(since).log_change()
        first = self._logs[self._pieces.parents[since::2]]
        middle = first + own.controls[::2, :, -1]
        halves: Complexes = np.stack([first, middle], axis=1).reshape(-1, first.shape[1])
        self._logs = np.concatenate([self._logs, halves])
        self._log_changes = EdgeCurves(
            np.concatenate([self._log_changes.controls, own.controls]),
            np.concatenate([self._log_changes.errors, own.errors]),
        )
