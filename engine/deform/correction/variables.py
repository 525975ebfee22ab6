"""The unknowns of corrections: coefficients of h and q whose size is |x|.

    |x|² = mean over ∂Ω of s ((Re h)² + |q|² + ε |h|² + ε' L² (|h'|² + |q'|²)),

s the stiffness. Four times this is, to second order, the symmetric Dirichlet energy of the
correction.
"""

from dataclasses import dataclass
from typing import NamedTuple, Self

import numpy as np

from engine.arrays import Complexes, Floats, Indices, freeze
from engine.deform.correction.products import products, products_along, real_products
from engine.maps import Boundary

OF_SIZE, OF_SLOPE = 1e-3, 1e-5  # ε and ε'
# Directions of the coordinates smaller than this, over the largest, are rounding errors.
RANK = 1e-6


class BasisValues(NamedTuple):
    """The functions of the unknowns at some points: few common ones, and how to combine them.

    Coefficients are complex, so there are two real unknowns to each common function. Products with
    `common` read a quarter of the memory that the functions of h and of q themselves would take.

    Parameters
    ----------
    common : complex128, shape (r, p)
    to_h, to_q : complex128, shape (N, r)
        The coefficients of each unknown's function, of h and of q.
    """

    common: Complexes
    to_h: Complexes
    to_q: Complexes

    @property
    def h(self) -> Complexes:
        """The functions of h, (N, p)."""
        return np.asarray(self.to_h @ self.common)

    def h_of(self, x: Floats) -> Complexes:
        (h,) = products(_combined(x[: len(self.to_h)], self.to_h)[None], self.common)
        return np.asarray(h)

    def both_of(self, x: Floats) -> tuple[Complexes, Complexes]:
        """Return h and q of unknowns, (p,) each."""
        parts = np.split(x, [len(self.to_h)])
        both = [_combined(*each) for each in zip(parts, (self.to_h, self.to_q), strict=True)]
        h, q = products(np.array(both), self.common)
        return h, q

    def against(self, of_h: Complexes, of_q: Complexes) -> Floats:
        """Return Re Σ over the points of numbers (p,) times the functions, float64 (2N,)."""
        of_common = products_along(np.stack([of_h, of_q]), self.common)
        both = zip(of_common[:, None], (self.to_h, self.to_q), strict=True)
        return np.concatenate([real_products(*each)[0] for each in both])

    def in_forms(self, forms: Floats) -> Self:
        """Return the functions of combinations (2N, j) of the unknowns, for h and q each."""
        of_h, of_q = np.split(forms, [len(self.to_h)])
        common = np.vstack([of_h.T @ self.to_h, of_q.T @ self.to_q]) @ self.common
        to_h, to_q = np.split(np.eye(len(common), dtype=np.complex128), 2)
        return type(self)(common, to_h, to_q)

    def of_h(self, forms: Floats) -> Self:
        """Return only the unknowns of h, in combinations (N, M) of them."""
        common, to_h = self.common, forms.T @ self.to_h
        if len(to_h) < len(common):
            common, to_h = freeze(to_h @ common), np.eye(len(to_h), dtype=np.complex128)
        return type(self)(common, freeze(to_h), np.zeros((0, len(common)), np.complex128))

    def rows_at(self, which: Indices, of_h: Complexes, of_q: Complexes) -> Floats:
        """Return the real parts of numbers (w,) times the functions at points, (w, 2N)."""
        values = self.common.T[which]
        return np.hstack(
            [
                real_products(values * of_h[:, None], self.to_h),
                real_products(values * of_q[:, None], self.to_q),
            ]
        )


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Variables:
    """h = H x_h and q = Q x_q, of real x = (x_h, x_q); N unknowns each.

    Build it with `Variables.of`.

    Parameters
    ----------
    h, q : complex128, shape (n, N)
        Coefficients of the functions in the domain's span.
    at_nodes, at_samples, at_points : BasisValues
        At the nodes of paths, at the samples of the boundary and at points.
    """

    h: Complexes
    q: Complexes
    at_nodes: BasisValues
    at_samples: BasisValues
    at_points: BasisValues

    @classmethod
    def of(cls, boundary: Boundary, nodes: Complexes, points: Complexes) -> Self:
        """Make the functions of a domain orthonormal in the size of corrections."""
        span = boundary.span
        samples, own = orthonormal_functions(boundary)
        count = len(own)
        root = np.sqrt(boundary.weights)[:, None]
        values = root * (samples @ own)
        slopes = boundary.size * root * (boundary.derivatives[:, :count] @ own)
        of_values, of_slopes = np.eye(2 * len(own.T)), OF_SLOPE * _gram(slopes)
        stretch = np.hstack([values.real, -values.imag])
        to_h = _whitened(stretch.T @ stretch + OF_SIZE * of_values + of_slopes)
        to_q = _whitened(of_values + of_slopes)
        coefficients = [own @ to for to in (to_h, to_q)]
        h, q = (freeze(np.pad(each, ((0, len(span) - count), (0, 0)))) for each in coefficients)
        places = [samples, *(span.coordinates(each)[:, :count] for each in (nodes, points))]
        combined = [freeze(np.ascontiguousarray(each.T)) for each in (to_h, to_q)]
        at_samples, at_nodes, at_points = (
            BasisValues(freeze(own.T @ rows.T), *combined) for rows in places
        )
        return cls(h=h, q=q, at_nodes=at_nodes, at_samples=at_samples, at_points=at_points)

    def of_h(self, forms: Floats) -> Self:
        """Return only the unknowns of h, in combinations (N, M) of them."""
        places = (self.at_nodes, self.at_samples, self.at_points)
        nodes, samples, points = (each.of_h(forms) for each in places)
        return type(self)(
            h=freeze(self.h @ forms),
            q=self.q[:, :0],
            at_nodes=nodes,
            at_samples=samples,
            at_points=points,
        )

    @property
    def count(self) -> int:
        """Number N of unknowns of h."""
        return int(self.h.shape[1])

    @property
    def nothing(self) -> Floats:
        """The unknowns, of h and q, of the zero correction."""
        return np.zeros(self.h.shape[1] + self.q.shape[1])


def orthonormal_functions(boundary: Boundary) -> tuple[Complexes, Complexes]:
    """Return single-valued functions that are orthonormal in the boundary's weights.

    Returns
    -------
    samples : complex128, shape (m, N)
        The coordinates of the boundary's samples.
    combinations : complex128, shape (N, r)
    """
    count = len(boundary.span.vertices)  # logarithms are not single-valued functions
    samples = boundary.span.coordinates(boundary.points)[:, :count]
    triangle = np.linalg.qr(np.sqrt(boundary.weights)[:, None] * samples, mode="r")
    _, sizes, directions = np.linalg.svd(triangle)
    kept = sizes > RANK * sizes[0]
    return samples, directions[kept].conj().T / sizes[kept]


def _gram(columns: Complexes) -> Floats:
    """Return the form x ↦ |columns · (x + i y)|² of the real and imaginary parts (x, y)."""
    product = columns.conj().T @ columns
    return np.block([[product.real, -product.imag], [product.imag, product.real]])


def _whitened(form: Floats) -> Complexes:
    """Return combinations, one for each real unknown, that make a form a sum of squares."""
    values, vectors = np.linalg.eigh(form)
    real, imaginary = np.split(vectors / np.sqrt(values), 2)
    return np.asarray(real + 1j * imaginary)


def _combined(x: Floats, values: Complexes) -> Complexes:
    # As reals: a complex product with real weights would spend half its work on zeros.
    total: Complexes = (x @ values.view(np.float64)).view(np.complex128)
    return total
