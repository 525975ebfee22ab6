"""How the motion of a clip leaves its keys and reaches them, by their passings and easings."""

from dataclasses import dataclass

import numpy as np

from app.document.figure import Figure
from app.document.keyframe import Keyframe
from app.document.queries.clips import Clip, closes, intervals
from app.document.queries.passages import Passages, Passed
from app.document.queries.remembered import remembered
from app.document.settings import FrameRange
from engine.interpolation import Joint
from engine.variant import Baseline

# Pixels by which the coefficients of two maps may differ that are the same to the eye: the solver
# comes back to a pose only so closely.
SAME_MAP = 0.01


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

    @property
    def paces(self) -> tuple[float, float]:
        """How fast `weight` grows with the share at the first key and at the second one."""
        if self.is_even or isinstance(self.start, Joint) or isinstance(self.end, Joint):
            return 1.0, 1.0
        return self.start, self.end

    def weight(self, share: float) -> float:
        """Return which share of the way is done after a share of the interval's time."""
        if self.is_even or isinstance(self.start, Joint) or isinstance(self.end, Joint):
            return share
        # The cubic from 0 to 1 with these slopes at its ends.
        rest = 1.0 - share
        return share * (rest * rest * self.start + share * (rest * (3.0 - self.end) + share))


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
    passages = _passages(clip)
    passed = [passages.ends(index) for index in range(len(clip.keys))]
    found = []
    for first, last in intervals(clip):
        start, end = passed[first][1], passed[last][0]
        window, turns = [clip.keys[first], clip.keys[last]], [clip.keys[first].turns]
        before, after = passages.arriving(first), passages.leaving(last)
        if isinstance(start, Joint) and before:
            window.insert(0, clip.keys[before.first])
            turns.insert(0, clip.keys[before.first].turns)
        if isinstance(end, Joint) and after:
            window.append(clip.keys[after.last])
            turns.append(clip.keys[after.first].turns)
        found.append(Transit(keys=tuple(window), turns=tuple(turns), start=start, end=end))
    return tuple(found)


def comes_round(clip: Clip) -> bool:
    """Tell whether the motion goes on from the last key to the first one."""
    return _passages(clip).gap is not None


def _passages(clip: Clip) -> Passages[Keyframe]:
    first, last = clip.keys[0], clip.keys[-1]
    frames = last.frame - first.frame
    gap = clip.period - frames if closes(clip) else None
    if clip.loop and first is not last and frames == clip.period and _is_same(first, last):
        gap = 0
    return Passages(keys=clip.keys, gap=gap, is_same=_is_same)


def _is_same(key: Keyframe, other_key: Keyframe) -> bool:
    """Tell whether two keys' poses have the same map."""
    pose, other = key.pose, other_key.pose
    if pose is other or pose.phi is other.phi:
        return True
    pairs = ((pose.phi, other.phi), (pose.psi, other.psi), (pose.logs, other.logs))
    return all(np.abs(one - two).max(initial=0.0) <= SAME_MAP for one, two in pairs)
