"""The metric variant (Sections 6 and 7.4).

The pullback metric of a map h has the matrix M_h = 𝒜 I + 2 [[Re η, Im η], [Im η, −Re η]], Equation
(9), with 𝒜 = |h_z|² + |h_z̄|², so that blending it linearly means to blend 𝒜 and η. On the outline
that gives |f_z^t|. It differs from the logarithmic blend by a residual that vanishes at both
keyframes, is analytic in time, and takes few forms across the outline: as Σ_j c_j(t) U_j(ζ), a
handful of Dirichlet problems serve every time.
"""

from dataclasses import dataclass
from typing import Self

import numpy as np
import numpy.typing as npt

from engine.arrays import Complexes, Floats, freeze
from engine.chebyshev import PiecewiseSeries, nodes, to_coefficients
from engine.dirichlet import Extension
from engine.interpolation.derivatives import Derivatives, Passage
from engine.interpolation.eta import EtaBlend
from engine.interpolation.passing import Course
from engine.maps import derivatives_of
from engine.paths import IntegrationPaths

DEGREE = 24  # of the series of a piece of time
TOLERANCE = 1e-10  # of the series' last terms, in ln |f_z|
LEFT_OUT = 1e-8  # of the modes, in ln |f_z|: two digits more than the points' places need
LAST_TERMS = 3
SHORTEST = 2.0**-30  # pieces of time are not halved below this


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class MetricBlend:
    """The metric tensor linear on the outline, and η linear: Properties 1 to 4, 5' to 7' and 8.

    log f_z is the logarithmic blend and a holomorphic residual,

        log f_z^t = Σ w_i(t) log f_z^i + Σ c_j(t) H_j,

    with the weights of the interval's course, 1 − t and t between two keyframes; the real part of
    H_j on the outline is the mode U_j of the residual. It vanishes at both keyframes, which come
    out exactly however coarsely the integral equation was solved.

    Departs from the paper: Section 7.4 transforms ln |f_z^t| as a whole, with an integration
    constant for the whole shape. Here the constant is tied to the anchor: arg f_z is linear there.

    Parameters
    ----------
    eta : EtaBlend
    series : PiecewiseSeries
        c_j.
    modes : complex128, shape (j, s)
        H_j at the nodes of the paths.
    modes_z : complex64, shape (j, s)
        H_j' there: the square of a step multiplies it, and single precision is plenty.
    """

    eta: EtaBlend
    series: PiecewiseSeries
    modes: Complexes
    modes_z: npt.NDArray[np.complex64]

    @classmethod
    def of(
        cls,
        passage: Passage,
        paths: IntegrationPaths,
        transform: Extension,
    ) -> Self:
        """Solve the Dirichlet problems of the residual between two keyframes."""
        fz, fzbar = derivatives_of([key.map for key in passage.keyframes], transform.nodes)
        real_parts, series = separate(OutlineMetric.of(fz, fzbar), passage.course)
        modes, modes_z = transform.extend(real_parts)
        modes.imag -= modes[0].imag
        # Unbounded there; the steps beside these nodes are so short that it is not missed.
        modes_z[paths.cornered] = 0.0
        return cls(
            eta=EtaBlend.of(passage),
            series=series,
            modes=freeze(np.ascontiguousarray(modes.T)),
            modes_z=freeze(modes_z.T.astype(np.complex64, order="C")),
        )

    @property
    def nbytes(self) -> int:
        """Memory beyond the keyframes' own, in bytes."""
        arrays = (self.modes, self.modes_z, self.series.coefficients)
        return self.eta.nbytes + sum(array.nbytes for array in arrays)

    def derivatives(self, time: float) -> Derivatives:
        """Blend the metric on the outline and η everywhere."""
        passage = self.eta.passage
        weights = passage.course(time)
        logarithm, logarithm_z = passage.log_fz(weights)
        coefficients = self.series(time)
        # As reals: a complex product with real coefficients would do half its work on zeros.
        logarithm.view(np.float64)[:] += coefficients @ self.modes.view(np.float64)
        single = coefficients.astype(np.float32)
        logarithm_z.view(np.float64)[:] += single @ self.modes_z.view(np.float32)
        return self.eta.with_log_fz(logarithm, logarithm_z, weights)


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class OutlineMetric:
    """The metrics of an interval's keyframes at points of the outline.

    Parameters
    ----------
    log_modulus, trace : float64, shape (q, N)
        ln |f_z|, and 𝒜 = |f_z|² + |f_z̄|², half the trace of the metric tensor.
    eta : complex128, shape (q, N)
        η up to conjugation, which |f_z| does not see.
    """

    log_modulus: Floats
    trace: Floats
    eta: Complexes

    @classmethod
    def of(cls, fz: Complexes, fzbar: Complexes) -> "OutlineMetric":
        """Work the metrics out from the derivatives (q, N)."""
        return cls(
            log_modulus=np.log(np.abs(fz)),
            trace=np.abs(fz) ** 2 + np.abs(fzbar) ** 2,
            eta=fz * fzbar.conj(),
        )

    def residuals(self, weights: Floats) -> Floats:
        """Return ln |f_z| of the blended metric less the blend of the ln |f_z|, (N, t).

        Departs from the paper: the bars of Equation (13) and the lines before it were lost; the
        product of its roots is |η|².

        Parameters
        ----------
        weights : float64, shape (q, t)
            Of the keyframes, at t times.
        """
        trace = self.trace.T @ weights
        twice_eta = 2 * np.abs(self.eta.T @ weights)
        # σ_a² = 𝒜 + 2|η| and σ_b² = 𝒜 − 2|η|, Equations (10) and (11); K² is their quotient,
        # Equation (12). The first is convex in time and the second concave: Properties 5' to 7'.
        # Their product is the discriminant of (13), above 0 by Lemma 7; as a product it keeps its
        # digits where the map is nearly singular.
        discriminant = (trace + twice_eta) * (trace - twice_eta)
        squared = (trace + np.sqrt(discriminant)) / 2  # Equation (13), the larger root
        residuals: Floats = 0.5 * np.log(squared) - self.log_modulus.T @ weights
        return residuals


