"""Frames that sliders, tracks and springs change: their distortion and their target errors."""

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
    slider_weights_at,
)
from app.motion import Animation, ParentMotion
from app.reports.acting_frames import acting_frames
from engine.interpolation import prove
from engine.maps import Boundary

NOTHING = DistortionRange(0.0, 1.0, 1.0)
MOST_LOOKED_AT: Final = 1_000  # frames; up to so many are all examined
SPREAD: Final = 150  # examined frames of more
MOST_DRIVEN: Final = 8_000  # frames whose motion is computed, since springs follow it
BETWEEN = (0.25, 0.5, 0.75)  # of each outline segment: measured points beside its ends


@dataclass(frozen=True, slots=True, kw_only=True)
class Short:
    """A run of frames in which a handle does not reach its track's target."""

    handle: str
    first: int
    last: int
    lag: float  # largest target error, in pixels


@dataclass(frozen=True, slots=True, kw_only=True)
class CorrectedReport:
    """The frames of a clip that sliders, tracks and springs change.

    Parameters
    ----------
    frames : int
        Number of examined corrected frames, with repeats.
    proven : int
        Number of frames proven over all of the domain; the others are measured.
    points : int
        Number of measured points on the outline.
    reached : DistortionRange
        Proven values of proven frames, measured values of the others.
    between : DistortionRange
        Measured halfway between frames.
    limits : DistortionRange
        The layer's limits, or larger values of its keys.
    short : tuple of Short
        The unreachable targets.
    looked_at, left_out : int
        Frames at which they act, repeats counted once: examined ones at equal steps,
        and the rest.
    slid : int
        Number of examined frames with sliders. They keep the layer's limits by construction, and
        are measured, not proven.
    curbed : float
        Largest change of ln |f_z| that keeps sliders within the limits.
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
    slid: int
    curbed: float

    @property
    def excess(self) -> DistortionRange:
        """Values beyond the limits, at frames or between them."""
        return self.reached.joined(self.between).beyond(self.limits)


def report_corrected(
    clip: Clip,
    boundary: Boundary,
    limits: DistortionRange,
    variant: Variant | None = None,
    carried: ParentMotion | None = None,
) -> CorrectedReport | None:
    """Prove or measure the corrected whole frames of a clip; None if there are none.

    Parameters
    ----------
    boundary : Boundary
        Of the layer's domain.
    limits : DistortionRange
        Of the keys and the layer.
    variant : Variant, optional
        The layer's own by default.
    carried : callable, optional
        Motion of the layer's parent, by frame.
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
    # Equal frames are examined once.
    same = {
        frame: (
            id(found[frame].series),
            slider_weights_at(clip, frame),
            segment_time_at(clip, frame),
        )
        for frame in found
    }
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
        slid=sum(repeats[frame] for frame, each in found.items() if each.sliders is not None),
        curbed=max(
            (each.sliders.solution.curbed for each in found.values() if each.sliders), default=0.0
        ),
    )


def _step(count: int, run_up: int) -> int:
    """Return the step between examined frames that keeps the time of computation bounded."""
    if count <= MOST_LOOKED_AT:
        return 1
    # Springs need `run_up` further frames before each examined frame.
    return -(-count // max(min(SPREAD, MOST_DRIVEN // (run_up + 1)), 1))


def _proven(animation: Animation, frame: int) -> DistortionRange | None:
    """Return the proof of a corrected frame; None if there is no proof against folding."""
    corrections = animation.corrections
    correction = None if corrections is None else corrections.correction_at(frame)
    if correction is None or correction.series is None or correction.sliders is not None:
        return None
    inbetweens, time = animation.base.unslid_at(frame)
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
    """Return the runs of examined frames, `step` apart, in which handles miss their targets."""
    found = []
    for handle in clip.layer.handles:
        lags = {
            frame: miss[handle.id]
            for frame, miss in misses.items()
            if handle.id in miss and misses_target(clip.layer, miss[handle.id])
        }
        # In one run, frame minus step times index is constant.
        for _, run in groupby(enumerate(lags), key=lambda each: each[1] - step * each[0]):
            frames = [frame for _, frame in run]
            lag = max(lags[frame] for frame in frames)
            found.append(Short(handle=handle.name, first=frames[0], last=frames[-1], lag=lag))
    return tuple(found)
