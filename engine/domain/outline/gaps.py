"""Narrow gaps: how much room there is outside a curve before it meets itself."""

import numpy as np
from scipy.spatial import cKDTree

from engine.arrays import Complexes, Floats
from engine.geometry import as_xy, edges

FACING = 0.2  # cosine between the outward normal and what lies opposite, at least
SQUARE_ON = 0.7  # cosine from which on the opposite side counts as straight ahead
DETOUR = 4.0  # arc length over distance from which on two points lie on different limbs


def half_gaps(curve: Complexes, normals: Complexes, *, reach: float, separation: float) -> Floats:
    """Return the radius of the largest empty disc that touches the curve from outside.

    Parameters
    ----------
    curve : complex128, shape (n,)
        Counter-clockwise, points nearly equally spaced.
    normals : complex128, shape (n,)
        Outward unit normals.
    reach : float
        Gaps with half widths above this are not looked for.
    separation : float
        Points closer than this along the curve make no gap.

    Returns
    -------
    float64, shape (n,)
        The radius, or infinity where no other part of the curve lies opposite within 2 `reach`.

    Notes
    -----
    The disc that touches p with normal n and passes through q has the radius |q - p| / (2 cos a),
    a the angle between n and q - p. The cosine is kept above 0.7 because normals at corners point
    past what is nearest to them; that only makes the gap look narrower.
    """
    radius = np.full(len(curve), np.inf)
    spacing = float(np.abs(edges(curve)).mean())
    first, second = cKDTree(as_xy(curve)).query_pairs(2 * reach, output_type="ndarray").T
    steps = second - first
    apart = np.minimum(steps, len(curve) - steps)
    # Most pairs are neighbours along the curve: these go first.
    limbs = apart > separation / spacing
    first, second, apart = first[limbs], second[limbs], apart[limbs]
    across = curve[second] - curve[first]
    limbs = apart * spacing > DETOUR * np.abs(across)
    first, second, across = first[limbs], second[limbs], across[limbs]
    distance = np.abs(across)
    for here, direction in ((first, across), (second, -across)):
        cosine = (direction * normals[here].conj()).real / np.maximum(distance, 1e-300)
        facing = cosine > FACING
        half = distance[facing] / (2 * np.maximum(cosine[facing], SQUARE_ON))
        np.minimum.at(radius, here[facing], half)
    return radius
