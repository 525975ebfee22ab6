"""The variants of interpolation by name, what each needs, and what they are compared with."""

from enum import StrEnum


class Variant(StrEnum):
    """How the derivatives of two keyframes are blended; the values are the names in files.

    `engine.interpolation.prepare_inbetweens` builds them.
    """

    METRIC = "metric"
    NU = "nu"
    SCALED_ETA = "scaled-eta"
    ETA = "eta"
    LINEAR = "linear"

    @property
    def needs_transform(self) -> bool:
        """Whether it needs the Hilbert transform of the outline."""
        return self is Variant.METRIC

    @property
    def is_scaled(self) -> bool:
        """Whether its Ψ is scaled by a ρ."""
        return self is Variant.SCALED_ETA


class Baseline(StrEnum):
    """Methods that the paper compares its variants with (Section 8); the names in files.

    `engine.baselines.prepare_baseline` builds them.
    """

    ARAP = "arap"
    FFMP = "ffmp"
    SIG13 = "sig13"
    HANDLES = "handles"
    CONFORMAL = "conformal"
    MESH_ETA = "mesh-eta"

    @property
    def needs_maps(self) -> bool:
        """Whether its keyframes must be harmonic maps; positions of a mesh do not do."""
        return self in {Baseline.HANDLES, Baseline.CONFORMAL}

    @property
    def unwraps(self) -> bool:
        """Whether it blends an angle of each triangle, which has a branch to choose."""
        return self in {Baseline.ARAP, Baseline.MESH_ETA}
