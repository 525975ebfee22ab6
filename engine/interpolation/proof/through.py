"""Enclosures of metric in-betweens through keyframes, by how their control values are chosen.

A cubic in (𝒜, η) whose four control values obey convex bounds obeys them at all times. Two of the
values are keyframes, or between two of them; those beside a tangent are curbed until they obey the
bounds (`engine.interpolation.passing.curbed`), which can be done where the least velocity of 𝒜 that
they allow is below the largest. What that room lacks, if anything, is all that they are broken by.
"""

from dataclasses import dataclass

import numpy as np

from engine.arrays import Floats
from engine.interpolation.passing import SPARE, Course, Tangent
from engine.interpolation.proof.cells import Patch, along_mean, from_metric, k_of
from engine.interpolation.proof.pieces import EdgeCurves
from engine.maps import Bounds, Enclosures


@dataclass(frozen=True, slots=True, kw_only=True)
class Between:
    """Bounds of a quantity on pieces, float64 (p,) each."""

    least: Floats
    most: Floats


def enclose_through(
    trace: EdgeCurves[np.float64], eta: EdgeCurves[np.complex128], course: Course, bounds: Bounds
) -> Enclosures:
    """Enclose the in-betweens of a course with tangents at all times, on pieces (p,)."""
    found = []
    for key in (course.first, course.first + 1):
        one = slice(key, key + 1)
        found.append(
            from_metric(
                Patch(trace.controls[:, one], trace.errors[:, key]),
                Patch(eta.controls[:, one], eta.errors[:, key]),
            )
        )
    for key, end in zip((course.first, course.first + 1), course.ends, strict=True):
        if isinstance(end, Tangent) and end.kept:
            found.append(_beside(trace, eta, key, end, bounds))
    k, sigma_a, sigma_b = zip(*found, strict=True)
    return Enclosures(np.maximum.reduce(k), np.maximum.reduce(sigma_a), np.minimum.reduce(sigma_b))


def _beside(
    trace: EdgeCurves[np.float64],
    eta: EdgeCurves[np.complex128],
    key: int,
    tangent: Tangent,
    bounds: Bounds,
) -> Enclosures:
    """Enclose the control values beside a keyframe."""
    own, size = _range(trace, key), _size_range(eta, key)
    stretch = (bounds.sigma_a * (1.0 - SPARE)) ** 2
    squeeze = (bounds.sigma_b * (1.0 + SPARE)) ** 2
    k = bounds.k * (1.0 - SPARE)
    shear = k / (1.0 + k * k)
    joint = tangent.joint
    # By how much 𝒜 may grow and shrink at each control value within the bounds, at least.
    growing, shrinking = [], []
    for arm in joint.arms:
        weights = np.zeros(eta.controls.shape[1])
        weights[key] = 1.0
        weights[key - 1 : key + 2] += arm * tangent.length * joint.velocity
        turned = _size(eta, weights)
        growing.append(np.maximum(stretch - own.most, 2 * size.least) - 2 * turned)
        from_squeeze = np.maximum(own.least - squeeze, 2 * size.least) - 2 * turned
        with np.errstate(divide="ignore"):
            part = 1.0 - turned / size.least
        from_key = np.where(part > 0, own.least, own.most) * part
        from_shear = np.maximum(own.least - turned / shear, from_key)
        shrinking.append(np.minimum(from_squeeze, from_shear))
    back, forth = (abs(arm) for arm in joint.arms)
    room = np.minimum.reduce(
        [
            (growing[0] + shrinking[0]) / back,
            (growing[1] + shrinking[1]) / forth,
            shrinking[0] / back + shrinking[1] / forth,
            growing[0] / back + growing[1] / forth,
        ]
    )
    broken = max(back, forth) * np.maximum(-room, 0.0) / 2
    worst = np.maximum(shear, size.most / own.least)
    least = np.minimum(squeeze, own.least - 2 * size.most)
    # The size of η from which on the bound on k asks for more than that on σ_b.
    crossing = np.where(worst < 0.5, least / (1.0 / worst - 2.0), np.inf)
    left = 1.0 - broken * worst / crossing
    share = np.where((left > 0) & (worst < 0.5) & (least > 0), worst / left, np.inf)
    return Enclosures(
        k=k_of(share),
        sigma_a=np.sqrt(np.maximum(stretch, own.most + 2 * size.most) + broken),
        sigma_b=np.sqrt(np.maximum(least - broken, 0.0)),
    )


def _range(curves: EdgeCurves[np.float64], key: int) -> Between:
    controls, errors = curves.controls[:, key], curves.errors[:, key]
    return Between(least=controls.min(axis=1) - errors, most=controls.max(axis=1) + errors)


def _size_range(curves: EdgeCurves[np.complex128], key: int) -> Between:
    """Return bounds of the absolute value."""
    controls, errors = curves.controls[:, key], curves.errors[:, key]
    least = along_mean(controls, 1).min(axis=1) - errors
    return Between(least=np.maximum(least, 0.0), most=np.abs(controls).max(axis=1) + errors)


def _size(curves: EdgeCurves[np.complex128], weights: Floats) -> Floats:
    """Return the largest absolute value of a weighted sum of the keyframes."""
    blended = np.abs(np.einsum("q,pqb->pb", weights, curves.controls)).max(axis=1)
    largest: Floats = blended + curves.errors @ np.abs(weights)
    return largest
