"""Springs: secondary motion of handles that lag behind their positions and swing."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from types import MappingProxyType

from app.document.checks import NOTHING, Unknown, require

MAX_SPRING_FREQUENCY = 1000.0  # Hz
MAX_DAMPING = 100.0  # 1 is critical damping
MAX_LAG = 10_000.0  # frames
MAX_STRENGTH = 10.0


@dataclass(frozen=True, slots=True, kw_only=True)
class Spring:
    """A damped oscillator that moves a handle, driven by the motion of the handle's position."""

    handle: int  # handle id
    frequency: float  # in Hz
    damping: float  # 1 is critical damping, without overshoot
    lag: float = 0.0  # frames
    strength: float = 1.0  # factor of the displacement
    # Id of the handle about which the handle swings; None takes the result of `spring_root`.
    root: int | None = None
    # Freedom of the distance from the root: 0 keeps the distance, 1 ignores the root.
    stretch: float = 0.0
    enabled: bool = True
    unknown: Unknown = field(default_factory=lambda: NOTHING, repr=False, hash=False)

    def __post_init__(self) -> None:
        require(
            0 < self.frequency <= MAX_SPRING_FREQUENCY,
            f"The frequency of a spring is above 0 and at most {MAX_SPRING_FREQUENCY:,.0f} Hz, not "
            f"{self.frequency:g}.",
        )
        require(
            0 <= self.damping <= MAX_DAMPING,
            f"The damping of a spring is from 0 to {MAX_DAMPING:g}, not {self.damping:g}.",
        )
        require(
            0 <= self.lag <= MAX_LAG,
            f"The lag of a spring is from 0 to {MAX_LAG:,.0f} frames, not {self.lag:g}.",
        )
        require(
            0 <= self.strength <= MAX_STRENGTH,
            f"The strength of a spring is from 0 to {MAX_STRENGTH:g}, not {self.strength:g}.",
        )
        require(
            0 <= self.stretch <= 1,
            f"The stretch of a spring is between 0 and 1, not {self.stretch:g}.",
        )
        require(self.root != self.handle, "A spring swings about another handle than its own.")


# Frequency and damping by name. "tail" and "ear" are measured on the samples, the others are chosen
# between them.
SPRING_PRESETS: Mapping[str, tuple[float, float]] = MappingProxyType(
    {
        "tail": (1.6, 0.18),
        "ear": (3.0, 0.25),
        "hair": (2.2, 0.35),
        "cloth": (1.3, 0.5),
        "jelly": (4.5, 0.12),
    }
)
