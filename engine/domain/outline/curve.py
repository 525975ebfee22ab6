"""Closed curves given by many points (n,), the last one joined to the first."""

import numpy as np

from engine.arrays import Complexes, Floats
from engine.geometry import edge_vectors


def arc_lengths(curve: Complexes) -> Floats:
    """Return the arc length (n + 1,) from point 0 to each point and, last, of the whole curve."""
    return np.concatenate([[0.0], np.cumsum(np.abs(edge_vectors(curve)))])


def resample(curve: Complexes, spacing: float) -> Complexes:
    """Return points on the curve at equal arc lengths, about `spacing` apart, at least 8."""
    arcs = arc_lengths(curve)
    count = max(8, round(arcs[-1] / spacing))
    return points_at_arc_lengths(curve, arcs[-1] * np.arange(count) / count)


def points_at_arc_lengths(curve: Complexes, wanted: Floats) -> Complexes:
    """Return the points of the curve at the arc lengths `wanted`, 0 to the whole length."""
    closed = np.append(curve, curve[0])
    return np.asarray(np.interp(wanted, arc_lengths(curve), closed))


def outward_normals(curve: Complexes, reach: int) -> Complexes:
    """Return the unit normals to the right of a curve: outwards if it runs counter-clockwise.

    Tangents are taken over `reach` points before and after each one.
    """
    tangent = np.roll(curve, -reach) - np.roll(curve, reach)
    return -1j * tangent / np.maximum(np.abs(tangent), np.finfo(np.float64).tiny)


def smooth_curve(curve: Complexes, leash: Floats, rounds: int) -> Complexes:
    """Smooth a curve by repeated averaging, no point farther than `leash` (n,) from its place."""
    smoothed = curve
    for _ in range(rounds):
        mean = (np.roll(smoothed, 1) + 2 * smoothed + np.roll(smoothed, -1)) / 4
        step = mean - curve
        smoothed = curve + step * np.minimum(1, leash / np.maximum(np.abs(step), 1e-300))
    return smoothed


def limit_growth(values: Floats, arcs: Floats, slope: float) -> Floats:
    """Lower values (n,) on a closed curve until they grow by at most `slope` per arc length.

    In both directions; `arcs` (n + 1,) are the curve's `arc_lengths`.
    """
    # Twice around: the lowest value may stand just before point 0.
    around = slope * np.concatenate([arcs[:-1], arcs[:-1] + arcs[-1]])
    n = len(values)
    twice = np.tile(values, 2)
    twice = np.minimum.accumulate(twice - around) + around
    twice = np.tile(twice[n:], 2)
    backwards = np.minimum.accumulate((twice + around)[::-1])[::-1] - around
    return np.asarray(backwards[:n], dtype=np.float64)
