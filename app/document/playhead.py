"""The current frame as a function of the clock."""

import math
from dataclasses import dataclass, replace
from typing import Self

from app.document.model import Document
from app.errors import LissomError
from app.texts import _

# Frames. A clock reading of n / fps counts as frame n despite rounding.
SLACK = 1e-6


def loop_length(document: Document) -> int:
    """Return the number of frames after which playback begins anew in a loop.

    A loop of the whole animation skips the last frame, which equals the first. A loop of the
    preview range shows all its frames.
    """
    played = document.played_frames
    return max(1, played.last - played.first + (0 if played == document.frames else 1))


@dataclass(frozen=True, slots=True, kw_only=True)
class Playhead:
    """A playhead that is stopped at a frame, or playing since a clock reading."""

    frame: int = 0  # current frame if stopped, first frame if playing
    # Clock reading in seconds at the start of playback; None while stopped.
    since: float | None = None
    speed: float = 1.0  # factor of the document's rate; negative plays backwards

    def __post_init__(self) -> None:
        if self.speed == 0 or not math.isfinite(self.speed):
            raise LissomError(
                _("The playback speed must be a number other than 0, not {speed}.").format(
                    speed=self.speed
                )
            )

    def frame_at(self, document: Document, now: float) -> int:
        """Return the frame that is shown at clock reading `now`.

        Without a loop, playback stops at the end.
        """
        if self.since is None:
            return self.frame
        played = document.played_frames
        run = self.frame + self._gone(document, now)
        if not document.loop:
            return played.clamp(run)
        return played.first + (run - played.first) % loop_length(document)

    def is_over(self, document: Document, now: float) -> bool:
        """Return whether playback without a loop has reached the end."""
        if self.since is None or document.loop:
            return False
        run = self.frame + self._gone(document, now)
        return (
            run >= document.played_frames.last
            if self.speed > 0
            else run <= document.played_frames.first
        )

    def play(self, document: Document, now: float) -> Self:
        """Return the playhead playing from `now`; it restarts if it is at the end."""
        played = document.played_frames
        begin, end = (played.first, played.last)[:: 1 if self.speed > 0 else -1]
        frame = self.frame_at(document, now)
        starts_over = frame not in played or frame == end
        return replace(self, frame=begin if starts_over else frame, since=now)

    def pause(self, document: Document, now: float) -> Self:
        """Return the playhead stopped at the current frame."""
        return replace(self, frame=self.frame_at(document, now), since=None)

    def seek(self, frame: int, now: float) -> Self:
        """Return the playhead at a frame, still playing if it plays."""
        return replace(self, frame=frame, since=None if self.since is None else now)

    def at_speed(self, speed: float, document: Document, now: float) -> Self:
        """Return the playhead at the current frame with another speed."""
        frame = self.frame_at(document, now)
        return replace(self.seek(frame, now), speed=speed)

    def _gone(self, document: Document, now: float) -> int:
        since = now if self.since is None else self.since
        return math.floor((now - since) * document.fps * self.speed + SLACK)
