"""Where the walls of the barrier stand, and what the next map must keep."""

from engine.arrays import Floats
from engine.maps import Bounds, Certificate

# The walls stand inside the bounds by this part of the way to the identity; a step leaves at least
# KEPT of the slack between them and the map.
MARGIN, KEPT = 1e-4, 0.1
# While a map is outside its bounds the limits follow it at this relative distance.
FOLLOW = 0.005


def limits_for(certificate: Certificate, bounds: Bounds) -> Bounds:
    """Return the bounds, widened as far as the map of a certificate needs it."""
    k, sigma_a, sigma_b = certificate.k, certificate.sigma_a, certificate.sigma_b
    return Bounds(
        k=max(bounds.k, k + FOLLOW * (1 - k)),
        sigma_a=max(bounds.sigma_a, sigma_a * (1 + FOLLOW)),
        sigma_b=min(bounds.sigma_b, sigma_b * (1 - FOLLOW)),
    )


def closing_limits(bounds: Bounds, before: Bounds, a: Floats, b: Floats) -> Bounds:
    """Return the bounds, or limits that close in on a map that is outside of them."""
    k, sigma_a, sigma_b = _extremes(a, b)
    return Bounds(
        k=bounds.k if k < bounds.k else min(before.k, k + FOLLOW * (1 - k)),
        sigma_a=bounds.sigma_a
        if sigma_a < bounds.sigma_a
        else min(before.sigma_a, sigma_a * (1 + FOLLOW)),
        sigma_b=bounds.sigma_b
        if sigma_b > bounds.sigma_b
        else max(before.sigma_b, sigma_b * (1 - FOLLOW)),
    )


def place_walls(
    limits: Bounds, a: Floats, b: Floats, certificate: Certificate
) -> tuple[Bounds, Bounds]:
    """Return the walls of the barrier, and the bounds that the next map must keep everywhere."""
    inner = limits.towards_identity(MARGIN)
    k, sigma_a, sigma_b = _extremes(a, b)
    # A map may start between the walls and the limits.
    walls = Bounds(
        k=max(inner.k, k + (limits.k - k) / 4),
        sigma_a=max(inner.sigma_a, sigma_a + (limits.sigma_a - sigma_a) / 4),
        sigma_b=min(inner.sigma_b, sigma_b + (limits.sigma_b - sigma_b) / 4),
    )
    required = Bounds(
        k=walls.k - KEPT * (walls.k - k),
        sigma_a=walls.sigma_a - KEPT * (walls.sigma_a - sigma_a),
        sigma_b=walls.sigma_b - KEPT * (walls.sigma_b - sigma_b),
    )
    # Between its samples the present map may have less slack than that.
    for asked in (required, walls):
        if asked.allow(k=certificate.k, sigma_a=certificate.sigma_a, sigma_b=certificate.sigma_b):
            return walls, asked
    return walls, limits


def _extremes(a: Floats, b: Floats) -> tuple[float, float, float]:
    return float((b / a).max()), float((a + b).max()), float((a - b).min())
