"""Cache of all in-betweens of a layer on one mesh, by content, and the next jobs."""

from collections.abc import Callable, Mapping, Sequence
from copy import copy
from dataclasses import dataclass, field
from functools import partial
from itertools import chain
from typing import Literal

from app.document import (
    Clip,
    Pose,
    pose_segments,
)
from app.motion.caches.cached_frames import CachedFrames
from app.motion.caches.inbetween_jobs import (
    CachedSegment,
    CacheUpdate,
    SeriesBuild,
    compute_frame,
    compute_segments,
)
from app.motion.caches.segment_memory import by_nearness
from app.motion.inbetweens.frame_corrector import needs_correction
from app.motion.inbetweens.pose_sampler import PoseSampler
from app.motion.inbetweens.segment_keys import SegmentKey
from engine.interpolation import InteriorKnot

EXPECTED = 100  # assumed bytes per vertex of a series before the first is built
# Parts of a clip that a job computes.
InbetweenPart = Literal["frame", "in-betweens", "fine", "series", "correction"]


@dataclass(slots=True, kw_only=True, eq=False)
class InbetweenCache(CachedFrames):
    """The in-betweens of a layer on a mesh, and the next jobs; for the main thread only.

    The content (`SegmentKey`) identifies a segment. Undo, copied keys and a variant tried again
    thus find earlier results. A segment has nothing, one frame, prepared in-betweens, or a series.
    Workers get frozen input; their results are taken whenever they arrive.
    """

    whole: Clip | None = None  # the newest clip of the document with complete in-betweens
    build: SeriesBuild | None = None  # an unfinished series while no worker builds it
    _failures: set[tuple[InbetweenPart, tuple[SegmentKey, ...]]] = field(
        init=False, default_factory=set
    )

    def velocity_shares(self, clip: Clip) -> Mapping[int, float]:
        """Return the share of its velocity that the limits allow at smooth keys, by frame.

        From 0, a stop, to 1; only for computed segments.
        """
        found: dict[int, float] = {}
        for number, segment in enumerate(pose_segments(clip)):
            known = self.segment(clip, number)
            if known is None or not known.is_ready:
                continue
            first = int(isinstance(segment.start, InteriorKnot))
            ends, keys = (segment.start, segment.end), segment.keys[first : first + 2]
            for end, key, kept in zip(ends, keys, known.velocity_shares or (1.0, 1.0), strict=True):
                if isinstance(end, InteriorKnot):
                    found[key.frame] = kept
        return found

    @property
    def nbytes(self) -> int:
        """Bytes of all cached segments."""
        return self.memory.nbytes

    def snapshot(self) -> "InbetweenCache":
        """Return a copy that a worker may read while this cache changes."""
        copied = copy(self)
        copied.memory = self.memory.snapshot()
        return copied

    def missing_segments(self, clip: Clip, frame: float, *, is_edited: bool = True) -> list[int]:
        """Return the numbers of segments to prepare, nearest first, each content once.

        For a layer that is not edited, a complete series is enough.
        """
        keys, nearest = self.memory.keys_of(clip), dict[SegmentKey, int]()
        for number in by_nearness(clip, frame):
            known = self.memory.find(keys[number])
            is_kept = is_edited or needs_correction(clip)
            if known is None or not (known.inbetweens or (known.is_streamed and not is_kept)):
                nearest.setdefault(keys[number], number)
        return list(nearest.values())

    def segments_job(
        self, clip: Clip, wanted: Sequence[int], sibling: PoseSampler | None = None
    ) -> Callable[[], CacheUpdate]:
        sampler, keep = self.sampler or sibling, self._poses()
        return partial(compute_segments, clip, wanted, self.mesh, sampler, keep=keep)

    def frame_job(self, clip: Clip, frame: float) -> Callable[[], CacheUpdate] | None:
        """Return the job for a single in-between; None if it is known or not possible.

        A single frame is not possible before the first in-betweens of a layer, which take longer.
        """
        layer, sampler = clip.layer, self.sampler
        if layer.domain is not self.mesh.source or self.is_exact(clip, frame):
            return None
        if needs_correction(clip):
            # Corrections need the whole segment.
            return None
        if sampler is None or not sampler.is_for(layer):
            return None
        return partial(compute_frame, clip, frame, self.mesh, sampler, keep=self._poses())

    def has_room(self) -> bool:
        """Return whether one more segment of the present clips fits into the budget."""
        memory = self.memory
        used = memory.other_bytes + memory.needed_bytes
        return used + memory.largest[0] <= memory.budget.limit

    def next_build(self, clip: Clip, frame: float, *, heat: bool) -> SeriesBuild | None:
        """Return the unfinished or next series to build, if any.

        Segments nearest to the frame come first. Segments beyond the budget get no series. With
        `heat`, series of the distortions are built too.
        """
        build, self.build = self.build, None
        if not self.has(clip):
            return None
        memory = self.memory
        keys, used = memory.keys_of(clip), memory.other_bytes + memory.needed_bytes
        if build is not None and build.segment_key in keys:
            return build
        usual = EXPECTED * len(self.mesh.domain.mesh.vertices)
        for key in dict.fromkeys(keys[number] for number in by_nearness(clip, frame)):
            known = memory.find(key)
            if known is None:
                continue
            for distortions, series in enumerate((known.series, known.distortions)):
                if series is not None:
                    used += memory.sizes_of(key)[1 + distortions]
                elif known.sites and known.inbetweens and (heat or not distortions):
                    if used + (memory.largest[1 + distortions] or usual) > memory.budget.limit:
                        return None
                    return SeriesBuild(key, known, distortions=bool(distortions))
        return None

    def set_needed_clips(
        self, present: Sequence[Clip], nearby: Sequence[Clip], frame: float
    ) -> None:
        """Set the playhead, the present clips, and the clips after undo and redo."""
        if self.memory.need(present, nearby, frame):
            there = self.memory.present.values()
            self._failures = {each for each in self._failures if each[1] in there}
        if self.whole != present[0] and self.has(present[0]):
            self.whole = present[0]

    def add(self, found: CacheUpdate) -> None:
        """Add the result of a job for any clip."""
        present, sampler = self.memory.present, found.sampler
        if sampler is not None and (
            not present or any(sampler.is_for(clip.layer) for clip in present)
        ):
            self.sampler = sampler
        for key, newer in found.segments.items():
            self.memory.add(key, newer)
        self.memory.budget.make_room()

    def add_build(self, build: SeriesBuild) -> None:
        """Take back a series, finished or not."""
        self.build = build if build.series is None else None
        if build.series is not None:
            positions, distortions = (
                (None, build.series) if build.distortions else (build.series, None)
            )
            built = CachedSegment(build.poses, series=positions, distortions=distortions)
            self.add(CacheUpdate(None, {build.segment_key: built}))

    def releasable_bytes(self, clip: Clip) -> int:
        """Return the bytes that `release_intermediates` frees once series show a complete clip."""
        if not self.has(clip) or needs_correction(clip):
            return 0
        memory = self.memory
        passing = [
            key
            for key in dict.fromkeys(memory.keys_of(clip))
            if (known := memory.find(key))
            and known.inbetweens
            and known.sites
            and (known.series is None or known.is_streamed)
        ]
        own = self.sampler.extension_bytes if self.sampler is not None else 0
        # Without segments, no series shows the pose.
        own += self.mesh.coordinates_bytes if memory.keys_of(clip) else 0
        return own + sum(memory.sizes_of(key)[0] for key in passing)

    def release_intermediates(self) -> None:
        """Free the prepared in-betweens of segments with a complete series."""
        for key, known in self.memory.items():
            if known.inbetweens is not None and known.is_streamed:
                self.memory.put(key, known._replace(inbetweens=None, single_frame=None))
        if self.memory.items() and all(known.is_streamed for _, known in self.memory.items()):
            self.mesh.forget_coordinates()
        if self.sampler is not None:
            prepared = (known.poses for _, known in self.memory.items() if known.inbetweens)
            self.sampler.keep_only(frozenset(chain(*prepared)))
            self.sampler.forget_extension()

    def mark_failed(self, part: InbetweenPart, clip: Clip) -> None:
        """Record that a part of a clip cannot be computed, until its keys change."""
        if self.memory.keys_of(clip) in self.memory.present.values():
            self._failures.add((part, self.memory.keys_of(clip)))

    def has_failed(self, clip: Clip, part: InbetweenPart = "in-betweens") -> bool:
        """Return whether a part of a clip is known to be impossible."""
        return bool(self._failures) and (part, self.memory.keys_of(clip)) in self._failures

    def _poses(self) -> frozenset[Pose]:
        """Return the poses whose samples are needed."""
        prepared = (known.poses for _, known in self.memory.items() if known.inbetweens)
        present = (key.pose for clip in self.memory.present for key in clip.keys)
        return frozenset(chain(*prepared, present))
