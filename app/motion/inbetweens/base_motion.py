"""The closed-form motion of a clip from key to key, before anything is corrected."""

import numpy as np

from app.document import Clip, Variant, resting_pose, time_of, transits
from app.motion.inbetweens.pose_sampler import PoseSampler
from engine.arrays import Complexes
from engine.interpolation import Frame, Inbetweens

KEPT = 4  # intervals that stay prepared
# The one-sided difference of fourth order: in time, in-betweens are analytic from key to key.
STEP = 2e-3
FORWARD = (-25 / 12, 4.0, -3.0, 4 / 3, -1 / 4)


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
            transit, bounds = transits(self.clip)[interval], self.clip.figure.bounds
            prepared = self.sampler.inbetweens_of(transit, bounds, self.variant)
            known = prepared, prepared.nbytes
        self._prepared[interval] = known
        for oldest in list(self._prepared)[:-KEPT]:
            self._prepared.pop(oldest, None)
        return known[0]

    def velocity(self, interval: int, *, at_end: bool) -> Complexes:
        """Return how fast the points (m,) leave an interval's first key, or reach its second one.

        In pixels, over the time of the interval's in-betweens from 0 to 1.
        """
        inbetweens = self.inbetweens(interval)
        sign = -1.0 if at_end else 1.0
        steps = [inbetweens.frame(at_end + sign * i * STEP).positions for i in range(len(FORWARD))]
        weights = sign / STEP * np.array(FORWARD, dtype=np.complex128)
        velocity: Complexes = weights @ np.array(steps)
        return velocity
