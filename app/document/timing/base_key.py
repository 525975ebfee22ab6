"""Base class of all keys except pose keys."""

from dataclasses import dataclass, field, replace
from typing import Self

from app.document.checks import NOTHING, Unknown, require_frame
from app.document.timing.easing import HOLD, LINEAR, Easing
from app.document.timing.tangent_mode import TangentMode, require_tangent_mode
from app.texts import _


@dataclass(frozen=True, slots=True, kw_only=True)
class BaseKey:
    """Frame, easing and tangent mode of a key, and the segment to the next key."""

    frame: int
    easing: Easing = LINEAR
    tangent_mode: TangentMode = TangentMode.SMOOTH
    unknown: Unknown = field(default_factory=lambda: NOTHING, repr=False, hash=False)

    def __post_init__(self) -> None:
        require_frame(self.frame, _("A key"))
        require_tangent_mode(self.tangent_mode)
        object.__setattr__(self, "tangent_mode", TangentMode(self.tangent_mode))

    @property
    def shown_tangent_mode(self) -> TangentMode:
        """Tangent mode of the key, with a hold shown as `TangentMode.HOLD`."""
        return TangentMode.HOLD if self.easing == HOLD else self.tangent_mode

    def with_easing_of(self, other: Self, *, backwards: bool = False) -> Self:
        """Return the key with the easing of another key, or with that easing reversed."""
        return replace(self, easing=other.easing.reversed() if backwards else other.easing)

    def retimed(self, frame: int, pace: float) -> Self:  # noqa: ARG002 - it has no velocity
        """Return the key at another frame; the speed factor `pace` scales velocities, if any."""
        return self if frame == self.frame else replace(self, frame=frame)
