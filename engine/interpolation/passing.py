"""Motion through keyframes with continuous velocity, within bounds on the distortion.

Each interval is a cubic Bézier curve in the quantities that its variant blends. As weights of the
keyframes its Bernstein polynomials sum to 1, so that they act on log f_z and on the anchor's pose
too. Bernstein weights are convex: where the control values obey a convex bound, so does every
in-between. The paper blends two keyframes only.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from math import inf
from typing import NamedTuple, Self

import numpy as np

from engine.arrays import Complexes, Floats, freeze
from engine.maps import Boundary, Bounds, HarmonicMap
from engine.variant import Variant

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


class Joint(NamedTuple):
    """Where the motion passes a keyframe between two others at one velocity.

    Parameters
    ----------
    before, after : float
        Lengths of the intervals on both sides, above 0, in any unit of time.
    end_pace, start_pace : float
        How fast time runs at the end of the former and at the start of the latter, above 0: 1
        where no easing changes it.
    """

    before: float
    after: float
    end_pace: float = 1.0
    start_pace: float = 1.0

    @property
    def velocity(self) -> Floats:
        """Weights (3,) of the keyframe before, this one and the next one in its velocity.

        Catmull–Rom with true spacing: the slope of the parabola through the three.
        """
        whole = self.before + self.after
        first, last = -self.after / (self.before * whole), self.before / (self.after * whole)
        return np.array([first, -first - last, last])

    @property
    def arms(self) -> tuple[float, float]:
        """The times by which the velocity, full, leads back and forth to the control values."""
        return -self.before / (3 * self.end_pace), self.after / (3 * self.start_pace)


class Tangent(NamedTuple):
    """A joint with what the bounds leave of its velocity.

    Parameters
    ----------
    joint : Joint
    length : float
        Part of the velocity, from 0 to 1; with the metric variant, of that of η.
    kept : float
        How much of all of the velocity is left, from 0, a stop, to 1.
    """

    joint: Joint
    length: float
    kept: float


# How an interval leaves a keyframe, or reaches it: a tangent, or the share of a straight blend's
# velocity, 1 for a corner and 0 for a stop.
End = Tangent | float


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Course:
    """The weights of an interval's keyframes as cubic polynomials of time.

    Parameters
    ----------
    controls : float64, shape (4, q), or None
        The control values as weights of the q keyframes: the two of the interval, with one before
        them and one after them where there are tangents. None for a linear blend of two.
    first : int
        Index of the keyframe at time 0; that at time 1 comes after it.
    ends : tuple of End
        What it was built from.
    """

    controls: Floats | None
    first: int
    ends: tuple[End, End]

    @classmethod
    def straight(cls) -> Self:
        """Return the linear blend of two keyframes, as the paper has it."""
        return cls(controls=None, first=0, ends=(1.0, 1.0))

    @classmethod
    def between(cls, start: End, end: End) -> Self:
        """Return the course of an interval that leaves one keyframe and reaches the next one so."""
        if start == end == 1.0:
            return cls.straight()
        first = int(isinstance(start, Tangent))
        count = first + 2 + isinstance(end, Tangent)
        controls = np.zeros((4, count))
        controls[:2, first] = controls[2:, first + 1] = 1.0
        if isinstance(start, Tangent):
            controls[1, :3] += start.length * start.joint.arms[1] * start.joint.velocity
        else:
            controls[1, first : first + 2] += start / 3 * np.array([-1.0, 1.0])
        if isinstance(end, Tangent):
            controls[2, first:] += end.length * end.joint.arms[0] * end.joint.velocity
        else:
            controls[2, first : first + 2] += end / 3 * np.array([1.0, -1.0])
        return cls(controls=freeze(controls), first=first, ends=(start, end))

    @property
    def full(self) -> Self:
        """The course with all of its velocities."""
        # But for a stop at a pose that is to be kept.
        ends = (
            e._replace(length=1.0) if isinstance(e, Tangent) and e.kept else e for e in self.ends
        )
        return type(self).between(*ends)

    @property
    def count(self) -> int:
        """The number of keyframes, q."""
        return 2 if self.controls is None else self.controls.shape[1]

    @property
    def is_straight(self) -> bool:
        """Whether it is the linear blend."""
        return self.controls is None

    def __call__(self, time: float) -> Floats:
        """Return the weights (q,) at a time in [0, 1]; they sum to 1."""
        return self.at(np.array(time))

    def at(self, times: Floats) -> Floats:
        """Return the weights at times (...), float64 (q, ...)."""
        if self.controls is None:
            return np.stack([1.0 - times, times])
        weights: Floats = np.tensordot(self.controls.T, bernstein(times), axes=1)
        return weights


def bernstein(times: Floats) -> Floats:
    """Return the cubic Bernstein polynomials at times (...), float64 (4, ...)."""
    rest = 1.0 - times
    return np.stack([rest**3, 3 * times * rest**2, 3 * times**2 * rest, times**3])


def shortened(
    variant: Variant,
    maps: Sequence[HarmonicMap],
    joint: Joint,
    bounds: Bounds,
    boundary: Boundary,
) -> Tangent:
    """Return a joint's tangent, short enough for the control values to obey the bounds.

    Parameters
    ----------
    variant : Variant
    maps : sequence of HarmonicMap, length 3
        The keyframe and its neighbours, in order of time.
    joint : Joint
    bounds : Bounds
        Widened where the keyframe itself exceeds them.
    boundary : Boundary

    Returns
    -------
    Tangent
        Of length 0, a stop, where the keyframe is equal to a neighbour: past it the motion would
        swing beyond the pose that is to be kept.

    Notes
    -----
    For the metric variant the bounds are convex in (𝒜, η): 𝒜 + 2|η| ≤ σ_a², 𝒜 − 2|η| ≥ σ_b² and
    |η| ≤ 𝒜 k / (1 + k²). Obeyed by the control values on the boundary, they hold for every
    in-between, there and, as η is anti-holomorphic and f_z has no zeros, inside. As 𝒜 is free
    at each point of the boundary, it is only curbed where it must be (`curbed`); what is left to
    bisection is the velocity of η. For ν the bound on k is convex, and those on σ are not; nor are
    any of the others'. Scaled η has its ρ to obey them (`engine.interpolation.scaling`).
    """
    if any(_is_same(maps[1], f, boundary) for f in (maps[0], maps[2])):
        return Tangent(joint, 0.0, 0.0)
    quantities = np.array([_quantities(variant, f, boundary) for f in maps])
    if variant is Variant.METRIC:
        return _shortened_metric(quantities, joint, bounds, boundary)
    key, velocity = quantities[1], np.tensordot(joint.velocity, quantities, axes=1)
    worst_a, worst_b = _stretches(variant, key)
    limits = (
        max(bounds.sigma_a, float(worst_a.max())) * (1.0 - SPARE),
        min(bounds.sigma_b, float(worst_b.min())) * (1.0 + SPARE),
        max(bounds.k, float(_dilatation(worst_a, worst_b).max())) * (1.0 - SPARE),
    )

    def is_within(length: float) -> bool:
        return all(
            _obeys(variant, key + share * length * arm * velocity, limits)
            for arm in joint.arms
            for share in SHARES
        )

    length = _longest(is_within)
    return Tangent(joint, length, length)


def _shortened_metric(
    quantities: Complexes, joint: Joint, bounds: Bounds, boundary: Boundary
) -> Tangent:
    """Shorten the velocity of η only as far as 𝒜 cannot make up for it."""
    trace, eta = quantities[:, 0].real, quantities[:, 1]
    velocity, turned = np.tensordot(joint.velocity, quantities, axes=1)

    def is_within(length: float) -> bool:
        lowest, highest = _room(trace[1], eta[1], length * turned, joint, bounds)
        # Between samples the room may be less.
        room = highest - lowest
        return bool((room.min(axis=1) >= BETWEEN * _second(room)).all())

    length = _longest(is_within)
    left = curbed(trace, eta, Tangent(joint, length, 1.0), bounds)
    weights = np.repeat(boundary.weights[:, None], PARTS + 1, axis=1)

    def energy(by_trace: Floats, by_eta: Complexes) -> float:
        return float((weights * (by_trace**2 + 4 * np.abs(by_eta) ** 2)).sum())

    whole = energy(velocity.real, turned)
    kept = energy(left, length * turned) / whole if whole > 0 else 1.0
    return Tangent(joint, length, min(1.0, kept**0.5))


def curbed(trace: Floats, eta: Complexes, tangent: Tangent, bounds: Bounds) -> Floats:
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
    joint = tangent.joint
    velocity: Floats = np.tensordot(joint.velocity, trace, axes=1)
    if not tangent.kept:
        return 0.0 * velocity
    turned = tangent.length * np.tensordot(joint.velocity, eta, axes=1)
    lowest, highest = _room(trace[1], eta[1], turned, joint, bounds)
    middle = (lowest + highest) / 2
    lowest, highest = np.minimum(lowest, middle), np.maximum(highest, middle)
    still = np.clip(0.0, lowest, highest)
    wanted = velocity - still
    room = np.where(wanted > 0, highest - still, still - lowest)
    # Full up to half of the room, and all of it at one and a half: without a kink in between.
    share = np.abs(wanted) / np.where(room > 0, room, 1.0)
    bent = share - np.clip(share - 0.5, 0.0, None) ** 2 / 2
    curb = np.where(share <= 0.5, share, np.where(share < 1.5, bent, 1.0))
    left: Floats = still + np.sign(wanted) * room * curb
    return left


def _room(
    trace: Floats, eta: Complexes, turned: Complexes, joint: Joint, bounds: Bounds
) -> tuple[Floats, Floats]:
    """Return between which velocities of 𝒜 both control values obey the bounds, at each point.

    Parameters
    ----------
    trace, eta : shape (...)
        Of the keyframe.
    turned : complex128, shape (...)
        The velocity of η.
    joint : Joint
    bounds : Bounds
        Widened at points where the keyframe exceeds them.
    """
    size = np.abs(eta)
    stretch = np.maximum((bounds.sigma_a * (1.0 - SPARE)) ** 2, trace + 2 * size)
    squeeze = np.minimum((bounds.sigma_b * (1.0 + SPARE)) ** 2, trace - 2 * size)
    k = bounds.k * (1.0 - SPARE)
    shear = np.maximum(k / (1.0 + k * k), size / trace)
    lowest, highest = np.full(trace.shape, -np.inf), np.full(trace.shape, np.inf)
    for arm in joint.arms:
        turned_size = np.abs(eta + arm * turned)
        least = np.maximum(squeeze + 2 * turned_size, turned_size / shear)
        most = stretch - 2 * turned_size
        ends = (least - trace) / arm, (most - trace) / arm
        lowest = np.maximum(lowest, ends[0] if arm > 0 else ends[1])
        highest = np.minimum(highest, ends[1] if arm > 0 else ends[0])
    return lowest, highest


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


def _obeys(variant: Variant, values: Complexes, limits: tuple[float, float, float]) -> bool:
    """Tell whether values (2, p, PARTS) obey σ_a, σ_b and k, between the samples too."""
    sigma_a, sigma_b = _stretches(variant, values)
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


def _quantities(variant: Variant, f: HarmonicMap, boundary: Boundary) -> Complexes:
    """Return the two quantities that a variant blends, along the boundary's segments.

    Returns
    -------
    complex128, shape (2, p, PARTS + 1)
        𝒜 and η of metric, ln |f_z| and ν or conj(η), f_z and conj(f_z̄) of linear.
    """
    ends = boundary.points[boundary.following]
    steps = np.linspace(0.0, 1.0, PARTS + 1)
    along = boundary.points[:, None] + (ends - boundary.points)[:, None] * steps
    fz, fzbar = (values.reshape(along.shape) for values in f.derivatives(along.ravel()))
    g = fzbar.conj()
    match variant:
        case Variant.LINEAR:
            return np.stack([fz, g])
        case Variant.NU:
            return np.stack([np.log(np.abs(fz)) + 0j, g / fz])
        case Variant.ETA | Variant.SCALED_ETA:
            return np.stack([np.log(np.abs(fz)) + 0j, fz * g])
        case Variant.METRIC:
            return np.stack([np.abs(fz) ** 2 + np.abs(g) ** 2 + 0j, fz * g])


def _stretches(variant: Variant, values: Complexes) -> tuple[Floats, Floats]:
    """Return σ_a and σ_b of a variant's quantities (2, ...)."""
    first, second = values[0].real, np.abs(values[1])
    match variant:
        case Variant.LINEAR:
            a, b = np.abs(values[0]), second
        case Variant.NU:
            a = np.exp(first)
            b = a * second
        case Variant.ETA | Variant.SCALED_ETA:
            a = np.exp(first)
            b = second / a
        case Variant.METRIC:
            # 𝒜 ± 2|η| = σ², Equations (10) and (11).
            squares = np.maximum(first + 2 * second, 0.0), np.maximum(first - 2 * second, 0.0)
            return np.sqrt(squares[0]), np.sqrt(squares[1])
    return a + b, a - b


def _dilatation(sigma_a: Floats, sigma_b: Floats) -> Floats:
    """Return k; a map that folds has more than 1."""
    whole = sigma_a + sigma_b
    k: Floats = np.where(whole > 0, (sigma_a - sigma_b) / np.where(whole > 0, whole, 1.0), inf)
    return k


def _is_same(f: HarmonicMap, other: HarmonicMap, boundary: Boundary) -> bool:
    """Tell whether two maps place the boundary alike."""
    if f is other:
        return True
    vertices = np.concatenate(boundary.loops)
    apart = f(vertices) - other(vertices)
    return bool(np.abs(apart).max() <= SAME_MAP * boundary.size)
