"""The visible range of time."""

from dataclasses import dataclass, replace
from typing import Self

from app.document import FrameRange

SMALLEST, LARGEST = 0.002, 4.0  # em per frame
MARGIN = 1.4  # em left and right of fitted frames
ROOM = 0.04  # of the width: space right of the last frame for dragged keys


@dataclass(frozen=True, slots=True)
class TimeRangeView:
    """The visible range of time."""

    start: float  # frame at the left edge
    scale: float  # em per frame

    @classmethod
    def fitting(cls, frames: FrameRange, width: float) -> Self:
        """Return the range that shows all frames in a width in em."""
        free = max(width * (1 - ROOM) - 2 * MARGIN, 1.0)
        scale = min(free / max(frames.last - frames.first, 1), LARGEST)
        return cls(frames.first - MARGIN / scale, scale)

    def place(self, frame: float) -> float:
        """Return a frame's distance from the left edge, in em."""
        return (frame - self.start) * self.scale

    def frame(self, place: float) -> float:
        """Return the frame at a place in em."""
        return self.start + place / self.scale

    def zoomed(self, factor: float, place: float) -> Self:
        """Return the range with a frame width scaled by a factor, fixed at `place`."""
        scale = min(max(self.scale * factor, SMALLEST), LARGEST)
        return replace(self, start=self.frame(place) - place / scale, scale=scale)

    def panned(self, by: float) -> Self:
        """Return the range moved by em to later frames."""
        return replace(self, start=self.start + by / self.scale)

    def kept_near(self, frames: FrameRange, width: float) -> Self:
        """Return the range moved so that at least half of the width shows the frames' range."""
        half = width / 2 / self.scale
        return replace(self, start=min(max(self.start, frames.first - half), frames.last - half))

    def showing(self, frame: float, width: float, *, turns: bool) -> Self:
        """Return the range moved to show a frame; unchanged if it is visible.

        Parameters
        ----------
        width : float
            In em.
        turns : bool
            Whether to move by a whole page instead of the least distance.
        """
        place = self.place(frame)
        if 0 <= place <= width:
            return self
        if turns:
            return self.panned(place - MARGIN)
        return self.panned(place if place < 0 else place - width)
