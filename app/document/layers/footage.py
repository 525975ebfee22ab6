"""Footage: a video, an animated picture or numbered pictures that a layer shows in time."""

from bisect import bisect_right
from dataclasses import dataclass, field
from itertools import accumulate
from math import floor, isfinite
from typing import Final

from app.document.channels.values import FootageTime
from app.document.checks import NOTHING, Unknown, require, require_size
from app.texts import N_, _

SLOWEST_FOOTAGE, FASTEST_FOOTAGE = 0.01, 1000.0  # frames per second
MOST_PICTURES: Final = 100_000
# Share of a frame by which rounding may miss the beginning of a frame.
_NEARLY: Final = 1e-6


@dataclass(frozen=True, slots=True, kw_only=True)
class Footage:
    """Pictures that follow each other at a constant rate, and the files that hold them.

    A frame of the footage lasts 1 / `fps` seconds, and a picture one or more frames.
    """

    name: str  # of the file, or of the first numbered picture
    folder: str  # absolute path; project files store it relative to themselves
    # Names in the folder: one file of a video or an animated picture, or all numbered pictures.
    files: tuple[str, ...]
    size: tuple[int, int]  # width and height in pixels
    fps: float  # frames per second
    picture_count: int
    holds: tuple[int, ...] = ()  # frames that each picture lasts; () is one each
    unknown: Unknown = field(default_factory=lambda: NOTHING, repr=False, hash=False)
    # First frame after each picture, or () without holds.
    _ends: tuple[int, ...] = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        require_size(self.size, _("The footage"))
        require(
            isfinite(self.fps) and SLOWEST_FOOTAGE <= self.fps <= FASTEST_FOOTAGE,
            N_("Footage must have {least:g} to {most:g} frames a second, not {fps:g}."),
            least=SLOWEST_FOOTAGE,
            most=FASTEST_FOOTAGE,
            fps=self.fps,
        )
        require(
            1 <= self.picture_count <= MOST_PICTURES
            and bool(self.files)
            and len(self.files) in {1, self.picture_count}
            and len(self.holds) in {0, self.picture_count}
            and min(self.holds, default=1) >= 1,
            N_("The footage {name!r} is not described as one."),
            name=self.name,
        )
        object.__setattr__(self, "_ends", tuple(accumulate(self.holds)))

    @property
    def frame_count(self) -> int:
        return self._ends[-1] if self._ends else self.picture_count

    @property
    def seconds(self) -> float:
        return self.frame_count / self.fps

    @property
    def is_numbered(self) -> bool:
        """Whether each picture has a file of its own."""
        return len(self.files) > 1

    def frame_at(self, time: FootageTime, seconds: float) -> float:
        """Return the frame, with its fraction, some seconds after a key of the footage's time.

        Holds the first and the last frame, or loops. Before the key, its own frame holds.
        """
        frame = time.start + max(seconds, 0.0) * time.speed * self.fps
        if time.loops:
            return frame % self.frame_count
        return min(max(frame, 0.0), self.frame_count - 1.0)

    def picture_of(self, frame: float) -> int:
        """Return the number of the picture, from 0, that a frame shows."""
        whole = floor(frame + _NEARLY) % self.frame_count
        return bisect_right(self._ends, whole) if self._ends else whole
