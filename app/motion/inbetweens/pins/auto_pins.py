"""In-betweens of a clip's segments with auto-pins."""

from functools import partial

import numpy as np

from app.document import (
    Clip,
    Layer,
    PinnedSegment,
    Variant,
    clip_segments,
    find_chains,
    find_limbs,
    ground_velocity_at,
    pinned_segments,
    pose_segments,
    with_stiffness,
)
from app.motion.inbetweens.content_cache import digest
from app.motion.inbetweens.outline_cache import SAMPLED, nbytes_or_0
from app.motion.inbetweens.pins.limb_motion import firmness_on_limbs, rigid_points, segment_bones
from app.motion.inbetweens.pose_sampler import PoseSampler
from app.motion.inbetweens.segment_keys import segment_key
from engine.arrays import Booleans, Complexes, Floats
from engine.deform.correction.corrector import PointCorrector, build_corrector
from engine.geometry import diameter
from engine.interpolation import (
    CorrectionSeries,
    Frame,
    Inbetweens,
    SegmentPins,
    solve_pins,
    solve_pins_at,
    value_points_for_corrections,
)
from engine.maps import Boundary

BESIDE = 0.03  # fraction of the diameter: closer to the anchor or a pinned handle, handles yield
FIRM = 0.01  # a handle with firmness above 1 minus this has firmness 1
# One-sided difference of fourth order. In-betweens are analytic in time between keys. Around holes
# they may jump at the key itself, which is not sampled.
STEP = 2e-3
FORWARD = (-77 / 12, 107 / 6, -39 / 2, 61 / 6, -25 / 12)
KEPT = 3  # cached segments: one, and both neighbours
SLOWEST = 1e-9  # speed below which a segment begins at rest


