"""The change of a frame by sliders, tracks and springs."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import NamedTuple

from app.document import Pose
from engine.arrays import nbytes_of
from engine.interpolation import CorrectionSeries
from engine.sliders import FrameSolution


class SolvedSliders(NamedTuple):
    """The curbed weights of poses with their full turns."""

    solution: FrameSolution
    poses: tuple[tuple[Pose, int], ...]


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class SecondaryCorrection:
    """Sliders of a frame, and the correction that brings handles to targets of tracks and springs.

    `sliders` come first.
    """

    sliders: SolvedSliders | None = None
    series: CorrectionSeries | None = None  # constant in time: the correction of this frame
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
        return nbytes_of((self.sliders and self.sliders.solution, self.series))
