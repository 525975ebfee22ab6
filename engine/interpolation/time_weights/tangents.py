"""How long a tangent may be: the control values beside a keyframe obey the bounds.

For the metric variant the bounds are convex in (𝒜, η): 𝒜 + 2|η| ≤ σ_a², 𝒜 − 2|η| ≥ σ_b² and
|η| ≤ 𝒜 k / (1 + k²). Obeyed by the control values on the boundary, they hold for every in-between,
there and, as η is anti-holomorphic and f_z has no zeros, inside. As 𝒜 is free at each point of the
boundary, it is only curbed where it must be; what is left to bisection is the velocity of η. For ν
the bound on k is convex, and those on σ are not; nor are any of the others'. Scaled η has its ρ to
obey them (`engine.interpolation.scaling`).
"""

from collections.abc import Callable
from math import inf
from typing import NamedTuple

import numpy as np

from engine.arrays import Complexes, Floats
from engine.interpolation.time_weights.weights import InteriorKnot, Tangent
from engine.maps import Boundary, Bounds, HarmonicMap

PARTS = 6  # into which the boundary's segments are cut for the samples of control values
# Between samples a value exceeds them by an eighth of its second differences, to leading order.
BETWEEN = 1.5 / 8
# Part of a bound that is left to the errors of the Dirichlet problem's solution.
SPARE = 1e-4
# Shares of the way to a control value that are looked at too: where a variant's bounds are not
# convex, the way may leave them at once and come back.
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
    """Tell whether two maps place the boundary alike."""
    if f is other:
        return True
    vertices = np.concatenate(boundary.loops)
    apart = f(vertices) - other(vertices)
    return bool(np.abs(apart).max() <= SAME_MAP * boundary.size)


def shorten_tangent(
    quantities: Complexes, stretches: SingularValues, joint: InteriorKnot, bounds: Bounds
) -> Tangent:
    """Return a joint's tangent, short enough for the control values to obey the bounds.

    Parameters
    ----------
    quantities : complex128, shape (3, 2, p, PARTS + 1)
        What is blended of a keyframe and its neighbours, along the boundary's segments.
    stretches : callable
        Returns σ_a and σ_b of two such quantities.
    joint : InteriorKnot
    bounds : Bounds
        Widened where the keyframe itself exceeds them.
    """
    key, velocity = quantities[1], np.tensordot(joint.velocity, quantities, axes=1)
    worst_a, worst_b = stretches(*key)
    limits = (
        max(bounds.sigma_a, float(worst_a.max())) * (1.0 - SPARE),
        min(bounds.sigma_b, float(worst_b.min())) * (1.0 + SPARE),
        max(bounds.k, float(_dilatation(worst_a, worst_b).max())) * (1.0 - SPARE),
    )

    def is_within(length: float) -> bool:
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
    """Return a tangent of 𝒜 and η, with the velocity of η as long as 𝒜 can make up for it.

    Parameters
    ----------
    quantities : complex128, shape (3, 2, p, PARTS + 1)
    joint, bounds
        As in `shortened`.
    boundary : Boundary
    """
    trace, eta = quantities[:, 0].real, quantities[:, 1]
    velocity, turned = np.tensordot(joint.velocity, quantities, axes=1)

    def is_within(length: float) -> bool:
        lowest, highest = _allowed(trace[1], eta[1], length * turned, joint, bounds)
        # Between samples the slack may be less.
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
    """Return the velocity of 𝒜 at a joint, curbed point by point where bounds ask for it.

    Parameters
    ----------
    trace : float64, shape (3, ...)
        𝒜 of the keyframe and its neighbours at points of the boundary.
    eta : complex128, shape (3, ...)
    tangent : Tangent
    bounds : Bounds

    Returns
    -------
    float64, shape (...)
    """
    joint = tangent.knot
    velocity: Floats = np.tensordot(joint.velocity, trace, axes=1)
    if not tangent.velocity_share:
        return 0.0 * velocity
    turned = tangent.length * np.tensordot(joint.velocity, eta, axes=1)
    return clamp_smoothly(velocity, *_allowed(trace[1], eta[1], turned, joint, bounds))


