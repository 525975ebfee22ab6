"""Targets of handles and bones during a segment, as functions of segment time from 0 to 1."""

from dataclasses import dataclass

import numpy as np

from engine.arrays import Booleans, Complexes, Floats
from engine.deform.correction.point_targets import PointTargets
from engine.geometry import Similarity, fit_rigid
from engine.interpolation.added.pins.bones import SegmentBones

# Weight of the points of bones: almost held, they make room for pinned handles.
BONE_FIRMNESS = 0.998


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class SegmentPins:
    """Handles pinned from one keyframe to the next, and the transition of all other handles.

    A pinned handle moves from its place at the first keyframe to its place at the second one by
    3t² − 2t³, or evenly on ground that moves. A handle pinned only in the previous or next segment
    starts or ends at its velocity there. Its displacement is t(1−t)² s₀ − t²(1−t) s₁, with a weight
    that fades as (1−t)³ and t³. The other handles follow the rigid motion that explains most of the
    displacement.

    Attributes
    ----------
    is_pinned : bool, shape (m,)
    is_even : bool, shape (m,)
        Whether a pinned handle moves evenly.
    ends : complex128, shape (2, m)
        Places of the handles at the keyframes.
    slopes : complex128, shape (2, m)
        s₀ and s₁, per unit of time; 0 if the neighbouring segment pins nothing.
    weights : float64, shape (2, m)
        Weights of the slopes, 0 or 1.
    firmness : float64, shape (m,)
        Stiffness of each target: 1, less close to a fixed anchor.
    is_anchored : bool
        Whether the anchor stays at its position in the base.
    bones : SegmentBones or None
        Of the points after the handles.
    """

    is_pinned: Booleans
    is_even: Booleans
    ends: Complexes
    slopes: Complexes
    weights: Floats
    firmness: Floats
    is_anchored: bool
    bones: SegmentBones | None = None

    def targets(self, time: float, places: Complexes, anchor: complex) -> PointTargets:
        """Return the targets of the points, given their places and the anchor of the base."""
        if self.bones is None:
            return self._handle_targets(time, places, anchor)[0]
        count = len(self.is_pinned)
        known, motion = self._handle_targets(time, places[:count], anchor)
        held = places[:count] + known.offsets
        pinned = {int(i): complex(held[i]) for i in np.flatnonzero(self.is_pinned)}
        even = np.flatnonzero(self.is_even).tolist()
        points = places[count:]
        offsets = self.bones.wanted(time, motion.apply(points), pinned, even) - points
        weights = np.full(len(points), BONE_FIRMNESS)
        weights[: len(self.bones.rest[0])] = 0.0
        return known._replace(
            offsets=np.append(known.offsets, offsets), weights=np.append(known.weights, weights)
        )

    @property
    def _is_end(self) -> Booleans:
        """Whether each handle is the end of a chain of two bones."""
        ends = [] if self.bones is None else [c.end for c in self.bones.chains if len(c.parts) == 2]
        is_end = np.zeros(len(self.is_pinned), dtype=np.bool_)
        is_end[ends] = True
        return is_end

    def _handle_targets(
        self, time: float, places: Complexes, anchor: complex
    ) -> tuple[PointTargets, Similarity]:
        """Return the targets of the handles, and the rigid motion of all others."""
        rest = 1.0 - time
        share = np.where(self.is_even, time, time * time * (3.0 - 2.0 * time))
        wanted = self.ends[0] + share * (self.ends[1] - self.ends[0])
        moving = time * rest * (rest * self.slopes[0] - time * self.slopes[1])
        offsets = np.where(self.is_pinned, wanted - places, moving)
        fading = rest**3 * self.weights[0] + time**3 * self.weights[1]
        weights = np.where(self.is_pinned, 1.0, fading)
        # Bones bring the ends of their chains to their places, wherever the body is.
        carrying = np.where(self._is_end, 0.0, weights)
        motion = fit_rigid(places, offsets, carrying, anchor if self.is_anchored else None)
        rigid = motion.apply(places) - places
        offsets = rigid + weights * (offsets - rigid)
        return PointTargets(offsets, self.firmness, self.is_anchored), motion
