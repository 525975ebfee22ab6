"""Easing: time within the segment between two keys."""

from collections.abc import Sequence
from dataclasses import dataclass
from math import inf
from reprlib import repr as shortened
from typing import Self

from app.errors import LissomError
from app.texts import _

# Halvings of [0, 1] until neighbouring doubles meet.
HALVINGS = 54


@dataclass(frozen=True, slots=True)
class Easing:
    """A monotone map of [0, 1] to itself, or a hold.

    Raises a `LissomError` if there are not four numbers, or one is outside [0, 1].
    """

    # x1, y1, x2, y2 of a cubic Bézier curve from (0, 0) to (1, 1). With all four in [0, 1], both
    # coordinates are monotone and the weight stays in [0, 1], which the distortion bounds require.
    # None holds the first key until the second key.
    curve: tuple[float, float, float, float] | None

    def __post_init__(self) -> None:
        if self.curve is None:
            return
        if not (len(self.curve) == 4 and all(0.0 <= value <= 1.0 for value in self.curve)):
            raise LissomError(
                _(
                    "An easing curve must be four numbers from 0 to 1, not {curve}. With other "
                    "numbers the in-betweens could exceed the limits."
                ).format(curve=shortened(self.curve))
            )
        # After the check, because an integer may be too large for a float.
        object.__setattr__(self, "curve", tuple(float(value) for value in self.curve))

    def __call__(self, s: float) -> float:
        """Return the weight of the second key at the fraction s of the segment."""
        if s <= 0.0:
            return 0.0
        if s >= 1.0:
            return 1.0
        if self.curve is None:
            return 0.0
        x1, y1, x2, y2 = self.curve
        if (x1, x2) == (y1, y2):
            return s
        # Bisection needs no slope (which may be 0 or infinite) and is exactly monotone in s despite
        # rounding of x.
        low, high = 0.0, 1.0
        for _step in range(HALVINGS):
            middle = (low + high) / 2
            if _bezier(x1, x2, middle) < s:
                low = middle
            else:
                high = middle
        return min(1.0, _bezier(y1, y2, high))

    @property
    def end_speeds(self) -> tuple[float, float]:
        """Slopes of the curve at the start and at the end, from 0 to infinity; 1 is linear.

        Both are 0 for a hold.
        """
        if self.curve is None:
            return 0.0, 0.0
        x1, y1, x2, y2 = self.curve
        return _end_speed((x1, y1), (x2, y2)), _end_speed(
            (1.0 - x2, 1.0 - y2), (1.0 - x1, 1.0 - y1)
        )

    def reversed(self) -> Self:
        """Return the easing of the segment played backwards; a hold stays a hold."""
        if self.curve is None:
            return self
        x1, y1, x2, y2 = self.curve
        return type(self)((1.0 - x2, 1.0 - y2, 1.0 - x1, 1.0 - y1))

    @property
    def name(self) -> str:
        """Name of the preset with this curve, or "custom"."""
        return next((name for name, preset in PRESETS.items() if preset == self), "custom")

    @classmethod
    def parse(cls, value: object) -> "Easing":
        """Return the easing for the name of a preset or a list of four numbers."""
        if isinstance(value, str):
            if value not in PRESETS:
                raise LissomError(
                    _(
                        "There is no easing {value}; choose one of {presets}, or give four "
                        "numbers from 0 to 1."
                    ).format(value=shortened(value), presets=", ".join(PRESETS))
                )
            return PRESETS[value]
        if not isinstance(value, Sequence) or not all(
            isinstance(number, (int, float)) and not isinstance(number, bool) for number in value
        ):
            raise LissomError(
                _("An easing must be a name or four numbers from 0 to 1, not {value}.").format(
                    value=shortened(value)
                )
            )
        return cls(tuple(value))

    def to_json(self) -> str | list[float]:
        """Return the value from which `parse` makes this easing."""
        name = self.name
        return name if self.curve is None or name != "custom" else list(self.curve)


def _end_speed(first: tuple[float, float], second: tuple[float, float]) -> float:
    """Return the slope of a curve at (0, 0) from its control points."""
    for x, y in (first, second):
        if x > 0.0:
            return y / x
        if y > 0.0:
            return inf
    return 1.0


def _bezier(first: float, second: float, parameter: float) -> float:
    rest = 1.0 - parameter
    return parameter * (3.0 * rest * (rest * first + parameter * second) + parameter * parameter)


LINEAR = Easing((0.0, 0.0, 1.0, 1.0))
HOLD = Easing(None)
PRESETS = {
    "linear": LINEAR,
    "in": Easing((0.42, 0.0, 1.0, 1.0)),
    "out": Easing((0.0, 0.0, 0.58, 1.0)),
    "in-out": Easing((0.42, 0.0, 0.58, 1.0)),
    "hold": HOLD,
}
