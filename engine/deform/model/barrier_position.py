"""Where the barrier stands, and the limits that follow a map outside its bounds."""

from collections.abc import Sequence
from itertools import chain

import numpy as np

from engine.arrays import Floats
from engine.deform.model.barrier import MARGIN, BarrierBounds
from engine.maps import Boundary, Certificate, HarmonicMap, LocalBounds, segment_enclosures

# The barrier stands beyond every sample by this much, or this part of sigma_a. A map may be at its
# limits to the last digit, and the barrier's Hessian has a root only where there is slack.
LEAST_SLACK = 1e-10
# A step leaves at least this part of the slack between the barrier and the map.
KEPT = 0.1
# While a map is outside its bounds the limits follow it at this relative distance.
FOLLOW = 0.005
# Of k, σ_a and σ_b.
WORST = (np.maximum, np.maximum, np.minimum)
# Maps stay this far (of the way to the identity) inside their bounds. A later certificate, from
# other samples or on another machine, then finds them within.
ROUNDING = 1e-9


def widen_limits(
    proven: Certificate | LocalBounds, bounds: LocalBounds, *, room: float = FOLLOW
) -> LocalBounds:
    """Return the bounds, widened to the proven distortions.

    The part `room` of the remaining slack is added.
    """
    return LocalBounds(
        k=np.maximum(bounds.k, proven.k + room * (1 - proven.k)),
        sigma_a=np.maximum(bounds.sigma_a, proven.sigma_a * (1 + room)),
        sigma_b=np.minimum(bounds.sigma_b, proven.sigma_b * (1 - room)),
    )


def proven_around(
    harmonic_map: HarmonicMap, certificate: Certificate, boundary: Boundary
) -> LocalBounds:
    """Return proven bounds around each sample of a map; without bisection, except for the worst."""
    of_segments = segment_enclosures(harmonic_map, boundary)
    k, sigma_a, sigma_b = (np.empty_like(each) for each in of_segments)
    for at, its, worst in zip((k, sigma_a, sigma_b), of_segments, WORST, strict=True):
        at[boundary.next_samples] = its
        worst(at, its, out=at)
    return LocalBounds(
        k=np.minimum(k, certificate.k),
        sigma_a=np.minimum(sigma_a, certificate.sigma_a),
        sigma_b=np.maximum(sigma_b, certificate.sigma_b),
    )


def tighten_limits(
    bounds: LocalBounds, before: LocalBounds, boundary: Boundary, reached: Floats
) -> LocalBounds:
    """Return the bounds, or limits that close in on a map that is outside the bounds.

    `reached` are the map's distortions (3, m).
    """
    outside = reached >= stack_limits(bounds.at(boundary))
    if not outside.any():
        return bounds
    # Where no sample is outside, no value bounds the worst from below.
    worst_k, worst_a, negative_b = np.where(outside, reached, -np.inf).max(axis=1).tolist()
    near = LocalBounds(
        k=1 - (1 - FOLLOW) * (1 - worst_k),
        sigma_a=worst_a * (1 + FOLLOW),
        sigma_b=-negative_b * (1 - FOLLOW),
    )
    return LocalBounds(
        k=np.maximum(bounds.k, np.minimum(before.k, near.k)),
        sigma_a=np.maximum(bounds.sigma_a, np.minimum(before.sigma_a, near.sigma_a)),
        sigma_b=np.minimum(bounds.sigma_b, np.maximum(before.sigma_b, near.sigma_b)),
    )


def place_barrier_bounds(
    limits: LocalBounds, boundary: Boundary, reached: Floats, certificate: Certificate
) -> tuple[BarrierBounds, LocalBounds]:
    """Return the barrier bounds of the samples, and the bounds of the whole next map.

    `reached` are the map's distortions (3, m).
    """
    at, least = stack_limits(limits.at(boundary)), np.full((3, 1), LEAST_SLACK)
    inner = stack_limits(limits.towards_identity(MARGIN).at(boundary))
    least[1:] *= reached[1].max()
    # A map may start between the barrier and the limits.
    walls = np.maximum(inner, reached + np.maximum((at - reached) / 4, least))
    beyond = walls - at
    # Between its samples the present map may have less slack than a step must leave.
    required = beyond - KEPT * (walls - reached), beyond
    widened = (_shifted(limits, each.max(axis=1).tolist()) for each in required)
    proven, found = proven_at(certificate, reached), limits
    for asked in chain(widened, (limits.towards_identity(ROUNDING),)):
        if limits.include(asked) and (proven <= stack_limits(asked.at(boundary))).all():
            found = asked
            break
    k, sigma_a, negative_b = walls
    return BarrierBounds(k, sigma_a, -negative_b), found


def _shifted(limits: LocalBounds, beyond: Sequence[float]) -> LocalBounds:
    """Return limits that are wider by these amounts, in rows of `stack_limits`."""
    more, longer, shorter = beyond
    return LocalBounds(
        k=limits.k + more, sigma_a=limits.sigma_a + longer, sigma_b=limits.sigma_b - shorter
    )


def proven_at(certificate: Certificate, reached: Floats) -> Floats:
    """Estimate the proven distortions around samples from the samples' distortions, (3, m) each.

    The worst proven value exceeds the worst sample by some amount; each sample gets the same
    amount.
    """
    worst = reached.max(axis=1, keepdims=True)
    proven: Floats = stack_limits(certificate) + (reached - worst)
    return proven


def stack_limits(limits: Certificate | LocalBounds) -> Floats:
    """Return k, σ_a and −σ_b, all upper limits, as rows (3, 1) or (3, m)."""
    rows = np.array([limits.k, limits.sigma_a, np.negative(limits.sigma_b)], np.float64)
    return rows.reshape(3, -1)


def stack_distortions(a: Floats, b: Floats) -> Floats:
    """Return the rows (3, m) k, σ_a, −σ_b of |f_z| and |f_z̄| (m,)."""
    return np.array([b / a, a + b, b - a])
