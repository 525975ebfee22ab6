"""Where the points of a corrected frame are, and how that changes with the unknowns.

With F = f_z and G = conj(f_z̄) of a frame, h and q holomorphic, the corrected frame has

    F e^h,    G e^{σh} + q K e^h,

σ = −1 (η is kept where q = 0) or 1 (ν is kept). All is holomorphic, and F e^h has no zeros where F
has none.
"""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from engine.arrays import Complexes, Floats
from engine.correction.corrector import Corrector


class BaseFrame(NamedTuple):
    """A frame that is corrected, at the nodes of a corrector's paths and the boundary's samples.

    Parameters
    ----------
    fz, g : complex128, shape (s,)
        F and G at the nodes.
    by : complex128, shape (s,)
        K, what q is multiplied by.
    sign : {-1, 1}
        σ.
    """

    fz: Complexes
    g: Complexes
    by: Complexes
    sign: int


@dataclass(frozen=True, slots=True, eq=False)
class CorrectedFrame:
    """A frame with h and q.

    Parameters
    ----------
    corrector : Corrector
    base : BaseFrame
    x : float64, shape (2N,)
    """

    corrector: Corrector
    base: BaseFrame
    x: Floats

    def places(self) -> Complexes:
        """Return the integrals from the anchor to each point, then around each hole."""
        conformal, own, mixed = self._integrands()
        weights = self.corrector.paths.weights
        return np.asarray(weights @ conformal + (weights @ (own + mixed)).conj())

    def rows(self) -> Floats:
        """Return the derivatives of these by the unknowns: real parts, then imaginary ones."""
        known, weights = self.corrector.variables, self.corrector.paths.weights
        conformal, own, mixed = self._integrands()
        count = len(weights)
        both = np.vstack([weights * conformal, weights * (self.base.sign * own + mixed)])
        by_h = both @ known.h_at_nodes
        by_q = (weights * self._factor()) @ known.q_at_nodes
        rows = np.hstack([by_h[:count] + by_h[count:].conj(), by_q.conj()])
        return np.vstack([rows.real, rows.imag])

    def bending(self, pulls: Complexes) -> "Bending":
        """Return the second derivative of Re Σ conj(pull_i) place_i by the unknowns."""
        conformal, own, mixed = self._integrands()
        weights = self.corrector.paths.weights
        back, through = pulls.conj() @ weights, pulls @ weights
        by_q = through * self._factor()
        return Bending(self.corrector, back * conformal + through * (own + mixed), by_q)

    def _integrands(self) -> tuple[Complexes, Complexes, Complexes]:
        """Return F e^h, G e^{σh} and q K e^h at the nodes."""
        known, base = self.corrector.variables, self.base
        h = known.h_at_nodes @ self.x[: known.count]
        q = known.q_at_nodes @ self.x[known.count :]
        grown = np.exp(h)
        own = base.g * (grown if base.sign > 0 else 1.0 / grown)
        return base.fz * grown, own, base.by * grown * q

    def _factor(self) -> Complexes:
        """Return K e^h."""
        known = self.corrector.variables
        h = known.h_at_nodes @ self.x[: known.count]
        return np.asarray(self.base.by * np.exp(h))


class Bending(NamedTuple):
    """A symmetric form of the unknowns: Re Σ twice · (δh)² + 2 both · δh δq over the nodes."""

    corrector: Corrector
    twice: Complexes
    both: Complexes

    def __call__(self, x: Floats) -> Floats:
        """Return the form's product with a vector."""
        known = self.corrector.variables
        h = known.h_at_nodes @ x[: known.count]
        q = known.q_at_nodes @ x[known.count :]
        of_h, of_q = self.twice * h + self.both * q, self.both * h
        return np.concatenate([(of_h @ known.h_at_nodes).real, (of_q @ known.q_at_nodes).real])
