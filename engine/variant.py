"""The variants of interpolation by name, their needs, and the rival methods."""

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


class Baseline(StrEnum):
    """Methods that the paper compares its variants with (Section 8); the names in files.

    `app.motion.rival_methods.preparation.prepare_baseline` builds them.
    """

    ARAP = "arap"
    FFMP = "ffmp"
    SIG13 = "sig13"
    HANDLES = "handles"
    CONFORMAL = "conformal"
    MESH_ETA = "mesh-eta"

    @property
    def needs_maps(self) -> bool:
        """Whether its keyframes must be harmonic maps; positions of a mesh do not suffice."""
        return self in {Baseline.HANDLES, Baseline.CONFORMAL}

    @property
    def unwraps(self) -> bool:
        """Whether it blends an angle of each triangle, whose branch must be chosen."""
        return self in {Baseline.ARAP, Baseline.MESH_ETA}
