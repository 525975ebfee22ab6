"""The motion of a clip from key to key, before tracks and springs."""

from collections.abc import Callable

from app.document import Clip, Pose, Variant, keyed_pose_at, segment_time_at
from app.motion.inbetweens.auto_pins import AutoPins
from app.motion.inbetweens.pose_sampler import PoseSampler
from engine.interpolation import Frame, Inbetweens

KEPT = 4  # segments that stay prepared


class KeyframeMotion:
    """The motion of a clip at a sampler's points.

    The sampler belongs to the layer's domain and anchor, the pins to the same clip and variant. The
    last used segments stay prepared, since frames are usually requested in order.
    """

    def __init__(
        self, clip: Clip, variant: Variant, sampler: PoseSampler, pins: AutoPins | None = None
    ) -> None:
        self.clip = clip
        self.variant = variant
        self.sampler = sampler
        self._pins = pins or AutoPins(clip, variant, sampler)
        sampler.keep_only({key.pose for key in clip.keys})
        # By number, in the order of last use, with sizes in bytes.
        self._prepared: dict[int | Pose, tuple[Inbetweens, int]] = {}

    @property
    def nbytes(self) -> int:
        """Bytes of the prepared segments."""
        return sum(size for _, size in tuple(self._prepared.values()))

    def frame(self, frame: float) -> Frame:
        """Return positions and derivatives at a frame."""
        moment = segment_time_at(self.clip, frame)
        resting = keyed_pose_at(self.clip, moment)
        if resting is None:
            return self.inbetweens(moment.segment).frame(moment.weight)
        positions = self.sampler.samples(resting).positions
        fz, fzbar = self.clip.layer.map_of(resting).derivatives(self.sampler.sites.points)
        return Frame(positions=positions, fz=fz, fzbar=fzbar, rho=None)

    def segment_at(self, frame: float) -> tuple[Inbetweens, float]:
        """Return the in-betweens around a frame, and its time among them.

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
        """Return the in-betweens of a segment."""
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
