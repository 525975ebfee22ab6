"""Largest length of a tangent: the control values beside a keyframe obey the bounds.

For the metric variant the bounds are convex in (𝒜, η): 𝒜 + 2|η| ≤ σ_a², 𝒜 − 2|η| ≥ σ_b² and
|η| ≤ 𝒜 k / (1 + k²). If the control values on the boundary obey them, so does every in-between on
the boundary. As η is anti-holomorphic and f_z has no zeros, so does every in-between inside. 𝒜 is
free at each point of the boundary and is limited only where necessary; bisection finds the velocity
of η. For ν the bound on k is convex, but the bounds on σ are not. For the other variants no bound
is convex. Scaled η obeys the bounds by its ρ (`engine.interpolation.scaling`).
"""

from collections.abc import Callable
from math import inf
from typing import NamedTuple

import numpy as np

from engine.arrays import Complexes, Floats
from engine.interpolation.time_weights.weights import InteriorKnot, Tangent
from engine.maps import Boundary, Bounds, HarmonicMap

PARTS = 6  # of each boundary segment, for the samples of control values
# Between samples a value exceeds them by an eighth of its second differences, to leading order.
BETWEEN = 1.5 / 8
# Share of a bound reserved for the error of the Dirichlet problem's solution.
SPARE = 1e-4
# Shares of the distance to a control value that are tested. If a variant's bounds are not convex,
# the segment to the control value may leave them and return.
SHARES = (1.0, 0.25, 0.0625)
HALVINGS = 30
SAME_MAP = 1e-9  # of the size of the shape

SingularValues = Callable[[Complexes, Complexes], tuple[Floats, Floats]]


def derivatives_along(f: HarmonicMap, boundary: Boundary) -> tuple[Complexes, Complexes]:
    """Return f_z and conj(f_z̄) along the boundary's segments, complex128 (p, PARTS + 1) each."""
    ends = boundary.points[boundary.next_samples]
    steps = np.linspace(0.0, 1.0, PARTS + 1)
    along = boundary.points[:, None] + (ends - boundary.points)[:, None] * steps
    fz, fzbar = (values.reshape(along.shape) for values in f.derivatives(along.ravel()))
    return fz, fzbar.conj()


def are_same_maps(f: HarmonicMap, other: HarmonicMap, boundary: Boundary) -> bool:
    """Return whether two maps agree on the boundary."""
    if f is other:
        return True
    vertices = np.concatenate(boundary.loops)
    apart = f(vertices) - other(vertices)
    return bool(np.abs(apart).max() <= SAME_MAP * boundary.size)


def shorten_tangent(
    quantities: Complexes, stretches: SingularValues, joint: InteriorKnot, bounds: Bounds
) -> Tangent:
    """Return the tangent at a knot, short enough for the control values to obey the bounds.

    Parameters
    ----------
    quantities : complex128, shape (3, 2, p, PARTS + 1)
        The blended quantities of a keyframe and its neighbours, along the boundary's segments.
    stretches : callable
        Returns σ_a and σ_b, given the two quantities.
    bounds : Bounds
        Widened by the keyframe's own extremes.
    """
    key, velocity = quantities[1], np.tensordot(joint.velocity, quantities, axes=1)
    worst_a, worst_b = stretches(*key)
    limits = (
        max(bounds.sigma_a, float(worst_a.max())) * (1.0 - SPARE),
        min(bounds.sigma_b, float(worst_b.min())) * (1.0 + SPARE),
        max(bounds.k, float(_dilatation(worst_a, worst_b).max())) * (1.0 - SPARE),
    )

    def is_within(length: float) -> bool:
        # Far beyond the limits, stretches overflow and do not obey.
        with np.errstate(over="ignore", invalid="ignore"):
            return all(
                _obeys(*stretches(*(key + share * length * arm * velocity)), limits)
                for arm in joint.control_offsets
                for share in SHARES
            )

    length = _longest(is_within)
    return Tangent(joint, length, length)


