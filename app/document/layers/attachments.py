"""Keys of a layer's parent."""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import Self

from app.document.channels.cycles import Cycle, count_changes_within
from app.document.channels.key import BaseKey
from app.document.checks import LAST_FRAME, require, require_id, require_point
from app.texts import N_, _


@dataclass(frozen=True, slots=True, kw_only=True)
class Attachment(BaseKey):
    """A joint that attaches a layer to a parent from a frame on, or detaches it.

    The layer's anchor follows the point of the parent at every time. The in-betweens leave this
    freedom open (Section 7, "a user curve for the anchor"), so attachment adds no distortion.
    """

    parent: int | None  # layer id; None detaches the layer
    parent_point: complex = 0j  # point of the undeformed parent
    inherits_rotation: bool = True  # whether the layer rotates with the parent around the point
    rest_rotation: float = (
        0.0  # rotation of the parent, in radians, at which the layer has its own rotation
    )
    rest_scale: float = 1.0  # scale of the parent at which the layer has its own scale
    frame: int = 0  # first frame of the attachment
    # Offset of the anchor from the point. It rotates with the parent if the layer does.
    offset: complex = 0j
    # Whether the layer keeps its place in the scene at that frame; replaces `rest_rotation` and
    # `offset`. A detached layer stays there.
    keep_world_transform: bool = False
    # The frame whose placement is kept, if earlier than `frame`. Needs `keep_world_transform`.
    kept_since: int | None = None
    # Whether the layer's own transform moves it at its joint. Up to schema 4 it did not while the
    # layer had a parent, and after a detach it was a motion of the scene.
    applies_transform: bool = True
    # Whether the layer blends to its placement under the next attachment, so that nothing jumps
    # there. Needs `keep_world_transform`.
    blends_to_next: bool = False

    def __post_init__(self) -> None:
        BaseKey.__post_init__(self)
        if self.parent is not None:
            require_id(self.parent, _("A layer"))
        require_point(self.parent_point, _("A joint"))
        require_point(self.offset, _("The offset of a joint"))
        require(
            math.isfinite(self.rest_rotation),
            N_("The rotation of a joint must be finite, not {rest_rotation}."),
            rest_rotation=self.rest_rotation,
        )
        require(
            math.isfinite(self.rest_scale) and self.rest_scale > 0,
            N_("The scale of a joint must be above 0, not {rest_scale}."),
            rest_scale=self.rest_scale,
        )
        require(
            self.kept_since is None or 0 <= self.kept_since <= self.frame,
            N_(
                "A joint from frame {frame} on must keep a position of that frame or earlier, "
                "not of frame {kept_since}."
            ),
            frame=self.frame,
            kept_since=self.kept_since,
        )

    @property
    def kept_from(self) -> int:
        """The frame whose placement the attachment keeps."""
        return self.frame if self.kept_since is None else self.kept_since

    def retimed(self, frame: int, pace: float) -> Self:  # noqa: ARG002 - it has no velocity
        """Return the attachment at another frame.

        The frame whose placement is kept stays, but is no later than the attachment.
        """
        since = None if self.kept_since is None else min(self.kept_since, frame)
        return replace(self, frame=frame, kept_since=since)

    def mapped(self, to: Callable[[int], int], pace: float) -> Self:  # noqa: ARG002
        """Return the attachment in a time that is mapped as a whole."""
        since = None if self.kept_since is None else to(self.kept_since)
        return replace(self, frame=to(self.frame), kept_since=since)


def attachments_repeat(joints: Sequence[Attachment], cycle: Cycle) -> bool:
    """Return whether the parent of a layer changes within a cycle and repeats with the cycle.

    The attachments repeat if no key lies in the repeats. A key at the end of the cycle may only
    restore the attachment of the beginning.
    """
    begun = _begun(joints, cycle)
    return cycle.contains_changes(
        joint.frame for joint in joints if not _is_again(joint, begun, cycle)
    )


@lru_cache(maxsize=64)
def repeated_joints(
    joints: tuple[Attachment, ...], cycles: tuple[Cycle, ...], end: int
) -> tuple[Attachment, ...]:
    """Return attachments with copies in each repeat of the cycles, up to the last frame.

    Each repeat, and the time after the last, begins like the cycle; the attachment before it blends
    to that state. With `keep_world_transform` each copy keeps the placement at its own frame.
    Nothing then jumps, even if the parent moves on meanwhile.
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
            # The last repeat, which the document's end cuts off, blends to this key.
            again[start] = replace(begun, frame=start, kept_since=since)
        again |= {joint.frame: joint for joint in others}
        joints = tuple(again[frame] for frame in sorted(again))
    return joints


def _is_again(joint: Attachment, begun: Attachment, cycle: Cycle) -> bool:
    """Return whether the key at a cycle's end equals the attachment at its beginning."""
    same = replace(joint, frame=begun.frame, kept_since=None, blends_to_next=begun.blends_to_next)
    is_alike = joint.parent == begun.parent and (joint.keep_world_transform or same == begun)
    return joint.frame == cycle.last and is_alike


def _begun(joints: Sequence[Attachment], cycle: Cycle) -> Attachment:
    """Return the attachment at a cycle's beginning; without one, an attachment to no parent."""
    before = [joint for joint in joints if joint.frame <= cycle.first]
    return before[-1] if before else Attachment(parent=None, frame=cycle.first)
