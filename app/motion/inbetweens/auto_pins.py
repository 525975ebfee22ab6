"""In-betweens of a clip's segments, with the handles that stay between their keys."""

from functools import partial

import numpy as np

from app.document import (
    Clip,
    PinnedSegment,
    Variant,
    clip_segments,
    pinned_segments,
    pose_segments,
)
from app.motion.inbetweens.pose_sampler import PoseSampler, prepare_corrector
from app.motion.inbetweens.segment_keys import segment_key
from engine.arrays import Complexes, Floats
from engine.deform.correction import PointCorrector
from engine.geometry import diameter
from engine.interpolation import (
    CorrectionSeries,
    Frame,
    Inbetweens,
    SegmentPins,
    solve_pins,
)

BESIDE = 0.03  # of the diameter: nearer to an anchor or a handle that stays, handles give way
FIRM = 0.01  # of full firmness: a handle that lacks less is held fully
# The one-sided difference of fourth order: in time, in-betweens are analytic between keys. Around
# holes they may jump at the key itself, where nothing is looked at.
STEP = 2e-3
FORWARD = (-77 / 12, 107 / 6, -39 / 2, 61 / 6, -25 / 12)
KEPT = 3  # segments that stay prepared for pins: one, with those on both sides
SLOWEST = 1e-9  # pace below which a segment begins at rest


class AutoPins:
    """The auto-pins of a clip.

    Parameters
    ----------
    clip : Clip
    variant : Variant
    sampler : PoseSampler
        Of the layer's domain, at any points; what it knows of the outline is used, and kept there.
    """

    def __init__(self, clip: Clip, variant: Variant, sampler: PoseSampler) -> None:
        self.clip, self._variant, self._known = clip, variant, sampler
        self._segments = pinned_segments(clip)
        self._prepared: tuple[PointCorrector, PoseSampler] | None = None
        self._looked_at: dict[int, Inbetweens] = {}  # at its own sampler, the latest last

    def inbetweens(self, number: int, sampler: PoseSampler) -> Inbetweens:
        """Return the in-betweens of a segment at the points of a sampler."""
        base = self._base(number, sampler)
        pins = self.series(number)
        return base if pins is None else base.with_correction(pins)

    def frame(self, number: int, sampler: PoseSampler, time: float) -> Frame:
        """Return one of these; of a variant that makes single frames."""
        transit, bounds = pose_segments(self.clip)[number], self.clip.layer.bounds
        return sampler.frame_of(transit, bounds, self._variant, time, self.series(number))

    def series(self, number: int) -> CorrectionSeries | None:
        """Return the corrections of a segment; None where nothing is pinned."""
        segment = self._segments[number]
        if segment is None:
            return None
        key = segment_key(self.clip, number, self._variant)
        return self._known.known.pins_of(key, segment.poses, partial(self._solved, number, segment))

    def _base(self, number: int, sampler: PoseSampler) -> Inbetweens:
        bounds = self.clip.layer.bounds
        return sampler.inbetweens_of(pose_segments(self.clip)[number], bounds, self._variant)

    def _solved(self, number: int, segment: PinnedSegment) -> CorrectionSeries:
        corrector, sampler = self.prepare()
        pins, bounds = self._pins(number, segment, sampler), self.clip.layer.bounds
        return solve_pins(self._own_base(number), corrector, pins, bounds)

    def _own_base(self, number: int) -> Inbetweens:
        """Return a segment without pins at the sampler of these, which its neighbours ask for."""
        base = self._looked_at.pop(number, None) or self._base(number, self.prepare()[1])
        self._looked_at[number] = base
        for oldest in list(self._looked_at)[:-KEPT]:
            del self._looked_at[oldest]
        return base

    def prepare(self) -> tuple[PointCorrector, PoseSampler]:
        """Return what corrects the handles, and a sampler of these with the values it takes."""
        if self._prepared is None:
            self._prepared = prepare_corrector(self.clip.layer, self._known)
        return self._prepared

    def _pins(self, number: int, segment: PinnedSegment, sampler: PoseSampler) -> SegmentPins:
        """Return where the handles are wanted during a segment."""
        clip, layer = self.clip, self.clip.layer
        own = clip_segments(clip)[number]
        keys = [clip.keys[index] for index in (own.first, own.last)]
        ends = [sampler.samples(key.pose).positions for key in keys]
        slopes = np.zeros((2, len(layer.handles)), dtype=np.complex128)
        for side, other in enumerate(segment.neighbours):
            pace = self._pace(number, side)
            if other is not None and SLOWEST < pace < np.inf:
                # Pixels a frame there, against the velocity of the motion that has to stay.
                away = self._velocity(other, 1 - side)
                slopes[side] = -self._pace(other, 1 - side) * away / pace
        anchor = layer.anchor if layer.has_parent else None
        return SegmentPins(
            is_pinned=segment.is_pinned,
            ends=np.array(ends),
            slopes=np.where(segment.fading, slopes, 0.0),
            weights=segment.fading.astype(np.float64),
            firmness=self._firmness(segment, anchor),
            is_anchored=anchor is not None,
        )

    def _pace(self, number: int, side: int) -> float:
        """Return how fast the time of a segment's in-betweens runs at one of its ends, a frame."""
        span, transit = clip_segments(self.clip)[number], pose_segments(self.clip)[number]
        easing = self.clip.keys[span.first].easing.end_speeds
        pace = transit.end_speeds[side] * easing[side] / span.frames
        return pace if np.isfinite(pace) else 0.0

    def _velocity(self, number: int, side: int) -> Complexes:
        """Return how fast points leave a segment's first key, or reach its second one, by time."""
        base, sign = self._own_base(number), -1.0 if side else 1.0
        steps = [base.frame(side + sign * (i + 1) * STEP).positions for i in range(len(FORWARD))]
        weights = sign / STEP * np.array(FORWARD, dtype=np.complex128)
        velocity: Complexes = weights @ np.array(steps)
        return velocity

    def _firmness(self, segment: PinnedSegment, anchor: complex | None) -> Floats:
        """Return how firmly handles are held: 0 on what stays more than they do, 1 far from it.

        The anchor stays more than pinned handles, these more than fading ones, and the others give
        way to all: two points of one place that are wanted apart would tear the drawing.
        """
        layer = self.clip.layer
        places = np.array([each.position for each in layer.handles], dtype=np.complex128)
        rank = 2 * segment.is_pinned + segment.fading.any(axis=0)
        apart = np.abs(places[:, None] - places)
        near = np.where(rank > rank[:, None], apart, np.inf).min(axis=1)
        if anchor is not None:
            near = np.minimum(near, np.abs(places - anchor))
        return firmness_at(near / diameter(layer.domain.outline))


def firmness_at(distances: Floats) -> Floats:
    """Return how firmly handles are held at distances, over the diameter, from what stays more."""
    far = -np.expm1(-((distances / BESIDE) ** 2))
    firmness: Floats = np.where(far > 1 - FIRM, 1.0, far)
    return firmness
