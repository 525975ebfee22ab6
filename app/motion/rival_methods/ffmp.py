"""Free-form motion processing (Kircher and Garland 2008), in the plane."""

from dataclasses import dataclass
from typing import Self

import numpy as np
from scipy.sparse import csc_array, csr_array

from app.motion.rival_methods.mesh_keyframes import MeshFrame, MeshKeyframe
from app.motion.rival_methods.poisson import PoissonStep
from app.motion.rival_methods.triangulated_domain import (
    TriangulatedDomain,
    factorise_symmetric,
    solve_complex,
)
from engine.arrays import Complexes, Floats, Indices, freeze


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class FfmpInbetweens:
    """Blends the transforms between neighbouring triangles' frames, J_i⁻¹ J_j; integrates twice.

    The ratios of neighbouring Jacobians are independent of rotations and affine maps of the whole,
    so no branch must be chosen except at the anchor's triangle, whose frame is given. The ratios
    are blended in their polar decomposition. Then frames are fitted to the ratios, and positions to
    the frames.

    If keyframe i becomes B_i f^i with affine B_i, every in-between becomes an affine map of its
    former value. Both systems are linear in the rows of the Jacobians, and the frame at the anchor
    is a factor on the left of all others. So nothing bounds the distortion.

    Departs from their paper: surfaces in space have frames of three vectors, a plane mesh of two;
    and both ratios at an edge count, J_i⁻¹ J_j and J_j⁻¹ J_i, so that the order of the triangles
    does not matter.

    Parameters
    ----------
    angles, scales : float64, shape (2, 2 e)
        Of the ratios at inner edges, in both directions, in each keyframe: of their similar part.
    stretches : complex128, shape (2, 2 e)
        The rest of their polar decompositions.
    """

    first: MeshKeyframe
    second: MeshKeyframe
    step: PoissonStep
    angles: Floats
    scales: Floats
    stretches: Complexes

    @classmethod
    def of(cls, first: MeshKeyframe, second: MeshKeyframe, step: PoissonStep) -> Self:
        """Compute the ratios of both keyframes."""
        start, end = _directed(step.domain)
        ratios = [_ratios(key, start, end) for key in (first, second)]
        similar, other = (np.array(part) for part in zip(*ratios, strict=True))
        angles = np.angle(similar)
        return cls(
            first=first,
            second=second,
            step=step,
            angles=freeze(angles),
            scales=freeze(np.abs(similar)),
            stretches=freeze(other * np.exp(-1j * angles)),
        )

    def frame(self, time: float) -> MeshFrame:
        first, second, weights = self.first, self.second, np.array([1.0 - time, time])
        rotation = np.exp(1j * (weights @ self.angles))
        ratios = rotation * (weights @ self.scales), rotation * (weights @ self.stretches)
        matrix = self._mismatch(*ratios)
        root = self.step.domain.crossings.order[0]
        turn = np.exp(1j * (weights @ [first.angles[root], second.angles[root]]))
        similar = turn * (weights @ [abs(first.fz[root]), abs(second.fz[root])])
        other = turn * (weights @ [first.stretch[root], second.stretch[root]])
        fz, fzbar = _fitted(matrix, int(root), complex(similar), complex(other))
        anchor = complex(weights @ [first.anchor_position, second.anchor_position])
        return self.step.integrate(fz, fzbar, anchor)

    def _mismatch(self, similar: Complexes, other: Complexes) -> csr_array:
        """Return the matrix (4 e, 2 m) from all (f_x, f_y) to (f_x, f_y)_j − (f_x, f_y)_i C_ij."""
        start, end = _directed(self.step.domain)
        # C z = c z + d z̄ as a real matrix, by columns.
        columns = (
            (similar.real + other.real, similar.imag + other.imag),
            (other.imag - similar.imag, similar.real - other.real),
        )
        ones = np.ones(len(start))
        values = [np.column_stack([ones, -x, -y]) for x, y in columns]
        places = [np.column_stack([2 * end + k, 2 * start, 2 * start + 1]) for k in (0, 1)]
        count = 2 * len(start)
        rows = np.arange(0, 3 * count + 1, 3)
        entries = np.concatenate(values).ravel(), np.concatenate(places).ravel(), rows
        return csr_array(entries, shape=(count, 2 * len(self.step.domain.areas)))


def _directed(domain: TriangulatedDomain) -> tuple[Indices, Indices]:
    """Return the triangles on either side of the inner edges, in both directions, each (2 e,)."""
    one, other = domain.pairs.T
    return np.concatenate([one, other]), np.concatenate([other, one])


def _ratios(key: MeshKeyframe, start: Indices, end: Indices) -> tuple[Complexes, Complexes]:
    """Return c and d of J_i⁻¹ J_j, z ↦ c z + d z̄, from triangles i to triangles j."""
    a, b = key.fz[start], key.fzbar[start]
    c, d = key.fz[end], key.fzbar[end]
    area = np.abs(a) ** 2 - np.abs(b) ** 2
    return (a.conj() * c - b * d.conj()) / area, (a.conj() * d - b * c.conj()) / area


def _fitted(
    matrix: csr_array, root: int, similar: complex, other: complex
) -> tuple[Complexes, Complexes]:
    """Return f_z and f_z̄ (m,) of the frames that fit the ratios best, with the root's given."""
    own, given = [2 * root, 2 * root + 1], np.array([similar + other, 1j * (similar - other)])
    columns = csc_array(matrix)
    free = np.delete(np.arange(matrix.shape[1]), own)
    unknown, known = columns[:, free], np.asarray(columns[:, own] @ given)
    frames = np.empty(matrix.shape[1], dtype=np.complex128)
    frames[free] = solve_complex(
        factorise_symmetric(unknown.T @ unknown), -np.asarray(unknown.T @ known)
    )
    frames[own] = given
    by_x, by_y = frames[::2], frames[1::2]
    return (by_x - 1j * by_y) / 2, (by_x + 1j * by_y) / 2
