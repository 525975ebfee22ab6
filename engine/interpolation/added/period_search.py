"""The search for the correction h of frames that closes their periods, among few functions."""

from typing import Any, NamedTuple, Self

import numpy as np
import numpy.typing as npt
import scipy.linalg

from engine.arrays import Complexes, Floats, freeze
from engine.interpolation.series.residual import combine_arrays
from engine.paths import Loops

CLOSED = 1e-14  # the iteration ends after a step in the unknowns of at most this
MOST_STEPS = 15
INDEPENDENT = 1e-13  # of the largest: smaller constraints depend on the others

# f_z and conj(f_z̄) of frames, or their moduli, (t, p) each.
FrameParts = tuple[npt.NDArray[Any], npt.NDArray[Any]]


class PeriodSearch(NamedTuple):
    """Search for h among few functions (c,), in unknowns (i,); the sum of squares is its size.

    `values` (i, p) are the functions of the unknowns at the nodes of the loops.
    """

    loops: Loops
    values: Complexes
    to_few: Floats

    @classmethod
    def among(cls, loops: Loops, few: Complexes, size: Floats, fixed: Floats) -> Self:
        """Use a form (c, c) as the size, and keep the values of forms (f, c) at 0.

        `few` (c, p) are the few functions at the nodes.
        """
        free = scipy.linalg.null_space(fixed)
        root = np.linalg.cholesky(free.T @ size @ free)
        to_few = np.asarray(scipy.linalg.solve_triangular(root, free.T, lower=True).T)
        return cls(loops, freeze(combine_arrays(to_few.T, few)), freeze(to_few))

    def closest(self, parts: FrameParts, sign: int, goals: Floats | float = 0.0) -> Floats:
        """Close the periods of frames (t,) as near to goals (t, i) as possible; (c, t)."""
        goals = goals + np.zeros((len(parts[0]), len(self.values)))
        x = goals
        for _ in range(MOST_STEPS):
            fz, g = corrected(parts, sign, combine_arrays(x, self.values))
            gaps = self.loops.integrals(fz) + self.loops.integrals(g).conj()
            by_h = self.loops.products(fz, self.values)
            by_h += sign * self.loops.products(g, self.values).conj()
            rows = np.concatenate([by_h.real, by_h.imag], axis=1)
            right = rows @ (x - goals)[..., None]
            right -= np.concatenate([gaps.real, gaps.imag], axis=1)[..., None]
            step = goals - x + (np.linalg.pinv(rows, rcond=INDEPENDENT) @ right)[..., 0]
            x = x + step
            if np.abs(step).max() < CLOSED:
                break
        return np.asarray(self.to_few @ x.T)


def corrected(parts: FrameParts, sign: int, h: Complexes | Floats) -> FrameParts:
    """Return frames of f_z and conj(f_z̄), or of their moduli, each (t, p), changed by h."""
    grown = np.exp(h)
    return parts[0] * grown, parts[1] * (grown if sign > 0 else 1.0 / grown)
