"""Planar shape interpolation with bounded distortion (Chen, Weber, Keren and Ben-Chen 2013)."""

from dataclasses import dataclass
from typing import Self

import numpy as np

from app.motion.rival_methods.flattening import Flattening, edge_lengths
from app.motion.rival_methods.mesh_keyframes import MeshFrame, MeshKeyframe
from engine.arrays import Floats, freeze


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class FlatInbetweens:
    """The pull-back metrics Jᵀ J are blended linearly, and the blend is flattened.

    On a mesh the metric of a triangle is the squared lengths of its edges, so these are blended.
    The blend's conformal distortion is below the larger of the keyframes' in every triangle, but
    the blend is not flat. The flattening is discretely conformal, and keeps the lengths between
    neighbours on the border. The conformal distortion that it adds to a triangle goes to 0 with the
    triangle's size; the added isometric distortion has no limit.

    A metric leaves the rigid motion free. The anchor fixes it: its position and arg f_z around it
    are linear in time.

    Parameters
    ----------
    squared : float64, shape (2, m, 3)
        Lengths of the half-edges in both keyframes, squared.
    """

    first: MeshKeyframe
    second: MeshKeyframe
    flattening: Flattening
    squared: Floats

    @classmethod
    def of(cls, first: MeshKeyframe, second: MeshKeyframe, flattening: Flattening) -> Self:
        """Compute the metrics of both keyframes."""
        lengths = [edge_lengths(flattening.domain, key.positions) for key in (first, second)]
        squared = freeze(np.square(lengths))
        return cls(first=first, second=second, flattening=flattening, squared=squared)

    def blended_lengths(self, time: float) -> Floats:
        """Return the lengths (m, 3) of the half-edges before the flattening."""
        return np.asarray(np.sqrt((1.0 - time) * self.squared[0] + time * self.squared[1]))

    def frame(self, time: float) -> MeshFrame:
        first, second, domain = self.first, self.second, self.flattening.domain
        positions, defect = self.flattening.flatten(self.blended_lengths(time))
        fz, fzbar = domain.derivatives(positions)
        angle = (1.0 - time) * first.anchor_angle + time * second.anchor_angle
        turn = np.exp(1j * (angle - np.angle(domain.anchor_fz(fz))))
        anchor = (1.0 - time) * first.anchor_position + time * second.anchor_position
        return MeshFrame(
            positions=anchor + turn * positions,
            fz=turn * fz,
            fzbar=turn * fzbar,
            angle_defect=defect,
        )
