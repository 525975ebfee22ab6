"""Cycles: ranges of frames that repeat."""

from bisect import bisect_left, bisect_right
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field, replace
from itertools import pairwise
from typing import Self

from app.document.channels.key import BaseKey
from app.document.checks import NOTHING, Unknown, require, require_frame
from app.errors import LissomError
from app.texts import N_, _

MAX_CYCLES = 1_000  # per layer


@dataclass(frozen=True, slots=True, kw_only=True)
class Cycle:
    """A range of frames that repeats; its last frame equals its first."""

    first: int
    last: int
    until: int | None = None  # last frame of the repeats; None is the document's last frame
    unknown: Unknown = field(default_factory=lambda: NOTHING, repr=False, hash=False)

    def __post_init__(self) -> None:
        for frame in filter(None, (self.first, self.last, self.until)):
            require_frame(frame, _("The end of a cycle"))
        require(
            self.first < self.last,
            N_("A cycle must end after its first frame, {first}, not at frame {last}."),
            first=self.first,
            last=self.last,
        )
        require(
            self.until is None or self.until >= self.last,
            N_(
                "Frames {first} to {last} cannot repeat until frame {until}, which is not after "
                "their end."
            ),
            first=self.first,
            last=self.last,
            until=self.until,
        )

    @property
    def period(self) -> int:
        """Length of a repeat in frames."""
        return self.last - self.first

    @property
    def description(self) -> str:
        """The range in words."""
        return _("frames {first} to {last}").format(first=self.first, last=self.last)

    def contains(self, frame: float) -> bool:
        """Return whether a frame is in the cycle's own range, its last frame excluded."""
        return self.first <= frame < self.last

    def covers(self, frame: float) -> bool:
        """Return whether a frame is in the cycle or its repeats."""
        return self.first <= frame and (self.until is None or frame <= self.until)

    def repeats_keys(self, keys: Sequence[BaseKey]) -> bool:
        """Return whether these keys repeat; keys that extend beyond the cycle do not."""
        return self.contains(keys[0].frame) and keys[-1].frame <= self.last

    def contains_changes(self, frames: Iterable[int]) -> bool:
        """Return whether there are changes within the cycle and none in its repeats.

        Changes before the cycle and after its repeats are ignored.
        """
        later = [frame for frame in frames if frame > self.first]
        if self.until is not None:
            later = [frame for frame in later if frame < self.until]
        return bool(later) and max(later) < self.last

    def retimed(self, to: Callable[[int], int]) -> Self:
        """Return the cycle with its frames mapped by a function."""
        until = None if self.until is None else to(self.until)
        return replace(self, first=to(self.first), last=to(self.last), until=until)

    def clamped_source_frame(self, frame: float, end: int) -> float:
        """Return the frame of the cycle that a frame shows, clamped to the cycle and its repeats.

        Repeats without an end stop at `end`, the document's last frame.
        """
        until = max(self.last, end) if self.until is None else self.until
        return self.source_frame(min(max(frame, self.first), until))

    def source_frame(self, frame: float) -> float:
        """Return the frame of the cycle that a repeated frame shows."""
        return self.first + (frame - self.first) % self.period


def require_no_overlap(cycles: Sequence[Cycle]) -> None:
    """Raise a `LissomError` unless each cycle's repeats end before the next cycle begins."""
    require(
        len(cycles) <= MAX_CYCLES,
        N_("A layer can have at most {most:,} cycles, not {count:,}."),
        most=MAX_CYCLES,
        count=len(cycles),
    )
    for before, after in pairwise(cycles):
        require(
            before.until is not None and before.until <= after.first,
            N_(
                "The repeats of {cycle} and {next_cycle} overlap. End the repeats of {cycle} at "
                "frame {first} or earlier."
            ),
            cycle=before.description,
            next_cycle=after.description,
            first=after.first,
        )


def require_repeatable_cycle(cycle: Cycle, keys: Sequence[int]) -> None:
    """Refuse a cycle that does not join a layer's keys, given by their frames in order.

    The motion must lead into the cycle, repeat, and lead on to the next key.
    """
    begin, end = bisect_left(keys, cycle.first), bisect_left(keys, cycle.last)
    own, has_before, after = keys[begin:end], begin > 0, keys[end : end + 1]
    if after and (cycle.until is None or after[0] < cycle.until):
        raise LissomError(
            _(
                "The key at frame {after} lies where {cycle} repeat. Pose it in {cycle}, let "
                "the repeats end there, or bake the repeats first."
            ).format(after=after[0], cycle=cycle.description)
        )
    require(
        bool(own) or not (has_before and after),
        N_("No key in {cycle} could repeat; insert a key there first."),
        cycle=cycle.description,
    )
    require(
        not (has_before and own) or own[0] == cycle.first,
        N_("The cycle starts at frame {first}. Set a key there."),
        first=cycle.first,
    )
    until = cycle.until
    if until is None or len(own) < 2 or not after or after[0] == until:
        return
    if all((until - frame) % cycle.period for frame in own):
        raise LissomError(
            _(
                "The repeats of {cycle} end at frame {until}, between two keys, so no motion "
                "leads to the key at frame {after}. End the repeats at frame {nearest_end} "
                "instead."
            ).format(
                until=until,
                cycle=cycle.description,
                after=after[0],
                nearest_end=_nearest_end(cycle, own, after[0]),
            )
        )


def _nearest_end(cycle: Cycle, own: Sequence[int], before: int) -> int:
    """Return the frame nearest to the cycle's end at which the repeats show a key."""
    until = cycle.last if cycle.until is None else cycle.until
    begun = until - (until - cycle.first) % cycle.period - cycle.first
    ends = [frame + begun + away for frame in own for away in (-cycle.period, 0, cycle.period)]
    fitting = [end for end in ends if cycle.last <= end <= before] or [before]
    return min(fitting, key=lambda end: abs(end - until))


def count_changes_within(frames: Sequence[int], cycle: Cycle) -> int:
    """Return the number of these ordered frames strictly inside a cycle."""
    return max(0, bisect_left(frames, cycle.last) - bisect_right(frames, cycle.first))


def count_repeated_changes(frames: Sequence[int], cycles: Iterable[Cycle], end: int) -> int:
    """Return the largest number of changes with all repeats up to the document's last frame."""
    count = len(frames)
    for cycle in cycles:
        own = count_changes_within(frames, cycle)
        until = end if cycle.until is None else cycle.until
        count += (own + 1) * ((until - cycle.first) // cycle.period) if own else 0
    return count
