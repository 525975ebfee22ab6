"""Positions of the points of a corrected frame, and their derivatives by the unknowns.

With F = f_z and G = conj(f_z̄) of a frame, h and q holomorphic, the corrected frame has

    F e^h,    G e^{σh} + q K e^h,

σ = −1 (η is kept where q = 0) or 1 (ν is kept). All is holomorphic, and F e^h has no zeros where F
has none.
"""

from dataclasses import dataclass
from typing import NamedTuple, Self

import numpy as np

from engine.arrays import Complexes, Floats
from engine.deform.correction.corrector import PointCorrector
from engine.deform.correction.products import real_products
from engine.deform.correction.variables import BasisValues


class BaseFrame(NamedTuple):
    """A frame to correct, at the nodes of a corrector's paths or the boundary's samples.

    Parameters
    ----------
    fz, g : complex128, shape (s,)
        F and G.
    by : complex128, shape (s,)
        K, the factor of q.
    sign : {-1, 1}
        σ.
    """

    fz: Complexes
    g: Complexes
    by: Complexes
    sign: int

    def apply_correction(
        self, values: BasisValues, x: Floats
    ) -> tuple[Complexes, Complexes, Complexes, Complexes]:
        """Return F e^h, G e^{σh}, q K e^h and the factor K e^h of q, for unknowns x (2N,).

        `values` are the unknowns' functions at the points of the frame.
        """
        h, q = values.both_of(x)
        grown = np.exp(h)
        own = self.g * (grown if self.sign > 0 else 1.0 / grown)
        factor = self.by * grown
        return self.fz * grown, own, q * factor, factor


@dataclass(frozen=True, slots=True, eq=False)
class CorrectedFrame:
    """A frame with h and q, at the nodes of paths.

    Parameters
    ----------
    x : float64, shape (2N,)
    conformal, own, mixed, factor : complex128, shape (s,)
        F e^h, G e^{σh}, q K e^h and K e^h.
    """

    corrector: PointCorrector
    base: BaseFrame
    x: Floats
    conformal: Complexes
    own: Complexes
    mixed: Complexes
    factor: Complexes

    @classmethod
    def of(cls, corrector: PointCorrector, base: BaseFrame, x: Floats) -> Self:
        return cls(corrector, base, x, *base.apply_correction(corrector.variables.at_nodes, x))

    def places(self) -> Complexes:
        """Return the integrals from the anchor to each point, then around each hole."""
        both = self.corrector.paths.integrals(np.stack([self.conformal, self.own + self.mixed]))
        return np.asarray(both[0] + both[1].conj())

    def constraint_rows(self) -> Floats:
        """Return the derivatives of `places` by the unknowns: real parts, then imaginary ones."""
        values = self.corrector.variables.at_nodes
        f, g = self.conformal, self.base.sign * self.own + self.mixed
        weights = np.stack([f + g, 1j * (g - f), self.factor])
        real, imaginary, mixed = self.corrector.paths.products_with(weights, values.common)
        by_h = real_products(np.concatenate([real, imaginary]), values.to_h)
        by_q = real_products(np.concatenate([mixed, 1j * mixed]), values.to_q)
        return np.hstack([by_h, by_q])

    def curvature(self, pulls: Complexes) -> "Curvature":
        """Return the second derivative of Re Σ conj(pull_i) place_i by the unknowns."""
        paths = self.corrector.paths
        back, through = paths.spread(pulls.conj()), paths.spread(pulls)
        twice = back * self.conformal + through * (self.own + self.mixed)
        return Curvature(self.corrector.variables.at_nodes, twice, through * self.factor)


class Curvature(NamedTuple):
    """A symmetric form of the unknowns: Re Σ twice · (δh)² + 2 both · δh δq over the nodes."""

    values: BasisValues
    twice: Complexes
    both: Complexes

    def __call__(self, x: Floats) -> Floats:
        """Return the form's product with a vector."""
        h, q = self.values.both_of(x)
        return self.values.against(self.twice * h + self.both * q, self.both * h)
