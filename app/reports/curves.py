"""Distortion over time at the worst points of a drawing, as the paper plots it (Section 8)."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple

import numpy as np

from app.document import Clip, DistortionRange, clip_segments, pose_segments
from app.motion import (
    AnyInbetweens,
    CorrectedFrames,
    MeshFrame,
    PoseSampler,
    apply_correction,
)
from app.storage import write_atomically
from engine.arrays import Floats
from engine.interpolation import Frame, Inbetweens
from engine.maps import distortion

POINTS = 100
TIMES = 24  # samples per segment


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Curves:
    """Distortion of an animation at its worst points."""

    clip: Clip
    frames: Floats  # float64 (t,)
    # float64 (t, p), at the points with the largest value over all time.
    k: Floats
    tau: Floats
    # float64 (t, p): the same as a share of the larger of the two adjacent keys. Bounded
    # in-betweens never exceed 1. τ is counted from 1, its undistorted value.
    k_share: Floats
    tau_share: Floats
    extremes: Floats  # float64 (t, 3) over all points: largest k and σ_a, smallest σ_b

    def extremes_at(self, frame: float) -> DistortionRange:
        """Return the extremes at a frame, interpolated between the measured frames."""
        cycle = self.clip.layer.cycle_at(frame)
        if cycle is not None and frame >= cycle.last:
            frame = cycle.source_frame(frame)
        elif frame < self.frames[0] and self.clip.loop:
            frame += self.clip.period
        return DistortionRange(
            *(float(np.interp(frame, self.frames, row)) for row in self.extremes.T)
        )


class CorrectedSample(NamedTuple):
    """Corrections of whole frames at the points of a sampler, by sliders, tracks and springs."""

    frames: CorrectedFrames
    sampler: PoseSampler

    def frame(
        self, clip: Clip, frame: int, between: AnyInbetweens, time: float
    ) -> Frame | MeshFrame:
        """Return the shown in-between at a whole frame, with its correction."""
        correction = self.frames.at(clip, frame)
        if correction is None or not isinstance(between, Inbetweens):
            return between.frame(time)
        return apply_correction(self.sampler, between, time, correction).frame(time)


def measure_curves(
    clip: Clip, inbetweens: Sequence[AnyInbetweens], corrected: CorrectedSample | None = None
) -> Curves:
    """Measure the distortion of a clip with at least two keys.

    `inbetweens` are those of its segments, at the measured points. With `corrected`, only whole
    frames are measured.
    """
    frames, ks, taus, extremes = [], [], [], []
    for span, segment, between in zip(
        clip_segments(clip), pose_segments(clip), inbetweens, strict=True
    ):
        for share in np.linspace(0.0, 1.0, TIMES):
            if corrected is not None:
                share = round(share * span.frames) / span.frames  # noqa: PLW2901
            t = segment.weight(clip.keys[span.first].easing(float(share)))
            frames.append(span.start + share * span.frames)
            if corrected is None:
                blended = between.frame(t)
            else:
                shown = round(frames[-1])
                shown -= clip.period if shown > clip.frames.last else 0
                blended = corrected.frame(clip, shown, between, t)
            ks.append(distortion.k(blended.fz, blended.fzbar))
            taus.append(distortion.tau(blended.fz, blended.fzbar))
            extremes.append(DistortionRange.measured(blended.fz, blended.fzbar))
    worst_k, worst_tau = worst_points(np.array(ks)), worst_points(np.array(taus))
    return Curves(
        clip=clip,
        frames=np.array(frames, dtype=np.float64),
        k=worst_k,
        tau=worst_tau,
        k_share=_shares(worst_k),
        tau_share=_shares(worst_tau - 1.0),
        extremes=np.array(extremes),
    )


def split_at_keys(curves: Curves, values: Floats) -> tuple[Floats, Floats]:
    """Return frames and values (t, p) of all points as one line, broken by NaN at each key."""
    intervals = len(curves.frames) // TIMES
    blocks = values.T.reshape(-1, intervals, TIMES)
    broken = np.concatenate([blocks, np.full((*blocks.shape[:2], 1), np.nan)], axis=2)
    frames = curves.frames.reshape(intervals, TIMES)
    frames = np.concatenate([frames, np.full((intervals, 1), np.nan)], axis=1)
    return np.tile(frames.ravel(), len(blocks)), broken.ravel()


def write_curves(path: Path, curves: Curves) -> None:
    """Write the curves as comma-separated values, one row for each time."""
    count = curves.k.shape[1]
    names = ["frame"]
    for name in ("k", "k_share"):
        names += [f"{name}_{point}" for point in range(count)]
    for name in ("tau", "tau_share"):
        names += [f"{name}_{point}" for point in range(count)]
    table = np.column_stack([curves.frames, curves.k, curves.k_share, curves.tau, curves.tau_share])
    rows = [",".join(names), *(",".join(f"{value:.9g}" for value in row) for row in table)]
    text = ("\n".join(rows) + "\n").encode()
    write_atomically(path, lambda file: file.write(text))


def worst_points(values: Floats) -> Floats:
    """Return the columns (t, p) of the points with the largest values at any time."""
    order = np.argsort(values.max(axis=0))[::-1][:POINTS]
    return values[:, order]


def divide_by_keys(values: Floats) -> Floats:
    """Return values (t, p) of a segment relative to the larger key value, 0 if that is 0.

    The linear scaling of Section 8: the curve of a point with an undistorted first key goes from 0
    to 1.
    """
    largest = np.maximum(values[0], values[-1])
    relative = np.zeros_like(values)
    np.divide(values, largest, out=relative, where=largest > 1e-9)
    return relative


def _shares(values: Floats) -> Floats:
    """Return values (t, p) of all segments, each relative to its own keys."""
    blocks = values.reshape(-1, TIMES, values.shape[1])
    return np.concatenate([divide_by_keys(block) for block in blocks])
