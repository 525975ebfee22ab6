"""The corrections of a clip's frames in a window: what is there, and what a worker finds next."""

from collections.abc import Callable, Mapping
from functools import partial
from typing import NamedTuple

from app.document import Clip, Document, clip_of
from app.motion.inbetweens import Corrections, FrameCorrection, PoseSampler, is_corrected
from app.motion.joints import carried_in

BATCH = 2  # frames that are solved before a worker looks for more urgent work
MOST_ROUGH = 2_000  # frames of which the rigid motion is worked out ahead

Found = Mapping[int, FrameCorrection | None]


class FoundCorrections(NamedTuple):
    """What a worker has found: corrections by their frames, and by what."""

    corrections: Corrections
    frames: Found
    is_rough: bool


class CorrectedFrames:
    """The corrections of a clip's whole frames; of the main thread alone.

    Until a frame's own is there, its rigid motion stands in for it, or else what an earlier clip of
    the figure had there.

    Attributes
    ----------
    clip : Clip
    """

    def __init__(self, clip: Clip, earlier: "CorrectedFrames | None" = None) -> None:
        self.clip = clip
        self._is_asked = is_corrected(clip)
        self._corrections: Corrections | None = None
        self._exact: dict[int, FrameCorrection | None] = {}
        self._rough: dict[int, FrameCorrection | None] = {}
        if earlier is not None and self._is_asked:
            self._rough = {**earlier._rough, **earlier._exact}  # noqa: SLF001 - its own

    def at(self, clip: Clip, frame: int) -> FrameCorrection | None:
        """Return the best that is known of a frame of a clip; of another one there is nothing."""
        if clip != self.clip or not self._is_asked:
            return None
        return self._exact[frame] if frame in self._exact else self._rough.get(frame)

    def corrects(self, clip: Clip) -> bool:
        """Tell whether frames of a clip may be corrected."""
        return clip == self.clip and self._is_asked

    def is_exact(self, clip: Clip, frame: int) -> bool:
        """Tell whether that is what the frame has."""
        return clip != self.clip or not self._is_asked or frame in self._exact

    @property
    def is_whole(self) -> bool:
        """Whether all frames of the clip are there."""
        frames = self.clip.frames
        return not self._is_asked or len(self._exact) > frames.last - frames.first

    @property
    def misses(self) -> Mapping[int, Mapping[int, float]]:
        """By how many pixels handles, by their ids, miss their tracks' wishes, by frames."""
        return {frame: each.misses for frame, each in self._exact.items() if each and each.misses}

    def missing(
        self, document: Document, frame: int, siblings: Mapping[int, PoseSampler]
    ) -> Callable[[], FoundCorrections] | None:
        """Return what finds the corrections that are wanted next, the nearest to a frame first."""
        # The first in-betweens of the window find out about the outline what is needed here, too.
        is_known = self.clip.figure.id in siblings or len(self.clip.keys) == 1
        if self.is_whole or not is_known:
            return None
        if self._corrections is None:
            return partial(_begin, document, self.clip, siblings)
        frames = range(self.clip.frames.first, self.clip.frames.last + 1)
        lacking = [each for each in frames if each not in self._exact]
        lacking.sort(key=lambda each: abs(each - frame))
        return partial(_solve, self._corrections, lacking[:BATCH])

    def take(self, found: FoundCorrections) -> None:
        """Take in what a worker has found."""
        self._corrections = found.corrections
        (self._rough if found.is_rough else self._exact).update(found.frames)


def _begin(document: Document, clip: Clip, siblings: Mapping[int, PoseSampler]) -> FoundCorrections:
    """Prepare a clip's corrections, and find the rigid motion of its frames."""
    figure = clip.figure
    sibling = siblings.get(figure.id)
    if sibling is None or sibling.domain.cage is not figure.domain.cage:
        sibling = PoseSampler(figure.domain, anchor=figure.anchor, points=figure.domain.outline)
    carried = carried_in(document, figure.id, siblings)
    corrections = Corrections(clip, clip.figure.variant, sibling, carried)
    frames = range(clip.frames.first, clip.frames.last + 1)[:MOST_ROUGH]
    return FoundCorrections(
        corrections, {frame: corrections.rigid_at(frame) for frame in frames}, is_rough=True
    )


def _solve(corrections: Corrections, frames: list[int]) -> FoundCorrections:
    found = {frame: corrections.at(frame) for frame in frames}
    return FoundCorrections(corrections, found, is_rough=False)


def corrected_clip(
    document: Document, figure: int, earlier: CorrectedFrames | None
) -> CorrectedFrames:
    """Return the corrections of a figure's clip; the earlier ones where the motion is the same."""
    clip = clip_of(document, figure)
    if earlier is not None and earlier.clip == clip:
        return earlier
    return CorrectedFrames(clip, earlier)
