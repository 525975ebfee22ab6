"""The corrections of a clip's frames in a window: what is there, and what a worker finds next."""

from collections.abc import Callable, Mapping, Sequence
from functools import partial
from typing import NamedTuple

from app.document import Clip, Document, clip_of
from app.motion.inbetweens import (
    BaseMotionFrame,
    FrameCorrector,
    PoseSampler,
    SecondaryCorrection,
    have_same_base_frames,
    needs_correction,
)
from app.motion.parenting import find_parent_motion

BATCH = 2  # frames that are solved before a worker looks for more urgent work
BASE_FRAMES_AT_ONCE = 6  # the same of frames of which only the ground is wanted

Found = Mapping[int, SecondaryCorrection | None]


class CorrectionUpdate(NamedTuple):
    """What a worker has found: corrections and grounds by their frames, and by what."""

    corrections: FrameCorrector
    exact: Found
    base_frames: Mapping[int, BaseMotionFrame]


class CorrectedFrames:
    """The corrections of a clip's whole frames; of the main thread alone.

    Until a frame's own is there, what an earlier clip of the layer had there stands in for it.

    Attributes
    ----------
    clip : Clip
    """

    def __init__(self, clip: Clip, earlier: "CorrectedFrames | None" = None) -> None:
        self.clip = clip
        self._is_asked = needs_correction(clip)
        self._corrections: FrameCorrector | None = None
        self._exact: dict[int, SecondaryCorrection | None] = {}
        self._rough: dict[int, SecondaryCorrection | None] = {}
        self._grounds: dict[int, BaseMotionFrame] = {}
        # Of the frame that was watched last.
        self._latest: SecondaryCorrection | None = None
        if earlier is not None:
            self._take_over(earlier)

    def _take_over(self, earlier: "CorrectedFrames") -> None:
        """Take what an earlier clip's frames have as what stands in for these."""
        if have_same_base_frames(self.clip, earlier.clip):
            self._grounds, self._latest = earlier._grounds, earlier._latest  # noqa: SLF001 - its own
            if earlier._corrections is not None:  # noqa: SLF001
                self._corrections = earlier._corrections.with_tracks(self.clip)  # noqa: SLF001
        if not self._is_asked:
            return
        self._rough = {**earlier._rough, **earlier._exact}  # noqa: SLF001

    def at(self, clip: Clip, frame: int) -> SecondaryCorrection | None:
        """Return the best that is known of a frame of a clip; of another one there is nothing."""
        if clip != self.clip or not self._is_asked:
            return None
        return self._exact[frame] if frame in self._exact else self._rough.get(frame)

    def corrects(self, clip: Clip) -> bool:
        """Tell whether frames of a clip may be corrected."""
        return clip == self.clip and self._is_asked

    def is_exact(self, clip: Clip, frame: int) -> bool:
        """Tell whether that is what the frame has."""
        if clip != self.clip or not self._is_asked:
            return True
        return frame in self._exact

    def ground(self, frame: int) -> BaseMotionFrame | None:
        """Return what tracks are relative to at a frame, if that is known."""
        return self._grounds.get(frame)

    @property
    def is_begun(self) -> bool:
        """Whether what takes longest is done: a frame comes in moments from now on."""
        return self._corrections is not None

    @property
    def nbytes(self) -> int:
        """Bytes of what frames are found with."""
        return 0 if self._corrections is None else self._corrections.nbytes

    def rest(self) -> None:
        """Let go of what frames are found with, where all are there, until the next edit."""
        if self.is_whole:
            self._corrections = None

    @property
    def count_grounds(self) -> int:
        """Of how many frames that is known."""
        return len(self._grounds)

    @property
    def is_whole(self) -> bool:
        """Whether all frames of the clip are there."""
        return not self._is_asked or len(self._exact) >= len(self._frames)

    @property
    def _frames(self) -> range:
        return range(self.clip.frames.first, self.clip.frames.last + 1)

    @property
    def misses(self) -> Mapping[int, Mapping[int, float]]:
        """By how many pixels handles, by their ids, miss their tracks' wishes, by frames."""
        return {
            frame: each.target_errors
            for frame, each in self._exact.items()
            if each and each.target_errors
        }

    def lead(self, frame: int) -> None:
        """Let what was found last of tracks stand in at a frame until its own is there."""
        if self._latest is not None and frame not in self._exact:
            self._rough[frame] = self._latest

    def missing(
        self, document: Document, frame: int, siblings: Mapping[int, PoseSampler]
    ) -> Callable[[], CorrectionUpdate] | None:
        """Return what finds the corrections that are wanted next, the nearest to a frame first."""
        if self.is_whole or not self._is_known(siblings):
            return None
        lacking = [each for each in self._frames if each not in self._exact]
        lacking.sort(key=lambda each: abs(each - frame))
        begin = partial(_prepare, self._corrections, document, self.clip, siblings)
        return lambda: _find(begin(), lacking[:BATCH])

    def missing_here(
        self, document: Document, frame: int, siblings: Mapping[int, PoseSampler]
    ) -> Callable[[], CorrectionUpdate] | None:
        """Return what finds the correction of one frame, whatever else is missing."""
        if self.is_exact(self.clip, frame) or not self._is_known(siblings):
            return None
        begin = partial(_prepare, self._corrections, document, self.clip, siblings)
        return lambda: _find(begin(), [frame])

    def missing_ground(
        self, document: Document, frame: int, siblings: Mapping[int, PoseSampler]
    ) -> Callable[[], CorrectionUpdate] | None:
        """Return what finds the grounds that are wanted next, the nearest to a frame first.

        Without handles there is nothing that could be recorded.
        """
        lacking = [each for each in self._frames if each not in self._grounds]
        if not (lacking and self.clip.layer.handles and self._is_known(siblings)):
            return None
        lacking.sort(key=lambda each: abs(each - frame))
        begin = partial(_prepare, self._corrections, document, self.clip, siblings)
        return lambda: _find(begin(), [], lacking[:BASE_FRAMES_AT_ONCE])

    def _is_known(self, siblings: Mapping[int, PoseSampler]) -> bool:
        """Tell whether the window knows the outline.

        Its first in-betweens find out about it what is needed here, too.
        """
        return self.clip.layer.id in siblings or len(self.clip.keys) == 1

    def take(self, found: CorrectionUpdate, *, is_newest: bool = False) -> None:
        """Take in what a worker has found; what is of an earlier clip stands in for this one's.

        It is the newest where it is of the frame that a person watches.
        """
        clip = found.corrections.clip
        if not have_same_base_frames(self.clip, clip):
            return
        if self._corrections is None:
            self._corrections = found.corrections.with_tracks(self.clip)
        for frame, ground in found.base_frames.items():
            self._grounds.setdefault(frame, ground)
        (self._exact if clip == self.clip else self._rough).update(found.exact)
        for each in found.exact.values() if is_newest else ():
            self._latest = each


