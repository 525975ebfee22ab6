"""Where handles are wanted during a segment, as functions of its own time from 0 to 1."""

from dataclasses import dataclass

import numpy as np

from engine.arrays import Booleans, Complexes, Floats
from engine.deform.correction import PointTargets
from engine.geometry import fit_rigid


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class SegmentPins:
    """Handles that stay from one keyframe to the next, and how the others leave and reach them.

    A pinned handle goes from its place at the first keyframe to that at the second one as 3t² − 2t³
    does. One that is pinned in the segment before or after only is there with its velocity: it is
    moved by t(1−t)² s₀ − t²(1−t) s₁, with a weight that fades as (1−t)³ and t³. The others move
    with the rigid motion that does most of it.

    Parameters
    ----------
    is_pinned : bool, shape (m,)
    ends : complex128, shape (2, m)
        The places of the handles at the keyframes.
    slopes : complex128, shape (2, m)
        s₀ and s₁, by time; 0 where the segments beyond pin nothing.
    weights : float64, shape (2, m)
        Of these, 0 or 1.
    firmness : float64, shape (m,)
        How firmly a handle is held, 1 but next to an anchor that stays.
    is_anchored : bool
        Whether the anchor stays where the base has it.
    """

    is_pinned: Booleans
    ends: Complexes
    slopes: Complexes
    weights: Floats
    firmness: Floats
    is_anchored: bool

    def targets(self, time: float, places: Complexes, anchor: complex) -> PointTargets:
        """Return where handles are wanted that the base has at places (m,), and its anchor."""
        rest = 1.0 - time
        wanted = self.ends[0] + time * time * (3.0 - 2.0 * time) * (self.ends[1] - self.ends[0])
        moving = time * rest * (rest * self.slopes[0] - time * self.slopes[1])
        offsets = np.where(self.is_pinned, wanted - places, moving)
        fading = rest**3 * self.weights[0] + time**3 * self.weights[1]
        weights = np.where(self.is_pinned, 1.0, fading)
        motion = fit_rigid(places, offsets, weights, anchor if self.is_anchored else None)
        rigid = motion.apply(places) - places
        return PointTargets(rigid + weights * (offsets - rigid), self.firmness, self.is_anchored)
