"""Results of all rival methods, and their common interface."""

from dataclasses import dataclass
from typing import Protocol

from engine.arrays import Complexes


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class MeshFrame:
    """An in-between of a triangulated domain.

    Parameters
    ----------
    positions : complex128, shape (n,)
        Of the vertices.
    fz, fzbar : complex128, shape (m,)
        f_z and f_z̄ of each triangle, of the map that is linear in it.
    poisson_error : float or None
        Distance of the method's own blend of the Jacobians from those of one map: the root mean
        squared difference from `fz` and `fzbar`, over that of the blend itself. 0 is integrable.
    angle_defect : float or None
        The largest difference from 2π, in radians, of the angles around an inner vertex after a
        flattening.
    rho : float or None
        The scaling of η.
    """

    positions: Complexes
    fz: Complexes
    fzbar: Complexes
    poisson_error: float | None = None
    angle_defect: float | None = None
    rho: float | None = None


class MeshInbetweens(Protocol):
    """In-betweens of two keyframes by one method."""

    def frame(self, time: float) -> MeshFrame:
        pass
