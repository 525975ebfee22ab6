"""Springs: secondary motion of handles that lag behind their positions and swing."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from types import MappingProxyType

from app.document.checks import NOTHING, Unknown, require
from app.texts import N_

MAX_SPRING_FREQUENCY = 1000.0  # Hz
MAX_DAMPING = 100.0  # 1 is critical damping
MAX_LAG = 10_000.0  # frames
MAX_STRENGTH = 10.0


def require_oscillator(frequency: float, damping: float) -> None:
    """Refuse a frequency or a damping out of range."""
    require(
        0 < frequency <= MAX_SPRING_FREQUENCY,
        N_(
            "The frequency of a spring must be above 0 and at most {largest:,.0f} Hz, not "
            "{frequency:g}."
        ),
        largest=MAX_SPRING_FREQUENCY,
        frequency=frequency,
    )
    require(
        0 <= damping <= MAX_DAMPING,
        N_("The damping of a spring must be from 0 to {largest:g}, not {damping:g}."),
        largest=MAX_DAMPING,
        damping=damping,
    )


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
        require_oscillator(self.frequency, self.damping)
        require(
            0 <= self.lag <= MAX_LAG,
            N_("The lag of a spring must be from 0 to {largest:,.0f} frames, not {lag:g}."),
            largest=MAX_LAG,
            lag=self.lag,
        )
        require(
            0 <= self.strength <= MAX_STRENGTH,
            N_("The strength of a spring must be from 0 to {largest:g}, not {strength:g}."),
            largest=MAX_STRENGTH,
            strength=self.strength,
        )
        require(
            0 <= self.stretch <= 1,
            N_("The stretch of a spring must be from 0 to 1, not {stretch:g}."),
            stretch=self.stretch,
        )
        require(
            self.root != self.handle,
            N_("The root of a spring must be another handle than the spring's own."),
        )


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
