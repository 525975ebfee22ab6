"""What the energies of all corrections of a boundary have in common."""

from typing import NamedTuple

import numpy as np

from engine.arrays import Complexes, Floats, Indices
from engine.deform.handles import squared_places
from engine.deform.model import Jet, in_basis
from engine.maps import Boundary

# Samples of the Hessian for each function of the span.
SAMPLES_PER_FUNCTION = 6


class Rows(NamedTuple):
    """What does not depend on the base, of a boundary and points in its domain.

    Parameters
    ----------
    boundary : Boundary
        With its own samples only.
    coordinates, derivatives : complex128, shape (h, r)
        Of the functions of the basis, at the points.
    firmer : float64, shape (h,)
        By which factor points are held more firmly, as handles are (`Handles`).
    held : float64, shape (u, u)
        The Hessian of the mean over the outline's vertices of |δ|² / L².
    some : intp, shape (s,)
        The samples of the Hessian of the energy.
    some_weights : float64, shape (s,)
    single : complex64, shape (m, r)
        The derivatives of the basis at all samples, with half the digits.
    """

    boundary: Boundary
    coordinates: Complexes
    derivatives: Complexes
    firmer: Floats
    held: Floats
    some: Indices
    some_weights: Floats
    single: Complexes

    @classmethod
    def of(cls, boundary: Boundary, points: Complexes) -> "Rows":
        """Prepare them."""
        span, basis = boundary.span, boundary.basis
        count = len(boundary.points)
        stride = max(1, count // (SAMPLES_PER_FUNCTION * len(span)))
        starts = np.arange(0, count, stride)
        some = np.minimum(starts + stride // 2, count - 1)
        vertices = boundary.vertex_coordinates @ basis / boundary.size
        held = squared_places(boundary, vertices / np.sqrt(len(vertices)))
        return cls(
            boundary=boundary,
            coordinates=span.coordinates(points) @ basis,
            derivatives=span.derivatives(points) @ basis,
            firmer=boundary.stiffness_around(points)[1],
            held=held,
            some=some,
            some_weights=np.add.reduceat(boundary.weights, starts),
            single=boundary.basis_derivatives.astype(np.complex64),
        )

    def change(self, unknowns: Floats) -> Jet:
        """Return the map of the span that unknowns (u,) stand for."""
        phi, psi = in_basis(self.boundary, unknowns)
        rows = self.boundary.basis_derivatives
        return Jet(
            f=rows @ phi,
            g=rows @ psi,
            positions=self.coordinates @ phi + (self.coordinates @ psi).conj(),
            fz=self.derivatives @ phi,
        )
