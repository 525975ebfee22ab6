"""Cauchy complex barycentric coordinates of a cage and their derivatives.

The coordinates of Weber, Ben-Chen and Gotsman (2009) span the holomorphic functions Φ(z) = Σ C_j(z)
φ_j of Equation (14). With the cage vertices z_j in counter-clockwise order, B_j = z_j − z and
ℓ_j(z) = log(B_{j+1} / B_j), everything here follows from one real logarithm per vertex and one
arctangent per edge: the integrand of Cauchy's formula is linear along an edge, with the divided
difference s_j = (φ_{j+1} − φ_j) / (z_{j+1} − z_j), so that

    2πi Φ(z)   = Σ ℓ_j (φ_j + s_j (z − z_j)),
    2πi Φ'(z)  = Σ ℓ_j s_j,
    2πi Φ''(z) = Σ (s_j − s_{j−1}) / B_j.

Points lie strictly inside the cage. On the cage Φ' is log-singular at the vertices; outside it the
formulas give the values of another function, 0 for constants. Cages in holes use these functions;
they run clockwise (`engine.maps.span`).
"""

from collections.abc import Iterator

import numpy as np

from engine.arrays import Complexes, Floats
from engine.errors import EngineError
from engine.geometry import edge_vectors, signed_area

TWO_PI_I = 2j * np.pi
# Entries of one block of points × cage vertices: 8 bytes each, so that a few blocks stay in cache.
BLOCK_ENTRIES = 1 << 16


def edge_logarithms(cage: Complexes, points: Complexes) -> Complexes:
    """Return ℓ_j(z) = log(B_{j+1} / B_j) for each point (m,) and cage edge (n,), complex128 (m, n).

    Column j belongs to the edge from vertex j to vertex j + 1. The imaginary part is the signed
    angle under which the point sees the edge, in (−π, π).

    Raises
    ------
    EngineError
        If a point is a cage vertex.
    """
    x, y, squared = _offsets(cage, points)
    logarithms = np.empty(squared.shape, dtype=np.complex128)
    logarithms.real, logarithms.imag = _logarithms(x, y, squared)
    return logarithms


def divided_differences(cage: Complexes, coefficients: Complexes) -> Complexes:
    """Return s_j = (φ_{j+1} − φ_j) / (z_{j+1} − z_j), shaped like `coefficients` (n, ...)."""
    lengths = np.diff(cage, append=cage[:1]).reshape(-1, *[1] * (coefficients.ndim - 1))
    return np.diff(coefficients, axis=0, append=coefficients[:1]) / lengths


def difference_jumps(cage: Complexes, coefficients: Complexes) -> Complexes:
    """Return s_j − s_{j−1} at the vertices, shaped like `coefficients`."""
    differences = divided_differences(cage, coefficients)
    return np.diff(differences, axis=0, prepend=differences[-1:])


def cauchy_coordinates(cage: Complexes, points: Complexes) -> Complexes:
    """Return the coordinates C_j(z) of each point, complex128 (m, n).

    They sum to 1 and reproduce z. Cost: m·n logarithms.
    """
    lengths = edge_vectors(cage)
    coordinates = np.empty((len(points), len(cage)), dtype=np.complex128)
    for block in _blocks(len(points), len(cage)):
        logarithms = edge_logarithms(cage, points[block]) / TWO_PI_I
        # ℓ_j (z − z_j) / (z_{j+1} − z_j) belongs to vertex j + 1, the rest of ℓ_j to vertex j.
        to_next = logarithms * ((points[block, None] - cage) / lengths)
        # The C_j of Equation (14).
        coordinates[block] = logarithms - to_next + np.roll(to_next, 1, axis=1)
    return coordinates


def cauchy_derivatives(cage: Complexes, points: Complexes) -> Complexes:
    """Return D_j(z) = C_j'(z), complex128 (m, n); log-singular at cage vertices."""
    lengths = TWO_PI_I * edge_vectors(cage)
    derivatives = np.empty((len(points), len(cage)), dtype=np.complex128)
    for block in _blocks(len(points), len(cage)):
        per_length = edge_logarithms(cage, points[block]) / lengths
        derivatives[block] = np.roll(per_length, 1, axis=1) - per_length
    return derivatives


