"""The shapes that tools draw over the drawing, and the names of cursors and colours.

The viewport draws every shape in the same way for all tools. Places and sizes are in the active
layer's coordinates, and widths of lines in em.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

Cursor = Literal["arrow", "hand", "move", "resize"]
ColourRole = Literal["accent", "text", "good", "warning", "danger"]  # of the theme's palette


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class LineShape:
    """A line through places, which stands out from any drawing."""

    points: Sequence[complex]
    role: ColourRole = "accent"
    opacity: float = 1.0
    closed: bool = False
    width: float = 0.16
    breadth: float = 0.0  # least width, in pixels of the picture


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class AreaShape:
    """A filled convex polygon."""

    points: Sequence[complex]
    role: ColourRole = "accent"
    opacity: float = 1.0


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class CircleShape:
    """A ring, which stands out from any drawing."""

    centre: complex
    radius: float
    role: ColourRole = "accent"
    opacity: float = 1.0
    width: float = 0.12


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class KnobShape:
    """A disc with a dark rim."""

    centre: complex
    radius: float
    role: ColourRole = "accent"


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class StrokeShape:
    """The area that a round brush covers on its way."""

    points: Sequence[complex]
    radius: float
    role: ColourRole = "accent"


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class TagShape:
    """A short text above a place, or beside the pointer."""

    text: str
    place: complex | None = None


OverlayShape = LineShape | AreaShape | CircleShape | KnobShape | StrokeShape | TagShape
