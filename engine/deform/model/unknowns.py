"""Real unknowns of a map in its boundary's basis (`engine.deform.model.objective`)."""

import numpy as np

from engine.arrays import Complexes, Floats
from engine.maps import Boundary


def in_basis(boundary: Boundary, unknowns: Floats) -> tuple[Complexes, Complexes]:
    """Return φ and ψ (r,) in the basis for unknowns (u,)."""
    r, count = boundary.basis.shape[1], len(boundary.holes)
    conjugates = np.ascontiguousarray(unknowns).view(np.complex128).conj()
    of_phi = conjugates[:r]
    of_psi = np.concatenate([[0.0], conjugates[r:], of_phi[r - count :].conj()])
    return of_phi, of_psi


def by_unknowns(boundary: Boundary, by_phi: Complexes, by_psi: Complexes) -> Floats:
    """Return gradients (..., u) from the factors of φ and ψ (..., r), logarithms included.

    `by_phi` is changed.
    """
    count = len(boundary.holes)
    if count:
        by_phi[..., -count:] += by_psi[..., -count:].conj()
    own = by_psi[..., 1 : by_psi.shape[-1] - count]
    joined = np.concatenate([by_phi, own], axis=-1)
    gradients: Floats = joined.view(np.float64 if joined.dtype == np.complex128 else np.float32)
    return gradients
