"""How the motion of a clip leaves its keys and reaches them, by their passings and easings."""

from dataclasses import dataclass
from math import isfinite
from typing import NamedTuple

import numpy as np

from app.document.figure import Figure
from app.document.keyframe import Keyframe, Pose
from app.document.queries.clips import Clip, closes, intervals
from app.document.queries.remembered import remembered
from app.document.settings import FrameRange
from app.document.timing import HOLD, Passing
from engine.interpolation import Joint
from engine.variant import Baseline

# Pixels by which the coefficients of two maps may differ that are the same to the eye: the solver
# comes back to a pose only so closely.
SAME_MAP = 0.01
# How an interval leaves a key, or reaches it: by the joint with which the motion passes it, or at a
# share of a straight blend's pace, 1 at a corner and 0 at a stop.
Passed = Joint | float


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Transit:
    """How a clip goes from one key to the next."""

    # The two; with the one before where `start` is a joint, and the one after where `end` is one.
    keys: tuple[Keyframe, ...]
    turns: tuple[int, ...]  # whole turns on the way from each of them to the next
    start: Passed
    end: Passed

    @property
    def is_joined(self) -> bool:
        """Whether it depends on other keys than the two."""
        return len(self.keys) > 2

    @property
    def is_even(self) -> bool:
        """Whether it goes straight from key to key, as quickly as the easing says."""
        return self.start == self.end == 1.0

    def weight(self, share: float) -> float:
        """Return which share of the way is done after a share of the interval's time."""
        if self.is_even or isinstance(self.start, Joint) or isinstance(self.end, Joint):
            return share
        # The cubic from 0 to 1 with these slopes at its ends.
        rest = 1.0 - share
        return share * (rest * rest * self.start + share * (rest * (3.0 - self.end) + share))


class _Step(NamedTuple):
    """From one key to another, by their indices, and in how many frames."""

    first: int
    last: int
    frames: int


def transits(clip: Clip) -> tuple[Transit, ...]:
    """Return the transits of a clip's intervals, in their order."""
    return _transits(clip.figure, clip.frames, clip.loop, clip.baseline)


@remembered
def _transits(
    figure: Figure,
    frames: FrameRange,
    loop: bool,  # noqa: FBT001 - a field of the clip
    baseline: Baseline | None,
) -> tuple[Transit, ...]:
    clip = Clip(figure=figure, frames=frames, loop=loop, fps=1.0, baseline=baseline)
    passed = [_passed(clip, index) for index in range(len(clip.keys))]
    found = []
    for first, last in intervals(clip):
        start, end = passed[first][1], passed[last][0]
        window, turns = [clip.keys[first], clip.keys[last]], [clip.keys[first].turns]
        before, after = _arriving(clip, first), _leaving(clip, last)
        if isinstance(start, Joint) and before:
            window.insert(0, clip.keys[before.first])
            turns.insert(0, clip.keys[before.first].turns)
        if isinstance(end, Joint) and after:
            window.append(clip.keys[after.last])
            turns.append(clip.keys[after.first].turns)
        found.append(Transit(keys=tuple(window), turns=tuple(turns), start=start, end=end))
    return tuple(found)


def _passed(clip: Clip, index: int) -> tuple[Passed, Passed]:
    """Return how a key is reached, and how it is left."""
    before, after = _moving(clip, _arriving(clip, index)), _moving(clip, _leaving(clip, index))
    reached = clip.keys[index if before is None else before.last]
    left = clip.keys[index if after is None else after.first]
    end_pace = 1.0 if before is None else clip.keys[before.first].easing.paces[1]
    start_pace = 1.0 if after is None else left.easing.paces[0]
    stops = _rest(end_pace), _rest(start_pace)
    if before and after and reached.passing is left.passing is Passing.THROUGH:
        neighbours = clip.keys[before.first], clip.keys[after.last]
        if any(_is_same(left.pose, key.pose) for key in neighbours):
            # A pose that is given twice is meant to be kept: past it the shape would swing beyond.
            return stops
        joint = Joint(before.frames, after.frames)
        if end_pace == start_pace == 0.0:
            return joint, joint
        if 0.0 in (end_pace, start_pace):
            return stops
        if isfinite(end_pace) and isfinite(start_pace):
            joint = joint._replace(end_pace=end_pace, start_pace=start_pace)
            return joint, joint
        return 1.0, 1.0
    return (
        stops[0] if reached.passing is Passing.STOP else 1.0,
        stops[1] if left.passing is Passing.STOP else 1.0,
    )


def _rest(pace: float) -> float:
    """Return 0 where a blend must stop at a key, and 1 where its easing stops there by itself."""
    return 1.0 if pace == 0.0 else 0.0


def _arriving(clip: Clip, index: int) -> _Step | None:
    """Return the step that leads to a key."""
    keys, last = clip.keys, len(clip.keys) - 1
    if index > 0:
        return _Step(index - 1, index, keys[index].frame - keys[index - 1].frame)
    if closes(clip):
        return _Step(last, 0, clip.period - (keys[last].frame - keys[0].frame))
    return _arriving(clip, last) if _comes_round(clip) else None


def _leaving(clip: Clip, index: int) -> _Step | None:
    """Return the step that leads on from a key."""
    keys, last = clip.keys, len(clip.keys) - 1
    if index < last:
        return _Step(index, index + 1, keys[index + 1].frame - keys[index].frame)
    if closes(clip):
        return _Step(last, 0, clip.period - (keys[last].frame - keys[0].frame))
    return _leaving(clip, 0) if _comes_round(clip) else None


def _moving(clip: Clip, step: _Step | None) -> _Step | None:
    """Return a step, unless there is no motion in it."""
    return None if step is None or clip.keys[step.first].easing == HOLD else step


def _comes_round(clip: Clip) -> bool:
    """Tell whether the last key is the first one again: the same pose at the same moment."""
    first, last = clip.keys[0], clip.keys[-1]
    is_whole = first is not last and last.frame - first.frame == clip.period
    return clip.loop and is_whole and _is_same(first.pose, last.pose)


def _is_same(pose: Pose, other: Pose) -> bool:
    """Tell whether two poses have the same map."""
    if pose is other or pose.phi is other.phi:
        return True
    pairs = ((pose.phi, other.phi), (pose.psi, other.psi), (pose.logs, other.logs))
    return all(np.abs(one - two).max(initial=0.0) <= SAME_MAP for one, two in pairs)
