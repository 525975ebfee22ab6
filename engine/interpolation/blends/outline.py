"""The metric tensors during a segment, on the outline (Section 6)."""

from dataclasses import dataclass
from typing import Self

import numpy as np

from engine.arrays import Complexes, Floats
from engine.interpolation.enclosures.cells import project_on_mean
from engine.interpolation.enclosures.pieces import BoundaryBezier
from engine.interpolation.time_weights.tangents import (
    ValueRange,
    allowed_velocities,
    clamp_smoothly,
    limit_velocity,
)
from engine.interpolation.time_weights.weights import Tangent, TimeWeights
from engine.maps import Bounds


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class OutlineMetric:
    """The metrics during a segment at points of the outline.

    Attributes
    ----------
    time_weights : TimeWeights
        Weights of η.
    log_modulus : float64, shape (q, N)
        ln |f_z| of the keyframes.
    trace : float64, shape (2, N) or (4, N)
        𝒜 = |f_z|² + |f_z̄|², half the trace of the metric tensor. With straight time weights it is
        that of two keyframes, otherwise it holds control values.
    eta : complex128, shape (q, N)
        η up to conjugation, which does not change |f_z|.
    """

    time_weights: TimeWeights
    log_modulus: Floats
    trace: Floats
    eta: Complexes

    @classmethod
    def of(cls, fz: Complexes, fzbar: Complexes, time_weights: TimeWeights, bounds: Bounds) -> Self:
        """Compute the metrics from the derivatives (q, N) of the weighted keyframes."""
        # The entries of the metric tensor, Equation (9).
        trace, eta = np.abs(fz) ** 2 + np.abs(fzbar) ** 2, fz * fzbar.conj()
        return cls(
            time_weights=time_weights,
            log_modulus=np.log(np.abs(fz)),
            trace=_controls(trace, eta, time_weights, bounds),
            eta=eta,
        )

    def residuals(self, times: Floats) -> Floats:
        """Return ln |f_z| of the blended metric minus the blend of the ln |f_z|, (N, times).

        Departs from the paper: the bars of Equation (13) and the lines before it were lost; the
        product of its roots is |η|².
        """
        trace = self.trace.T @ trace_time_weights(self.time_weights).at(times)
        twice_eta = 2 * np.abs(self.eta.T @ self.time_weights.at(times))
        # Equation (10): σ_a² = 𝒜 + 2|η|, convex in time. Equation (11): σ_b² = 𝒜 − 2|η|, concave.
        # Equation (12): K² is their quotient. Hence Properties 5' to 7'. Their product is the
        # discriminant, above 0 by Lemma 7, and keeps its digits where the map is nearly singular.
        discriminant = (trace + twice_eta) * (trace - twice_eta)
        squared = (trace + np.sqrt(discriminant)) / 2  # Equation (13), the larger root
        blend = self.log_modulus.T @ self.time_weights.unlimited.at(times)
        residuals: Floats = 0.5 * np.log(squared) - blend
        return residuals


def trace_time_weights(time_weights: TimeWeights) -> TimeWeights:
    """Return the time weights of the values or control values of 𝒜, given those of η."""
    return time_weights if time_weights.is_straight else TimeWeights.cubic()


def _controls(trace: Floats, eta: Complexes, time_weights: TimeWeights, bounds: Bounds) -> Floats:
    """Return the control values of 𝒜 (4, N), from 𝒜 and η (q, N) of the keyframes."""
    full = time_weights.unlimited.controls
    if full is None:
        return trace
    controls: Floats = full @ trace
    for row, end, window, arm in zip(
        (1, 2), time_weights.ends, time_weights.support, (1, 0), strict=True
    ):
        if isinstance(end, Tangent):
            left = limit_velocity(trace[window], eta[window], end, bounds)
            controls[row] = trace[window[1]] + end.knot.control_offsets[arm] * left
    return controls


