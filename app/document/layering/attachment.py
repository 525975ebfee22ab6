"""What a figure hangs on."""

import math
from dataclasses import dataclass

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
