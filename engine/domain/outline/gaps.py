"""Narrow gaps: the room outside a curve before it meets itself."""

import numpy as np
from scipy.spatial import cKDTree

from engine.arrays import Complexes, Floats
from engine.geometry import as_xy, edge_vectors

FACING = 0.2  # least cosine between the outward normal and the direction to the opposite side
SQUARE_ON = 0.7  # cosine from which the opposite side counts as straight ahead
BLOCK = 1 << 14  # pairs in one block, so that they stay in cache
DETOUR = 4.0  # arc length over distance from which on two points lie on different limbs


def half_gaps(curve: Complexes, normals: Complexes, *, reach: float, separation: float) -> Floats:
    """Return the radius of the largest empty disc that touches the curve from outside.

    Parameters
    ----------
    curve : complex128, shape (n,)
        With its inside on the left, points nearly equally spaced.
    normals : complex128, shape (n,)
        Outward unit normals.
    reach : float
        Largest half width of a gap.
    separation : float
        Points closer than this along the curve make no gap.

    Returns
    -------
    float64, shape (n,)
        The radius; infinity if no other part of the curve lies opposite within 2 `reach`.
    """
    radius = np.full(len(curve), np.inf)
    spacing = float(np.abs(edge_vectors(curve)).mean())
    pairs = cKDTree(as_xy(curve)).query_pairs(2 * reach, output_type="ndarray")
    for start in range(0, len(pairs), BLOCK):
        first, second = pairs[start : start + BLOCK].T
        steps = second - first
        apart = np.minimum(steps, len(curve) - steps)
        # Most pairs are neighbours along the curve: drop these first.
        limbs = apart > separation / spacing
        first, second, apart = first[limbs], second[limbs], apart[limbs]
        across = curve[second] - curve[first]
        limbs = apart * spacing > DETOUR * np.abs(across)
        first, second, across = first[limbs], second[limbs], across[limbs]
        for here, direction in ((first, across), (second, -across)):
            np.minimum.at(radius, here, empty_disc_radius(normals[here], direction))
    return radius


def empty_disc_radius(normals: Complexes, across: Complexes) -> Floats:
    """Return the radius of the disc that touches a curve from outside and another place of it.

    It is |q - p| / (2 cos a), a the angle between the outward unit normal at the contact p and the
    vector q - p `across` to the other place; infinity if q does not lie opposite. The cosine is
    kept above 0.7 because normals at corners point past the nearest opposite place; this only makes
    the disc smaller.
    """
    distance = np.abs(across)
    cosine = (across * normals.conj()).real / np.maximum(distance, np.finfo(np.float64).tiny)
    return np.where(cosine > FACING, distance / (2 * np.maximum(cosine, SQUARE_ON)), np.inf)
