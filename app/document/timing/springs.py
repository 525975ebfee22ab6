"""Springs: handles that follow their place in the motion late, and swing about it."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from types import MappingProxyType

from app.document.checks import NOTHING, Unknown, require

MAX_SPRING_FREQUENCY = 1000.0  # Hz
MAX_DAMPING = 100.0  # of the critical one
MAX_LAG = 10_000.0  # frames
MAX_STRENGTH = 10.0


@dataclass(frozen=True, slots=True, kw_only=True)
class Spring:
    """How a handle follows: a damped oscillator that the motion of its own place drives."""

    handle: int  # its id
    frequency: float  # in Hz
    damping: float  # 1 is critical: it comes back without swinging over
    lag: float = 0.0  # frames
    strength: float = 1.0  # how far it swings, 1 as the oscillator does
    # The id of the handle about which it swings; None is the one that `root_of` finds.
    root: int | None = None
    # How far it may leave its distance from the root: 0 keeps it, 1 swings freely, root or not.
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


# By name: frequency and damping. Measured on the samples' tails and ears; the others are between.
SPRING_PRESETS: Mapping[str, tuple[float, float]] = MappingProxyType(
    {
        "tail": (1.6, 0.18),
        "ear": (3.0, 0.25),
        "hair": (2.2, 0.35),
        "cloth": (1.3, 0.5),
        "jelly": (4.5, 0.12),
    }
)
