"""The motion of a clip from key to key, before handles go their own ways."""

from app.document import Clip, Variant, resting_pose, time_of
from app.motion.inbetweens.auto_pins import AutoPins
from app.motion.inbetweens.pose_sampler import PoseSampler
from engine.interpolation import Frame, Inbetweens

KEPT = 4  # intervals that stay prepared


class BaseMotion:
    """A clip's motion at the points of a sampler.

    Parameters
    ----------
    clip : Clip
    variant : Variant
    sampler : PoseSampler
        Of the figure's domain and anchor.

    Of intervals, those that were asked for last stay prepared: frames come one after the other.
    """

    def __init__(self, clip: Clip, variant: Variant, sampler: PoseSampler) -> None:
        self.clip = clip
        self.variant = variant
        self.sampler = sampler
        self._pins = AutoPins(clip, variant, sampler)
        sampler.keep_only({key.pose for key in clip.keys})
        # By their numbers, the latest last, with their bytes.
        self._prepared: dict[int, tuple[Inbetweens, int]] = {}

    @property
    def nbytes(self) -> int:
        """Bytes of what is prepared."""
        return sum(size for _, size in tuple(self._prepared.values()))

    def frame(self, frame: float) -> Frame:
        """Return positions and derivatives of the points at a frame."""
        moment = time_of(self.clip, frame)
        resting = resting_pose(self.clip, moment)
        if resting is None:
            return self.inbetweens(moment.interval).frame(moment.weight)
        positions = self.sampler.samples(resting).positions
        fz, fzbar = self.clip.figure.map_of(resting).derivatives(self.sampler.sites.points)
        return Frame(positions=positions, fz=fz, fzbar=fzbar, rho=None)

    def inbetweens(self, interval: int) -> Inbetweens:
        """Return the in-betweens of one of the clip's intervals."""
        known = self._prepared.pop(interval, None)
        if known is None:
            prepared = self._pins.inbetweens(interval, self.sampler)
            known = prepared, prepared.nbytes
        self._prepared[interval] = known
        for oldest in list(self._prepared)[:-KEPT]:
            self._prepared.pop(oldest, None)
        return known[0]