def shorten_metric_tangent(
    quantities: Complexes, joint: InteriorKnot, bounds: Bounds, boundary: Boundary
) -> Tangent:
    """Return a tangent of 𝒜 and η, with the longest velocity of η that 𝒜 can compensate.

    The arguments are as in `shorten_tangent`.
    """
    trace, eta = quantities[:, 0].real, quantities[:, 1]
    velocity, turned = np.tensordot(joint.velocity, quantities, axes=1)

    def is_within(length: float) -> bool:
        lowest, highest = _allowed(trace[1], eta[1], length * turned, joint, bounds)
        # Between samples the slack may be smaller.
        slack = highest - lowest
        return bool((slack.min(axis=1) >= BETWEEN * _second(slack)).all())

    length = _longest(is_within)
    left = limit_velocity(trace, eta, Tangent(joint, length, 1.0), bounds)
    weights = np.repeat(boundary.lengths[:, None], PARTS + 1, axis=1)

    def energy(by_trace: Floats, by_eta: Complexes) -> float:
        return float((weights * (by_trace**2 + 4 * np.abs(by_eta) ** 2)).sum())

    whole = energy(velocity.real, turned)
    kept = energy(left, length * turned) / whole if whole > 0 else 1.0
    return Tangent(joint, length, min(1.0, kept**0.5))


def limit_velocity(trace: Floats, eta: Complexes, tangent: Tangent, bounds: Bounds) -> Floats:
    """Return the velocity of 𝒜 at a knot, limited point by point by the bounds, float64 (...).

    `trace` and `eta` (3, ...) are 𝒜 and η of the keyframe and its neighbours, at points of the
    boundary.
    """
    joint = tangent.knot
    velocity: Floats = np.tensordot(joint.velocity, trace, axes=1)
    if not tangent.velocity_share:
        return 0.0 * velocity
    turned = tangent.length * np.tensordot(joint.velocity, eta, axes=1)
    return clamp_smoothly(velocity, *_allowed(trace[1], eta[1], turned, joint, bounds))


def clamp_smoothly(velocity: Floats, lowest: Floats, highest: Floats) -> Floats:
    """Limit velocities of 𝒜 smoothly to the range from `lowest` to `highest`.

    The result is nondecreasing in all three arguments.
    """
    middle = (lowest + highest) / 2
    lowest, highest = np.minimum(lowest, middle), np.maximum(highest, middle)
    still = np.clip(0.0, lowest, highest)
    wanted = velocity - still
    slack = np.where(wanted > 0, highest - still, still - lowest)
    # The full velocity up to half of the slack, and the full slack from 1.5 of it, without a kink.
    share = np.abs(wanted) / np.where(slack > 0, slack, 1.0)
    bent = share - np.clip(share - 0.5, 0.0, None) ** 2 / 2
    held = np.where(share <= 0.5, share, np.where(share < 1.5, bent, 1.0))
    left: Floats = still + np.sign(wanted) * slack * held
    return left


class ValueRange(NamedTuple):
    """Lower and upper bounds of a quantity, float64 (...) each."""

    least: Floats
    most: Floats


