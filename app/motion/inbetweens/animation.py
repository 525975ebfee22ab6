"""The motion of a clip at any frame, for exports, attachments and checks."""

from typing import Self

from app.document import Clip, Variant
from app.motion.inbetweens.frame_corrector import FrameCorrector, needs_correction
from app.motion.inbetweens.keyframe_motion import KeyframeMotion
from app.motion.inbetweens.pose_sampler import PoseSampler
from app.motion.inbetweens.slider_stage import apply_correction
from app.motion.inbetweens.spring_offsets import ParentMotion
from engine.arrays import Complexes
from engine.interpolation import Frame


class Animation:
    """The motion of a clip at a sampler's points, with sliders, tracks and springs.

    The variant is by default the layer's own, and the points, complex128 (m,), are the vertices of
    the domain's mesh. An earlier sampler is reused if it is for the layer on its own mesh.
    `carried` returns the rigid motion of the layer at a frame, for scene-space tracks, by default
    the identity.

    `base` is the motion with auto-pins and sliders, without tracks and springs.
    """

    def __init__(
        self,
        clip: Clip,
        variant: Variant | None = None,
        *,
        points: Complexes | None = None,
        sampler: PoseSampler | None = None,
        carried: ParentMotion | None = None,
    ) -> None:
        self.clip = clip
        self.variant: Variant = clip.layer.variant if variant is None else Variant(variant)
        if (
            sampler is None
            or sampler.domain is not clip.layer.domain
            or not sampler.is_for(clip.layer)
            or (points is not None and points is not sampler.sites.points)
        ):
            sampler = PoseSampler(clip.layer, points=points, sibling=sampler)
        self.sampler = sampler
        self.base = KeyframeMotion(clip, self.variant, sampler)
        self.carried = carried
        self._is_corrected = needs_correction(clip)
        self._corrections: FrameCorrector | None = None

    @property
    def corrections(self) -> FrameCorrector | None:
        """Corrections of the base motion; None without sliders, tracks and springs."""
        if self._corrections is None and self._is_corrected:
            self._corrections = FrameCorrector(self.clip, self.variant, self.sampler, self.carried)
        return self._corrections

    def at_points(self, points: Complexes) -> Self:
        """Return the same motion at other points (m,); corrections are computed once for both."""
        sampler = PoseSampler(self.clip.layer, points=points, sibling=self.sampler)
        other = type(self)(self.clip, self.variant, sampler=sampler, carried=self.carried)
        other._corrections = self.corrections  # noqa: SLF001 - its own
        return other

    def positions(self, frame: float) -> Complexes:
        """Return the positions (m,) at a frame, possibly fractional."""
        return self.frame(frame).positions

    def frame(self, frame: float) -> Frame:
        """Return positions and derivatives at a frame."""
        correction = None if self.corrections is None else self.corrections.correction_at(frame)
        if correction is None:
            return self.base.frame(frame)
        inbetweens, time = self.base.unslid_at(frame)
        found = apply_correction(self.sampler, inbetweens, time, correction)
        return found.frame(time)
