"""How a figure stands among the others: what it hangs on, and when it is seen."""

import math
from dataclasses import dataclass
from itertools import pairwise

from app.document.checks import require, require_place


@dataclass(frozen=True, slots=True, kw_only=True)
class Attachment:
    """The joint by which a figure hangs on another one.

    The anchor of the figure is where the point of its parent is, at every time: the one freedom
    that the in-betweens leave (Section 7, "a user curve for the anchor"), so that the figure is no
    more distorted than without.
    """

    to: int  # the id of the parent
    at: complex  # the point of the parent, where it is drawn at rest
    turns: bool = True  # whether the figure turns with the parent around that point
    rest: float = 0.0  # the parent's turn, in radians, at which the figure is as it is by itself

    def __post_init__(self) -> None:
        require(self.to >= 0, f"A figure's id is not negative, unlike {self.to}.")
        require_place(self.at, "A joint")
        require(math.isfinite(self.rest), f"A turn must be finite, not {self.rest}.")


@dataclass(frozen=True, slots=True)
class Switch:
    """From a frame on a figure is seen, or is not."""

    frame: int
    visible: bool


def require_in_order(switches: tuple[Switch, ...]) -> None:
    """Raise a `LissomError` unless each switch comes after the one before."""
    for before, after in pairwise(switches):
        require(
            before.frame < after.frame,
            f"The figure is shown or hidden at frame {after.frame} after frame {before.frame}.",
        )
