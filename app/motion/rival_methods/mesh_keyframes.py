"""Keyframes and in-betweens of a triangulated domain: positions of vertices, and derivatives."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np
import numpy.typing as npt

from app.motion.rival_methods.triangulated_domain import TriangulatedDomain
from engine.arrays import Complexes, Floats, as_points, freeze
from engine.errors import EngineError
from engine.interpolation import TWO_KEYFRAMES
from engine.paths import root_sheets

WINDS = (
    "Keyframe {number} winds around a hole: past ({x:.6g}, {y:.6g}) it makes {turns:.0f} whole "
    "turns more than the domain. Pose it again without these turns."
)


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class MeshKeyframe:
    """One keyframe, linear in each triangle.

    Parameters
    ----------
    angles : float64, shape (m,)
        arg f_z of each triangle.
    anchor_angle : float
        arg f_z around the anchor.
    """

    positions: Complexes
    fz: Complexes
    fzbar: Complexes
    angles: Floats
    anchor_position: complex
    anchor_angle: float

    @property
    def stretch(self) -> Complexes:
        """S of the polar decomposition R S: z ↦ |f_z| z + this (m,) times z̄."""
        return np.asarray(self.fzbar * np.exp(-1j * self.angles))


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


def mesh_keyframes(
    domain: TriangulatedDomain,
    positions: Sequence[npt.ArrayLike],
    *,
    turns: npt.ArrayLike | None = None,
    principal: bool = False,
) -> tuple[MeshKeyframe, ...]:
    """Differentiate keyframes and choose the branches of their rotation angles.

    Parameters
    ----------
    positions : sequence of complex, shape (n,)
        Of the vertices, in each of q keyframes.
    turns : int, shape (q − 1,), optional
        Whole turns between neighbouring keyframes beyond the shorter way.
    principal : bool
        Whether each triangle's angle is the one between −π and π, regardless of its neighbours: the
        choice of Alexa et al. (2000), which fails where shapes rotate far.

    Raises
    ------
    EngineError
        If there are fewer than two keyframes, or a keyframe has the wrong number of positions,
        folds, or winds around a hole.

    Notes
    -----
    Otherwise the angles are continued from the anchor across inner edges (Section 7.2 of the paper;
    Choi and Szymczak 2003), and the anchor's own are as in `root_sheets`. Across an edge the branch
    is unique: without folds f_z rotates an edge to less than π/2 from its image under the map,
    which is the same for the triangles on both sides. Around a hole the sum may be a whole turn.
    """
    if len(positions) < 2:
        raise EngineError(TWO_KEYFRAMES, count=len(positions))
    checked = [_checked(domain, each, number) for number, each in enumerate(positions)]
    derivatives = [domain.derivatives(each) for each in checked]
    for number, (each, (fz, fzbar)) in enumerate(zip(checked, derivatives, strict=True)):
        _require_unfolded(domain, each, np.abs(fz) - np.abs(fzbar), number)
    at_anchor = np.array([domain.anchor_fz(fz) for fz, _ in derivatives])
    sheets = 2 * np.pi * root_sheets(at_anchor, turns)
    keyframes: list[MeshKeyframe] = []
    for position, (fz, fzbar), anchor, sheet in zip(
        checked, derivatives, at_anchor, sheets, strict=True
    ):
        angle = float(np.angle(anchor) + sheet)
        continued = _continued(domain, fz, anchor)
        _require_unwound(domain, fz, continued, len(keyframes))
        keyframes.append(
            MeshKeyframe(
                positions=position,
                fz=freeze(fz),
                fzbar=freeze(fzbar),
                angles=freeze(np.angle(fz) if principal else continued + angle),
                anchor_position=complex(position[domain.anchor]),
                anchor_angle=angle,
            )
        )
    return tuple(keyframes)


def _continued(domain: TriangulatedDomain, fz: Complexes, anchor: complex) -> Floats:
    """Return the arguments of f_z (m,) less that of the anchor, continued across inner edges."""
    crossings = domain.crossings
    turns = np.angle(fz * fz[crossings.parent].conj())
    root = crossings.order[0]
    turns[root] = np.angle(fz[root] / anchor)
    principal = np.angle(fz / anchor)
    # Only the integer is taken from the sum, so that rounding does not add up along the path.
    sheets = np.round((crossings.sums(turns) - principal) / (2 * np.pi))
    return principal + 2 * np.pi * sheets


def _require_unwound(
    domain: TriangulatedDomain, fz: Complexes, angles: Floats, number: int
) -> None:
    """Raise an `EngineError` for angles that grow by whole turns around a hole.

    They have no logarithm.
    """
    one, other = domain.pairs.T
    rest = angles[other] - angles[one] - np.angle(fz[other] * fz[one].conj())
    wound = np.flatnonzero(np.abs(rest) > np.pi)
    if len(wound):
        at = domain.points[domain.corners[one[wound[0]]]].mean()
        raise EngineError(
            WINDS, number=number, x=at.real, y=at.imag, turns=abs(rest[wound[0]]) / (2 * np.pi)
        )


def _checked(domain: TriangulatedDomain, values: npt.ArrayLike, number: int) -> Complexes:
    positions = as_points(values, f"The positions of keyframe {number}")
    if len(positions) != len(domain.points):
        raise EngineError(
            "Keyframe {number} has {count} points, but the triangles need {points}; all "
            "keyframes must have the same triangles.",
            number=number,
            count=len(positions),
            points=len(domain.points),
        )
    return positions


def _require_unfolded(
    domain: TriangulatedDomain, positions: Complexes, sigma_b: Floats, number: int
) -> None:
    """Raise an `EngineError` for flipped triangles, and fans that wind twice around a vertex."""
    worst = int(sigma_b.argmin())
    if sigma_b[worst] <= 0:
        at = domain.points[domain.corners[worst]].mean()
        raise EngineError(
            "Keyframe {number} folds: triangle {triangle}, at ({x:.6g}, {y:.6g}) of the domain, "
            "is flipped ({count} of {all} are). Pose it again without folds. For a harmonic "
            "map, use smaller triangles.",
            number=number,
            triangle=worst,
            x=at.real,
            y=at.imag,
            count=np.count_nonzero(sigma_b <= 0),
            all=len(sigma_b),
        )
    a, b, c = positions[domain.corners.T]
    angles = np.angle([(c - a) / (b - a), (a - b) / (c - b), (b - c) / (a - c)])
    around = np.bincount(domain.corners.T.ravel(), angles.ravel())
    double = np.flatnonzero(~domain.border & (np.abs(around - 2 * np.pi) > 1.0))
    if len(double):
        raise EngineError(
            "Keyframe {number} folds: the triangles around point {point} overlap. Pose it again "
            "without folds.",
            number=number,
            point=double[0],
        )
