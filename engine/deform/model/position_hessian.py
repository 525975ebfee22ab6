"""Hessian of the energy of handles' positions, which is quadratic in the unknowns."""

import numpy as np

from engine.arrays import Complexes, Floats
from engine.maps import Boundary

# λ = STIFFNESS / L² for a handle of weight 1.
STIFFNESS = 1e4


def position_hessian(boundary: Boundary, coordinates: Complexes, stiffness: Floats) -> Floats:
    """Return the Hessian (u, u) of the energy of handles' positions, in the order of `Objective`.

    Parameters
    ----------
    coordinates : complex128, shape (h, r)
        The functions of the boundary's basis at the handles' points.
    stiffness : float64, shape (h,)
    """
    hessian = position_gram_matrix(boundary, np.sqrt(2.0 * stiffness)[:, None] * coordinates)
    hold_constants(boundary, hessian)
    return hessian


def position_gram_matrix(boundary: Boundary, rows: Complexes) -> Floats:
    """Return the Gram matrix (u, u) of displacements of points, in the order of `Objective`.

    Parameters
    ----------
    rows : complex128, shape (p, r)
        The functions of the boundary's basis at the points, times a factor of each point.
    """
    root = rows.copy()
    r, count = root.shape[1], len(boundary.holes)
    of_psi = root[:, 1 : r - count]
    # A logarithm is in Φ and, conjugate, in Ψ.
    root[:, r - count :] *= 2.0
    # Re f = Re(Σ C φ + Σ C ψ), Im f = Im(Σ C φ − Σ C ψ).
    real, imaginary = np.hstack([root, of_psi]), -1j * np.hstack([root, -of_psi])
    both = np.concatenate([real, imaginary]).view(np.float64)
    squared: Floats = both.T @ both
    return squared


def hold_constants(boundary: Boundary, hessian: Floats) -> None:
    """Add a stiffness of the constants on the cages of holes to a Hessian (u, u)."""
    r = boundary.basis.shape[1]
    for constant in range(1, 1 + len(boundary.holes)):
        # On the cage of a hole a constant changes no map, and would be free.
        for first in (2 * constant, 2 * (constant + r - 1)):
            hessian[[first, first + 1], [first, first + 1]] += STIFFNESS
