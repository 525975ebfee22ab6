"""Cholesky factors of Hessians, given by their upper triangles."""

import numpy as np
from scipy.linalg import blas, lapack

from engine.arrays import Floats, Singles
from engine.deform.model.hessian import Reals

# The diagonal is made larger by this part of itself and of a floor, and by more until the
# factorisation succeeds. Next to a bound the largest entries are 1e12 times the least, so a part of
# their mean must not enter any step. The floor fixes unknowns that change no map: all of them
# without handles, and functions of the span that coincide around a tiny hole. Entries of the energy
# are about 8.
SHIFT, SHIFT_GROWTH = 1e-13, 1e2
FLOOR = 1e5
# In single precision each pivot keeps at least this part of its diagonal, else too few digits are
# left. With handles the part is some thousandths; with many stiff bones, 1e-4; with one handle,
# which leaves a rotation, 1e-7.
LEAST_PIVOT = 1e-5


def factor_shifted(hessian: Floats) -> Floats:
    """Factor a positive semidefinite matrix, given by its upper triangle, shifted as needed."""
    shift = SHIFT
    # Twelve tries reach far beyond any diagonal: then the entries themselves are not finite.
    for _ in range(12):
        factor = factor_regularised(hessian, shift)
        if factor is not None:
            return factor
        shift *= SHIFT_GROWTH
    # No shift helps: an infinite Hessian, whose steps are 0.
    return np.diag(np.full(len(hessian), np.inf))


def factor_regularised(hessian: Floats, shift: float) -> Floats | None:
    """Factor a matrix given by its upper triangle, with a part of its diagonal and a floor added.

    None if it is not positive definite.
    """
    shifted = hessian.copy()
    np.fill_diagonal(shifted, (1.0 + shift) * hessian.diagonal() + shift * FLOOR)
    # In Fortran order the upper triangle is the lower one.
    factor, failed = lapack.dpotrf(shifted.T, lower=1, clean=0, overwrite_a=1)
    return None if failed else factor


def factor_single(hessian: Singles) -> Singles | None:
    """Factor in place a matrix given by its upper triangle; None if too many digits are lost."""
    diagonal = hessian.diagonal().copy()
    factor: Singles
    factor, failed = lapack.spotrf(hessian.T, lower=1, clean=0, overwrite_a=1)
    if failed or np.any(factor.diagonal() ** 2 < LEAST_PIVOT * diagonal):
        return None
    return factor


def solve_factored(factor: Reals, wanted: Floats) -> Floats:
    """Return the solution (u,) for the right-hand side `wanted` (u,), by a Cholesky factor."""
    trsv = blas.strsv if factor.dtype == np.float32 else blas.dtrsv
    # Two solves with vectors: `dpotrs` takes three times as long for one.
    half = trsv(factor, wanted, lower=1)
    solution: Floats = trsv(factor, half, lower=1, trans=1, overwrite_x=1).astype(np.float64)
    return solution
