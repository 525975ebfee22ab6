"""Handles that two neighbouring keys have at one place stay there in between: what that asks.

In a span, from one key to the next in h frames, with τ from 0 to 1, a handle has in the base
motion the place b and reaches p₀ and p₁ at the keys. Still ones are to go from p₀ to p₁ as
3τ² − 2τ³ does; what they lack is o = p − b. Where a handle is still on one side of a key and moves
on the other, its velocity is that of the still side: in the span where it moves it lacks
h (ȯ₀ τ(1−τ)² − ȯ₁ τ²(1−τ)), with ȯ = minus the base's velocity on the still side, and what it lacks
counts with a weight that fades, (1−τ)³ and τ³.
"""

from typing import NamedTuple

import numpy as np

from app.document import (
    HOLD,
    Clip,
    Moment,
    passings_of,
    place_at,
    spans,
    time_of,
    transits,
)
from app.motion.inbetweens.base_motion import BaseMotion
from engine.arrays import Booleans, Complexes, Floats

SAME = 0.5  # pixels between two targets that are at one place
RARELY = 1e-12  # a weight below it is none


class Lack(NamedTuple):
    """What handles lack in a frame.

    Parameters
    ----------
    offsets : complex128, shape (h,)
        From where the base has them to where they should be, in pixels.
    weights : float64, shape (h,)
        How much each counts, from 0 to 1.
    """

    offsets: Complexes
    weights: Floats


def still_handles(clip: Clip) -> Booleans:
    """Return which handles (k, h) are still in which of the clip's spans."""
    figure, keys = clip.figure, clip.keys
    following = {spring.handle for spring in figure.springs if spring.enabled}
    still = np.zeros((len(spans(clip)), len(figure.handles)), dtype=bool)
    if not figure.stillness or clip.baseline is not None:
        return still
    for number, span in enumerate(spans(clip)):
        one, other = keys[span.first], keys[span.last]
        # A whole turn between equal targets is meant: it would be unwound.
        if one.easing == HOLD or one.turns:
            continue
        for index, handle in enumerate(figure.handles):
            if handle.free or handle.id in following:
                continue
            places = (key.pose.targets[handle.id].position for key in (one, other))
            still[number, index] = handle.locked or abs(next(places) - next(places)) < SAME
    return still


class Stillness:
    """What the stillness of handles asks of each frame of a clip.

    Parameters
    ----------
    motion : BaseMotion
        At points of which the handles are a part.
    places : slice
        Which of them are the handles.
    """

    def __init__(self, motion: BaseMotion, places: slice) -> None:
        clip = motion.clip
        self._clip = clip
        self._spans = spans(clip)
        self._still = still_handles(clip)
        shape = (len(self._spans), 2, self._still.shape[1])
        self._ends = np.zeros(shape, dtype=np.complex128)
        velocities = np.zeros(shape, dtype=np.complex128)
        for number, span in enumerate(self._spans):
            if not self._still[number].any():
                continue
            paces = transits(clip)[number].paces
            easing = clip.keys[span.first].easing.paces
            for side, key in enumerate((span.first, span.last)):
                samples = motion.sampler.samples(clip.keys[key].pose)
                self._ends[number, side] = samples.positions[places]
                pace = paces[side] * easing[side] / span.frames
                if pace and np.isfinite(pace):
                    speed = motion.velocity(number, at_end=side == 1)[places]
                    velocities[number, side] = pace * speed
        self._weights = np.zeros(shape)
        self._slopes = np.zeros(shape, dtype=np.complex128)
        for number, (at_start, at_end) in enumerate(passings_of(clip)):
            for side, other in enumerate((at_start.before, at_end.after)):
                if other is not None:
                    there, here = self._still[other], self._still[number]
                    self._weights[number, side] = there & ~here
                    slope = -velocities[other, 1 - side]
                    self._slopes[number, side] = np.where(there & ~here, slope, 0.0)

    def lack(self, frame: float, places: Complexes) -> Lack | None:
        """Return what the handles, which the base has at these places (h,), lack at a frame.

        At keys that is nothing, with the weights of both sides. None where nothing is ever asked.
        """
        moment = time_of(self._clip, frame)
        if not self._spans or not (
            self._still[moment.interval].any() or self._weights[moment.interval].any()
        ):
            return None
        _, span, share = place_at(self._clip, frame)
        if moment.weight in (0.0, 1.0) or not 0.0 < share < 1.0:
            side = int(moment.weight == 1.0)
            there = self._still[moment.interval] | (self._weights[moment.interval, side] > 0)
            return Lack(np.zeros_like(places), there.astype(np.float64))
        return self._lack(moment, span.frames, share, places)

    def _lack(self, moment: Moment, frames: int, share: float, places: Complexes) -> Lack:
        number, rest = moment.interval, 1.0 - share
        still, ends, slopes = self._still[number], self._ends[number], self._slopes[number]
        goal = ends[0] + share * share * (3.0 - 2.0 * share) * (ends[1] - ends[0])
        moving = frames * share * rest * (rest * slopes[0] - share * slopes[1])
        before, after = self._weights[number]
        weights = np.where(still, 1.0, rest**3 * before + share**3 * after)
        offsets = np.where(still, goal - places, moving)
        return Lack(offsets, np.where(weights > RARELY, weights, 0.0))
