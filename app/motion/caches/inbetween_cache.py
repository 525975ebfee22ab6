"""Cache of all in-betweens of a layer on one mesh, by content, and the next jobs."""

from collections.abc import Callable, Mapping, Sequence
from copy import copy
from dataclasses import InitVar, dataclass, field
from functools import partial
from itertools import chain
from typing import Literal

import numpy as np

from app.document import (
    Clip,
    Pose,
    SegmentTime,
    keyed_pose_at,
    pose_segments,
    segment_keys,
    segment_time_at,
)
from app.motion.caches.inbetween_jobs import (
    AnyInbetweens,
    CachedSegment,
    CacheUpdate,
    SeriesBuild,
    SingleFrame,
    compute_frame,
    compute_segments,
)
from app.motion.caches.segment_memory import MemoryBudget, SegmentMemory, by_nearness
from app.motion.inbetweens.frame_corrector import needs_correction
from app.motion.inbetweens.pose_sampler import PoseSampler
from app.motion.inbetweens.secondary_correction import SecondaryCorrection
from app.motion.inbetweens.segment_keys import SegmentKey, segment_key
from app.motion.inbetweens.slider_stage import apply_correction
from app.motion.meshes.deform_mesh import DeformMesh
from app.motion.meshes.vertices import StreamedVertices, VertexArray, Vertices
from engine.arrays import Complexes
from engine.interpolation import Inbetweens, InteriorKnot

EXPECTED = 100  # assumed bytes per vertex of a series before the first is built
# Parts of a clip that a job computes.
InbetweenPart = Literal["frame", "in-betweens", "fine", "series", "correction"]


