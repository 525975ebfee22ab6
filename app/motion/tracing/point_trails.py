"""A few points of a layer over time; each moment is worked out once, as long as its keys stay."""

from typing import NamedTuple

import numpy as np

from app.document import Clip, Pose, keyed_pose_at, pose_segments, segment_time_at
from app.motion.inbetweens import (
    Animation,
    ParentMotion,
    PoseSampler,
    needs_correction,
    segment_key,
)
from engine.arrays import Complexes

REMEMBERED = 4  # times as many moments as a clip has frames, for undo and redo


class TrailFrame(NamedTuple):
    """The points (p,) at a moment, and f_z there; the poses that they follow from stay alive."""

    positions: Complexes
    fz: Complexes
    poses: tuple[Pose, ...]


class PointTrails:
    """Some points of a layer at any frame of a clip, as it is shown.

    Parameters
    ----------
    points : complex128, shape (p,)
        Of the layer at rest; at least one.
    sibling : PoseSampler, optional
        With the same outline and cage; what it knows of them is used again.
    earlier : PointTrails, optional
        If it is of the same points, what it knows is used again.
    carried : callable, optional
        Where the layer hangs, at a frame.

    Attributes
    ----------
    worked_out : int
        How many moments had to be worked out, as nothing was known of them.
    sampler : PoseSampler or None
        None until the first of them.
    known : dict
        What was found, by the pair of the keys around and the weight between them; where frames are
        corrected, by the clip and the frame.
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
        if earlier is None:
            return
        layer, own = earlier.clip.layer, clip.layer
        is_same = layer.domain is own.domain and layer.anchor == own.anchor
        if is_same and np.array_equal(points, earlier.points):
            most = REMEMBERED * (1 + clip.frames.last - clip.frames.first)
            self.sampler = earlier.sampler
            self.known = dict(list(earlier.known.items())[-most:])

    def at(self, frame: float) -> TrailFrame:
        """Return where the points are at a frame."""
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
            keys = pose_segments(self.clip)[moment.segment].keys if resting is None else ()
            poses = (resting,) if resting is not None else tuple(each.pose for each in keys)
            self.known[key] = TrailFrame(moved.positions, moved.fz, poses)
            self.worked_out += 1
        return self.known[key]

    def base_at(self, frame: float) -> TrailFrame:
        """Return the same before anything is corrected."""
        moved = self._animate().base.frame(frame)
        return TrailFrame(moved.positions, moved.fz, ())

    def release_intermediates(self) -> None:
        """Let go of what moments are worked out with; one that is not known needs it again."""
        self._animation = None
        if self.sampler is not None:
            # It holds the outline's transform, too.
            self.sampler.forget_extension()

    def _animate(self) -> Animation:
        if self._animation is None:
            layer = self.clip.layer
            sampler = self.sampler or PoseSampler(
                layer.domain, anchor=layer.anchor, points=self.points, sibling=self._sibling
            )
            self._animation = Animation(self.clip, sampler=sampler, carried=self._carried)
            self.sampler = sampler
        return self._animation
