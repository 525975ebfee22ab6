"""Products with complex matrices, as products of reals.

They are no slower. A complex product leaves processors with AVX in a state in which complex
exponentials and logarithms take twenty times longer, until the next real product.
"""

import numpy as np

from engine.arrays import Complexes, Floats


def products(rows: Complexes, matrix: Complexes) -> Complexes:
    """Return rows (k, r) times a matrix (r, p), for few rows."""
    parts = np.concatenate([rows.real, rows.imag]) @ matrix.view(np.float64)
    real, imaginary = np.split(parts.view(np.complex128), 2)
    real += 1j * imaginary
    return real


def products_along(rows: Complexes, matrix: Complexes) -> Complexes:
    """Return rows (k, p) times the transpose of a matrix (r, p)."""
    both = np.concatenate([rows.conj(), 1j * rows.conj()]).view(np.float64)
    real, imaginary = np.split(both @ matrix.view(np.float64).T, 2)
    return np.asarray(real + 1j * imaginary)


def real_products(rows: Complexes, matrix: Complexes) -> Floats:
    """Return the real parts of rows (w, r) times the transpose of a matrix (N, r)."""
    product: Floats = rows.view(np.float64) @ matrix.conj().view(np.float64).T
    return product
