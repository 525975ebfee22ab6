"""Frames that are other than the closed-form motion: how far they distort, and what they miss."""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import reduce
from itertools import groupby

import numpy as np

from app.document import Clip, Extremes, Variant, falls_short
from app.motion import Animation, Carried
from engine.maps import Boundary

BETWEEN = (0.25, 0.5, 0.75)  # of each segment of the outline: where it is measured beside its ends


@dataclass(frozen=True, slots=True, kw_only=True)
class Short:
    """A handle that its track wants where it cannot come, from one frame to another."""

    handle: str
    first: int
    last: int
    lag: float  # pixels, the most


@dataclass(frozen=True, slots=True, kw_only=True)
class CorrectedReport:
    """The frames of a clip in which handles are held still or go their own ways.

    Parameters
    ----------
    frames : int
        How many.
    solved : int
        How many of them are more than moved as a whole, which distorts nothing.
    points : int
        On the outline, at which each of these is measured.
    reached : Extremes
        Of all of them.
    limits : Extremes
        What they are to keep: the figure's bounds, or what its keys have beyond them.
    short : tuple of Short
        What is out of reach.
    """

    frames: int
    solved: int
    points: int
    reached: Extremes
    limits: Extremes
    short: tuple[Short, ...]

    @property
    def excess(self) -> Extremes:
        """By how much they are beyond the limits."""
        return self.reached.beyond(self.limits)


def report_corrected(
    clip: Clip,
    boundary: Boundary,
    limits: Extremes,
    variant: Variant | None = None,
    carried: Carried | None = None,
) -> CorrectedReport | None:
    """Measure the whole frames of a clip that are corrected; None where none is.

    Parameters
    ----------
    clip : Clip
    boundary : Boundary
        Of the figure's domain.
    limits : Extremes
        Of the keys and the bounds.
    variant : Variant, optional
        The figure's own by default.
    carried : callable, optional
        Where the figure hangs, at a frame.
    """
    ends = boundary.points[boundary.following]
    points = np.concatenate(
        [boundary.points, *(boundary.points * (1 - s) + ends * s for s in BETWEEN)]
    )
    animation = Animation(clip, variant, points=points, carried=carried)
    if animation.corrections is None:
        return None
    corrected, found, misses = 0, [], {}
    for frame in range(clip.frames.first, clip.frames.last + 1):
        correction = animation.corrections.at(frame)
        if correction is None:
            continue
        corrected += 1
        misses[frame] = correction.misses
        if correction.phi is not None:
            moved = animation.frame(frame)
            found.append(Extremes.measured(moved.fz, moved.fzbar))
    return CorrectedReport(
        frames=corrected,
        solved=len(found),
        points=len(points),
        reached=reduce(Extremes.joined, found, Extremes(0.0, 1.0, 1.0)),
        limits=limits,
        short=_short(clip, misses),
    )


def _short(clip: Clip, misses: Mapping[int, Mapping[int, float]]) -> tuple[Short, ...]:
    """Return the runs of frames in which handles fall short."""
    found = []
    for handle in clip.figure.handles:
        lags = {
            frame: miss[handle.id]
            for frame, miss in misses.items()
            if handle.id in miss and falls_short(clip.figure, miss[handle.id])
        }
        # Frames of one run are as far ahead of their number in it.
        for _, run in groupby(enumerate(lags), key=lambda each: each[1] - each[0]):
            frames = [frame for _, frame in run]
            lag = max(lags[frame] for frame in frames)
            found.append(Short(handle=handle.name, first=frames[0], last=frames[-1], lag=lag))
    return tuple(found)