class AutoPins:
    """The auto-pins of a clip.

    `sampler` belongs to the layer's domain, at any points. Its cached data of the outline is used
    and extended.
    """

    def __init__(self, clip: Clip, variant: Variant, sampler: PoseSampler) -> None:
        self.clip, self._variant, self._known = clip, variant, sampler
        self._segments = pinned_segments(clip)
        self._prepared: tuple[PointCorrector, PoseSampler] | None = None
        self._looked_at: dict[
            int, Inbetweens
        ] = {}  # in the order of last use, at the sampler of the handles

    def inbetweens(self, number: int, sampler: PoseSampler) -> Inbetweens:
        """Return the in-betweens of a segment at the points of a sampler."""
        base = self._base(number, sampler)
        pins = self.series(number)
        return base if pins is None else base.with_correction(pins)

    def frame(self, number: int, sampler: PoseSampler, time: float) -> Frame:
        """Return a single in-between, for a variant that makes single frames."""
        segment, bounds = pose_segments(self.clip)[number], self.clip.layer.widest_bounds
        pins = self._correction_at(number, time)
        return sampler.frame_of(segment, bounds, self._variant, time, pins)

    def _correction_at(self, number: int, time: float) -> CorrectionSeries | None:
        """Return the correction of a segment at a time; None without pins."""
        segment = self._segments[number]
        if segment is None:
            return None
        key = segment_key(self.clip, number, self._variant)
        known = self._known.known.find_pins(key)
        if known is not None:
            return known
        corrector, sampler = self.prepare()
        pins, bounds = self._pins(number, segment, sampler), self.clip.layer.widest_bounds
        interval = sampler.segment_of(pose_segments(self.clip)[number], bounds, self._variant)
        return solve_pins_at(time, self._variant, interval, corrector, pins, bounds)

    def series(self, number: int) -> CorrectionSeries | None:
        """Return the corrections of a segment; None without pins."""
        segment = self._segments[number]
        if segment is None:
            return None
        key = segment_key(self.clip, number, self._variant)
        return self._known.known.pins_of(key, segment.poses, partial(self._solved, number, segment))

    def _base(self, number: int, sampler: PoseSampler) -> Inbetweens:
        bounds = self.clip.layer.widest_bounds
        return sampler.inbetweens_of(pose_segments(self.clip)[number], bounds, self._variant)

    def _solved(self, number: int, segment: PinnedSegment) -> CorrectionSeries:
        corrector, sampler = self.prepare()
        pins, bounds = self._pins(number, segment, sampler), self.clip.layer.widest_bounds
        return solve_pins(self._own_base(number), corrector, pins, bounds)

    def _own_base(self, number: int) -> Inbetweens:
        """Return a segment without pins at the handles; neighbour segments use it too."""
        base = self._looked_at.pop(number, None) or self._base(number, self.prepare()[1])
        self._looked_at[number] = base
        for oldest in list(self._looked_at)[:-KEPT]:
            del self._looked_at[oldest]
        return base

    def prepare(self) -> tuple[PointCorrector, PoseSampler]:
        """Return the corrector of the handles, and a sampler with the values that it needs."""
        if self._prepared is None:
            limbs = find_limbs(self.clip.layer)
            more = None if limbs is None else np.concatenate(rigid_points(limbs))
            self._prepared = prepare_corrector(self.clip.layer, self._known, more)
        return self._prepared

    def _pins(self, number: int, segment: PinnedSegment, sampler: PoseSampler) -> SegmentPins:
        """Return the targets of the handles during a segment."""
        clip, layer = self.clip, self.clip.layer
        own = clip_segments(clip)[number]
        keys = clip.keys[own.first], clip.keys[own.last]
        ends = [sampler.samples(key.pose).positions for key in keys]
        slopes = np.zeros((2, len(layer.handles)), dtype=np.complex128)
        for side, other in enumerate(segment.neighbours):
            pace = self._pace(number, side)
            if other is not None and SLOWEST < pace < np.inf:
                # Pixels per frame, opposite to the velocity of the motion that is pinned.
                away = self._velocity(other, 1 - side)[: len(layer.handles)]
                moving = ground_velocity_at(clip, other) * self._is_on_ground
                slopes[side] = (moving - self._pace(other, 1 - side) * away) / pace
        anchor, firmness = layer.anchor if layer.has_parent else None, self._firmness(segment)
        limbs, bones, count = find_limbs(layer), None, len(layer.handles)
        if limbs is not None:
            whole = pose_segments(clip)[number]
            places = [sampler.samples(key.pose).positions[count:] for key in whole.keys]
            weights = sampler.weights_of(whole, layer.widest_bounds, self._variant)
            bones = segment_bones(
                *(layer, limbs, keys, np.array(places), whole.revolutions, weights.unlimited)
            )
            firmness = firmness_on_limbs(layer, limbs, firmness, segment.is_pinned)
        return SegmentPins(
            is_pinned=segment.is_pinned,
            is_even=self._is_on_ground & (segment.ground_velocity != 0.0),
            ends=np.array(ends)[:, :count],
            slopes=np.where(segment.fading, slopes, 0.0),
            weights=segment.fading.astype(np.float64),
            firmness=firmness,
            is_anchored=anchor is not None,
            bones=bones,
        )

    def _pace(self, number: int, side: int) -> float:
        """Return the speed of a segment's in-between time at one end, per frame."""
        span, segment = clip_segments(self.clip)[number], pose_segments(self.clip)[number]
        easing = self.clip.keys[span.first].easing.end_speeds
        pace = segment.end_speeds[side] * easing[side] / span.frames
        return pace if np.isfinite(pace) else 0.0

    def _velocity(self, number: int, side: int) -> Complexes:
        """Return the velocity over the in-between time at a segment's first or second key."""
        base, sign = self._own_base(number), -1.0 if side else 1.0
        steps = [base.frame(side + sign * (i + 1) * STEP).positions for i in range(len(FORWARD))]
        weights = sign / STEP * np.array(FORWARD, dtype=np.complex128)
        velocity: Complexes = weights @ np.array(steps)
        return velocity

    @property
    def _is_on_ground(self) -> Booleans:
        """Whether each handle stands on the ground when pinned: the ends of limbs."""
        ends = {chain.end for chain in find_chains(self.clip.layer.bones)}
        return np.array([each.id in ends for each in self.clip.layer.handles], dtype=np.bool_)

    def _firmness(self, segment: PinnedSegment) -> Floats:
        """Return the firmness of each handle: 0 on a point of higher rank, 1 far from it.

        The anchor ranks above pinned handles, these above fading ones, and these above all others.
        Two close points with different targets would tear the drawing.
        """
        layer = self.clip.layer
        anchor = layer.anchor if layer.has_parent else None
        places = np.array([each.position for each in layer.handles], dtype=np.complex128)
        rank = 2 * segment.is_pinned + segment.fading.any(axis=0)
        apart = np.abs(places[:, None] - places)
        near = np.where(rank > rank[:, None], apart, np.inf).min(axis=1)
        if anchor is not None:
            near = np.minimum(near, np.abs(places - anchor))
        return firmness_at(near / diameter(layer.domain.outline))


def firmness_at(distances: Floats) -> Floats:
    """Return the firmness at distances, relative to the diameter, from points of higher rank."""
    far = -np.expm1(-((distances / BESIDE) ** 2))
    firmness: Floats = np.where(far > 1 - FIRM, 1.0, far)
    return firmness


def corrector_for(boundary: Boundary, anchor: complex, points: Complexes) -> PointCorrector:
    """Return the corrector of a domain's frames with targets for points (m,)."""
    content = digest(*boundary.loops, *boundary.span.cages, boundary.weights, points)
    make = partial(build_corrector, boundary, anchor, points)
    return SAMPLED.find(("corrector", content, anchor), make, nbytes_or_0)


def prepare_corrector(
    layer: Layer, sibling: PoseSampler, more: Complexes | None = None
) -> tuple[PointCorrector, PoseSampler]:
    """Return the corrector of a layer's handles, and a sampler with the values that it needs.

    The sibling has the same outline, cage and anchor. `more`, complex128 (p,), are further points
    to correct, after the handles.
    """
    sites = sibling.sites
    points = np.array([each.position for each in layer.handles], dtype=np.complex128)
    if more is not None:
        points = np.append(points, more)
    corrector = corrector_for(with_stiffness(layer, sites.boundary), sites.anchor, points)
    sampler = PoseSampler(
        layer,
        points=points,
        values_at=value_points_for_corrections(corrector),
        sibling=sibling,
    )
    return corrector, sampler
