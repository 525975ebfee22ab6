"""Frames that tracks and springs change: how far they distort, and what handles miss."""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import reduce
from itertools import groupby
from typing import Final

import numpy as np

from app.document import (
    Clip,
    DistortionRange,
    Variant,
    misses_target,
    segment_time_at,
)
from app.motion import Animation, ParentMotion
from app.reports.acting_frames import acting_frames
from engine.interpolation import prove
from engine.maps import Boundary

NOTHING = DistortionRange(0.0, 1.0, 1.0)
MOST_LOOKED_AT: Final = 1_000  # frames; up to so many are all looked at
SPREAD: Final = 150  # frames that are looked at of more
MOST_DRIVEN: Final = 8_000  # frames whose motion is worked out, since springs follow it
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
    """The frames of a clip that tracks and springs change.

    Parameters
    ----------
    frames : int
        How many, of those that were looked at and their repeats.
    proven : int
        How many of them are proven, over all of the domain; the others are measured.
    points : int
        On the outline, at which frames are measured.
    reached : DistortionRange
        Of all of them: what is proven of those that are, what is measured of the others.
    between : DistortionRange
        What is measured halfway between frames.
    limits : DistortionRange
        What they are to keep: the layer's bounds, or what its keys have beyond them.
    short : tuple of Short
        What is out of reach.
    looked_at, left_out : int
        Frames at which tracks and springs act, with repeats once: those that were looked at, at
        equal steps, and those that were not.
    """

    frames: int
    proven: int
    points: int
    reached: DistortionRange
    between: DistortionRange
    limits: DistortionRange
    short: tuple[Short, ...]
    looked_at: int
    left_out: int

    @property
    def excess(self) -> DistortionRange:
        """By how much they, or what is between them, are beyond the limits."""
        return self.reached.joined(self.between).beyond(self.limits)


def report_corrected(
    clip: Clip,
    boundary: Boundary,
    limits: DistortionRange,
    variant: Variant | None = None,
    carried: ParentMotion | None = None,
) -> CorrectedReport | None:
    """Prove or measure the whole frames of a clip that are corrected; None where none is.

    Parameters
    ----------
    clip : Clip
    boundary : Boundary
        Of the layer's domain.
    limits : DistortionRange
        Of the keys and the bounds.
    variant : Variant, optional
        The layer's own by default.
    carried : callable, optional
        Where the layer hangs, at a frame.
    """
    ends = boundary.points[boundary.next_samples]
    points = np.concatenate(
        [boundary.points, *(boundary.points * (1 - s) + ends * s for s in BETWEEN)]
    )
    animation = Animation(clip, variant, points=points, carried=carried)
    if animation.corrections is None:
        return None
    acting, counts = acting_frames(clip, is_carried=carried is not None)
    step = _step(len(acting), animation.corrections.run_up)
    looked_at = acting[::step].tolist()
    corrections = {frame: animation.corrections.correction_at(frame) for frame in looked_at}
    found = {frame: each for frame, each in corrections.items() if each is not None}
    repeats = dict(zip(looked_at, counts[::step].tolist(), strict=True))
    # Those that come to the very same are looked at once.
    same = {frame: (id(found[frame]), segment_time_at(clip, frame)) for frame in found}
    once = {each: frame for frame, each in reversed(same.items())}
    proofs = {at: _proven(animation, frame) for at, frame in once.items()}
    reached = [
        _measured(animation, once[at]) if proof is None else proof for at, proof in proofs.items()
    ]
    between = [frame + 0.5 for frame in once.values() if frame < clip.frames.last]
    return CorrectedReport(
        frames=sum(repeats[frame] for frame in found),
        proven=sum(repeats[frame] for frame, at in same.items() if proofs[at] is not None),
        points=len(points),
        reached=reduce(DistortionRange.joined, reached, NOTHING),
        between=reduce(
            DistortionRange.joined, (_measured(animation, at) for at in between), NOTHING
        ),
        limits=limits,
        short=_short(clip, step, {frame: each.target_errors for frame, each in found.items()}),
        looked_at=len(looked_at),
        left_out=len(acting) - len(looked_at),
    )


def _step(count: int, run_up: int) -> int:
    """Return by how many of a number of frames to go on, so that there is time to look at them."""
    if count <= MOST_LOOKED_AT:
        return 1
    # Each takes as many more as springs need before it.
    return -(-count // max(min(SPREAD, MOST_DRIVEN // (run_up + 1)), 1))


def _proven(animation: Animation, frame: int) -> DistortionRange | None:
    """Return the proof of a corrected frame; None if nothing is proven of it."""
    corrections = animation.corrections
    correction = None if corrections is None else corrections.correction_at(frame)
    if correction is None:
        return None
    inbetweens, time = animation.base.segment_at(frame)
    proof = prove(inbetweens.with_correction(correction.series, animation.sampler.basis), time)
    return (
        DistortionRange(proof.k, proof.sigma_a, proof.sigma_b)
        if proof.is_locally_injective
        else None
    )


def _measured(animation: Animation, at: float) -> DistortionRange:
    frame = animation.frame(at)
    return DistortionRange.measured(frame.fz, frame.fzbar)


def _short(clip: Clip, step: int, misses: Mapping[int, Mapping[int, float]]) -> tuple[Short, ...]:
    """Return the runs of frames, looked at by steps, in which handles fall short."""
    found = []
    for handle in clip.layer.handles:
        lags = {
            frame: miss[handle.id]
            for frame, miss in misses.items()
            if handle.id in miss and misses_target(clip.layer, miss[handle.id])
        }
        # Frames of one run are as many steps ahead of their number in it.
        for _, run in groupby(enumerate(lags), key=lambda each: each[1] - step * each[0]):
            frames = [frame for _, frame in run]
            lag = max(lags[frame] for frame in frames)
            found.append(Short(handle=handle.name, first=frames[0], last=frames[-1], lag=lag))
    return tuple(found)
