"""The motion of a clip from key to key, with sliders, before tracks and springs."""

from collections.abc import Callable
from copy import copy

from app.document import Clip, Pose, Variant, keyed_pose_at, segment_time_at
from app.motion.inbetweens.pins.auto_pins import AutoPins
from app.motion.inbetweens.pose_sampler import PoseSampler
from app.motion.inbetweens.slider_stage import BaseAt, SliderStage
from engine.interpolation import Frame, Inbetweens
from engine.sliders import SliderFrame

KEPT = 4  # segments that stay prepared


class KeyframeMotion:
    """The motion of a clip at a sampler's points.

    The sampler belongs to the layer's domain and anchor, the pins to the same clip and variant. The
    last used segments stay prepared, since frames are usually requested in order.
    """

    def __init__(
        self,
        clip: Clip,
        variant: Variant,
        sampler: PoseSampler,
        pins: AutoPins | None = None,
    ) -> None:
        self.clip = clip
        self.variant = variant
        self.sampler = sampler
        self._pins = pins = pins or AutoPins(clip, variant, sampler)
        self.sliders: SliderStage | None = None
        if clip.sliders and clip.baseline is None:

            def base_at(beside: PoseSampler) -> BaseAt:
                return KeyframeMotion(clip, variant, beside, pins).unslid_at

            self.sliders = SliderStage(clip, variant, sampler, base_at)
        used = set() if self.sliders is None else set(self.sliders.poses)
        sampler.keep_only(used | {key.pose for key in clip.keys})
        # By number, in the order of last use, with sizes in bytes.
        self._prepared: dict[int | Pose, tuple[Inbetweens, int]] = {}

    def with_sliders(self, clip: Clip) -> "KeyframeMotion":
        """Return the motion of a clip that differs only in values of sliders."""
        changed = copy(self)
        changed.clip = clip
        changed.sliders = None if self.sliders is None else self.sliders.with_values(clip)
        return changed

    @property
    def nbytes(self) -> int:
        """Bytes of the prepared segments."""
        return sum(size for _, size in tuple(self._prepared.values()))

    def frame(self, frame: float) -> Frame:
        """Return positions and derivatives at a frame."""
        moment = segment_time_at(self.clip, frame)
        resting = keyed_pose_at(self.clip, moment)
        if resting is None or self.sliders is not None:
            inbetweens, time = self.segment_at(frame)
            return inbetweens.frame(time)
        positions = self.sampler.samples(resting).positions
        fz, fzbar = self.clip.layer.map_of(resting).derivatives(self.sampler.sites.points)
        return Frame(positions=positions, fz=fz, fzbar=fzbar, rho=None)

    def segment_at(self, frame: float) -> tuple[Inbetweens | SliderFrame, float]:
        """Return the in-betweens around a frame, and its time among them.

        With sliders, only this frame among them. Both can be corrected.
        """
        inbetweens, time = self.unslid_at(frame)
        if self.sliders is None:
            return inbetweens, time
        return self.sliders.frame(inbetweens, time, frame), time

    def unslid_at(self, frame: float) -> tuple[Inbetweens, float]:
        """Return the in-betweens around a frame without sliders, and its time among them.

        At a key they are in-betweens of its pose with itself, which can be corrected like all
        others.
        """
        moment = segment_time_at(self.clip, frame)
        resting = keyed_pose_at(self.clip, moment)
        if resting is None:
            return self.inbetweens(moment.segment), moment.weight
        return self._kept(
            resting, lambda: self.sampler.still_inbetweens(resting, self.variant)
        ), 0.0

    def inbetweens(self, interval: int) -> Inbetweens:
        """Return the in-betweens of a segment without sliders."""
        return self._kept(interval, lambda: self._pins.inbetweens(interval, self.sampler))

    def _kept(self, key: int | Pose, prepare: Callable[[], Inbetweens]) -> Inbetweens:
        known = self._prepared.pop(key, None)
        if known is None:
            prepared = prepare()
            known = prepared, prepared.nbytes
        self._prepared[key] = known
        for oldest in list(self._prepared)[:-KEPT]:
            self._prepared.pop(oldest, None)
        return known[0]