@dataclass(slots=True, kw_only=True, eq=False)
class InbetweenCache:
    """The in-betweens of a layer on a mesh; for the main thread only.

    The content (`SegmentKey`) identifies a segment. Undo, copied keys and a variant tried again
    thus find earlier results. A segment has nothing, one frame, prepared in-betweens, or a series.
    Workers get frozen input; their results are taken whenever they arrive.
    """

    mesh: DeformMesh
    budget: InitVar[MemoryBudget | None] = None  # by default one of its own
    memory: SegmentMemory = field(init=False)
    sampler: PoseSampler | None = None  # of the workers; None until a key or a track moves
    # Whether poses are sampled in double precision, which takes longer.
    samples_poses: bool = False
    whole: Clip | None = None  # the newest clip of the document with complete in-betweens
    build: SeriesBuild | None = None  # an unfinished series while no worker builds it
    _failures: set[tuple[InbetweenPart, tuple[SegmentKey, ...]]] = field(
        init=False, default_factory=set
    )
    # Displacement of the vertices by the last requested correction.
    _moved: tuple[SecondaryCorrection, Complexes] | None = field(init=False, default=None)

    def __post_init__(self, budget: MemoryBudget | None) -> None:
        self.memory = SegmentMemory(budget=budget or MemoryBudget())

    def segment(self, clip: Clip, number: int) -> CachedSegment | None:
        return self.memory.find(segment_key(clip, number))

    def prepared(self, clip: Clip) -> tuple[AnyInbetweens, ...] | None:
        """Return the prepared in-betweens of all segments; None if one is missing."""
        if clip.layer.domain is not self.mesh.source:
            return None
        known = [self.memory.find(key) for key in self.memory.keys_of(clip)]
        every = [each.inbetweens for each in known if each is not None and each.inbetweens]
        return tuple(every) if len(every) == len(known) else None

    def has(self, clip: Clip) -> bool:
        """Return whether all frames of a clip can be shown."""
        if clip.layer.domain is not self.mesh.source:
            return False
        if self.lacks_sampler(clip):
            return False
        known = map(self.memory.find, self.memory.keys_of(clip))
        return all(each is not None and _shows(each, clip) for each in known)

    def lacks_sampler(self, clip: Clip) -> bool:
        """Return whether a clip needs corrections and the sampler for them is missing."""
        return self.sampler is None and needs_correction(clip)

    def is_exact(self, clip: Clip, frame: float) -> bool:
        """Return whether the frame's own in-between is available."""
        return self._find(clip, segment_time_at(clip, frame)) is not None

    def vertices(
        self,
        clip: Clip,
        frame: float,
        instead: Pose | SingleFrame | None = None,
        correction: SecondaryCorrection | None = None,
    ) -> Vertices | None:
        """Return the vertices at a frame, or of `instead`; None if not computed."""
        if correction is not None and instead is None:
            return self._corrected(clip, frame, correction)
        vertices = self._uncorrected(clip, frame, instead)
        if vertices is None or correction is None:
            return vertices
        positions = vertices.positions + self._displacement(clip, frame, correction)
        return VertexArray(positions=positions, triangles=vertices.triangles)

    def _corrected(
        self, clip: Clip, frame: float, correction: SecondaryCorrection
    ) -> VertexArray | None:
        moment = segment_time_at(clip, frame)
        resting, sampler = keyed_pose_at(clip, moment), self.sampler
        if sampler is None:
            return None
        if resting is not None:
            inbetweens, time = sampler.still_inbetweens(resting, clip.layer.variant), 0.0
        else:
            known = self.segment(clip, moment.segment)
            if known is None or not isinstance(known.inbetweens, Inbetweens):
                return None
            inbetweens, time = known.inbetweens, moment.weight
        if inbetweens.sampled_domain is not sampler.sites:
            # In-betweens of an earlier anchor were computed along other paths.
            sampler = PoseSampler(sampler.domain, anchor=clip.layer.anchor, sibling=sampler)
        moved = apply_correction(sampler, inbetweens, time, correction).frame(time)
        triangles = self.mesh.order.triangles(clip, frame)
        return VertexArray(positions=moved.positions, triangles=triangles)

    def _displacement(self, clip: Clip, frame: float, correction: SecondaryCorrection) -> Complexes:
        """Return the displacement (v,) of the vertices by a correction at its own frame.

        It approximates the correction of a pose that is being dragged.
        """
        if self._moved is None or self._moved[0] is not correction:
            after, before = (self._corrected(clip, frame, correction), self.vertices(clip, frame))
            if after is None or before is None:
                return np.zeros(len(self.mesh.domain.mesh.vertices), np.complex128)
            self._moved = correction, after.positions - before.positions
        return self._moved[1]

    def _uncorrected(
        self, clip: Clip, frame: float, instead: Pose | SingleFrame | None
    ) -> Vertices | None:
        moment = segment_time_at(clip, frame)
        triangles = self.mesh.order.triangles(clip, frame)
        found = instead or self._find(clip, moment)
        if isinstance(found, Pose):
            positions = self._pose_vertices(found)
        elif isinstance(found, SingleFrame):
            positions = found.positions
        elif found is None or not found.is_ready:
            return None
        elif found.series is not None and found.series.covers(moment.weight):
            return StreamedVertices(found.series, found.distortions, moment.weight, triangles)
        elif found.inbetweens is None:
            return None
        else:
            positions = found.inbetweens.frame(moment.weight).positions
        return VertexArray(positions=positions, triangles=triangles)

    def _find(self, clip: Clip, moment: SegmentTime) -> Pose | SingleFrame | CachedSegment | None:
        """Return the pose, frame or segment that shows this time exactly, if any."""
        if clip.layer.domain is not self.mesh.source:
            return None
        if self.lacks_sampler(clip):
            return None
        resting = keyed_pose_at(clip, moment)
        known = self.segment(clip, moment.segment) if resting is None else None
        if known is None or _shows(known, clip):
            return known or resting
        if needs_correction(clip):
            return None
        return (
            known.single_frame
            if known.single_frame and known.single_frame.weight == moment.weight
            else None
        )

    def _pose_vertices(self, pose: Pose) -> Complexes:
        if self.samples_poses and self.sampler is not None:
            return self.sampler.samples(pose).positions
        return self.mesh.pose_vertices(pose)

    def positions(
        self, clip: Clip, frame: float, correction: SecondaryCorrection | None = None
    ) -> Complexes | None:
        vertices = self.vertices(clip, frame, correction=correction)
        return None if vertices is None else vertices.positions

    def nearest_pose(self, clip: Clip, moment: SegmentTime) -> Pose | SingleFrame:
        """Return the known pose nearest in time within the segment, its keys included."""
        after = moment.weight > 0.5
        distance = 1.0 - moment.weight if after else moment.weight
        known = self.segment(clip, moment.segment)
        one = None if known is None else known.single_frame
        if one is not None and abs(one.weight - moment.weight) <= distance:
            return one
        return clip.keys[segment_keys(clip)[moment.segment][after]].pose

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
        if sampler is None or sampler.anchor != layer.anchor:
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
        anchors, sampler = {clip.layer.anchor for clip in self.memory.present}, found.sampler
        if sampler is not None and (not anchors or sampler.anchor in anchors):
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
        return own + sum(memory.sizes_of(key)[0] for key in passing)

    def release_intermediates(self) -> None:
        """Free the prepared in-betweens of segments with a complete series."""
        for key, known in self.memory.items():
            if known.inbetweens is not None and known.is_streamed:
                self.memory.put(key, known._replace(inbetweens=None, single_frame=None))
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


def _shows(known: CachedSegment, clip: Clip) -> bool:
    """Return whether a clip's frames can be shown; corrections need prepared in-betweens."""
    return known.inbetweens is not None if needs_correction(clip) else known.is_ready
