"""The rival methods of interpolation by name, and their needs."""

from enum import StrEnum


class Baseline(StrEnum):
    """Methods that the paper compares its variants with (Section 8); the names in files.

    `app.motion.prepare_baseline` builds them.
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
