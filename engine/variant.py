"""The variants of interpolation by name, and their needs."""

from enum import StrEnum


class Variant(StrEnum):
    """Ways to blend the derivatives of two keyframes; the values are the names in files.

    `engine.interpolation.prepare_inbetweens` builds them.
    """

    METRIC = "metric"
    NU = "nu"
    SCALED_ETA = "scaled-eta"
    ETA = "eta"
    LINEAR = "linear"

    @property
    def needs_transform(self) -> bool:
        """Whether the variant needs the Hilbert transform of the outline."""
        return self is Variant.METRIC

    @property
    def is_scaled(self) -> bool:
        """Whether its Ψ is scaled by a ρ."""
        return self is Variant.SCALED_ETA
