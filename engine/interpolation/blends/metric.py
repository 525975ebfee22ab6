"""The metric variant (Sections 6 and 7.4).

The pullback metric of a map h has the matrix M_h = 𝒜 I + 2 [[Re η, Im η], [Im η, −Re η]], Equation
(9), with 𝒜 = |h_z|² + |h_z̄|², so that blending it linearly means to blend 𝒜 and η. On the outline
that gives |f_z^t|. It differs from the logarithmic blend by a residual that vanishes at both
keyframes, is analytic in time, and takes few forms across the outline: as Σ_j c_j(t) U_j(ζ), a
handful of Dirichlet problems serve every time.
"""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from engine.arrays import Complexes, Floats
from engine.dirichlet import Extension, Refinement
from engine.interpolation.chebyshev import PiecewiseSeries, one, separate
from engine.interpolation.derivatives import Passage
from engine.interpolation.passing import Course, Tangent, bernstein, curbed
from engine.interpolation.periods import Residual
from engine.maps import Bounds, derivatives_of
from engine.paths import IntegrationPaths

TOLERANCE = 1e-9  # of the series' last terms, in ln |f_z|
# Of the modes, at most, in ln |f_z|: of places it is felt in the eighth digit. Where keyframes are
# passed it is felt in the velocity, which must be the same on both sides.
LEFT_OUT, LEFT_OUT_PASSING = 2e-6, 1e-7
# Last Legendre coefficients of the residual on a panel, in ln |f_z|, up to which it may stay; the
# times at which they are looked at; and how often a panel may be halved.
RESOLVED, LOOKED_AT, MOST_HALVINGS = 5e-4, (0.03, 0.25, 0.5, 0.75, 0.97), 8


class MetricResidual(NamedTuple):
    """What the metric variant adds to the logarithmic blend of f_z.

    It makes the metric tensor linear on the outline, and with η linear gives Properties 1 to 4, 5'
    to 7' and 8.

    log f_z is the logarithmic blend and a holomorphic residual,

        log f_z^t = Σ w_i(t) log f_z^i + Σ c_j(t) H_j,

    with the weights of the interval's course, 1 − t and t between two keyframes; the real part of
    H_j on the outline is the mode U_j of the residual. It vanishes at both keyframes, which come
    out exactly however coarsely the integral equation was solved.

    Departs from the paper: Section 7.4 transforms ln |f_z^t| as a whole, with an integration
    constant for the whole shape. Here the constant is tied to the anchor: arg f_z is linear there.

    Parameters
    ----------
    residual : Residual
    lacking : float64, shape (holes, j)
        By how much each H_j stays below U_j on the boundary of a hole.
    """

    residual: Residual
    lacking: Floats

    def lacking_at(self, times: Floats) -> Floats:
        """Return how much the real part stays below at times (t,), (t, holes)."""
        missing: Floats = self.residual.series.at(times).T @ self.lacking.T
        return missing

    @classmethod
    def of(
        cls,
        passage: Passage,
        bounds: Bounds,
        paths: IntegrationPaths,
        transform: Extension,
    ) -> "MetricResidual":
        """Solve the Dirichlet problems of the residual between two keyframes."""
        metric, panels = _resolved(passage, bounds, transform, np.array(LOOKED_AT))
        real_parts, series = separate(
            metric.residuals,
            tolerance=TOLERANCE,
            left_out=LEFT_OUT if passage.course.is_straight else LEFT_OUT_PASSING,
        )
        return cls._extended(real_parts, series, panels, paths)

    @classmethod
    def at(
        cls,
        time: float,
        passage: Passage,
        bounds: Bounds,
        paths: IntegrationPaths,
        transform: Extension,
    ) -> "MetricResidual":
        """Solve the one Dirichlet problem of a time in [0, 1]; at others it is not the residual."""
        metric, panels = _resolved(passage, bounds, transform, np.array([time]))
        return cls._extended(metric.residuals(np.array([time])), one(), panels, paths)

    @classmethod
    def _extended(
        cls,
        real_parts: Floats,
        series: PiecewiseSeries,
        panels: Refinement,
        paths: IntegrationPaths,
    ) -> "MetricResidual":
        modes, modes_z, lacking = panels.extend(real_parts)
        modes.imag -= modes[0].imag
        # Unbounded there; the steps beside these nodes are so short that it is not missed.
        modes_z[paths.cornered] = 0.0
        return cls(Residual.of(series, modes, modes_z), lacking)


