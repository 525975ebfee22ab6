"""Triangulated shapes and keyframes for the tests of the methods that the paper compares with."""

from functools import cache

import numpy as np
from interpolation_shapes import bar, bent

from engine.domain.meshing.mesh import Mesh
from engine.domain.meshing.triangulation import triangulate
from engine.maps import HarmonicMap


@cache
def meshed_bar(triangles: int = 600) -> Mesh:
    return triangulate(bar(0.25)[0], triangles)


def bend_of(curvature: float, power: int, eta: complex = 0.0) -> HarmonicMap:
    """Return a map of the bar whose middle line turns by curvature · x^power / power at x.

    1 makes a U of it, and 2 an S. η is the same everywhere.
    """
    _, cage = bar(0.25)
    nodes, weights = np.polynomial.legendre.leggauss(40)
    along = cage[:, None] * (nodes + 1) / 2
    fz = np.exp(1j * curvature * along**power / power)
    phi, psi = (cage * (part @ weights) / 2 for part in (fz, np.conj(eta) / fz))
    return HarmonicMap(cage=cage, phi=phi, psi=psi)


def s_to_u() -> list[HarmonicMap]:
    return [bend_of(0.6, 2, eta=0.1), bend_of(1.2, 1, eta=0.1)]


def stretched_pair() -> list[HarmonicMap]:
    """A bar that is stretched, and one bent, turned by 2.5 radians and compressed."""
    shape = bar(0.25)
    return [bent(shape, stretch=1.3), bent(shape, bend=1.2, turn=2.5, stretch=0.7, shift=1 + 1j)]


def rigid(turn: float, shift: complex) -> HarmonicMap:
    return bent(bar(0.25), turn=turn, shift=shift)


def k_of(fz, fzbar):
    return np.abs(fzbar) / np.abs(fz)
