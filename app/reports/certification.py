"""The distortion of an animation: certificates of its keyframes and of its in-betweens."""

from collections.abc import Iterable
from dataclasses import dataclass
from enum import StrEnum
from functools import reduce

import numpy as np

from app.document import (
    HOLD,
    Clip,
    Cycle,
    DistortionRange,
    Document,
    PoseSegment,
    Variant,
    clip_of,
    clip_segments,
    pose_segments,
)
from app.motion import Animation, ParentMotion, find_parent_motion
from app.reports.corrected_frames import CorrectedReport, report_corrected
from engine.arrays import Floats
from engine.interpolation import Inbetweens, Proof, prove
from engine.maps import Boundary, Certificate, certify

TIMES = 65  # samples of the in-betweens in each segment
CLOSER = 15  # further samples between the neighbours of each worst one
# Tolerance beyond the limits: absolute for k, relative for σ_a and σ_b. Enclosures are wider than
# the enclosed values by as much.
BEYOND = 0.002


class Verdict(StrEnum):
    """The result for all moments of a segment or of an animation, the best first.

    PROVEN: within the limits. MEASURED: within the limits by measurement, and proven not to fold.
    OVER: beyond the limits, or not proven not to fold.
    """

    PROVEN = "proven"
    MEASURED = "measured"
    OVER = "over"

    @staticmethod
    def worst(verdicts: Iterable["Verdict"]) -> "Verdict":
        """Return the worst verdict; the best one if there are none."""
        return max(verdicts, key=list(Verdict).index, default=Verdict.PROVEN)


@dataclass(frozen=True, slots=True, kw_only=True)
class SegmentReport:
    """The distortion of the in-betweens of one segment, and of its two keys.

    `limits` are the keys' own distortion. With auto-pins or a smooth tangent they are the layer's
    limits, or larger values of the keys around. `proof` encloses the in-betweens at all times.
    `unsettled` are the frames without a proof against folding, `loose` other frames with a less
    tight proof.
    """

    first: int
    last: int
    reached: DistortionRange
    keys: DistortionRange
    correction: float
    limits: DistortionRange
    proof: Proof
    unsettled: tuple[int, ...]
    loose: tuple[int, ...]

    @property
    def excess(self) -> DistortionRange:
        """Proven values beyond the limits."""
        return self._proven.beyond(self.limits)

    @property
    def may_fold(self) -> bool:
        """Whether some in-between folds, or is not proven not to."""
        return not self.proof.is_locally_injective

    @property
    def error(self) -> DistortionRange:
        """Upper bound of the true extremes minus the measured ones, from the proof."""
        return self._proven.beyond(self.reached)

    @property
    def _proven(self) -> DistortionRange:
        return DistortionRange(self.proof.k, self.proof.sigma_a, self.proof.sigma_b)

    @property
    def verdict(self) -> Verdict:
        if self.may_fold or not self.is_within:
            return Verdict.OVER
        return Verdict.PROVEN if _are_within(self._proven, self.limits) else Verdict.MEASURED

    @property
    def is_within(self) -> bool:
        """Whether the measured in-betweens keep the limits."""
        return _are_within(self.reached, self.limits)


@dataclass(frozen=True, slots=True, kw_only=True)
class Report:
    """The segments of a document, and certificates of its keyframes against its limits."""

    keys: tuple[tuple[int, Certificate], ...]
    segments: tuple[SegmentReport, ...]
    corrected: CorrectedReport | None = None
    cycles: tuple[Cycle, ...] = ()  # the segments stand for all repeats of these

    @property
    def verdict(self) -> Verdict:
        """The worst verdict of segments and corrected frames; OVER with an uncertified keyframe."""
        if not all(certificate.is_certified for _, certificate in self.keys):
            return Verdict.OVER
        return Verdict.worst([*(each.verdict for each in self.segments), self.corrected_verdict])

    @property
    def reached(self) -> DistortionRange:
        """The worst distortion: proven at keys, measured in segments and corrected frames."""
        found = [DistortionRange(own.k, own.sigma_a, own.sigma_b) for _, own in self.keys]
        found += [each.reached for each in self.segments]
        if self.corrected is not None and self.corrected.frames:
            found += [self.corrected.reached, self.corrected.between]
        return reduce(DistortionRange.joined, found)

    @property
    def corrected_verdict(self) -> Verdict:
        corrected = self.corrected
        if corrected is None or not (corrected.frames or corrected.left_out):
            return Verdict.PROVEN
        if not _are_within(corrected.reached.joined(corrected.between), corrected.limits):
            return Verdict.OVER
        is_proven = corrected.proven == corrected.frames and not corrected.left_out
        return Verdict.PROVEN if is_proven else Verdict.MEASURED


def _are_within(reached: DistortionRange, limits: DistortionRange) -> bool:
    """Return whether extremes keep the limits; all quantities have the same tolerance."""
    return (
        reached.k <= limits.k + BEYOND
        and reached.sigma_a <= limits.sigma_a * (1 + BEYOND)
        and reached.sigma_b >= limits.sigma_b * (1 - BEYOND)
    )