def _resolved(
    passage: Passage, bounds: Bounds, transform: Extension, times: Floats
) -> tuple["OutlineMetric", Refinement]:
    """Return the metrics at nodes that resolve the residual at some times, and the nodes' panels.

    The nodes follow the shape. Keyframes at extreme bounds vary faster still beside a vertex of the
    cage, and for them panels are halved there.
    """
    maps = [key.map for key in passage.keyframes]
    course = passage.course
    panels = Refinement.of(transform)
    metric = OutlineMetric.of(*derivatives_of(maps, panels.nodes), course, bounds)
    for _ in range(MOST_HALVINGS):
        coarse = panels.panels.unresolved(metric.residuals(times), RESOLVED)
        if not coarse.any():
            break
        panels = panels.halved(coarse)
        metric = OutlineMetric.of(*derivatives_of(maps, panels.nodes), course, bounds)
    return metric, panels


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class OutlineMetric:
    """The metrics along an interval's course at points of the outline.

    Parameters
    ----------
    course : Course
        Of η.
    log_modulus : float64, shape (q, N)
        ln |f_z| of the keyframes.
    trace : float64, shape (2, N) or (4, N)
        𝒜 = |f_z|² + |f_z̄|², half the trace of the metric tensor: of two keyframes where the course
        is straight, else control values.
    eta : complex128, shape (q, N)
        η up to conjugation, which |f_z| does not see.
    """

    course: Course
    log_modulus: Floats
    trace: Floats
    eta: Complexes

    @classmethod
    def of(cls, fz: Complexes, fzbar: Complexes, course: Course, bounds: Bounds) -> "OutlineMetric":
        """Work the metrics out from the derivatives (q, N) of the course's keyframes."""
        trace, eta = np.abs(fz) ** 2 + np.abs(fzbar) ** 2, fz * fzbar.conj()
        return cls(
            course=course,
            log_modulus=np.log(np.abs(fz)),
            trace=_controls(trace, eta, course, bounds),
            eta=eta,
        )

    def residuals(self, times: Floats) -> Floats:
        """Return ln |f_z| of the blended metric less the blend of the ln |f_z|, (N, times).

        Departs from the paper: the bars of Equation (13) and the lines before it were lost; the
        product of its roots is |η|².
        """
        weights = self.course.full.at(times)
        trace = self.trace.T @ (weights if self.course.is_straight else bernstein(times))
        twice_eta = 2 * np.abs(self.eta.T @ self.course.at(times))
        # σ_a² = 𝒜 + 2|η| and σ_b² = 𝒜 − 2|η|, Equations (10) and (11); K² is their quotient,
        # Equation (12). The first is convex in time and the second concave: Properties 5' to 7'.
        # Their product is the discriminant of (13), above 0 by Lemma 7; as a product it keeps its
        # digits where the map is nearly singular.
        discriminant = (trace + twice_eta) * (trace - twice_eta)
        squared = (trace + np.sqrt(discriminant)) / 2  # Equation (13), the larger root
        residuals: Floats = 0.5 * np.log(squared) - self.log_modulus.T @ weights
        return residuals


def _controls(trace: Floats, eta: Complexes, course: Course, bounds: Bounds) -> Floats:
    """Return the control values of 𝒜 (4, N) along a course, from the keyframes' 𝒜 and η (q, N)."""
    full = course.full.controls
    if full is None:
        return trace
    controls: Floats = full @ trace
    start, end = course.ends
    if isinstance(start, Tangent):
        curb = curbed(trace[:3], eta[:3], start, bounds)
        controls[1] = trace[1] + start.joint.arms[1] * curb
    if isinstance(end, Tangent):
        curb = curbed(trace[-3:], eta[-3:], end, bounds)
        controls[2] = trace[-2] + end.joint.arms[0] * curb
    return controls
