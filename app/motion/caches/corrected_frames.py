"""The corrections of a clip's frames in a window, and the jobs that compute them."""

from collections.abc import Callable, Mapping, Sequence
from functools import partial
from typing import NamedTuple

from app.document import Clip, Document, clip_of
from app.motion.inbetweens.frame_corrector import (
    BaseMotionFrame,
    FrameCorrector,
    have_same_base_frames,
    needs_correction,
)
from app.motion.inbetweens.pose_sampler import PoseSampler
from app.motion.inbetweens.secondary_correction import SecondaryCorrection
from app.motion.inbetweens.spring_offsets import ParentMotion
from app.motion.parenting.parent_transforms import find_parent_motion

BATCH = 2  # corrected frames per job, so that the worker soon takes more urgent jobs
BASE_FRAMES_AT_ONCE = 6  # base frames per job

Found = Mapping[float, SecondaryCorrection | None]


class CorrectionUpdate(NamedTuple):
    """Result of a job: corrections and base frames by frame, and their corrector."""

    corrections: FrameCorrector
    exact: Found
    base_frames: Mapping[int, BaseMotionFrame]


class CorrectedFrames:
    """The corrections of a clip's whole frames; for the main thread only.

    Until a frame's own correction is computed, the correction of an earlier clip replaces it.
    """

    def __init__(self, clip: Clip, earlier: "CorrectedFrames | None" = None) -> None:
        self.clip = clip
        self._is_asked = needs_correction(clip)
        self._corrections: FrameCorrector | None = None
        self._exact: dict[float, SecondaryCorrection | None] = {}
        self._rough: dict[float, SecondaryCorrection | None] = {}
        self._grounds: dict[int, BaseMotionFrame] = {}
        # Of the last displayed frame.
        self._latest: SecondaryCorrection | None = None
        if earlier is not None:
            self._take_over(earlier)

    def _take_over(self, earlier: "CorrectedFrames") -> None:
        """Take the frames of an earlier clip as replacements."""
        if have_same_base_frames(self.clip, earlier.clip):
            self._grounds = earlier._grounds  # noqa: SLF001 - its own
        if have_same_base_frames(self.clip, earlier.clip, values=False):
            self._latest = earlier._latest  # noqa: SLF001
            if earlier._corrections is not None:  # noqa: SLF001
                self._corrections = earlier._corrections.with_values(self.clip)  # noqa: SLF001
        # Corrections are functions of their own domain.
        if self._is_asked and earlier.clip.layer.domain is self.clip.layer.domain:
            self._rough = {**earlier._rough, **earlier._exact}  # noqa: SLF001

    def at(self, clip: Clip, frame: float) -> SecondaryCorrection | None:
        """Return the best known correction of a frame; None for another clip."""
        if clip != self.clip or not self._is_asked:
            return None
        return self._exact[frame] if frame in self._exact else self._rough.get(frame)

    def corrects(self, clip: Clip) -> bool:
        """Return whether the clip's frames may have corrections."""
        return clip == self.clip and self._is_asked

    def is_exact(self, clip: Clip, frame: float) -> bool:
        """Return whether `at` returns the frame's own correction."""
        if clip != self.clip or not self._is_asked:
            return True
        return frame in self._exact

    def compute(self, frame: float, sampler: PoseSampler, carried: ParentMotion) -> None:
        """Compute the correction of a frame, possibly fractional.

        The sampler belongs to the layer's domain; `carried` is the layer's transform by parents.
        """
        if self._corrections is None:
            self._corrections = FrameCorrector(self.clip, self.clip.layer.variant, sampler, carried)
        self._exact[frame] = self._corrections.correction_at(frame)

    def ground(self, frame: int) -> BaseMotionFrame | None:
        """Return the base frame that tracks are relative to, if computed."""
        return self._grounds.get(frame)

    @property
    def is_begun(self) -> bool:
        """Whether the slow preparation is done, so that a frame takes only moments."""
        return self._corrections is not None

    @property
    def nbytes(self) -> int:
        """Bytes of the data from which frames are computed."""
        return 0 if self._corrections is None else self._corrections.nbytes

    def rest(self) -> None:
        """Drop the data from which frames are computed, once all frames are known."""
        if self.is_whole:
            self._corrections = None

    @property
    def count_grounds(self) -> int:
        """Number of known base frames."""
        return len(self._grounds)

    @property
    def is_whole(self) -> bool:
        """Whether all frames of the clip are computed."""
        return not self._is_asked or len(self._exact) >= len(self._frames)

    @property
    def _frames(self) -> range:
        return range(self.clip.frames.first, self.clip.frames.last + 1)

    @property
    def misses(self) -> Mapping[int, Mapping[int, float]]:
        """Distances in pixels of handles from their track targets, by frame and handle id."""
        known = {frame: self._exact.get(frame) for frame in self._frames}
        return {
            frame: each.target_errors
            for frame, each in known.items()
            if each and each.target_errors
        }

    def lead(self, frame: int) -> None:
        """Use the last displayed correction at a frame until its own is computed."""
        if self._latest is not None and frame not in self._exact:
            self._rough[frame] = self._latest

    def missing(
        self, document: Document, frame: int, siblings: Mapping[int, PoseSampler]
    ) -> Callable[[], CorrectionUpdate] | None:
        """Return the next job for corrections, with the frames nearest to `frame` first, if any."""
        if self.is_whole or not self._is_known(siblings):
            return None
        lacking = [each for each in self._frames if each not in self._exact]
        lacking.sort(key=lambda each: abs(each - frame))
        begin = partial(_prepare, self._corrections, document, self.clip, siblings)
        return lambda: _find(begin(), lacking[:BATCH])

    def missing_here(
        self, document: Document, frame: int, siblings: Mapping[int, PoseSampler]
    ) -> Callable[[], CorrectionUpdate] | None:
        """Return the job for the correction of one frame, if needed."""
        if self.is_exact(self.clip, frame) or not self._is_known(siblings):
            return None
        begin = partial(_prepare, self._corrections, document, self.clip, siblings)
        return lambda: _find(begin(), [frame])

    def missing_ground(
        self, document: Document, frame: int, siblings: Mapping[int, PoseSampler]
    ) -> Callable[[], CorrectionUpdate] | None:
        """Return the next job for base frames, the nearest to `frame` first, if any.

        A layer without handles needs no base frames, since nothing can be recorded.
        """
        lacking = [each for each in self._frames if each not in self._grounds]
        if not (lacking and self.clip.layer.handles and self._is_known(siblings)):
            return None
        lacking.sort(key=lambda each: abs(each - frame))
        begin = partial(_prepare, self._corrections, document, self.clip, siblings)
        return lambda: _find(begin(), [], lacking[:BASE_FRAMES_AT_ONCE])

    def _is_known(self, siblings: Mapping[int, PoseSampler]) -> bool:
        """Return whether the outline's data is computed.

        The first in-betweens of the window compute it.
        """
        return self.clip.layer.id in siblings or len(self.clip.keys) == 1

    def take(self, found: CorrectionUpdate, *, is_newest: bool = False) -> None:
        """Take the result of a job; a result for an earlier clip becomes a replacement.

        `is_newest` marks the frame that is displayed.
        """
        clip = found.corrections.clip
        if not have_same_base_frames(self.clip, clip, values=False):
            return
        if self._corrections is None:
            self._corrections = found.corrections.with_values(self.clip)
        if have_same_base_frames(self.clip, clip):
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
    if earlier is not None:
        return earlier
    layer = clip.layer
    sibling = siblings.get(layer.id)
    if sibling is None or not sibling.is_for(layer):
        sibling = PoseSampler(layer, points=layer.domain.outline, sibling=sibling)
    carried = find_parent_motion(document, layer.id, siblings)
    return FrameCorrector(clip, clip.layer.variant, sibling, carried)


def _find(
    corrections: FrameCorrector, frames: Sequence[int], grounds: Sequence[int] = ()
) -> CorrectionUpdate:
    """Compute corrections with base frames for some frames, and base frames for others."""
    exact: Found = {frame: corrections.correction_at(frame) for frame in frames}
    known = {frame: corrections.base_frame_at(frame) for frame in (*frames, *grounds)}
    return CorrectionUpdate(corrections, exact, known)


def reuse_corrections(
    document: Document, layer: int, earlier: CorrectedFrames | None
) -> CorrectedFrames:
    """Return the corrections of a layer's clip; the earlier object if the motion is the same."""
    clip = clip_of(document, layer)
    if earlier is not None and earlier.clip == clip:
        return earlier
    return CorrectedFrames(clip, earlier)
