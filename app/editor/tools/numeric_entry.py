"""What is typed while the pointer drags: a number in place of its way, and an axis to keep to."""

import re
from dataclasses import dataclass
from typing import Final

# As people count pixels: x to the right, y down; the plane's y goes up.
AXES: Final[dict[str, complex]] = {"x": 1, "y": -1j}
ERASE: Final = "\b"
LONGEST = 12  # digits


@dataclass(slots=True)
class NumericEntry:
    """A number that is being typed, and the axis that is kept to: "x", "y", or empty for none."""

    text: str = ""
    axis: str = ""

    def type(self, characters: str) -> None:
        """Take what was typed; what makes no number is left out."""
        for character in characters.lower().replace(",", "."):
            if character in AXES:
                self.axis = "" if self.axis == character else character
            elif character == ERASE:
                self.text = self.text[:-1]
            elif character == "-":
                # As in Blender it turns the way round, wherever it is typed.
                self.text = self.text[1:] if self.text.startswith("-") else f"-{self.text}"
            elif re.fullmatch(r"-?\d*\.?\d*", self.text + character) and len(self.text) < LONGEST:
                self.text += character

    @property
    def value(self) -> float | None:
        """The number; None as long as there is none."""
        return float(self.text) if re.search(r"\d", self.text) else None

    @property
    def direction(self) -> complex | None:
        """The axis as a number of the plane; None where there is none."""
        return AXES.get(self.axis)

    def constrain_offset(self, offset: complex) -> complex:
        """Return the way that replaces the pointer's: kept to the axis, and as long as was typed.

        Without an axis a number is how far to go where the pointer goes, or to the right.
        """
        direction = self.direction
        if self.value is not None:
            ahead = offset / abs(offset) if offset else 1.0
            return self.value * (ahead if direction is None else direction)
        if direction is None:
            return offset
        return (offset * direction.conjugate()).real * direction

    def describe(self, unit: str) -> str:
        """Return what was typed, to be shown beside the pointer; empty where nothing was."""
        number = f"{self.text.replace('-', '−') or '…'} {unit}" if self.text else ""
        return " ".join(part for part in (self.axis.upper(), number) if part)
