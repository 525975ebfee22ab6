"""What a layer hangs on."""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from functools import lru_cache
from itertools import pairwise
from typing import Self

from app.document.checks import (
    LAST_FRAME,
    NOTHING,
    Unknown,
    require,
    require_frame,
    require_id,
    require_point,
)
from app.document.timing import Cycle, count_changes_within


@dataclass(frozen=True, slots=True, kw_only=True)
class Attachment:
    """The joint by which a layer hangs on another one from a frame on, or on nothing any more.

    The anchor of the layer is where the point of its parent is, at every time: the one freedom
    that the in-betweens leave (Section 7, "a user curve for the anchor"), so that the layer is no
    more distorted than without.
    """

    parent: int | None  # the id of the parent; None lets the layer go
    parent_point: complex = 0j  # the point of the parent, where it is drawn at rest
    inherits_rotation: bool = True  # whether the layer turns with the parent around that point
    rest_rotation: float = (
        0.0  # the parent's turn, in radians, at which the layer is as it is by itself
    )
    frame: int = 0  # from which on it holds, until the next one
    # Where the anchor is beside that point, as the parent is turned where the layer turns with it.
    offset: complex = 0j
    # Whether nothing jumps at that frame: in place of `rest` and `offset`, the layer goes on as it
    # is beside the point and turned then; one that is let go stays there.
    keep_world_transform: bool = False
    # The frame at which it was as it is kept, where that is an earlier one; one that keeps only.
    kept_since: int | None = None
    # Whether it goes over, from there, to where the next joint has the layer when that begins, so
    # that nothing jumps then either; one that keeps only.
    blends_to_next: bool = False
    unknown: Unknown = field(default_factory=lambda: NOTHING, repr=False, hash=False)

    def __post_init__(self) -> None:
        if self.parent is not None:
            require_id(self.parent, "a layer")
        require_point(self.parent_point, "A joint")
        require_point(self.offset, "What hangs on a joint")
        require(
            math.isfinite(self.rest_rotation), f"A turn must be finite, not {self.rest_rotation}."
        )
        require_frame(self.frame, "A joint")
        require(
            self.kept_since is None or 0 <= self.kept_since <= self.frame,
            f"What a joint keeps from frame {self.frame} on was so at that frame or before, not at "
            f"frame {self.kept_since}.",
        )

    @property
    def kept_from(self) -> int:
        """The frame at which a layer is as a joint keeps it."""
        return self.frame if self.kept_since is None else self.kept_since

    def retimed(self, to: Callable[[int], int]) -> Self:
        """Return the joint with its frames where a function has them."""
        since = None if self.kept_since is None else to(self.kept_since)
        return replace(self, frame=to(self.frame), kept_since=since)


def require_attachments(joints: tuple[Attachment, ...]) -> None:
    """Raise a `LissomError` unless each joint comes after the one before."""
    for before, after in pairwise(joints):
        require(
            before.frame < after.frame,
            f"The layer is attached anew at frame {after.frame} after frame {before.frame}.",
        )


def attachments_repeat(joints: Sequence[Attachment], cycle: Cycle) -> bool:
    """Tell whether what a layer hangs on changes within a cycle of it, and repeats with that.

    It does where nothing of it is said in the repeats, and at the end of the stretch at most that
    the layer hangs on what it hung on at the beginning. Else it has its own time.
    """
    begun = _begun(joints, cycle)
    return cycle.contains_changes(
        joint.frame for joint in joints if not _is_again(joint, begun, cycle)
    )


@lru_cache(maxsize=64)
def repeated_joints(
    joints: tuple[Attachment, ...], cycles: tuple[Cycle, ...], end: int
) -> tuple[Attachment, ...]:
    """Return joints with those of cycles in each repeat, up to the scene's last frame.

    Each repeat, and what follows the last one, begins as the stretch does; the last joint before
    leads there. One that keeps does so from its frame in each repeat, so that nothing jumps even
    where what carries the layer goes on meanwhile.
    """
    for cycle in cycles:
        if not (
            count_changes_within([joint.frame for joint in joints], cycle)
            and attachments_repeat(joints, cycle)
        ):
            continue
        begun, until = _begun(joints, cycle), end if cycle.until is None else cycle.until
        own = [joint for joint in joints if cycle.first < joint.frame < cycle.last]
        own[-1] = replace(own[-1], blends_to_next=own[-1].keep_world_transform)
        since = begun.kept_from if begun.keep_world_transform else None
        again = {joint.frame: joint for joint in own}
        others = [
            joint
            for joint in joints
            if joint.frame not in again and not _is_again(joint, begun, cycle)
        ]
        start = cycle.last
        while start <= min(until, LAST_FRAME):
            again[start] = replace(begun, frame=start, kept_since=since)
            for joint in own:
                at = joint.frame + start - cycle.first
                if at <= min(until, LAST_FRAME):
                    again[at] = replace(joint, frame=at)
            start += cycle.period
        if cycle.until is None and start <= LAST_FRAME:
            # To which a repeat leads that the scene's end cuts off.
            again[start] = replace(begun, frame=start, kept_since=since)
        again |= {joint.frame: joint for joint in others}
        joints = tuple(again[frame] for frame in sorted(again))
    return joints


def _is_again(joint: Attachment, begun: Attachment, cycle: Cycle) -> bool:
    """Tell whether a joint is at a cycle's end, and that with which the cycle begins."""
    same = replace(joint, frame=begun.frame, kept_since=None, blends_to_next=begun.blends_to_next)
    is_alike = joint.parent == begun.parent and (joint.keep_world_transform or same == begun)
    return joint.frame == cycle.last and is_alike


def _begun(joints: Sequence[Attachment], cycle: Cycle) -> Attachment:
    """Return the joint with which a cycle begins; before the first one a layer is by itself."""
    before = [joint for joint in joints if joint.frame <= cycle.first]
    return before[-1] if before else Attachment(parent=None, frame=cycle.first)
