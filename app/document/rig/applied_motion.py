"""Motion presets that were applied to a layer."""

from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass, field, replace
from types import MappingProxyType
from typing import Self

from app.document.channels.springs import Spring
from app.document.checks import LAST_FRAME, NOTHING, Unknown, require, require_distinct
from app.rigging import Parameters, find_kind, find_motion
from app.texts import N_

MAX_REPEATS = 1000


@dataclass(frozen=True, slots=True, kw_only=True)
class MadeKey:
    """A key as a motion preset made it, by which edits are known."""

    offset: int  # frames from the motion's start
    targets: Mapping[int, complex]  # by handle id

    def __post_init__(self) -> None:
        object.__setattr__(self, "targets", MappingProxyType(dict(self.targets)))


@dataclass(frozen=True, slots=True, kw_only=True)
class AppliedMotion:
    """An applied motion preset, with all that is needed to apply it again with other parameters.

    The keys alone define how the layer moves. `is_motion_unedited` tests whether the keys are
    still as the preset made them.
    """

    id: int = 0  # unique in the layer; keys of the motion refer to it
    motion: str  # name of an entry of `app.rigging.MOTIONS`
    kind: str  # name of one of its `KINDS`
    joints: Mapping[str, int]  # joint name to handle id
    facing: int  # 1 if the drawing looks to the right, -1 to the left
    parameters: Parameters
    first: int  # first frame
    start: int  # first frame of the motion; the layer blends in from `first` to `start`
    last: int  # last frame
    repeat_count: int = 1  # number of repeats
    # Pixels by which the ground passes to the left in a cycle, under a body that walks in place.
    stride: float = 0.0
    digest: str = ""  # of the keys that the preset made
    made: tuple[MadeKey, ...] = ()  # the keys of one repeat; empty in earlier projects
    springs: tuple[Spring, ...] = ()  # as the preset made them

    # Fields of a later version.
    unknown: Unknown = field(default_factory=lambda: NOTHING, repr=False, hash=False)

    def __post_init__(self) -> None:
        require(
            0 <= self.first <= self.start < self.last <= LAST_FRAME,
            N_(
                "A motion must run from a frame to a later frame, from 0 to {largest:,}. This "
                "motion blends in from frame {first} to {start}, and ends at frame {last}."
            ),
            largest=LAST_FRAME,
            first=self.first,
            start=self.start,
            last=self.last,
        )
        find_motion(self.motion).template_for(self.kind)
        kind = find_kind(self.kind)
        if kind.parents:
            kind.require_joints(self.joints)
        require(
            self.facing in (1, -1),
            N_("A drawing must face right (1) or left (-1), not {facing}."),
            facing=self.facing,
        )
        require(
            1 <= self.repeat_count <= MAX_REPEATS,
            N_("A motion can play 1 to {most:,} times, not {count:,} times."),
            most=MAX_REPEATS,
            count=self.repeat_count,
        )
        object.__setattr__(self, "joints", MappingProxyType(dict(self.joints)))

    @property
    def ground_velocity(self) -> float:
        """Pixels per frame by which standing feet move to the right."""
        return -self.stride * self.repeat_count / (self.last - self.start)

    def moved(self, to: Callable[[int], int]) -> Self:
        """Return the motion with its frames mapped by a function."""
        first, start, last = map(to, (self.first, self.start, self.last))
        return replace(self, first=first, start=start, last=last)

    def shifted(self, by: complex) -> Self:
        """Return the motion with its places moved on the canvas."""
        made = tuple(
            replace(key, targets={handle: at + by for handle, at in key.targets.items()})
            for key in self.made
        )
        return replace(self, made=made)

    def overlaps(self, first: int, last: int) -> bool:
        """Return whether the ranges of frames overlap in more than an end."""
        return self.first < last and first < self.last


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class UnreadMotion:
    """A motion in a project file that this version cannot read; it is written unchanged."""

    index: int  # position among the layer's motions in the file
    content: object  # decoded JSON
    reason: str  # why this version cannot read the motion, as a sentence


def require_motions(motions: Sequence[AppliedMotion], handles: Collection[int]) -> None:
    """Refuse motions with the same id, or whose joints are not among the handles."""
    require_distinct((each.id for each in motions), N_("Two motions have the id {value!r}."))
    for motion in motions:
        for joint, identity in motion.joints.items():
            require(
                identity in handles,
                N_(
                    "The joint {joint!r} of a motion is at handle {identity}, which does not exist."
                ),
                joint=joint,
                identity=identity,
            )
