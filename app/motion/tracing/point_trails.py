"""Points of a layer over time; each time is computed once as long as its keys stay."""

from typing import NamedTuple

import numpy as np

from app.document import Clip, Pose, keyed_pose_at, segment_time_at
from app.motion.inbetweens.animation import Animation
from app.motion.inbetweens.frame_corrector import needs_correction
from app.motion.inbetweens.pose_sampler import PoseSampler
from app.motion.inbetweens.segment_keys import segment_key, segment_poses
from app.motion.inbetweens.spring_offsets import ParentMotion
from engine.arrays import Complexes

REMEMBERED = 4  # kept times as a multiple of the clip's frames, for undo and redo


class TrailFrame(NamedTuple):
    """Points (p,) at a time, and f_z there; `poses` keeps the poses of the cache key alive."""

    positions: Complexes
    fz: Complexes
    poses: tuple[Pose, ...]


class PointTrails:
    """Points of a layer at any frame of a clip, with corrections.

    There is at least one point, complex128 (p,), of the undeformed layer. The sibling has the same
    outline and cage; its cached data is reused, as are earlier trails of the same points. `carried`
    returns the rigid motion of the layer at a frame.

    `worked_out` counts computed times, without cached ones. The sampler is None until the first
    computation. `known` has results by segment key and weight, or for corrected clips by clip and
    frame.
    """

    def __init__(
        self,
        clip: Clip,
        points: Complexes,
        sibling: PoseSampler | None = None,
        earlier: "PointTrails | None" = None,
        carried: ParentMotion | None = None,
    ) -> None:
        self.clip = clip
        self.points = points
        self.worked_out = 0
        self.sampler: PoseSampler | None = None
        self.known: dict[tuple[object, float], TrailFrame] = {}
        self._sibling = sibling
        self._carried = carried
        self._is_corrected = needs_correction(clip)
        self._animation: Animation | None = None
        if earlier is None or earlier.sampler is None:
            return
        is_own = earlier.sampler.domain is clip.layer.domain and earlier.sampler.is_for(clip.layer)
        if is_own and np.array_equal(points, earlier.points):
            most = REMEMBERED * (1 + clip.frames.last - clip.frames.first)
            self.sampler = earlier.sampler
            self.known = dict(list(earlier.known.items())[-most:])

    def at(self, frame: float) -> TrailFrame:
        moment = segment_time_at(self.clip, frame)
        resting = keyed_pose_at(self.clip, moment)
        key: tuple[object, float]
        if self._is_corrected:
            key = self.clip, frame
        elif resting is None:
            key = segment_key(self.clip, moment.segment), moment.weight
        else:
            key = (id(resting.phi), id(resting.psi)), 0.0
        if key not in self.known:
            moved = self._animate().frame(frame)
            poses = segment_poses(self.clip, moment.segment) if resting is None else (resting,)
            self.known[key] = TrailFrame(moved.positions, moved.fz, poses)
            self.worked_out += 1
        return self.known[key]

    def base_at(self, frame: float) -> TrailFrame:
        """Return the points at a frame before corrections."""
        moved = self._animate().base.frame(frame)
        return TrailFrame(moved.positions, moved.fz, ())

    def release_intermediates(self) -> None:
        """Drop the data from which times are computed; the next new time needs it again."""
        self._animation = None
        if self.sampler is not None:
            # The sampler also holds the outline's transform.
            self.sampler.forget_extension()

    def _animate(self) -> Animation:
        if self._animation is None:
            sampler = self.sampler or PoseSampler(
                self.clip.layer, points=self.points, sibling=self._sibling
            )
            self._animation = Animation(self.clip, sampler=sampler, carried=self._carried)
            self.sampler = sampler
        return self._animation
