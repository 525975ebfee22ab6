"""Where the animation stands, as a function of the clock's reading."""

import math
from dataclasses import dataclass, replace
from typing import Self

from app.document.model import Document
from app.errors import LissomError

# Of a frame: clocks read n / fps to within rounding, and that is frame n.
SLACK = 1e-6


@dataclass(frozen=True, slots=True, kw_only=True)
class Playhead:
    """A frame that stands, or runs since a reading of the clock."""

    frame: int = 0  # where it stands, or where it started
    # Reading of the clock in seconds when it started; None while it stands.
    since: float | None = None
    speed: float = 1.0  # times the document's own; negative runs backwards

    def __post_init__(self) -> None:
        if self.speed == 0 or not math.isfinite(self.speed):
            raise LissomError(f"The speed of play must be a number other than 0, not {self.speed}.")

    def frame_at(self, document: Document, now: float) -> int:
        """Return the frame that is shown when the clock reads `now`.

        A loop comes round: the whole of it without showing its last frame, which is its first one
        again; a part of it with all its frames. Anything else stops at the end.
        """
        if self.since is None:
            return self.frame
        played = document.played_frames
        run = self.frame + self._gone(document, now)
        if not document.loop:
            return played.clamp(run)
        length = played.last - played.first + (0 if played == document.frames else 1)
        return played.first + (run - played.first) % max(1, length)

    def is_over(self, document: Document, now: float) -> bool:
        """Tell whether it has run to the end, where nothing comes after."""
        if self.since is None or document.loop:
            return False
        run = self.frame + self._gone(document, now)
        return (
            run >= document.played_frames.last
            if self.speed > 0
            else run <= document.played_frames.first
        )

    def play(self, document: Document, now: float) -> Self:
        """Return the playhead that starts now, from the beginning if it stands at the end."""
        played = document.played_frames
        begin, end = (played.first, played.last)[:: 1 if self.speed > 0 else -1]
        frame = self.frame_at(document, now)
        starts_over = frame not in played or frame == end
        return replace(self, frame=begin if starts_over else frame, since=now)

    def pause(self, document: Document, now: float) -> Self:
        """Return the playhead that stands where it is now."""
        return replace(self, frame=self.frame_at(document, now), since=None)

    def seek(self, frame: int, now: float) -> Self:
        """Return the playhead at a frame, running on from there if it runs."""
        return replace(self, frame=frame, since=None if self.since is None else now)

    def at_speed(self, speed: float, document: Document, now: float) -> Self:
        """Return the playhead that goes on from where it is at another speed."""
        frame = self.frame_at(document, now)
        return replace(self.seek(frame, now), speed=speed)

    def _gone(self, document: Document, now: float) -> int:
        since = now if self.since is None else self.since
        return math.floor((now - since) * document.fps * self.speed + SLACK)
