"""Correction of a frame by tracks and springs."""

from collections.abc import Mapping
from dataclasses import dataclass, field

from engine.interpolation import CorrectionSeries


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class SecondaryCorrection:
    """The correction of a frame that brings handles with tracks and springs to their targets."""

    series: CorrectionSeries  # constant in time: the correction of this frame
    # In pixels by handle id, for handles with tracks.
    target_errors: Mapping[int, float] = field(default_factory=dict)
    targets: Mapping[int, complex] = field(default_factory=dict)  # of the same handles
    limits: tuple[str, ...] = ()  # that stop the handles; see `DistortionRange.reached`
    steps: int = 0  # total number of Newton steps

    @property
    def is_limited(self) -> bool:
        """Whether a limit stops a handle."""
        return bool(self.limits)

    @property
    def nbytes(self) -> int:
        """Memory of the functions in bytes."""
        return self.series.h.nbytes + self.series.q.nbytes
