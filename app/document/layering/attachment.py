"""What a figure hangs on."""

import math
from dataclasses import dataclass, field
from itertools import pairwise

from app.document.checks import NOTHING, Unknown, require, require_place
from app.document.settings import LAST_FRAME


@dataclass(frozen=True, slots=True, kw_only=True)
class Attachment:
    """The joint by which a figure hangs on another one from a frame on, or on nothing any more.

    The anchor of the figure is where the point of its parent is, at every time: the one freedom
    that the in-betweens leave (Section 7, "a user curve for the anchor"), so that the figure is no
    more distorted than without.
    """

    to: int | None  # the id of the parent; None lets the figure go
    at: complex = 0j  # the point of the parent, where it is drawn at rest
    turns: bool = True  # whether the figure turns with the parent around that point
    rest: float = 0.0  # the parent's turn, in radians, at which the figure is as it is by itself
    frame: int = 0  # from which on it holds, until the next one
    # Where the anchor is beside that point, as the parent is turned where the figure turns with it.
    offset: complex = 0j
    # Whether nothing jumps at that frame: in place of `rest` and `offset`, the figure goes on as it
    # is beside the point and turned then; one that is let go stays there.
    keeps: bool = False
    unknown: Unknown = field(default_factory=lambda: NOTHING, repr=False, hash=False)

    def __post_init__(self) -> None:
        require(
            self.to is None or self.to >= 0, f"A figure's id is not negative, unlike {self.to}."
        )
        require_place(self.at, "A joint")
        require_place(self.offset, "What hangs on a joint")
        require(math.isfinite(self.rest), f"A turn must be finite, not {self.rest}.")
        require(
            0 <= self.frame <= LAST_FRAME,
            f"A joint holds from a frame from 0 to {LAST_FRAME:,} on, not from {self.frame}.",
        )


def require_joints(joints: tuple[Attachment, ...]) -> None:
    """Raise a `LissomError` unless each joint comes after the one before."""
    for before, after in pairwise(joints):
        require(
            before.frame < after.frame,
            f"The figure is attached anew at frame {after.frame} after frame {before.frame}.",
        )
