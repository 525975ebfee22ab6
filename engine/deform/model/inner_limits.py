"""Bounds at inner points implied by limits that differ along the boundary.

ln k, ln σ_a and −ln σ_b of a locally injective harmonic map are subharmonic: with ν = G / F, ln |ν|
is, ln |F| is harmonic, and ln(1 + |ν|) and −ln(1 − |ν|) are convex and rising in ln |ν|. So each is
bounded above by the harmonic function with the logarithm of its limit on the boundary.
"""

import numpy as np
import shapely

from engine.arrays import Complexes, Floats
from engine.dirichlet import HilbertTransform
from engine.geometry import as_xy
from engine.maps import Boundary, LocalBounds


def limits_inside(
    transform: HilbertTransform, boundary: Boundary, bounds: LocalBounds, points: Complexes
) -> LocalBounds:
    """Bounds at inner points implied by stiffness-scaled bounds on the outline.

    They are harmonic extensions of the logarithms of the limits.

    Parameters
    ----------
    transform : HilbertTransform
        Of the same domain.
    bounds : LocalBounds
        Of the whole shape.
    points : complex128, shape (t,)
        In the closed domain.

    Returns
    -------
    LocalBounds
        Arrays (t,).
    """
    stiffness = np.maximum(_stiffness_at(boundary, transform.nodes), 1.0)
    given = np.column_stack([np.log(stiffness) / 2, 1 / np.sqrt(stiffness)])
    less, share = _continued(transform, boundary, given, points).T
    return LocalBounds(
        k=bounds.k * np.exp(-less),
        sigma_a=np.exp(np.log(bounds.sigma_a) * share),
        sigma_b=np.exp(np.log(bounds.sigma_b) * share),
    )


def _stiffness_at(boundary: Boundary, nodes: Complexes) -> Floats:
    starts, ends = boundary.points, boundary.points[boundary.next_samples]
    both = np.column_stack([starts, ends])
    segments = shapely.STRtree(shapely.linestrings(both.real, both.imag))
    nearest = segments.nearest(shapely.points(as_xy(nodes)))
    sides = ends[nearest] - starts[nearest]
    along = np.clip(((nodes - starts[nearest]) / sides).real, 0.0, 1.0)
    logarithms = np.log(boundary.stiffness)
    first, second = logarithms[nearest], logarithms[boundary.next_samples[nearest]]
    stiffness: Floats = np.exp((1 - along) * first + along * second)
    return stiffness


def _continued(
    transform: HilbertTransform, boundary: Boundary, given: Floats, points: Complexes
) -> Floats:
    """Return harmonic functions (t, j) with given values (N, j) at the boundary's nodes.

    Around holes they are real parts of single-valued functions and logarithms.
    """
    centres = np.array([hole.centre for hole in boundary.holes], dtype=np.complex128)
    around = np.log(np.abs(transform.nodes[:, None] - centres))
    extended = transform.at(points).extend(np.hstack([given, around]))
    count = given.shape[1]
    values = extended.values.real
    if not len(centres):
        harmonic: Floats = values
        return harmonic
    factors = np.linalg.solve(extended.lacking[:, count:], extended.lacking[:, :count])
    logarithms = np.log(np.abs(points[:, None] - centres))
    return np.asarray(values[:, :count] + (logarithms - values[:, count:]) @ factors)
