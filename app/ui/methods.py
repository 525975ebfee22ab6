"""The methods of interpolation as a person reads of them."""

from typing import NamedTuple

from app.document import Variant


class MethodText(NamedTuple):
    """A method's name, what it is known for, and what it does."""

    name: str
    trait: str
    what: str

    @property
    def title(self) -> str:
        """The name with its trait, for lists."""
        return f"{self.name} – {self.trait}"


METHODS: dict[Variant, MethodText] = {
    Variant.METRIC: MethodText(
        "Metric", "smooth, bounded", "Stretch and shear stay within those of the keys"
    ),
    Variant.NU: MethodText(
        "Nu (ν)", "even shear", "Shear stays within that of the keys, stretch nearly so"
    ),
    Variant.SCALED_ETA: MethodText(
        "Scaled eta (η)", "bounded", "As eta, held within the limits of the keys"
    ),
    Variant.ETA: MethodText(
        "Eta (η)", "may overshoot", "May leave the limits of the keys; for comparison"
    ),
    Variant.LINEAR: MethodText("Linear", "may fold", "Every point goes straight; for comparison"),
}
