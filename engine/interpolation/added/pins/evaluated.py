"""Corrections applied to in-betweens: the change of their derivatives at any points."""

from dataclasses import dataclass
from typing import NamedTuple, Self

import numpy as np
import numpy.typing as npt

from engine.arrays import Complexes, Floats, Indices, freeze
from engine.interpolation.added.pins.pinning import CorrectionSeries
from engine.interpolation.keyframe_blend.derivatives import Derivatives
from engine.interpolation.series.residual import Residual
from engine.maps import Span


class SpanBasis(NamedTuple):
    """The functions of a span (n,) at nodes (s,), and their derivatives, in single precision.

    Corrections are small relative to positions, and so are their rounding errors.
    """

    values: npt.NDArray[np.complex64]
    slopes: npt.NDArray[np.complex64]

    @classmethod
    def of(cls, span: Span, nodes: Complexes) -> Self:
        """Evaluate the functions at nodes (s,)."""
        values, slopes = span.coordinates(nodes), span.derivatives(nodes)
        return cls(freeze(values.astype(np.complex64)), freeze(slopes.astype(np.complex64)))

    @property
    def nbytes(self) -> int:
        return self.values.nbytes + self.slopes.nbytes

    def combined(self, forms: Complexes) -> Self:
        """Return the functions with coefficients (n, j) instead."""
        single = forms.astype(np.complex64)
        return type(self)(freeze(self.values @ single), freeze(self.slopes @ single))

    def evaluate(self, functions: Complexes | Floats) -> tuple[Complexes, Complexes]:
        """Return functions (n, j) and their derivatives at the nodes, (s, j) each."""
        single = functions.astype(np.complex64)
        values, slopes = self.values @ single, self.slopes @ single
        return values.astype(np.complex128), slopes.astype(np.complex128)


class Mixing(NamedTuple):
    """K, which multiplies q, at nodes (s,), and the derivative of log K."""

    k: Complexes
    log_k_z: Complexes


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class EvaluatedCorrection:
    """h and q of a correction at nodes (s,)."""

    known: CorrectionSeries
    h: Residual
    q: Residual

    @classmethod
    def of(
        cls, known: CorrectionSeries, span: Span, nodes: Complexes, basis: SpanBasis | None = None
    ) -> Self:
        """Evaluate the functions of a correction at nodes (s,); a known basis there saves time."""
        count, functions = known.h.shape[1], np.hstack([known.h, known.q])
        if basis is None:
            values, slopes = span.evaluate(functions, nodes, orders=(0, 1))
        else:
            values, slopes = basis.evaluate(functions)
        return cls(
            known=known,
            h=Residual.of(known.series, values[:, :count], slopes[:, :count]),
            q=Residual.of(known.series, values[:, count:], slopes[:, count:]),
        )

    def at(self, which: Indices) -> Self:
        """Return a copy restricted to some of the nodes."""
        return type(self)(known=self.known, h=self.h.at(which), q=self.q.at(which))

    def changed(
        self, base: Derivatives, mixing: Mixing, sign: int, time: float
    ) -> tuple[Derivatives, Mixing]:
        """Return F e^h, G e^{σh} + q K e^h and K e^h with their derivatives."""
        coefficients = self.known.series(time)
        (h, h_z), (q, q_z) = (each.combined(coefficients) for each in (self.h, self.q))
        # In place: fresh memory for each term would take longer than the arithmetic.
        grown = np.exp(h, out=h)
        k, log_k_z = mixing.k * grown, mixing.log_k_z + h_z
        fz, fzz = base.fz * grown, base.fzz * grown
        term = fz * h_z
        fzz += term
        own = grown if sign > 0 else np.divide(1.0, grown, out=grown)
        g, gz = base.g * own, np.multiply(base.gz, own, out=own)
        gz += np.multiply(g, sign * h_z, out=term)
        gz += np.multiply(k, q_z, out=term)
        k_q = np.multiply(q, k, out=q)
        gz += np.multiply(k_q, log_k_z, out=term)
        g += k_q
        return Derivatives(fz, fzz, g, gz), Mixing(k, log_k_z)

    def changed_values(
        self, fz: Complexes, g: Complexes, k: Complexes, sign: int, times: Floats
    ) -> tuple[Complexes, Complexes, Complexes]:
        """Return F e^h, G e^{σh} + q K e^h and K e^h at times (t,), for F, G and K (t, s)."""
        h, q = self.h.at_times(times), self.q.at_times(times)
        grown = np.exp(h)
        k = k * grown
        return fz * grown, g * (grown if sign > 0 else 1.0 / grown) + q * k, k
