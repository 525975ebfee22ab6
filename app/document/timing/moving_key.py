"""What keys of all that moves have alike, but for those of poses."""

from dataclasses import dataclass, field, replace
from typing import Self

from app.document.checks import NOTHING, Unknown, require_frame
from app.document.timing.easing import HOLD, LINEAR, Easing
from app.document.timing.passing import Passing, require_passing


@dataclass(frozen=True, slots=True, kw_only=True)
class MovingKey:
    """A key of what moves as poses do, and the way from there to the next one."""

    frame: int
    easing: Easing = LINEAR
    passing: Passing = Passing.THROUGH
    unknown: Unknown = field(default_factory=lambda: NOTHING, repr=False, hash=False)

    def __post_init__(self) -> None:
        require_frame(self.frame, "A key")
        require_passing(self.passing)
        object.__setattr__(self, "passing", Passing(self.passing))

    @property
    def shown_passing(self) -> Passing:
        """How the motion passes the key, by a hold too."""
        return Passing.HOLD if self.easing == HOLD else self.passing

    def with_way(self, other: Self, *, backwards: bool = False) -> Self:
        """Return the key with the way on from another one, or with that way run backwards."""
        return replace(self, easing=other.easing.reversed() if backwards else other.easing)

    def at_pace(self, frame: int, pace: float) -> Self:  # noqa: ARG002 - it has no velocity
        """Return the key at another frame of a motion that runs so many times as fast."""
        return self if frame == self.frame else replace(self, frame=frame)
