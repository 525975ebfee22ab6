"""The map whose derivatives are nearest to given ones: a Poisson equation, factorised once."""

from dataclasses import dataclass
from typing import Self

import numpy as np
from scipy.sparse.linalg import SuperLU

from app.motion.rival_methods.mesh_keyframes import MeshFrame
from app.motion.rival_methods.triangulated_domain import (
    TriangulatedDomain,
    factorise_symmetric,
    solve_complex,
)
from engine.arrays import Complexes, Indices


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class PoissonStep:
    """Integrates Jacobians of single triangles.

    Given a and b per triangle, it minimises Σ area (|f_z − a|² + |f_z̄ − b|²), half of the squared
    Frobenius norm of the difference of the Jacobians, over the piecewise linear maps f with a given
    position of the anchor (Alexa et al. 2000, Section 3; Xu et al. 2006 show that it is a Poisson
    equation).
    """

    domain: TriangulatedDomain
    free: Indices  # all vertices but the anchor
    factors: SuperLU  # of the Laplacian, at the free vertices

    @classmethod
    def on(cls, domain: TriangulatedDomain) -> Self:
        """Factorise the Laplacian of a domain, once for all frames."""
        free = np.delete(np.arange(len(domain.points)), domain.anchor)
        laplacian = domain.laplacian()
        return cls(
            domain=domain, free=free, factors=factorise_symmetric(2.0 * laplacian[free][:, free])
        )

    def integrate(self, fz: Complexes, fzbar: Complexes, anchor: complex) -> MeshFrame:
        """Return the map nearest to f_z and f_z̄ (m,), with the anchor at a given position."""
        domain = self.domain
        right = domain.sums_at_vertices(fz, fzbar)
        positions = np.zeros(len(domain.points), dtype=np.complex128)
        positions[self.free] = solve_complex(self.factors, right[self.free])
        found = domain.derivatives(positions)
        lacking, given = (
            float(domain.areas @ (np.abs(a) ** 2 + np.abs(b) ** 2))
            for a, b in ((found[0] - fz, found[1] - fzbar), (fz, fzbar))
        )
        return MeshFrame(
            positions=positions + anchor,
            fz=found[0],
            fzbar=found[1],
            poisson_error=float(np.sqrt(lacking / given)),
        )
