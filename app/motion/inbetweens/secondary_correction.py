"""Correction of a frame by tracks and springs."""

from collections.abc import Mapping
from dataclasses import dataclass, field

from engine.interpolation import CorrectionSeries


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class SecondaryCorrection:
    """The correction of a frame that brings handles with tracks and springs to their targets.

    Parameters
    ----------
    series : CorrectionSeries
        Constant in time: the correction of this frame.
    target_errors : mapping of int to float
        In pixels, for handles with tracks, by handle id.
    targets : mapping of int to complex
        Targets of the same handles.
    limits : tuple of str
        Names of the limits that stop the handles; see `DistortionRange.reached`.
    steps : int
        Total number of Newton steps.
    """

    series: CorrectionSeries
    target_errors: Mapping[int, float] = field(default_factory=dict)
    targets: Mapping[int, complex] = field(default_factory=dict)
    limits: tuple[str, ...] = ()
    steps: int = 0

    @property
    def is_limited(self) -> bool:
        """Whether a limit stops a handle."""
        return bool(self.limits)

    @property
    def nbytes(self) -> int:
        """Memory of the functions in bytes."""
        return self.series.h.nbytes + self.series.q.nbytes