def control_curves(
    trace: BoundaryBezier[np.float64],
    eta: BoundaryBezier[np.complex128],
    time_weights: TimeWeights,
    bounds: Bounds,
) -> BoundaryBezier[np.float64]:
    """Return the control values of 𝒜 with error bounds along pieces of the boundary.

    `trace` and `eta` are those of the keyframes; `course` has the time weights of η.

    Notes
    -----
    Where 𝒜 has its full velocity along a piece, the control values are as exact as 𝒜. Where the
    velocity is limited, they interpolate linearly between both ends of the piece. The error is then
    the range of the limited velocity, which rises with the velocity and with its limits.
    """
    full = time_weights.unlimited.controls
    if full is None:
        return trace
    controls = np.einsum("dq,pqb->pdb", full, trace.controls)
    errors = trace.errors @ np.abs(full).T
    for index, (end, arm) in enumerate(zip(time_weights.ends, (1, 0), strict=True)):
        if not isinstance(end, Tangent):
            continue
        own = time_weights.support[index]
        here = trace.of(own)
        velocity, error = _velocity(here, eta.of(own), end, bounds)
        reach = end.knot.control_offsets[arm]
        controls[:, 1 + index] = here.controls[:, 1] + reach * velocity
        errors[:, 1 + index] = here.errors[:, 1] + abs(reach) * error
    return BoundaryBezier(controls, errors)


def _velocity(
    trace: BoundaryBezier[np.float64],
    eta: BoundaryBezier[np.complex128],
    tangent: Tangent,
    bounds: Bounds,
) -> tuple[Floats, Floats]:
    """Return the velocity of 𝒜 at a tangent as quadratics (p, 3) along pieces, and its errors."""
    joint = tangent.knot
    free = np.einsum("q,pqb->pb", joint.velocity, trace.controls)
    free_error = trace.errors @ np.abs(joint.velocity)
    if not tangent.velocity_share:
        return 0.0 * free, 0.0 * free_error
    wanted = _range(free, free_error)
    own = _range(trace.controls[:, 1], trace.errors[:, 1])
    turned = []
    for arm in joint.control_offsets:
        weights = np.array([0.0, 1.0, 0.0]) + arm * tangent.length * joint.velocity
        turned.append(_size(eta, weights))
    lowest, highest = allowed_velocities(
        ValueRange(np.maximum(own.least, 0.0), own.most),
        _size(eta, np.array([0.0, 1.0, 0.0])),
        (turned[0], turned[1]),
        joint,
        bounds,
    )
    is_free = (wanted.most <= highest.least / 2) & (wanted.least >= lowest.most / 2)
    is_free &= (lowest.most <= 0.0) & (highest.least >= 0.0)
    ends = np.stack(
        [
            limit_velocity(trace.controls[:, :, end].T, eta.controls[:, :, end].T, tangent, bounds)
            for end in (0, -1)
        ],
        axis=1,
    )
    least, most = (clamp_smoothly(*each) for each in zip(wanted, lowest, highest, strict=True))
    error = np.maximum(most - ends.min(axis=1), ends.max(axis=1) - least)
    linear = np.stack([ends[:, 0], ends.mean(axis=1), ends[:, 1]], axis=1)
    return (
        np.where(is_free[:, None], free, linear),
        np.where(is_free, free_error, np.where(np.isnan(error), np.inf, error)),
    )


def _range(controls: Floats, errors: Floats) -> ValueRange:
    return ValueRange(controls.min(axis=1) - errors, controls.max(axis=1) + errors)


def _size(curves: BoundaryBezier[np.complex128], weights: Floats) -> ValueRange:
    """Return the range of the absolute value of a weighted sum of three keyframes."""
    controls = np.einsum("q,pqb->pb", weights, curves.controls)
    errors = curves.errors @ np.abs(weights)
    least = project_on_mean(controls, 1).min(axis=1) - errors
    return ValueRange(np.maximum(least, 0.0), np.abs(controls).max(axis=1) + errors)
