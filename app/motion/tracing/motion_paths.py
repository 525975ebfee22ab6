"""Motion paths of a layer's handles."""

from dataclasses import dataclass

import numpy as np

from app.document import Clip
from app.motion.inbetweens.pose_sampler import PoseSampler
from app.motion.inbetweens.spring_offsets import ParentMotion
from app.motion.tracing.point_trails import PointTrails
from engine.arrays import Complexes, Indices, freeze

MOST = 1000  # traced frames; longer animations skip frames evenly


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class MotionPaths:
    """Positions of a layer's handles in the frames of its clip."""

    clip: Clip
    frames: Indices  # intp (f,)
    positions: Complexes  # complex128 (f, h), in the layer's space
    trails: PointTrails | None  # for the worker only; None without handles


def trace_paths(
    clip: Clip,
    earlier: MotionPaths | None = None,
    sibling: PoseSampler | None = None,
    carried: ParentMotion | None = None,
) -> MotionPaths:
    """Return the exact positions of a clip's handles in all frames.

    Earlier paths of the same handles and poses are reused. The sibling has the same outline and
    cage, and shares the data that depends on these alone. `carried` returns the rigid motion of the
    layer at a frame.
    """
    first, last = clip.frames.first, clip.frames.last
    frames = np.arange(first, last + 1, 1 + (last - first) // MOST)
    points = np.array([handle.position for handle in clip.layer.handles], dtype=np.complex128)
    tracked, places = None, np.empty((len(frames), 0), dtype=np.complex128)
    if len(points):
        known = earlier.trails if earlier else None
        tracked = PointTrails(clip, points, sibling, known, carried)
        places = np.array([tracked.at(float(frame)).positions for frame in frames])
    return MotionPaths(clip=clip, frames=freeze(frames), positions=freeze(places), trails=tracked)
