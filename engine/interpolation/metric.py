"""The metric variant (Sections 6 and 7.4)."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Self

import numpy as np
import numpy.typing as npt

from engine.arrays import Complexes, Floats, Integers, readonly
from engine.dirichlet import HilbertTransform, ProjectedTransform
from engine.interpolation.derivatives import Derivatives, blended_log_fz
from engine.interpolation.eta import EtaBlend
from engine.interpolation.keyframe_samples import KeyframeSamples
from engine.interpolation.metric_residual import OutlineMetric, TimeSeries, separate
from engine.paths import IntegrationPaths


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class MetricBlend:
    """The metric tensor linear on the outline, and η linear: Properties 1 to 4, 5' to 7' and 8.

    log f_z is the logarithmic blend and a holomorphic residual,

        log f_z^t = (1 − t) log f_z⁰ + t log f_z¹ + Σ c_j(t) H_j,

    H_j the Hilbert transforms of the shapes that the residual takes on the outline. It vanishes at
    both keyframes, which come out exactly however coarsely the integral equation was solved.

    Departs from the paper: Section 7.4 transforms ln |f_z^t| as a whole, with an integration
    constant for the whole shape. Here the constant is tied to the anchor: arg f_z is linear there.

    Parameters
    ----------
    eta : EtaBlend
        Of the two keyframes.
    series : TimeSeries
        c_j.
    shapes : complex128, shape (j, s)
        H_j at the nodes.
    shape_slopes : complex64, shape (j, s)
        H_j' at the nodes: the square of a step multiplies it, and single precision is plenty.
    """

    eta: EtaBlend
    series: TimeSeries
    shapes: Complexes
    shape_slopes: npt.NDArray[np.complex64]

    @classmethod
    def of(
        cls,
        keyframes: Sequence[KeyframeSamples],
        sheets: Integers,
        paths: IntegrationPaths,
        transform: HilbertTransform | ProjectedTransform,
    ) -> Self:
        """Solve the Dirichlet problems of the residual between two keyframes."""
        derivatives = [key.map.derivatives(transform.nodes) for key in keyframes]
        fz, fzbar = (np.array(column) for column in zip(*derivatives, strict=True))
        real_parts, series = separate(OutlineMetric.of(fz, fzbar))
        values, slopes = transform.extend(real_parts, paths.nodes)
        values.imag -= values[0].imag
        # Unbounded there; the steps beside these nodes are so short that it is not missed.
        slopes[paths.cornered] = 0.0
        return cls(
            eta=EtaBlend.of(keyframes, sheets),
            series=series,
            shapes=readonly(values.T),
            shape_slopes=readonly(slopes.T.astype(np.complex64)),
        )

    @property
    def nbytes(self) -> int:
        """Memory beyond the keyframes' own, in bytes."""
        arrays = (self.shapes, self.shape_slopes, self.series.coefficients)
        return self.eta.nbytes + sum(array.nbytes for array in arrays)

    def derivatives(self, weights: Floats) -> Derivatives:
        """Blend the metric on the outline and η everywhere."""
        logarithm, log_slope = blended_log_fz(self.eta.keyframes, self.eta.sheets, weights)
        coefficients = self.series(float(weights[1]))
        # As reals: a complex product with real coefficients would do half its work on zeros.
        logarithm.view(np.float64)[:] += coefficients @ self.shapes.view(np.float64)
        single = coefficients.astype(np.float32)
        log_slope.view(np.float64)[:] += single @ self.shape_slopes.view(np.float32)
        return self.eta.with_log_fz(logarithm, log_slope, weights)