def _prepare(
    earlier: FrameCorrector | None,
    document: Document,
    clip: Clip,
    siblings: Mapping[int, PoseSampler],
) -> FrameCorrector:
    """Return a clip's corrections, the earlier ones if there are any."""
    if earlier is not None:
        return earlier
    layer = clip.layer
    sibling = siblings.get(layer.id)
    if sibling is None or sibling.domain.cage is not layer.domain.cage:
        sibling = PoseSampler(layer.domain, anchor=layer.anchor, points=layer.domain.outline)
    carried = find_parent_motion(document, layer.id, siblings)
    return FrameCorrector(clip, clip.layer.variant, sibling, carried)


def _find(
    corrections: FrameCorrector, frames: Sequence[int], grounds: Sequence[int] = ()
) -> CorrectionUpdate:
    """Find the corrections of some frames with their grounds, and the grounds of others."""
    exact = {frame: corrections.correction_at(frame) for frame in frames}
    known = {frame: corrections.base_frame_at(frame) for frame in (*frames, *grounds)}
    return CorrectionUpdate(corrections, exact, known)


def reuse_corrections(
    document: Document, layer: int, earlier: CorrectedFrames | None
) -> CorrectedFrames:
    """Return the corrections of a layer's clip; the earlier ones where the motion is the same."""
    clip = clip_of(document, layer)
    if earlier is not None and earlier.clip == clip:
        return earlier
    return CorrectedFrames(clip, earlier)
