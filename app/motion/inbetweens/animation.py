"""A clip's motion at any frame: the one way to it for exports, joints and checks."""

from app.document import Clip, Variant
from app.motion.inbetweens.frame_corrector import FrameCorrector, needs_correction
from app.motion.inbetweens.keyframe_motion import KeyframeMotion
from app.motion.inbetweens.pose_sampler import PoseSampler
from app.motion.inbetweens.spring_offsets import ParentMotion
from engine.arrays import Complexes
from engine.interpolation import Frame


class Animation:
    """A clip's motion at the points of a sampler: from key to key, and as handles stay and go.

    Parameters
    ----------
    variant : str, optional
        The layer's own by default.
    points : complex128, shape (m,), optional
        By default the vertices of the domain's mesh.
    sampler : PoseSampler, optional
        An earlier animation's; it is used again if its domain and anchor are the layer's: poses
        that it has sampled are not sampled again.

    Attributes
    ----------
    base : KeyframeMotion
        The motion from key to key, with handles that stay, and without tracks and springs.
    carried : callable, optional
        Where the layer hangs, at a frame, for what is planted in the scene; by itself without.
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
            or sampler.anchor != clip.layer.anchor
            or (points is not None and points is not sampler.sites.points)
        ):
            sampler = PoseSampler(clip.layer.domain, anchor=clip.layer.anchor, points=points)
        self.sampler = sampler
        self.base = KeyframeMotion(clip, self.variant, sampler)
        self.carried = carried
        self._is_corrected = needs_correction(clip)
        self._corrections: FrameCorrector | None = None

    @property
    def corrections(self) -> FrameCorrector | None:
        """What is added to the base motion; None where nothing ever is."""
        if self._corrections is None and self._is_corrected:
            self._corrections = FrameCorrector(self.clip, self.variant, self.sampler, self.carried)
        return self._corrections

    def positions(self, frame: float) -> Complexes:
        """Return where the points (m,) are at a frame, which may lie between two numbers."""
        return self.frame(frame).positions

    def frame(self, frame: float) -> Frame:
        """Return positions and derivatives of the points at a frame."""
        correction = None if self.corrections is None else self.corrections.correction_at(frame)
        if correction is None:
            return self.base.frame(frame)
        inbetweens, time = self.base.segment_at(frame)
        return inbetweens.with_correction(correction.series, self.sampler.basis).frame(time)