def certify_document(document: Document, variant: Variant | None = None) -> dict[str, Report]:
    """Return the reports of the posed layers by name."""
    return {
        layer.name: certify_clip(
            clip_of(document, layer.id), variant, find_parent_motion(document, layer.id)
        )
        for layer in document.layers
        if not layer.still
    }


def certify_clip(
    clip: Clip, variant: Variant | None = None, carried: ParentMotion | None = None
) -> Report:
    """Prove and measure the distortion of a layer over time and space.

    |ν| and log σ_a are subharmonic, so that the worst distortion of every in-between is on the
    outline. It is measured at graded samples, some hundred per edge, the same for keys and
    in-betweens. The proof covers all points and times, and concerns the in-betweens as defined,
    with auto-pins. The measurement concerns the computed in-betweens.

    Frames in which tracks and springs move handles are solved and proven one by one. Between two of
    these frames the distortion is measured.

    By default the variant is the layer's own. `carried` gives the parent's motion by frame.
    """
    layer, domain = clip.layer, clip.layer.domain
    boundary = Boundary.sample(domain)
    keys = tuple(
        (key.frame, certify(clip.layer.map_of(key.pose), boundary, clip.layer.widest_bounds))
        for key in clip.keys
    )
    animation = Animation(clip, variant, points=boundary.points)
    reports = tuple(
        _segment_report(clip, animation, boundary, number, segment)
        for number, segment in enumerate(pose_segments(clip))
    )
    every = [each.limits for each in reports]
    every += [DistortionRange(own.k, own.sigma_a, own.sigma_b) for _, own in keys]
    bounds = DistortionRange(
        layer.widest_bounds.k, layer.widest_bounds.sigma_a, layer.widest_bounds.sigma_b
    )
    limits = reduce(DistortionRange.joined, every, bounds)
    corrected = report_corrected(clip, boundary, limits, variant, carried)
    return Report(keys=keys, segments=reports, corrected=corrected, cycles=layer.cycles)


def _segment_report(
    clip: Clip, animation: Animation, boundary: Boundary, number: int, segment: PoseSegment
) -> SegmentReport:
    layer, span = clip.layer, clip_segments(clip)[number]
    start, end, last = clip.keys[span.first], clip.keys[span.last], span.start + span.frames
    # A key with hold easing is shown until the next key.
    held = start.easing == HOLD
    ends = [
        DistortionRange.measured(*layer.map_of(key.pose).derivatives(boundary.points))
        for key in ((start, start) if held else (start, end, *segment.keys))
    ]
    bound = ends[0].joined(ends[1])
    inbetweens = (
        animation.sampler.inbetweens(start.pose, start.pose, animation.variant)
        if held
        else animation.base.inbetweens(number)
    )
    limits = bound
    if segment.has_smooth_tangent or inbetweens.corrections:
        bounds = layer.widest_bounds
        limits = reduce(
            DistortionRange.joined, ends, DistortionRange(bounds.k, bounds.sigma_a, bounds.sigma_b)
        )
    proof = prove(inbetweens)
    return SegmentReport(
        first=span.start,
        last=last if last <= clip.frames.last else end.frame,
        reached=bound.joined(_measured(inbetweens)),
        keys=bound,
        correction=inbetweens.correction,
        limits=limits,
        proof=proof,
        unsettled=_frames(clip, number, proof.unproven_times),
        loose=_frames(clip, number, proof.not_tight),
    )


def _measured(inbetweens: Inbetweens) -> DistortionRange:
    """Return the extremes over time: at equal steps, then more closely around each worst one."""

    def at(times: Floats) -> list[DistortionRange]:
        frames = (inbetweens.frame(float(t)) for t in times)
        return [DistortionRange.measured(frame.fz, frame.fzbar) for frame in frames]

    times = np.linspace(0.0, 1.0, TIMES)[1:-1]
    found = at(times)
    step = times[1] - times[0]
    worst = {
        float(times[int(np.argmax([sign * value for value in values]))])
        for sign, values in zip((1, 1, -1), zip(*found, strict=True), strict=True)
    }
    for time in worst:
        found += at(np.linspace(time - step, time + step, CLOSER + 2)[1:-1])
    return reduce(DistortionRange.joined, found)


def _frames(clip: Clip, number: int, ranges: tuple[tuple[float, float], ...]) -> tuple[int, ...]:
    """Return the frames of a segment nearest to these ranges of its time in [0, 1]."""
    span, segment = clip_segments(clip)[number], pose_segments(clip)[number]
    start, end = span.start, span.start + span.frames
    found = []
    for frame in range(start, end + 1) if ranges else ():
        ends = (span.share(max(frame - 0.5, start)), span.share(min(frame + 0.5, end)))
        since, until = (segment.weight(clip.keys[span.first].easing(share)) for share in ends)
        if any(first <= until and last >= since for first, last in ranges):
            found.append(frame)
    return tuple(found)
