"""Keys of all channels."""

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from typing import Any, Generic, Self, TypeVar

from app.document.channels.easing import HOLD, LINEAR, Easing
from app.document.channels.tangent_mode import TangentMode, require_tangent_mode
from app.document.checks import NOTHING, Unknown, require_frame
from app.texts import _

V = TypeVar("V")
KeyOf = TypeVar("KeyOf", bound="BaseKey")
Value = TypeVar("Value", float, complex)


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
        """Return the key with the segment of another key, or with that segment reversed."""
        return replace(self, easing=other.easing.reversed() if backwards else other.easing)

    def retimed(self, frame: int, pace: float) -> Self:  # noqa: ARG002 - it has no velocity
        """Return the key at another frame; the speed factor `pace` scales velocities, if any."""
        return self if frame == self.frame else replace(self, frame=frame)

    def copied(self, frame: int) -> Self:
        """Return a copy of the key for another frame."""
        return self.retimed(frame, 1.0)

    def mapped(self, to: Callable[[int], int], pace: float) -> Self:
        """Return the key in a time that is mapped as a whole: its own frame and all others."""
        return self.retimed(to(self.frame), pace)

    def without_velocity(self) -> Self:
        """Return the key without a velocity of its own."""
        return self


@dataclass(frozen=True, slots=True, kw_only=True)
class Key(BaseKey, Generic[V]):
    """A value at a frame, and the segment to the next key."""

    value: V
    # Velocity of each component of the kind through the key, per frame; None derives a velocity
    # from the neighbouring keys. Empty derives all.
    velocities: tuple[float | complex | None, ...] = ()

    def __hash__(self) -> int:
        # Cheap, because queries are cached by rows of thousands of keys.
        return hash((self.frame, self.value))

    def velocity_of(self, component: int) -> Any:
        """Return the key's own velocity of a component of the kind; None if it is derived."""
        return self.velocities[component] if self.velocities else None

    def retimed(self, frame: int, pace: float) -> Self:
        """Return the key at another frame, with its velocities multiplied by `pace`."""
        scaled = tuple(None if each is None else pace * each for each in self.velocities)
        return (
            replace(self, frame=frame, velocities=scaled)
            if self.velocities
            else (BaseKey.retimed(self, frame, pace))
        )

    def without_velocity(self) -> Self:
        """Return the key without velocities of its own."""
        return replace(self, velocities=()) if self.velocities else self


@dataclass(frozen=True)  # no slots: Python 3.11 cannot combine them with Generic
class KeyedProperty(Generic[KeyOf, Value]):
    """A number of keys that is interpolated between them."""

    value_of: Callable[[KeyOf], Value]
    tolerance: float  # two keys closer than this are equal
    # A key's own velocity per frame; None derives the velocity from the neighbouring keys.
    velocity: Callable[[KeyOf], Value | None] = lambda _: None
    # Values this far apart mean the same state, as a rotation by full turns; 0 if none do.
    period: float = 0.0

    def is_same(self, one: KeyOf, other: KeyOf) -> bool:
        """Return whether two keys have the same value."""
        return abs(self.value_of(one) - self.value_of(other)) <= self.tolerance

    def is_same_state(self, one: KeyOf, other: KeyOf) -> bool:
        """Return whether two keys have the same value, or values whole periods apart."""
        change = self.value_of(one) - self.value_of(other)
        if self.period and not isinstance(change, complex):
            change -= self.period * round(change / self.period)
        return abs(change) <= self.tolerance
