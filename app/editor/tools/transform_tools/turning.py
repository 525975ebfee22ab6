"""The angle of a drag around a centre, by the pointer or by typed degrees."""

import cmath
import math
from dataclasses import dataclass, field

from app.editor.overlay_shapes import OverlayShape
from app.editor.tools.numeric_entry import NumericEntry

STEP = math.radians(15.0)  # step of a rotation that snaps


@dataclass(slots=True, kw_only=True)
class Turning:
    """A rotation around a centre since the press at `start`; full turns add up."""

    centre: complex
    start: complex
    angle: float = 0.0  # in radians
    entry: NumericEntry = field(default_factory=NumericEntry)  # typed degrees

    def follow(self, place: complex, *, snaps: bool) -> bool:
        """Turn to the pointer's place; return whether the pointer decides the angle."""
        ratio = (place - self.centre) / ((self.start - self.centre) or 1)
        if not ratio or self.entry.value is not None:
            return False
        # The nearest angle to the present one, so that full turns add up.
        angle = self.angle + cmath.phase(ratio * cmath.exp(-1j * self.angle))
        self.angle = STEP * round(angle / STEP) if snaps else angle
        return True

    def type(self, characters: str) -> bool:
        """Turn by the typed degrees; return whether a number is typed."""
        degrees = self.entry.type_number(characters)
        if degrees is not None:
            self.angle = math.radians(degrees)
        return degrees is not None

    @property
    def text(self) -> str:
        """The angle in degrees, with its sign."""
        degrees = round(math.degrees(self.angle))
        return f"{degrees:+d}°".replace("-", "−") if degrees else "0°"

    def entry_shapes(self, centre: complex) -> list[OverlayShape]:
        """Return the typed degrees beside the pointer."""
        return self.entry.shapes(centre, "°")
