"""How the motion reaches each of some keys, and leaves it, by their passings and easings."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from math import isfinite
from typing import Generic, NamedTuple, Protocol, TypeVar

from app.document.timing import HOLD, Easing, Passing
from engine.interpolation import Joint

# How an interval leaves a key, or reaches it: by the joint with which the motion passes it, or at a
# share of a straight blend's pace, 1 at a corner and 0 at a stop.
Passed = Joint | float


class Timed(Protocol):
    """A key, of a pose or of a track."""

    @property
    def frame(self) -> int:
        """Its frame."""

    @property
    def easing(self) -> Easing:
        """How time runs until the next key."""

    @property
    def passing(self) -> Passing:
        """How the motion passes it, other than by a hold."""


Key = TypeVar("Key", bound=Timed)


class Leg(NamedTuple):
    """From one key to another, by their indices, and in how many frames."""

    first: int
    last: int
    frames: int


@dataclass(frozen=True, slots=True, kw_only=True)
class Passages(Generic[Key]):
    """Keys that follow each other in time, and how the motion goes through them."""

    keys: tuple[Key, ...]
    # How many frames lead from the last key to the first one again; 0 where it is the first one
    # again, and None where it leads nowhere.
    gap: int | None
    is_same: Callable[[Key, Key], bool]  # whether two keys have what moves alike
    # Whether the motion comes from rest at a key that no leg leads to, and so at one without a way
    # on, where it passes these through; else as straight as a corner.
    ends_rest: bool = False

    def ends(self, index: int) -> tuple[Passed, Passed]:
        """Return how a key is reached, and how it is left."""
        before, after = self.arriving(index), self.leaving(index)
        is_end = self.ends_rest and None in (before, after)
        return passed(self.keys, index, before, after, self.is_same, is_end=is_end)

    def arriving(self, index: int) -> Leg | None:
        """Return the leg that leads to a key."""
        last = len(self.keys) - 1
        if index > 0:
            return Leg(index - 1, index, self.keys[index].frame - self.keys[index - 1].frame)
        if self.gap is None:
            return None
        return Leg(last, 0, self.gap) if self.gap else self.arriving(last)

    def leaving(self, index: int) -> Leg | None:
        """Return the leg that leads on from a key."""
        last = len(self.keys) - 1
        if index < last:
            return Leg(index, index + 1, self.keys[index + 1].frame - self.keys[index].frame)
        if self.gap is None:
            return None
        return Leg(last, 0, self.gap) if self.gap else self.leaving(0)


def passed(
    keys: Sequence[Key],
    index: int,
    before: Leg | None,
    after: Leg | None,
    is_same: Callable[[Key, Key], bool],
    *,
    is_end: bool = False,
) -> tuple[Passed, Passed]:
    """Return how one of some keys is reached by a leg, and how it is left by another one.

    Parameters
    ----------
    keys : sequence of Key
    index : int
    before, after : Leg or None
    is_same : callable
        Tells whether two keys have what moves alike.
    is_end : bool
        Whether the motion comes from rest or to rest there, where it would pass through.
    """
    before, after = _moving(keys, before), _moving(keys, after)
    reached = keys[index if before is None else before.last]
    left = keys[index if after is None else after.first]
    end_pace = 1.0 if before is None else keys[before.first].easing.paces[1]
    start_pace = 1.0 if after is None else left.easing.paces[0]
    stops = rest(end_pace), rest(start_pace)
    if before and after and reached.passing is left.passing is Passing.THROUGH:
        if is_same(left, keys[before.first]) or is_same(left, keys[after.last]):
            # What is given twice is meant to be kept: past it the motion would swing beyond.
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
    resting = {Passing.STOP, Passing.THROUGH} if is_end else {Passing.STOP}
    return (
        stops[0] if reached.passing in resting else 1.0,
        stops[1] if left.passing in resting else 1.0,
    )


def _moving(keys: Sequence[Timed], leg: Leg | None) -> Leg | None:
    """Return a leg, unless there is no motion in it."""
    return None if leg is None or keys[leg.first].easing == HOLD else leg


def rest(pace: float) -> float:
    """Return 0 where a blend must stop at a key, and 1 where its easing stops there by itself."""
    return 1.0 if pace == 0.0 else 0.0
