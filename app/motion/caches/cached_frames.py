"""The vertices of a layer's frames on a mesh, from its cached segments."""

from dataclasses import InitVar, dataclass, field

import numpy as np

from app.document import (
    Clip,
    Pose,
    SegmentTime,
    keyed_pose_at,
    segment_keys,
    segment_time_at,
)
from app.motion.caches.inbetween_jobs import (
    AnyInbetweens,
    CachedSegment,
    SingleFrame,
)
from app.motion.caches.segment_memory import MemoryBudget, SegmentMemory
from app.motion.inbetweens.frame_corrector import needs_correction
from app.motion.inbetweens.pose_sampler import PoseSampler
from app.motion.inbetweens.secondary_correction import SecondaryCorrection
from app.motion.inbetweens.segment_keys import segment_key
from app.motion.inbetweens.slider_stage import apply_correction
from app.motion.meshes.deform_mesh import DeformMesh
from app.motion.meshes.vertices import StreamedVertices, VertexArray, Vertices
from engine.arrays import Complexes
from engine.interpolation import Inbetweens


@dataclass(slots=True, kw_only=True, eq=False)
class CachedFrames:
    """The frames of a layer on a mesh, as far as their segments are cached."""

    mesh: DeformMesh
    budget: InitVar[MemoryBudget | None] = None  # by default one of its own
    memory: SegmentMemory = field(init=False)
    sampler: PoseSampler | None = None  # of the workers; None until a key or a track moves
    # Whether poses are sampled in double precision, which takes longer.
    samples_poses: bool = False
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
            sampler = PoseSampler(clip.layer, domain=sampler.domain, sibling=sampler)
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
            known = self._released_segment(clip, moment, found)
            if known is not None and known.series is not None:
                return StreamedVertices(known.series, known.distortions, moment.weight, triangles)
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

    def _released_segment(
        self, clip: Clip, moment: SegmentTime, pose: Pose
    ) -> CachedSegment | None:
        """Return the segment whose series shows a key's pose while the mesh is released, if any."""
        if not self.mesh.is_released or pose is not keyed_pose_at(clip, moment):
            return None
        known = self.memory.find(self.memory.keys_of(clip)[moment.segment])
        return known if known is not None and known.is_streamed else None

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


def _shows(known: CachedSegment, clip: Clip) -> bool:
    """Return whether a clip's frames can be shown; corrections need prepared in-betweens."""
    return known.inbetweens is not None if needs_correction(clip) else known.is_ready
