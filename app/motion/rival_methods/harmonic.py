"""Methods whose in-betweens are harmonic maps: blended handles, and conformal interpolation."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from app.motion.rival_methods.mesh_keyframes import MeshFrame
from app.motion.rival_methods.triangulated_domain import TriangulatedDomain
from engine.arrays import Complexes
from engine.deform import Deformer, StartingPoint
from engine.errors import EngineError
from engine.interpolation import Prepared
from engine.maps import Boundary, HarmonicMap, derivatives_of

HOLOMORPHIC = 1e-6  # largest k of a map that counts as holomorphic


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class HandleInbetweens:
    """The shape is deformed in each frame, by handles with straight paths from key to key.

    Chen and Weber (2015) keep their bounds in each frame, but straight paths of handles are not the
    paths that a person would drag. The search begins at the keyframe that is nearer in time and
    stays in its valley. A keyframe is reproduced exactly only if it is a minimum of the energy for
    its handles.
    """

    domain: TriangulatedDomain
    deformer: Deformer  # with the handles and the bounds
    first: HarmonicMap
    second: HarmonicMap

    def frame(self, time: float) -> MeshFrame:
        handles = self.deformer.handles
        targets = (1.0 - time) * self.first(handles.points) + time * self.second(handles.points)
        start = self.deformer.resume(self.first if time < 0.5 else self.second)
        state, _ = self.deformer.settle(
            start, handles.targets(targets), ways=(StartingPoint.HERE,), throw=False
        )
        return _frame(self.domain, state.map(self.domain.points))


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class ConformalInbetweens:
    """Conformal maps stay conformal: log f' is blended (Weber and Gotsman 2010).

    Departs from their paper: f' is integrated, not fitted in the span of the Cauchy coordinates, so
    that keyframes are reproduced exactly.
    """

    domain: TriangulatedDomain
    prepared: (
        Prepared  # all keyframes by the ν variant: for holomorphic ones it blends log f' alone
    )
    start: int  # the keyframe at time 0

    def frame(self, time: float) -> MeshFrame:
        return _frame(self.domain, self.prepared.frame(self.start + time).positions)


def _frame(domain: TriangulatedDomain, positions: Complexes) -> MeshFrame:
    fz, fzbar = domain.derivatives(positions)
    return MeshFrame(positions=positions, fz=fz, fzbar=fzbar)


def require_holomorphic(maps: Sequence[HarmonicMap], boundary: Boundary) -> None:
    """Raise an `EngineError` for keyframes that are not conformal.

    Such a map has k > 1e-6 somewhere on the boundary.
    """
    for number, (fz, fzbar) in enumerate(zip(*derivatives_of(maps, boundary.points), strict=True)):
        k = np.abs(fzbar) / np.abs(fz)
        worst = int(k.argmax())
        if k[worst] > HOLOMORPHIC:
            z = boundary.points[worst]
            raise EngineError(
                "Keyframe {number} is not holomorphic: at ({x:.6g}, {y:.6g}) its conformal "
                "distortion k is {k:.3g}, and must be 0. Conformal interpolation is for "
                "conformal keyframes; choose another method.",
                number=number,
                x=z.real,
                y=z.imag,
                k=k[worst],
            )
