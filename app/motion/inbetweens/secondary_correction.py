"""What tracks and springs change of a frame of the motion from key to key."""

from collections.abc import Mapping
from dataclasses import dataclass, field

from engine.interpolation import CorrectionSeries


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class SecondaryCorrection:
    """The correction of a frame by which tracks and springs have their handles where they want.

    Parameters
    ----------
    known : CorrectionSeries
        The same at all times: of this frame.
    misses : mapping of int to float
        Target errors in pixels, of handles with tracks, by their ids.
    wishes : mapping of int to complex
        The targets of the same handles.
    limits : tuple of str
        The limits that stop it, in words; see `Extremes.reached`.
    steps : int
        Newton's, of all that was solved.
    """

    series: CorrectionSeries
    target_errors: Mapping[int, float] = field(default_factory=dict)
    targets: Mapping[int, complex] = field(default_factory=dict)
    limits: tuple[str, ...] = ()
    steps: int = 0

    @property
    def is_limited(self) -> bool:
        """Whether a limit stops it."""
        return bool(self.limits)

    @property
    def nbytes(self) -> int:
        """Memory of the functions."""
        return self.series.h.nbytes + self.series.q.nbytes
