"""The paths along which the handles of a layer move over time."""

from dataclasses import dataclass

import numpy as np

from app.document import Clip
from app.motion.inbetweens import ParentMotion, PoseSampler
from app.motion.tracing.point_trails import PointTrails
from engine.arrays import Complexes, Indices, freeze

MOST = 1000  # frames that are traced; of longer animations every second, third …


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class MotionPaths:
    """Where the handles of a layer are in the frames of its clip."""

    clip: Clip
    frames: Indices  # intp (f,)
    positions: Complexes  # complex128 (f, h): Of each handle, on the layer by itself
    trails: PointTrails | None  # of the worker alone; None where there are no handles


def trace_paths(
    clip: Clip,
    earlier: MotionPaths | None = None,
    sibling: PoseSampler | None = None,
    carried: ParentMotion | None = None,
) -> MotionPaths:
    """Work out where a clip's handles are in all frames; exactly, since they are few points.

    Parameters
    ----------
    earlier : MotionPaths, optional
        What is known of the same handles and poses is used again.
    sibling : PoseSampler, optional
        With the same outline and cage; what depends on them alone is shared.
    carried : callable, optional
        Where the layer hangs, at a frame.
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
