"""Cached in-betweens of a segment on a mesh, and the jobs that compute them."""

from collections.abc import Generator, Mapping, Sequence
from typing import NamedTuple

from app.document import Clip, Pose, pose_segments, segment_time_at
from app.motion.inbetweens.frame_corrector import needs_correction
from app.motion.inbetweens.pins.auto_pins import AutoPins
from app.motion.inbetweens.pose_sampler import PoseSampler
from app.motion.inbetweens.segment_keys import SegmentKey, segment_key, segment_poses
from app.motion.meshes.deform_mesh import DeformMesh
from app.motion.rival_methods.comparison import MemoizedFrames, compute_baseline
from engine.arrays import Complexes
from engine.interpolation import Inbetweens, SampledDomain
from engine.streaming import Distortions, MotionComponents, Positions, Series, build_series

# All in-betweens of two keys, ready for evaluation.
AnyInbetweens = Inbetweens | MemoizedFrames

# Vertices times steps of a series per job, some hundredths of a second, so that the worker soon
# takes more urgent jobs.
BATCH = 400_000


class SingleFrame(NamedTuple):
    """One in-between, at a time in [0, 1] between the two keys."""

    segment_key: SegmentKey
    weight: float
    positions: Complexes  # of the mesh's vertices, (v,)


class CachedSegment(NamedTuple):
    """The computed in-betweens of a segment.

    `poses` keeps the poses alive, since their ids are in the segment key. `velocity_shares` are the
    shares of the velocity at both ends. Rival methods have no sites. The series are of the
    positions, and of f_z and f_z̄.
    """

    poses: tuple[Pose, ...]
    single_frame: SingleFrame | None = None
    inbetweens: AnyInbetweens | None = None
    velocity_shares: tuple[float, float] | None = None
    sites: SampledDomain | None = None
    series: Series | None = None
    distortions: Series | None = None

    @property
    def is_ready(self) -> bool:
        """Whether the whole segment can be shown, prepared or by a complete series."""
        return self.inbetweens is not None or self.is_streamed

    @property
    def is_streamed(self) -> bool:
        """Whether the series of the positions is complete."""
        return self.series is not None and self.series.is_whole

    @property
    def sizes(self) -> tuple[int, int, int]:
        """Bytes of the prepared in-betweens with the samples of one key, and of both series."""
        own = 0 if self.single_frame is None else self.single_frame.positions.nbytes
        if self.inbetweens is not None:
            own += self.inbetweens.nbytes
        if isinstance(self.inbetweens, Inbetweens):
            # The samples of the other key count for the neighbour segment.
            own += self.inbetweens.keyframe_blend.ends[0].nbytes
        streamed = [each.nbytes if each else 0 for each in (self.series, self.distortions)]
        return own, streamed[0], streamed[1]

    def joined(self, newer: "CachedSegment") -> "CachedSegment":
        """Return the union of both; newer values win."""
        pairs = zip(newer, self, strict=True)
        return CachedSegment._make(new if new is not None else old for new, old in pairs)


class CacheUpdate(NamedTuple):
    """Computed segments, and the sampler that computed them, if any."""

    sampler: PoseSampler | None
    segments: Mapping[SegmentKey, CachedSegment]


def compute_segments(
    clip: Clip,
    wanted: Sequence[int],
    mesh: DeformMesh,
    sampler: PoseSampler | None = None,
    *,
    keep: frozenset[Pose] = frozenset(),
) -> CacheUpdate:
    """Prepare the in-betweens of the segments with these numbers; on a worker thread.

    The layer's sampler on the mesh is used; another sampler of the same outline is
    reused in part. Samples of the poses `keep` stay, besides those of the clip's poses.
    """
    layer, every = clip.layer, pose_segments(clip)
    if clip.baseline is not None:
        return CacheUpdate(
            sampler=None,
            segments={
                segment_key(clip, number): CachedSegment(
                    poses=segment_poses(clip, number),
                    inbetweens=compute_baseline(clip, clip.baseline, number, mesh.domain),
                )
                for number in wanted
            },
        )
    if sampler is None or sampler.domain is not mesh.domain or not sampler.is_for(layer):
        sampler = PoseSampler(layer, domain=mesh.domain, sibling=sampler)
    pins = AutoPins(clip, layer.variant, sampler)
    intervals = {
        segment_key(clip, number): CachedSegment(
            poses=segment_poses(clip, number),
            inbetweens=pins.inbetweens(number, sampler),
            velocity_shares=sampler.velocity_shares(
                every[number], layer.widest_bounds, layer.variant
            ),
            sites=sampler.sites,
        )
        for number in wanted
    }
    sampler.keep_only(keep.union(key.pose for key in clip.keys))
    if needs_correction(clip):
        # Prepared here, so that the first corrected frame does not wait for it.
        _ = sampler.basis
    return CacheUpdate(sampler=sampler, segments=intervals)


def compute_frame(
    clip: Clip,
    frame: float,
    mesh: DeformMesh,
    sampler: PoseSampler,
    *,
    keep: frozenset[Pose] = frozenset(),
) -> CacheUpdate:
    """Compute the exact in-between at a frame; on a worker thread.

    The sampler is of the mesh and the layer's anchor. If the whole segment takes no longer, the
    segment is prepared instead.
    """
    moment, layer = segment_time_at(clip, frame), clip.layer
    if not sampler.makes_single_frames(layer.variant):
        return compute_segments(clip, [moment.segment], mesh, sampler, keep=keep)
    pair, pins = segment_key(clip, moment.segment), AutoPins(clip, layer.variant, sampler)
    alone = pins.frame(moment.segment, sampler, moment.weight)
    one = SingleFrame(pair, moment.weight, alone.positions)
    return CacheUpdate(
        sampler, {pair: CachedSegment(segment_poses(clip, moment.segment), single_frame=one)}
    )


class SeriesBuild:
    """A series of positions, or of f_z and f_z̄, under construction; only the worker advances it."""

    def __init__(self, pair: SegmentKey, interval: CachedSegment, *, distortions: bool) -> None:
        inbetweens, sites = interval.inbetweens, interval.sites
        if inbetweens is None or sites is None or isinstance(inbetweens, MemoizedFrames):
            raise TypeError("only in-betweens that are prepared at sites are streamed")
        self.segment_key = pair
        self.poses = interval.poses
        self.distortions = distortions
        self.series: Series | None = None
        self._steps = self._build(inbetweens, sites)
        self._batch = max(1, BATCH // len(sites.points))

    def advance(self) -> "SeriesBuild":
        """Take some steps."""
        for _ in range(self._batch):
            try:
                next(self._steps)
            except StopIteration as stop:
                self.series = stop.value
                break
        return self

    def _build(self, inbetweens: Inbetweens, sites: SampledDomain) -> Generator[None, None, Series]:
        source: MotionComponents = (Distortions if self.distortions else Positions).of(
            inbetweens, sites
        )
        yield
        return (yield from build_series(source))
