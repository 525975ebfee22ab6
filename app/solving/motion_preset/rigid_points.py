"""Points of a drawing for rigid motions."""

import numpy as np

from engine.domain import Domain
from engine.geometry import crossings_at

LEVELS = (0.05, 0.35, 0.65, 0.94)  # fractions of the height
NARROW = 0.22  # fraction of the box's wider side: narrower parts have one point in their centre
INSET = 0.15  # distance of points from a part's sides, as a fraction of its width


def find_rigid_points(domain: Domain) -> dict[str, complex]:
    """Return named points on the left and right of a domain at several heights."""
    outline = domain.outline
    low, high = float(outline.imag.min()), float(outline.imag.max())
    most = max(high - low, float(np.ptp(outline.real)))
    points = dict[str, complex]()
    for number, level in enumerate(LEVELS, start=1):
        height = low + level * (high - low)
        first, last = _widest(domain, height)
        if last - first < NARROW * most:
            points[f"middle {number}"] = complex((first + last) / 2, height)
        else:
            points[f"left {number}"] = complex(first + INSET * (last - first), height)
            points[f"right {number}"] = complex(last - INSET * (last - first), height)
    return points


def _widest(domain: Domain, height: float) -> tuple[float, float]:
    """Return the start and the end of the widest part of a domain at a height."""
    crossings = crossings_at(domain.loops, height)
    pairs = crossings[: len(crossings) // 2 * 2].reshape(-1, 2)
    first, last = pairs[np.diff(pairs).argmax()]
    return float(first), float(last)
