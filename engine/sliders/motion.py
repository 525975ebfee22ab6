"""Motions of a slider: weights as functions of time, for series (`engine.streaming`)."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from engine.arrays import Floats
from engine.sliders.pose_blend import PoseBlend


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class SliderMotion:
    """x and y of each point in turn, (2m,), at times in [0, 1].

    Where the curb begins or ends a motion bends in time, and its series has more pieces.

    Attributes
    ----------
    poses, probed : PoseBlend
        The same poses at all points, and at a few points spread over the domain.
    weights : callable
        From a time to the weights (q,) of the poses.
    tolerance : float
        Largest error that a series may have, in units of length.
    """

    poses: PoseBlend
    probed: PoseBlend
    weights: Callable[[float], Floats]
    tolerance: float

    def sample(self, time: float) -> Floats:
        """Compute the positions directly."""
        return self.poses.frame(self.weights(time)).positions.view(np.float64)

    def probe(self, times: Floats) -> Floats:
        """Return the positions of the few points at times (t,)."""
        frames = [self.probed.frame(self.weights(time)) for time in times.tolist()]
        return np.array([frame.positions for frame in frames]).view(np.float64)
