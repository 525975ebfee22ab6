"""The energy of one sample as a function of a = |f_z| and b = |f_z̄|, with its derivatives.

Every isotropic energy density and every bound of the method depends on the Jacobian by a and b
alone, so that its gradient and Hessian with respect to F = f_z and G = conj(f_z̄) follow from a few
numbers. In the frames F / a and G / b the Hessian of a density h(a, b) is the radial block
[[h_aa, h_ab], [h_ab, h_bb]] and the tangential entries h_a / a and h_b / b (Chen and Weber 2017).
For the densities here the radial block is positive semidefinite, h_b ≥ 0, and the only eigenvalue
that can be negative is h_a / a.
"""

from typing import NamedTuple

import numpy as np

from engine.arrays import Floats


class RadialDerivatives(NamedTuple):
    """Derivatives of a density h(a, b) at each sample, float64 (m,) each.

    The gradient is `a` and `b_per_b` = h_b / b, which stays smooth at b = 0. The Hessian is `aa`,
    `ab`, `bb` and, along the circles |F| = a and |G| = b, `around_a` = h_a / a and `around_b` = h_b
    / b; a primal–dual barrier has other values there, unlike its gradient.
    """

    a: Floats
    b_per_b: Floats
    aa: Floats
    ab: Floats
    bb: Floats
    around_a: Floats
    around_b: Floats

    def weighted(self, weights: Floats) -> "RadialDerivatives":
        """Return the derivatives times a weight (m,) for each sample."""
        return RadialDerivatives(*(weights * part for part in self))

    def plus(self, other: "RadialDerivatives") -> "RadialDerivatives":
        """Return the sum of two densities."""
        return RadialDerivatives(*(mine + its for mine, its in zip(self, other, strict=True)))


def symmetric_dirichlet(a: Floats, b: Floats) -> Floats:
    """Symmetric Dirichlet density (a² + b²)(1 + (a² − b²)⁻²): 2 for an isometry, ∞ where a ≤ b.

    Half of σ_a² + σ_b² + σ_a⁻² + σ_b⁻².
    """
    if not (a > b).all():
        return np.full(np.shape(a), np.inf)
    x, y = a * a, b * b
    # By multiplications: NumPy takes several times as long for powers other than the second.
    inverse = 1.0 / (x - y)
    density: Floats = (x + y) * (1.0 + inverse * inverse)
    return density


def symmetric_dirichlet_derivatives(a: Floats, b: Floats) -> RadialDerivatives:
    """Return the derivatives of the symmetric Dirichlet density, for a > b ≥ 0."""
    x, y = a * a, b * b
    inverse = 1.0 / (x - y)
    cubed = inverse * inverse * inverse
    # σ⁻² of the larger and of the smaller stretch.
    stretch, squeeze = (1.0 / (a + b)) ** 2, (1.0 / (a - b)) ** 2
    stretch, squeeze = 3.0 * stretch * stretch, 3.0 * squeeze * squeeze
    # In σ_a and σ_b the density splits, so that its second derivatives are 1 + 3 σ⁻⁴ each.
    second = 2.0 + stretch + squeeze
    a_per_a = 2.0 * (1.0 - (x + 3.0 * y) * cubed)
    b_per_b = 2.0 * (1.0 + (3.0 * x + y) * cubed)
    return RadialDerivatives(
        a=a * a_per_a,
        b_per_b=b_per_b,
        aa=second,
        ab=stretch - squeeze,
        bb=second,
        around_a=a_per_a,
        around_b=b_per_b,
    )
