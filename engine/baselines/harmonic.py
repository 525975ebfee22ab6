"""Methods whose in-betweens are harmonic maps: blended handles, and conformal interpolation."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from engine.arrays import Complexes
from engine.baselines.frames import MeshFrame
from engine.baselines.triangulated_domain import TriangulatedDomain
from engine.deform import Deformer, StartingPoint
from engine.errors import EngineError
from engine.interpolation import Prepared
from engine.maps import Boundary, HarmonicMap, derivatives_of

HOLOMORPHIC = 1e-6  # largest k of a map that counts as holomorphic


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class HandleInbetweens:
    """The shape is deformed anew, by handles whose targets move straight from key to key.

    Chen and Weber (2015) keep their bounds in each frame, but handles that go straight go where
    nobody would pull them. The search begins at the keyframe that is nearer in time and stays in
    its valley: a keyframe comes out as far as it is a minimum of the energy for these handles.
    """

    domain: TriangulatedDomain
    deformer: Deformer  # with the handles and the bounds
    first: HarmonicMap
    second: HarmonicMap

    def frame(self, time: float) -> MeshFrame:
        """Return the in-between at a time in [0, 1]."""
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

    Departs from their paper: f' is integrated, not fitted in the span of the Cauchy coordinates,
    so that the keyframes come out exactly.
    """

    domain: TriangulatedDomain
    prepared: (
        Prepared  # all keyframes by the ν variant: for holomorphic ones it blends log f' alone
    )
    start: int  # the keyframe at time 0

    def frame(self, time: float) -> MeshFrame:
        """Return the in-between at a time in [0, 1]."""
        return _frame(self.domain, self.prepared.frame(self.start + time).positions)


def _frame(domain: TriangulatedDomain, positions: Complexes) -> MeshFrame:
    fz, fzbar = domain.derivatives(positions)
    return MeshFrame(positions=positions, fz=fz, fzbar=fzbar)


def require_holomorphic(maps: Sequence[HarmonicMap], boundary: Boundary) -> None:
    """Refuse keyframes that are not conformal.

    Raises
    ------
    EngineError
        If a map has k > 1e-6 somewhere on the boundary, and hence in the domain.
    """
    for number, (fz, fzbar) in enumerate(zip(*derivatives_of(maps, boundary.points), strict=True)):
        k = np.abs(fzbar) / np.abs(fz)
        worst = int(k.argmax())
        if k[worst] > HOLOMORPHIC:
            z = boundary.points[worst]
            raise EngineError(
                f"Keyframe {number} is not holomorphic: at ({z.real:.6g}, {z.imag:.6g}) its "
                f"conformal distortion k is {k[worst]:.3g}, and must be 0. Conformal interpolation "
                "is for conformal keyframes; choose another method."
            )
