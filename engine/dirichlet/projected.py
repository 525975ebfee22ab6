"""A rough Hilbert transform: the best fit among the holomorphic functions of the cage.

The Cauchy coordinates of the cage span n holomorphic functions; the one whose real part is nearest
to the given one along the outline, in the least-squares sense, stands in for the solution of the
Dirichlet problem. This is the way of Section 7.4 (after Weber and Gotsman 2010). It costs a small
matrix product where the integral equation of `engine.dirichlet.hilbert` costs a factorisation.
In-betweens are right to some thousandths of the diameter, a hundredth in hard cases, and keep their
bounds only as far.
"""

from dataclasses import dataclass
from typing import Self

import numpy as np

from engine.arrays import Complexes, Floats, freeze
from engine.geometry import box_diagonal, sample_graded
from engine.maps import cauchy_coordinates, evaluate

# Segments between nodes, over the distance to the nearest cage vertex and over the box diagonal.
SEGMENT_PER_DISTANCE = 0.5
SEGMENT_PER_SIZE = 1 / 200
# Singular values left out, over the largest: the functions are nearly dependent far from the cage.
CUTOFF = 1e-10


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class ProjectedTransform:
    """Fits holomorphic functions of one cage to real parts on the outline.

    Build it with `ProjectedTransform.on`.

    Parameters
    ----------
    outline, cage : complex128, shapes (p,) and (n,)
    points : complex128, shape (t,)
        In the closed domain.
    nodes : complex128, shape (N,)
        Points of the outline at which real parts are given.
    fit : float64, shape (2n, N)
        From real parts to the coefficients: their real parts, then their imaginary ones.
    """

    outline: Complexes
    cage: Complexes
    points: Complexes
    nodes: Complexes
    fit: Floats

    @classmethod
    def on(cls, outline: Complexes, cage: Complexes, points: Complexes) -> Self:
        """Prepare the fit for an outline (p,) inside a cage (n,), and points (t,)."""
        longest = SEGMENT_PER_SIZE * box_diagonal(outline)
        nodes = sample_graded(outline, cage, ratio=SEGMENT_PER_DISTANCE, longest=longest)
        lengths = np.abs(np.roll(nodes, -1) - nodes)
        root = np.sqrt(lengths + np.roll(lengths, 1))
        coordinates = cauchy_coordinates(cage, nodes)
        matrix = root[:, None] * np.hstack([coordinates.real, -coordinates.imag])
        fit = np.linalg.pinv(matrix, rcond=CUTOFF) * root
        return cls(outline=outline, cage=cage, points=points, nodes=freeze(nodes), fit=freeze(fit))

    @property
    def nbytes(self) -> int:
        """Memory that the arrays take, in bytes."""
        return self.nodes.nbytes + self.fit.nbytes

    def extend(self, real_parts: Floats) -> tuple[Complexes, Complexes]:
        """Return holomorphic functions with about these real parts, and their derivatives.

        Parameters
        ----------
        real_parts : float64, shape (N, j)
            At `nodes`.

        Returns
        -------
        values, derivatives : complex128, shape (t, j)
            Of each function.
        """
        real, imaginary = np.split(self.fit @ real_parts, 2)
        values, derivatives = evaluate(self.cage, real + 1j * imaginary, self.points, orders=(0, 1))
        return values, derivatives
