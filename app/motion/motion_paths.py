"""The paths along which the handles of a figure move over time."""

from dataclasses import dataclass

import numpy as np

from app.document import Clip
from app.motion.inbetweens import Animation, PoseSampler
from engine.arrays import Complexes, Indices, freeze

MOST = 1000  # frames that are traced; of longer animations every second, third …


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class MotionPaths:
    """Where the handles of a figure are in the frames of its clip.

    Parameters
    ----------
    clip : Clip
    frames : intp, shape (f,)
    places : complex128, shape (f, h)
        Of each handle, on the figure by itself.
    sampler : PoseSampler or None
        Of the worker alone; None where there are no handles.
    """

    clip: Clip
    frames: Indices
    places: Complexes
    sampler: PoseSampler | None


def trace_paths(
    clip: Clip, earlier: MotionPaths | None = None, sibling: PoseSampler | None = None
) -> MotionPaths:
    """Work out where a clip's handles are in all frames; exactly, since they are few points.

    Parameters
    ----------
    clip : Clip
    earlier : MotionPaths, optional
        What is known of the same handles and poses is used again.
    sibling : PoseSampler, optional
        With the same outline and cage; what depends on them alone is shared.
    """
    figure, first, last = clip.figure, clip.frames.first, clip.frames.last
    frames = np.arange(first, last + 1, 1 + (last - first) // MOST)
    points = np.array([handle.position for handle in figure.handles], dtype=np.complex128)
    if not len(points):
        places = freeze(np.empty((len(frames), 0), dtype=np.complex128))
        return MotionPaths(clip=clip, frames=freeze(frames), places=places, sampler=None)
    sampler = None if earlier is None else earlier.sampler
    if (
        sampler is None
        or sampler.domain is not figure.domain
        or sampler.anchor != figure.anchor
        or not np.array_equal(sampler.sites.points, points)
    ):
        sampler = PoseSampler(
            figure.domain, anchor=figure.anchor, points=points, sibling=sibling or sampler
        )
    animation = Animation(clip, sampler=sampler)
    places = np.array([animation.positions(float(frame)) for frame in frames])
    return MotionPaths(clip=clip, frames=freeze(frames), places=freeze(places), sampler=sampler)
