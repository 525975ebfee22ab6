"""Ready motions that a layer was given, and from what they were made."""

from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass, field, replace
from itertools import pairwise
from types import MappingProxyType
from typing import Self

from app.document.checks import LAST_FRAME, NOTHING, Unknown, require
from engine.geometry.motions import Parameters, find_kind, find_motion

MAX_REPEATS = 1000


@dataclass(frozen=True, slots=True, kw_only=True)
class AppliedMotion:
    """A ready motion as it was given, by which it can be given again in another way.

    It says nothing of how the layer moves: that its keys do. Whether they are as they were made,
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
    repeat_count: int = 1  # how often it is there
    digest: str = ""  # of the keys that were made

    # What a later version says of it.
    unknown: Unknown = field(default_factory=lambda: NOTHING, repr=False, hash=False)

    def __post_init__(self) -> None:
        require(
            0 <= self.first <= self.start < self.last <= LAST_FRAME,
            f"A motion goes from a frame to a later one, from 0 to {LAST_FRAME:,}, not from "
            f"{self.first} by {self.start} to {self.last}.",
        )
        find_motion(self.motion).template_for(self.kind)
        kind = find_kind(self.kind)
        if kind.parents:
            kind.require_joints(self.joints)
        require(
            self.facing in (1, -1), f"A drawing looks to the right, 1, or left, -1: {self.facing}."
        )
        require(
            1 <= self.repeat_count <= MAX_REPEATS,
            f"A motion is there once to {MAX_REPEATS:,} times, not {self.repeat_count:,} times.",
        )
        object.__setattr__(self, "joints", MappingProxyType(dict(self.joints)))

    def moved(self, to: Callable[[int], int]) -> Self:
        """Return the motion with its frames where a function has them."""
        first, start, last = map(to, (self.first, self.start, self.last))
        return replace(self, first=first, start=start, last=last)

    def overlaps(self, first: int, last: int) -> bool:
        """Tell whether some of its frames are strictly within others."""
        return self.first < last and first < self.last


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class UnreadMotion:
    """A motion in a project file that this version cannot show; it is written as it was read."""

    index: int  # its place among the layer's motions in the file
    content: object  # decoded JSON
    reason: str  # why it cannot be shown, as a sentence


def require_motions(motions: Sequence[AppliedMotion], handles: Collection[int]) -> None:
    """Raise a `LissomError` unless motions are apart, and their joints among some handles."""
    for before, after in pairwise(motions):
        require(
            before.last <= after.first,
            f"A motion from frame {after.first} on begins before the one from frame {before.first} "
            "on has ended.",
        )
    for motion in motions:
        for joint, identity in motion.joints.items():
            require(
                identity in handles,
                f"The joint {joint!r} of a motion is the handle {identity}, which is not there.",
            )
