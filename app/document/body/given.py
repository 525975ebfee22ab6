"""Ready motions that a figure was given, and from what they were made."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from types import MappingProxyType

from app.document.checks import NOTHING, Unknown, require
from engine.geometry.motions import Parameters

MOST_ROUNDS = 1000


@dataclass(frozen=True, slots=True, kw_only=True)
class GivenMotion:
    """A ready motion as it was given, by which it can be given again in another way.

    It says nothing of how the figure moves: that its keys do. Whether they are as they were made,
    or were edited since, tells `app.document.queries.is_as_given`.
    """

    motion: str  # the name of one of `engine.geometry.motions.MOTIONS`
    kind: str  # and of one of its `KINDS`
    joints: Mapping[str, int]  # the ids of the handles that are joints, by the joints' names
    facing: int  # 1 where the drawing looks to the right, -1 to the left
    parameters: Parameters
    first: int  # the frame at which it was given
    start: int  # the frame at which it begins; from the first one it blends in
    last: int  # the frame at which it ends
    rounds: int = 1  # how often it is there
    digest: str = ""  # of the keys that were made

    # What a later version says of it.
    unknown: Unknown = field(default_factory=lambda: NOTHING, repr=False, hash=False)

    def __post_init__(self) -> None:
        require(
            self.first <= self.start < self.last,
            f"A motion ends after frame {self.start}, at which it begins, not at {self.last}.",
        )
        require(
            self.facing in (1, -1), f"A drawing looks to the right, 1, or left, -1: {self.facing}."
        )
        require(
            1 <= self.rounds <= MOST_ROUNDS,
            f"A motion is there once to {MOST_ROUNDS:,} times, not {self.rounds:,} times.",
        )
        object.__setattr__(self, "joints", MappingProxyType(dict(self.joints)))

    def overlaps(self, first: int, last: int) -> bool:
        """Tell whether some of its frames are strictly within others."""
        return self.first < last and first < self.last
