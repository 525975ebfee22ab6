"""Enclosures of corrected in-betweens: bilinear patches of F e^h and G e^{σh} + q K e^h."""

import numpy as np

from engine.arrays import Complexes, Floats, ratio
from engine.interpolation.enclosures.cells import BernsteinPatch, project_on_mean
from engine.interpolation.enclosures.pieces import BoundaryBezier, Subdivision
from engine.interpolation.enclosures.sheets import BilinearPatch, log_modulus_of_metric
from engine.interpolation.inbetweens import Inbetweens
from engine.interpolation.proof.correction import CorrectionEnclosure
from engine.interpolation.proof.enclosing_cells import (
    CellEnclosures,
    CellResults,
    Cells,
    blend_curves,
)
from engine.maps import Enclosures


class CorrectedCellEnclosures(CellEnclosures):
    """Enclosures on cells of in-betweens with corrections.

    The sampled domain of the in-betweens has the boundary samples (`SampledDomain.sample_nodes`).
    """

    def __init__(self, inbetweens: Inbetweens, pieces: Subdivision) -> None:
        super().__init__(inbetweens, pieces)
        boundary = inbetweens.boundary
        self._is_linear, self._sign = inbetweens.blend.sign == 0, inbetweens.sign
        self._is_metric = not inbetweens.blend.is_closed_form
        self._corrections = [
            tuple(
                CorrectionEnclosure(each, known.series, boundary, pieces)
                for each in (known.h, known.q)
            )
            for known in (each.known for each in inbetweens.corrections)
        ]
        keyframe_blend, nodes = inbetweens.keyframe_blend, inbetweens.sampled_domain.sample_nodes()
        logs = [key.log_fz[nodes] for key in keyframe_blend.keyframes]
        # log F of the keyframes at the start of each piece; its increase along the piece follows.
        self._logs = np.array(logs).T + 2j * np.pi * np.asarray(keyframe_blend.sheets)
        self._time_weights = keyframe_blend.time_weights
        self._log_changes = pieces.derivatives(0).log_change()

    @property
    def cuts(self) -> Floats:
        """Times from 0 to 1 that no cell may cross, float64 (b,)."""
        cuts = super().cuts
        for h, _ in self._corrections:
            cuts = np.union1d(cuts, h.breaks)
        return cuts

    def of(self, chosen: Cells) -> CellResults:
        self._catch_up()
        first, second = self._blended(chosen)
        known = [tuple(each.on(*chosen) for each in both) for both in self._corrections]
        sheets = [(BilinearPatch.of(h), BilinearPatch.of(q)) for (h, _), (q, _) in known]
        low, a, b, share = self._frame(chosen, first, second, sheets)
        error = a.error + b.error
        k = share.size + share.error
        sigma_a = (np.abs(a.corners) + np.abs(b.corners)).max(axis=(1, 2)) + error
        sigma_b = (low - np.abs(b.corners)).min(axis=(1, 2)) - error
        is_known = np.isfinite(k + sigma_a + sigma_b)
        moduli = np.abs(a.corners).ravel(), np.abs(b.corners).ravel()
        off = sum(each for both in known for _, each in both)
        patches = [each for both in known for each, _ in both]
        return CellResults(
            Enclosures(
                np.where(is_known, k, np.inf),
                np.where(is_known, sigma_a, np.inf),
                np.where(is_known, sigma_b, -np.inf),
            ),
            Enclosures(ratio(moduli[1], moduli[0]), sum(moduli), moduli[0] - moduli[1]),
            self._by_time(np.asarray(off), first, second, *patches),
        )

    def _frame(
        self,
        chosen: Cells,
        first: BernsteinPatch[np.float64],
        second: BernsteinPatch[np.complex128],
        corrections: list[tuple[BilinearPatch, BilinearPatch]],
    ) -> tuple[Floats, BilinearPatch, BilinearPatch, BilinearPatch]:
        """Return a lower bound of |f_z|, then |f_z|, conj(f_z̄) up to a phase, and their ratio."""
        log_k = BilinearPatch.of(self._log_l(chosen))
        if self._is_linear:
            a, b = BilinearPatch.of(first), BilinearPatch.of(second)
            for h, q in corrections:
                log_k = log_k.plus(h)
                a = a.product(h.exponential())
                b = b.product(h.times(-1.0).exponential()).plus(q.product(log_k.exponential()))
            low = project_on_mean(a.corners, (1, 2))
            most = ratio(b.size + b.error, np.maximum(low.min(axis=(1, 2)) - a.error, 0.0))
            return low, a, b, BilinearPatch(most[:, None, None] * np.ones((1, 2, 2)), 0 * most)
        closing = self._closing(chosen)
        if self._sign > 0:
            log_a, share = BilinearPatch.of(first), BilinearPatch.of(second)
            if closing is not None:
                log_a = log_a.plus(closing.real)
                # K = L² / F, and F contains the h that closes periods.
                lost = closing.times(-2.0).exponential()
                corrections = [(h, q.product(lost)) for h, q in corrections]
            for h, q in corrections:
                log_a, share = log_a.plus(h.real), share.plus(q)
            a = log_a.exponential()
            return a.corners, a, share.product(a), share
        eta = BilinearPatch.of(second)
        log_a = (
            log_modulus_of_metric(BilinearPatch.of(first), eta)
            if self._is_metric
            else BilinearPatch.of(first)
        )
        if closing is not None:
            log_a = log_a.plus(closing.real)
        eta, log_a = self._scaled(chosen, eta, log_a)
        # Each correction adds q F K e^{2h} to F G; F K is L² before the corrections.
        for h, q in corrections:
            log_a, log_k = log_a.plus(h.real), log_k.plus(h)
            eta = eta.plus(q.product(log_k.times(2.0).exponential()))
        a = log_a.exponential()
        b = eta.product(log_a.times(-1.0).exponential())
        return a.corners, a, b, eta.product(log_a.times(-2.0).exponential())

    def _log_l(self, chosen: Cells) -> BernsteinPatch[np.complex128]:
        """Return the blend of the keyframes' log F."""
        known = self._log_changes.at(chosen.piece)
        controls = known.controls + self._logs[chosen.piece][:, :, None]
        weights = self._time_weights.controls_on(chosen.start, chosen.end)
        return blend_curves(BoundaryBezier(controls, known.errors), weights)

    def _catch_up(self) -> None:
        """Add the pieces created since the last call."""
        super()._catch_up()
        since = len(self._logs)
        if since == len(self._pieces.halves):
            return
        own = self._pieces.derivatives(since).log_change()
        first = self._logs[self._pieces.parents[since::2]]
        middle = first + own.controls[::2, :, -1]
        halves: Complexes = np.stack([first, middle], axis=1).reshape(-1, first.shape[1])
        self._logs = np.concatenate([self._logs, halves])
        self._log_changes = BoundaryBezier(
            np.concatenate([self._log_changes.controls, own.controls]),
            np.concatenate([self._log_changes.errors, own.errors]),
        )
