"""Cycles: stretches of time that repeat."""

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field, replace
from itertools import pairwise
from typing import Self

from app.document.checks import NOTHING, Unknown, require
from app.document.timing.moving_key import MovingKey


@dataclass(frozen=True, slots=True, kw_only=True)
class Cycle:
    """A stretch of time that repeats; its last frame is the same moment as its first one."""

    first: int
    last: int
    until: int | None = None  # the frame at which its repeats end; None is the scene's last one
    unknown: Unknown = field(default_factory=lambda: NOTHING, repr=False, hash=False)

    def __post_init__(self) -> None:
        require(
            self.first < self.last,
            f"What repeats ends after the frame at which it begins, {self.first}, not at "
            f"{self.last}.",
        )
        require(
            self.until is None or self.until >= self.last,
            f"Frames {self.first} to {self.last} cannot repeat until frame {self.until}, which is "
            "before their end.",
        )

    @property
    def period(self) -> int:
        """How many frames it takes to come round."""
        return self.last - self.first

    @property
    def told(self) -> str:
        """The stretch in words."""
        return f"frames {self.first} to {self.last}"

    def has(self, frame: float) -> bool:
        """Tell whether a frame is in the stretch itself, whose end is that of the last repeat."""
        return self.first <= frame < self.last

    def covers(self, frame: float) -> bool:
        """Tell whether a frame is in the stretch or in its repeats."""
        return self.first <= frame and (self.until is None or frame <= self.until)

    def takes(self, keys: Sequence[MovingKey]) -> bool:
        """Tell whether keys repeat with it: those that go on beyond it have their own time."""
        return self.has(keys[0].frame) and keys[-1].frame <= self.last

    def has_all(self, frames: Iterable[int]) -> bool:
        """Tell whether what changes at some frames changes in the stretch, and not in repeats.

        What changes before and after has no say, and there is a change at least.
        """
        later = [frame for frame in frames if frame > self.first]
        if self.until is not None:
            later = [frame for frame in later if frame < self.until]
        return bool(later) and max(later) < self.last

    def moved(self, to: Callable[[int], int]) -> Self:
        """Return the cycle with its frames where a function has them."""
        until = None if self.until is None else to(self.until)
        return replace(self, first=to(self.first), last=to(self.last), until=until)

    def held(self, frame: float, end: int) -> float:
        """Return the frame of the stretch that a frame shows of what is held before and after it.

        The last frame of the scene is where repeats without an end are over.
        """
        until = max(self.last, end) if self.until is None else self.until
        return self.source(min(max(frame, self.first), until))

    def source(self, frame: float) -> float:
        """Return the frame of the stretch that a frame shows while it repeats."""
        return self.first + (frame - self.first) % self.period


def require_apart(cycles: Iterable[Cycle]) -> None:
    """Raise a `LissomError` unless each cycle has ended when the next one begins."""
    for before, after in pairwise(cycles):
        require(
            before.until is not None and before.until <= after.first,
            f"The repeats of {before.told} and of {after.told} overlap; end the former at frame "
            f"{after.first} at the latest.",
        )


def require_repeatable(cycle: Cycle, keys: Sequence[int]) -> None:
    """Raise a `LissomError` unless motion comes into a cycle, round, and on to a figure's keys.

    These are told by their frames, in order.
    """
    own = [frame for frame in keys if cycle.has(frame)]
    before = [frame for frame in keys if frame < cycle.first]
    after = [frame for frame in keys if frame >= cycle.last]
    for frame in after:
        require(
            cycle.until is not None and frame >= cycle.until,
            f"The key at frame {frame} is where {cycle.told} repeat; pose it in {cycle.told}, let "
            "the repeats end there, or make them into keys first.",
        )
    require(
        bool(own) or not (before and after),
        f"There is no key in {cycle.told} that could repeat; insert one there first.",
    )
    require(
        not (before and own) or own[0] == cycle.first,
        f"Frame {cycle.first} needs a key, to which the keys before lead: it is where what repeats "
        "begins.",
    )
    if len(own) > 1 and after and cycle.until is not None:
        ways_on = [frame for frame in own if (cycle.until - frame) % cycle.period == 0]
        require(
            bool(ways_on) or after[0] == cycle.until,
            f"At frame {cycle.until} the repeats of {cycle.told} are between two keys, from where "
            f"nothing leads to the key at frame {after[0]}; let them end at frame "
            f"{_nearest_end(cycle, own, after[0])} instead.",
        )


def _nearest_end(cycle: Cycle, own: Sequence[int], before: int) -> int:
    """Return the frame nearest to a cycle's end at which it shows one of its keys."""
    until = cycle.last if cycle.until is None else cycle.until
    rounds = range((before - cycle.first) // cycle.period + 2)
    ends = [frame + number * cycle.period for number in rounds for frame in own]
    fitting = [end for end in ends if cycle.last <= end <= before] or [before]
    return min(fitting, key=lambda end: abs(end - until))
