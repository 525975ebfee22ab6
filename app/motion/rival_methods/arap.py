"""As-rigid-as-possible shape interpolation (Alexa, Cohen-Or and Levin 2000)."""

from dataclasses import dataclass

import numpy as np

from app.motion.rival_methods.mesh_keyframes import MeshFrame, MeshKeyframe
from app.motion.rival_methods.poisson import PoissonStep


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class ArapInbetweens:
    """Each triangle's Jacobian is blended separately, J = R S: the angle of R and S linearly.

    The blended Jacobians belong to no map, and the nearest map is taken. This step may add any
    amount of distortion.

    Departs from their paper: triangles are weighted by area, not equally, so that the result does
    not depend on the mesh. The angles are consistent unless the keyframes' are principal, as in the
    comparisons of Section 8 of *Bounded Distortion Harmonic Shape Interpolation*.
    """

    first: MeshKeyframe
    second: MeshKeyframe
    step: PoissonStep

    def frame(self, time: float) -> MeshFrame:
        first, second, rest = self.first, self.second, 1.0 - time
        rotation = np.exp(1j * (rest * first.angles + time * second.angles))
        similar = rest * np.abs(first.fz) + time * np.abs(second.fz)
        other = rest * first.stretch + time * second.stretch
        anchor = rest * first.anchor_position + time * second.anchor_position
        return self.step.integrate(rotation * similar, rotation * other, anchor)