def allowed_velocities(
    trace: ValueRange,
    size: ValueRange,
    turned: tuple[ValueRange, ValueRange],
    joint: InteriorKnot,
    bounds: Bounds,
) -> tuple[ValueRange, ValueRange]:
    """Return ranges of the least and largest velocity of 𝒜 with both control values in bounds.

    `trace` and `size` are 𝒜 and |η| of the keyframe, `turned` |η| of the control values. `bounds`
    are widened by the keyframe's own extremes.
    """
    stretch = (bounds.sigma_a * (1.0 - SPARE)) ** 2
    squeeze = (bounds.sigma_b * (1.0 + SPARE)) ** 2
    k = bounds.k * (1.0 - SPARE)
    shear = k / (1.0 + k * k)
    lowest, highest = [], []
    for arm, around in zip(joint.control_offsets, turned, strict=True):
        # Least and largest growth of 𝒜: for σ_b and k, and for σ_a.
        must = ValueRange(
            *(
                np.maximum(
                    np.minimum(squeeze - t, -2 * s) + 2 * u,
                    np.minimum(u / shear - t, _in_proportion(u, s, trace, extreme)),
                )
                for u, s, t, extreme in (
                    (around.least, size.most, trace.most, np.minimum),
                    (around.most, size.least, trace.least, np.maximum),
                )
            )
        )
        may = ValueRange(
            np.maximum(stretch - trace.most, 2 * size.least) - 2 * around.most,
            np.maximum(stretch - trace.least, 2 * size.most) - 2 * around.least,
        )
        if arm > 0:
            lowest.append(ValueRange(must.least / arm, must.most / arm))
            highest.append(ValueRange(may.least / arm, may.most / arm))
        else:
            lowest.append(ValueRange(may.most / arm, may.least / arm))
            highest.append(ValueRange(must.most / arm, must.least / arm))
    return (
        ValueRange(*(np.maximum(*ends) for ends in zip(*lowest, strict=True))),
        ValueRange(*(np.minimum(*ends) for ends in zip(*highest, strict=True))),
    )


def _in_proportion(
    turned: Floats, size: Floats, trace: ValueRange, extreme: Callable[[Floats, Floats], Floats]
) -> Floats:
    """Return the growth of 𝒜 that keeps its ratio to |η|."""
    with np.errstate(divide="ignore", invalid="ignore"):
        growth = np.where(size > 0, turned / size - 1.0, np.inf)
    found: Floats = extreme(trace.least * growth, trace.most * growth)
    return found


def _allowed(
    trace: Floats, eta: Complexes, turned: Complexes, joint: InteriorKnot, bounds: Bounds
) -> tuple[Floats, Floats]:
    """Return the least and largest velocity of 𝒜 at points, given the change of η."""
    own, size = ValueRange(trace, trace), np.abs(eta)
    around = [np.abs(eta + arm * turned) for arm in joint.control_offsets]
    lowest, highest = allowed_velocities(
        own,
        ValueRange(size, size),
        (ValueRange(around[0], around[0]), ValueRange(around[1], around[1])),
        joint,
        bounds,
    )
    return lowest.least, highest.least


def _longest(is_within: Callable[[float], bool]) -> float:
    """Return the largest number in [0, 1] within the condition, by bisection."""
    if is_within(1.0):
        return 1.0
    low, high = 0.0, 1.0
    for _ in range(HALVINGS):
        middle = (low + high) / 2
        if is_within(middle):
            low = middle
        else:
            high = middle
    return low


def _obeys(sigma_a: Floats, sigma_b: Floats, limits: tuple[float, float, float]) -> bool:
    """Return whether σ_a and σ_b (p, PARTS + 1), and k, obey limits, also between samples."""
    k = _dilatation(sigma_a, sigma_b)
    return (
        _largest(sigma_a) <= limits[0]
        and -_largest(-sigma_b) >= limits[1]
        and _largest(k) <= limits[2]
    )


def _largest(values: Floats) -> float:
    """Return an upper bound along segments, also between the samples (p, PARTS + 1)."""
    return float((values.max(axis=1) + BETWEEN * _second(values)).max())


def _second(values: Floats) -> Floats:
    """Return the largest second difference of values (p, PARTS + 1) along each segment."""
    second: Floats = np.abs(values[:, 2:] - 2 * values[:, 1:-1] + values[:, :-2]).max(axis=1)
    return second


def _dilatation(sigma_a: Floats, sigma_b: Floats) -> Floats:
    """Return k; above 1 for a map that folds."""
    whole = sigma_a + sigma_b
    k: Floats = np.where(whole > 0, (sigma_a - sigma_b) / np.where(whole > 0, whole, 1.0), inf)
    return k