def evaluate(
    cage: Complexes, coefficients: Complexes, points: Complexes, *, orders: tuple[int, ...]
) -> list[Complexes]:
    """Evaluate Σ C_j(z) φ_j and its derivatives without forming the coordinates.

    Parameters
    ----------
    coefficients : complex128, shape (n, q)
        One column for each holomorphic function.
    points : complex128, shape (m,)
        Points strictly inside the cage.
    orders : tuple of int
        Orders of the derivatives, each 0, 1 or 2.

    Returns
    -------
    list of complex128, shape (m, q)
        One array for each entry of `orders`. If 0 or 1 is among them, NaN at points outside a
        counter-clockwise cage, or inside a clockwise one in a hole.

    Notes
    -----
    One logarithm per point and edge serves all functions and both orders 0 and 1. The points are
    taken in blocks that stay in cache, so that memory does not grow with m·n. Accurate to rounding
    at distances from the cage that are not small compared with its edges.
    """
    differences = divided_differences(cage, coefficients)
    # z is measured from the middle of the cage: far from the origin Σ ℓ_j (φ_j − s_j z_j) and
    # z Σ ℓ_j s_j would both be large, and their sum would lose digits.
    middle = cage.mean()
    if 0 in orders:
        offsets = coefficients - differences * (cage - middle)[:, None]
        both = np.hstack([differences, offsets])
    if 2 in orders:
        jumps = difference_jumps(cage, coefficients)
    around = 2.0 * np.pi if signed_area(cage) > 0 else 0.0
    results = [np.empty((len(points), coefficients.shape[1]), np.complex128) for _ in orders]
    for block in _blocks(len(points), len(cage)):
        z = points[block]
        x, y, squared = _offsets(cage, z)
        found, outside = {}, slice(0)
        if 0 in orders or 1 in orders:
            lengths, angles = _logarithms(x, y, squared)
            outside = np.abs(angles.sum(axis=1) - around) > np.pi
            found[1] = _product(lengths, angles, both if 0 in orders else differences)
        if 0 in orders:
            found[1], rest = np.hsplit(found[1], 2)
            found[0] = rest + (z - middle)[:, None] * found[1]
        if 2 in orders:
            found[2] = _product(x / squared, -y / squared, jumps)
        for order, result in zip(orders, results, strict=True):
            result[block] = found[order] / TWO_PI_I
            result[block][outside] = np.nan
    return results


def _offsets(cage: Complexes, points: Complexes) -> tuple[Floats, Floats, Floats]:
    """Return x, y and x² + y² of B_j(z) = z_j − z for each point and vertex, (m, n)."""
    x = cage.real - points.real[:, None]
    y = cage.imag - points.imag[:, None]
    squared = x * x + y * y
    if squared.size and squared.min() == 0.0:
        raise EngineError("A point lies on a vertex of the cage; move the point inside the cage.")
    return x, y, squared


def _logarithms(x: Floats, y: Floats, squared: Floats) -> tuple[Floats, Floats]:
    """Return the real and the imaginary parts of ℓ_j(z), of offsets (m, n)."""
    log_squared = np.log(squared)
    x_next, y_next = _following(x), _following(y)
    ratio = _following(log_squared)
    ratio -= log_squared
    ratio *= 0.5
    cross, dot = x * y_next, x * x_next
    cross -= y * x_next
    dot += y * y_next
    return ratio, np.arctan2(cross, dot, out=cross)


def _following(values: Floats) -> Floats:
    """Return the values of the next vertex; like `np.roll`, but faster."""
    following = np.empty_like(values)
    following[:, :-1], following[:, -1] = values[:, 1:], values[:, 0]
    return following


def _product(real: Floats, imaginary: Floats, coefficients: Complexes) -> Complexes:
    """Return the product of a matrix (m, n), by its two parts, with coefficients (n, q)."""
    parts = np.ascontiguousarray(coefficients).view(np.float64)
    product: Complexes = (real @ parts).view(np.complex128)
    product += 1j * (imaginary @ parts).view(np.complex128)
    return product


def _blocks(points: int, vertices: int) -> Iterator[slice]:
    size = max(1, BLOCK_ENTRIES // vertices)
    for start in range(0, points, size):
        yield slice(start, start + size)