def clamp_smoothly(velocity: Floats, lowest: Floats, highest: Floats) -> Floats:
    """Return velocities of 𝒜 that are smoothly held between the least and the largest allowed.

    What is returned does not fall where any of the three rises.
    """
    middle = (lowest + highest) / 2
    lowest, highest = np.minimum(lowest, middle), np.maximum(highest, middle)
    still = np.clip(0.0, lowest, highest)
    wanted = velocity - still
    slack = np.where(wanted > 0, highest - still, still - lowest)
    # Full up to half of the slack, and all of it at one and a half: without a kink in between.
    share = np.abs(wanted) / np.where(slack > 0, slack, 1.0)
    bent = share - np.clip(share - 0.5, 0.0, None) ** 2 / 2
    held = np.where(share <= 0.5, share, np.where(share < 1.5, bent, 1.0))
    left: Floats = still + np.sign(wanted) * slack * held
    return left


class ValueRange(NamedTuple):
    """What a quantity is at least and at most, float64 (...) each."""

    least: Floats
    most: Floats


def allowed_velocities(
    trace: ValueRange,
    size: ValueRange,
    turned: tuple[ValueRange, ValueRange],
    joint: InteriorKnot,
    bounds: Bounds,
) -> tuple[ValueRange, ValueRange]:
    """Return the least and the largest velocity of 𝒜 with which both control values obey bounds.

    Parameters
    ----------
    trace, size : ValueRange
        𝒜 and |η| of the keyframe.
    turned : (Range, Range)
        |η| of the control values.
    joint : InteriorKnot
    bounds : Bounds
        Widened where the keyframe exceeds them.
    """
    stretch = (bounds.sigma_a * (1.0 - SPARE)) ** 2
    squeeze = (bounds.sigma_b * (1.0 + SPARE)) ** 2
    k = bounds.k * (1.0 - SPARE)
    shear = k / (1.0 + k * k)
    lowest, highest = [], []
    for arm, around in zip(joint.control_offsets, turned, strict=True):
        # By how much 𝒜 must and may grow, for σ_b and k, and for σ_a.
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
    """Return by how much 𝒜 must grow to keep its proportion to |η|, whatever it is."""
    with np.errstate(divide="ignore", invalid="ignore"):
        growth = np.where(size > 0, turned / size - 1.0, np.inf)
    found: Floats = extreme(trace.least * growth, trace.most * growth)
    return found


def _allowed(
    trace: Floats, eta: Complexes, turned: Complexes, joint: InteriorKnot, bounds: Bounds
) -> tuple[Floats, Floats]:
    """Return the same at points, with the velocity of η."""
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
    """Return the largest number from 0 to 1 that is found to be within, by bisection."""
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
    """Tell whether σ_a and σ_b (p, PARTS + 1), and k, obey limits, between the samples too."""
    k = _dilatation(sigma_a, sigma_b)
    return (
        _largest(sigma_a) <= limits[0]
        and -_largest(-sigma_b) >= limits[1]
        and _largest(k) <= limits[2]
    )


def _largest(values: Floats) -> float:
    """Return the largest of values (p, PARTS + 1) along segments, with what it may miss."""
    return float((values.max(axis=1) + BETWEEN * _second(values)).max())


def _second(values: Floats) -> Floats:
    """Return the largest second difference of values (p, PARTS + 1) along each segment."""
    second: Floats = np.abs(values[:, 2:] - 2 * values[:, 1:-1] + values[:, :-2]).max(axis=1)
    return second


def _dilatation(sigma_a: Floats, sigma_b: Floats) -> Floats:
    """Return k; a map that folds has more than 1."""
    whole = sigma_a + sigma_b
    k: Floats = np.where(whole > 0, (sigma_a - sigma_b) / np.where(whole > 0, whole, 1.0), inf)
    return k
