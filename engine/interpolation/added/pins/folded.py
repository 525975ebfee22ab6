"""SegmentPins folded into in-betweens: what becomes of their derivatives at any points."""

from dataclasses import dataclass
from typing import Self

import numpy as np

from engine.arrays import Complexes, Floats, Indices
from engine.interpolation.added.pins.pinning import PinSeries
from engine.interpolation.passage import Derivatives, Passage
from engine.interpolation.series import Residual
from engine.maps import Span


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class FoldedPins:
    """h and q of a segment at nodes (s,).

    Parameters
    ----------
    pins : PinSeries
    h, q : Residual
    """

    pins: PinSeries
    h: Residual
    q: Residual

    @classmethod
    def of(cls, pins: PinSeries, span: Span, nodes: Complexes) -> Self:
        """Evaluate the functions of pins at nodes (s,)."""
        count = pins.h.shape[1]
        values, slopes = span.evaluate(np.hstack([pins.h, pins.q]), nodes, orders=(0, 1))
        return cls(
            pins=pins,
            h=Residual.of(pins.series, values[:, :count], slopes[:, :count]),
            q=Residual.of(pins.series, values[:, count:], slopes[:, count:]),
        )

    def at(self, which: Indices) -> Self:
        """Return the same at some of the nodes."""
        return type(self)(pins=self.pins, h=self.h.at(which), q=self.q.at(which))

    def changed(self, base: Derivatives, passage: Passage, time: float) -> Derivatives:
        """Return F e^h and G e^{σh} + q K e^h with their derivatives, F and G of the base."""
        (h, h_z), (q, q_z) = (_both(each, time) for each in (self.h, self.q))
        log_k, log_k_z = passage.plain_log_fz(time)
        if self.pins.is_squared:
            log_k *= 2.0
            log_k_z = 2.0 * log_k_z - base.fzz / base.fz
        k = np.exp(log_k + h)
        if self.pins.is_squared:
            k /= base.fz
        sign, grown = self.pins.sign, np.exp(h)
        own = grown if sign > 0 else 1.0 / grown
        return Derivatives(
            fz=base.fz * grown,
            fzz=(base.fzz + base.fz * h_z) * grown,
            g=base.g * own + q * k,
            gz=(base.gz + sign * base.g * h_z) * own + (q_z + q * (log_k_z + h_z)) * k,
        )

    def changed_values(
        self, fz: Complexes, g: Complexes, passage: Passage, times: Floats
    ) -> tuple[Complexes, Complexes]:
        """Return the same at times (t,), of F and G (t, s) and without derivatives."""
        h, q = self.h.at_times(times), self.q.at_times(times)
        log_k = passage.plain_log_fz_at(times)
        k = np.exp(2.0 * log_k + h) / fz if self.pins.is_squared else np.exp(log_k + h)
        grown = np.exp(h)
        return fz * grown, g * (grown if self.pins.sign > 0 else 1.0 / grown) + q * k


def _both(function: Residual, time: float) -> tuple[Complexes, Complexes]:
    """Return a function and its derivative at a time."""
    value = np.zeros(function.modes.shape[1], dtype=np.complex128)
    slope = np.zeros_like(value)
    function.add_to(value, slope, time)
    return value, slope
