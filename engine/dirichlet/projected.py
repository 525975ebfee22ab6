"""The Hilbert transform in a hurry: fitted among the holomorphic functions of the cage.

The Cauchy coordinates of the cage span n holomorphic functions; the one whose real part is nearest
to the given one along the outline stands in for the solution of the Dirichlet problem. This is the
way of Section 7.4 (after Weber and Gotsman 2010). It costs a small matrix product where the
integral equation of `engine.dirichlet.hilbert` costs a factorisation. In-betweens are right only to
some thousandths of the diameter, a hundredth in hard cases, and their bounds hold only as far: they
are for following a hand.
"""

from dataclasses import dataclass
from typing import Self

import numpy as np

from engine.arrays import Complexes, Floats, readonly
from engine.geometry import box_diagonal, sample_graded
from engine.maps import cauchy_coordinates, evaluate

# Segments between nodes, over the distance to the nearest cage vertex and over the box diagonal.
RATIO = 0.5
LONGEST = 1 / 200
# Singular values left out, over the largest: the functions are nearly dependent far from the cage.
CUTOFF = 1e-10


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class ProjectedTransform:
    """Fits holomorphic functions of one cage to real parts on the outline.

    Build it with `ProjectedTransform.on`.

    Parameters
    ----------
    cage : complex128, shape (n,)
    nodes : complex128, shape (N,)
        Points of the outline at which real parts are given.
    fit : float64, shape (2n, N)
        From real parts to the coefficients: their real parts, then their imaginary ones.
    """

    cage: Complexes
    nodes: Complexes
    fit: Floats

    @classmethod
    def on(cls, outline: Complexes, cage: Complexes) -> Self:
        """Prepare the fit for an outline (p,) inside a cage (n,)."""
        nodes = sample_graded(outline, cage, ratio=RATIO, longest=LONGEST * box_diagonal(outline))
        lengths = np.abs(np.roll(nodes, -1) - nodes)
        root = np.sqrt(lengths + np.roll(lengths, 1))
        coordinates = cauchy_coordinates(cage, nodes)
        matrix = root[:, None] * np.hstack([coordinates.real, -coordinates.imag])
        fit = np.linalg.pinv(matrix, rcond=CUTOFF) * root
        return cls(cage=cage, nodes=readonly(nodes), fit=readonly(fit))

    @property
    def nbytes(self) -> int:
        """Memory that the arrays take, in bytes."""
        return self.nodes.nbytes + self.fit.nbytes

    def extend(self, real_parts: Floats, points: Complexes) -> tuple[Complexes, Complexes]:
        """Return holomorphic functions with about these real parts, and their derivatives.

        Parameters
        ----------
        real_parts : float64, shape (N, j)
            At `nodes`.
        points : complex128, shape (t,)
            In the closed domain.

        Returns
        -------
        values, slopes : complex128, shape (t, j)
            Of each function.
        """
        real, imaginary = np.split(self.fit @ real_parts, 2)
        values, slopes = evaluate(self.cage, real + 1j * imaginary, points, orders=(0, 1))
        return values, slopes
