"""The metric tensors along an interval's course, on the outline (Section 6)."""

from dataclasses import dataclass
from typing import Self

import numpy as np

from engine.arrays import Complexes, Floats
from engine.interpolation.courses import Course, Range, Tangent, allowed_velocities, curb, curbed
from engine.interpolation.enclosing import EdgeCurves, along_mean
from engine.maps import Bounds


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
    def of(cls, fz: Complexes, fzbar: Complexes, course: Course, bounds: Bounds) -> Self:
        """Work the metrics out from the derivatives (q, N) of the course's keyframes."""
        # The entries of the metric tensor, Equation (9).
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
        trace = self.trace.T @ course_of_trace(self.course).at(times)
        twice_eta = 2 * np.abs(self.eta.T @ self.course.at(times))
        # Equation (10): σ_a² = 𝒜 + 2|η|, convex in time. Equation (11): σ_b² = 𝒜 − 2|η|, concave.
        # Equation (12): K² is their quotient. Hence Properties 5' to 7'. Their product is the
        # discriminant, above 0 by Lemma 7, and keeps its digits where the map is nearly singular.
        discriminant = (trace + twice_eta) * (trace - twice_eta)
        squared = (trace + np.sqrt(discriminant)) / 2  # Equation (13), the larger root
        blend = self.log_modulus.T @ self.course.full.at(times)
        residuals: Floats = 0.5 * np.log(squared) - blend
        return residuals


def course_of_trace(course: Course) -> Course:
    """Return the weights of what is known of 𝒜 along a course of η."""
    return course if course.is_straight else Course.cubic()


def _controls(trace: Floats, eta: Complexes, course: Course, bounds: Bounds) -> Floats:
    """Return the control values of 𝒜 (4, N) along a course, from the keyframes' 𝒜 and η (q, N)."""
    full = course.full.controls
    if full is None:
        return trace
    controls: Floats = full @ trace
    for row, end, window, arm in zip((1, 2), course.ends, course.windows, (1, 0), strict=True):
        if isinstance(end, Tangent):
            left = curbed(trace[window], eta[window], end, bounds)
            controls[row] = trace[window[1]] + end.joint.arms[arm] * left
    return controls


def control_curves(
    trace: EdgeCurves[np.float64], eta: EdgeCurves[np.complex128], course: Course, bounds: Bounds
) -> EdgeCurves[np.float64]:
    """Return what is known of the control values of 𝒜 along pieces of the boundary.

    Parameters
    ----------
    trace, eta : EdgeCurves
        Of the keyframes.
    course : Course
        Of η.
    bounds : Bounds

    Notes
    -----
    Where 𝒜 has all of its velocity along a piece, control values are as exact as 𝒜 is. Where it is
    curbed they are the linear interpolant of what the velocity is at both ends, and are off by as
    much as the curb may be elsewhere in between: it rises with the velocity and with the limits of
    it, so that their ranges give its own.
    """
    full = course.full.controls
    if full is None:
        return trace
    controls = np.einsum("dq,pqb->pdb", full, trace.controls)
    errors = trace.errors @ np.abs(full).T
    for index, (end, arm) in enumerate(zip(course.ends, (1, 0), strict=True)):
        if not isinstance(end, Tangent):
            continue
        own = course.windows[index]
        here = trace.of(own)
        velocity, error = _velocity(here, eta.of(own), end, bounds)
        reach = end.joint.arms[arm]
        controls[:, 1 + index] = here.controls[:, 1] + reach * velocity
        errors[:, 1 + index] = here.errors[:, 1] + abs(reach) * error
    return EdgeCurves(controls, errors)


def _velocity(
    trace: EdgeCurves[np.float64], eta: EdgeCurves[np.complex128], tangent: Tangent, bounds: Bounds
) -> tuple[Floats, Floats]:
    """Return the velocity of 𝒜 at a joint as quadratics (p, 3) along pieces, and its errors."""
    joint = tangent.joint
    free = np.einsum("q,pqb->pb", joint.velocity, trace.controls)
    free_error = trace.errors @ np.abs(joint.velocity)
    if not tangent.kept:
        return 0.0 * free, 0.0 * free_error
    wanted = _range(free, free_error)
    own = _range(trace.controls[:, 1], trace.errors[:, 1])
    turned = []
    for arm in joint.arms:
        weights = np.array([0.0, 1.0, 0.0]) + arm * tangent.length * joint.velocity
        turned.append(_size(eta, weights))
    lowest, highest = allowed_velocities(
        Range(np.maximum(own.least, 0.0), own.most),
        _size(eta, np.array([0.0, 1.0, 0.0])),
        (turned[0], turned[1]),
        joint,
        bounds,
    )
    is_free = (wanted.most <= highest.least / 2) & (wanted.least >= lowest.most / 2)
    is_free &= (lowest.most <= 0.0) & (highest.least >= 0.0)
    ends = np.stack(
        [
            curbed(trace.controls[:, :, end].T, eta.controls[:, :, end].T, tangent, bounds)
            for end in (0, -1)
        ],
        axis=1,
    )
    least, most = (curb(*each) for each in zip(wanted, lowest, highest, strict=True))
    error = np.maximum(most - ends.min(axis=1), ends.max(axis=1) - least)
    linear = np.stack([ends[:, 0], ends.mean(axis=1), ends[:, 1]], axis=1)
    return (
        np.where(is_free[:, None], free, linear),
        np.where(is_free, free_error, np.where(np.isnan(error), np.inf, error)),
    )


def _range(controls: Floats, errors: Floats) -> Range:
    return Range(controls.min(axis=1) - errors, controls.max(axis=1) + errors)


def _size(curves: EdgeCurves[np.complex128], weights: Floats) -> Range:
    """Return the range of the absolute value of a weighted sum of three keyframes."""
    controls = np.einsum("q,pqb->pb", weights, curves.controls)
    errors = curves.errors @ np.abs(weights)
    least = along_mean(controls, 1).min(axis=1) - errors
    return Range(np.maximum(least, 0.0), np.abs(controls).max(axis=1) + errors)
