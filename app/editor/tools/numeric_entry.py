"""Typed numbers and axes that replace the pointer's offset during a drag."""

import re
from dataclasses import dataclass
from typing import Final

from app.editor.overlay_shapes import LineShape, OverlayShape, TagShape

# Typed pixels have x to the right and y down; the scene's y goes up.
AXES: Final[dict[str, complex]] = {"x": 1, "y": -1j}
ERASE: Final = "\b"
LONGEST = 12  # digits
FAR = 1e5  # pixels: half the length of the line that shows a locked axis


@dataclass(slots=True)
class NumericEntry:
    """A typed number, and the locked axis: "x", "y", or empty for none."""

    text: str = ""
    axis: str = ""

    def type(self, characters: str) -> None:
        """Add typed characters; characters that make no number are ignored."""
        for character in characters.lower().replace(",", "."):
            if character in AXES:
                self.axis = "" if self.axis == character else character
            elif character == ERASE:
                self.text = self.text[:-1]
            elif character == "-":
                # As in Blender, a minus typed anywhere changes the sign.
                self.text = self.text[1:] if self.text.startswith("-") else f"-{self.text}"
            elif re.fullmatch(r"-?\d*\.?\d*", self.text + character) and len(self.text) < LONGEST:
                self.text += character

    def type_number(self, characters: str) -> float | None:
        """Add typed characters but no axis, and return the number, if any."""
        self.type(characters)
        self.axis = ""
        return self.value

    @property
    def value(self) -> float | None:
        """The number; None if no number is typed."""
        return float(self.text) if re.search(r"\d", self.text) else None

    @property
    def direction(self) -> complex | None:
        """The axis as a unit vector of the scene; None without an axis."""
        return AXES.get(self.axis)

    def constrain_offset(self, offset: complex) -> complex:
        """Return the pointer's offset, projected to the axis and set to the typed length.

        Without an axis, the typed length goes in the pointer's direction, or to the right.
        """
        direction = self.direction
        if self.value is not None:
            ahead = offset / abs(offset) if offset else 1.0
            return self.value * (ahead if direction is None else direction)
        if direction is None:
            return offset
        return (offset * direction.conjugate()).real * direction

    def describe(self, unit: str) -> str:
        """Return the typed text for display beside the pointer; empty if nothing is typed."""
        number = f"{self.text.replace('-', '−') or '…'} {unit}" if self.text else ""
        return " ".join(part for part in (self.axis.upper(), number) if part)

    def shapes(self, start: complex, unit: str) -> list[OverlayShape]:
        """Return the locked axis through a place, and the typed text beside the pointer."""
        text, direction = self.describe(unit), self.direction
        if not text:
            return []
        ends = [] if direction is None else [start - FAR * direction, start + FAR * direction]
        return [LineShape(points=ends, width=0.12), TagShape(text=text)]