def separate(metric: OutlineMetric, course: Course) -> tuple[Floats, PiecewiseSeries]:
    """Write the residuals along a course as a sum of products of functions on the outline and time.

    Returns
    -------
    modes : float64, shape (N, j)
    series : PiecewiseSeries
        Of the j coefficients; the residuals are `modes @ series(t)` to about 1e-8.
    """
    x = nodes(DEGREE)
    pending = [(0.0, 1.0)]
    breaks, pieces = [0.0], []
    while pending:
        start, end = pending.pop()
        times = start + (end - start) * (1 + x) / 2
        coefficients = metric.residuals(course.at(times)) @ to_coefficients(DEGREE).T
        rest = np.abs(coefficients[:, -LAST_TERMS:]).max()
        if rest <= TOLERANCE or end - start <= SHORTEST:
            breaks.append(end)
            pieces.append(coefficients)
        else:
            middle = (start + end) / 2
            pending += [(middle, end), (start, middle)]
    modes, sizes, functions = np.linalg.svd(np.hstack(pieces), full_matrices=False)
    kept = max(1, int(np.count_nonzero(sizes > LEFT_OUT)))
    series = (sizes[:kept, None] * functions[:kept]).reshape(kept, len(pieces), DEGREE + 1)
    times, coefficients = np.array(breaks), series.transpose(1, 2, 0)
    return modes[:, :kept], PiecewiseSeries(
        breaks=freeze(times), coefficients=freeze(_vanishing_at_ends(times, coefficients))
    )


def _vanishing_at_ends(breaks: Floats, coefficients: Floats) -> Floats:
    """Take off the rounding that is left at the keyframes, so that they come out exactly."""
    signs = (-1.0) ** np.arange(DEGREE + 1)
    first, last = signs @ coefficients[0], coefficients[-1].sum(axis=0)
    at_breaks = first + np.multiply.outer(breaks, last - first)
    corrected = coefficients.copy()
    corrected[:, 0] -= (at_breaks[1:] + at_breaks[:-1]) / 2
    corrected[:, 1] -= (at_breaks[1:] - at_breaks[:-1]) / 2
    return corrected
