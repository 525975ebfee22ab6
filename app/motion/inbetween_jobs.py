"""In-betweens of one interval on a mesh: their key in a store, and how a worker makes them."""

from collections.abc import Generator, Mapping, Sequence
from typing import NamedTuple

from app.document import Clip, Pose, pose_segments, segment_time_at
from app.motion.baselines import MemoizedFrames, compute_baseline
from app.motion.deform_mesh import DeformMesh
from app.motion.inbetweens import (
    AutoPins,
    PoseSampler,
    SegmentKey,
    needs_correction,
    segment_key,
    segment_poses,
)
from engine.arrays import Complexes
from engine.interpolation import Inbetweens, SampledDomain
from engine.streaming import Distortions, MotionComponents, Positions, Series, build_series

# All in-betweens of two keys, ready to be evaluated.
AnyInbetweens = Inbetweens | MemoizedFrames

# Vertices times steps of a series that the worker takes before it looks for more urgent work: some
# hundredths of a second.
BATCH = 400_000


class SingleFrame(NamedTuple):
    """One in-between alone, at a time between the two keys in [0, 1]."""

    segment_key: SegmentKey
    weight: float
    positions: Complexes  # of the mesh's vertices, (v,)


class CachedSegment(NamedTuple):
    """What is known of the in-betweens of some poses.

    It keeps the poses alive, so that the identities by which their in-betweens are known stay
    theirs. `kept` tells how much of its velocity the motion has at both ends; methods that are not
    streamed have no sites. The series are of the positions, and of f_z and f_z̄.
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
        """Whether all of it can be shown: it is prepared, or its series leaves nothing out."""
        return self.inbetweens is not None or self.is_streamed

    @property
    def is_streamed(self) -> bool:
        """Whether the series of the positions has all of it."""
        return self.series is not None and self.series.is_whole

    @property
    def sizes(self) -> tuple[int, int, int]:
        """Bytes of what is prepared, with the samples of one key, and of both series."""
        own = 0 if self.single_frame is None else self.single_frame.positions.nbytes
        if self.inbetweens is not None:
            own += self.inbetweens.nbytes
        if isinstance(self.inbetweens, Inbetweens):
            # Those of the other key are its neighbour's.
            own += self.inbetweens.keyframe_blend.ends[0].nbytes
        streamed = [each.nbytes if each else 0 for each in (self.series, self.distortions)]
        return own, streamed[0], streamed[1]

    def joined(self, newer: "CachedSegment") -> "CachedSegment":
        """Return what is known by both."""
        pairs = zip(newer, self, strict=True)
        return CachedSegment._make(new if new is not None else old for new, old in pairs)


class CacheUpdate(NamedTuple):
    """What a worker has found of some intervals, and by which sampler, where that took one."""

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
    """Prepare the in-betweens of some of a clip's intervals; on a worker thread.

    Parameters
    ----------
    wanted : sequence of int
        Numbers of the intervals.
    mesh : DeformMesh
    sampler : PoseSampler, optional
        Of the mesh and the layer's anchor, or else one whose knowledge of the outline is used
        again, if it is of the same.
    keep : frozenset of Pose
        Whose samples are kept beside those of the clip.
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
    if sampler is None or sampler.domain is not mesh.domain or sampler.anchor != layer.anchor:
        is_sibling = sampler is not None and sampler.domain.cage is mesh.domain.cage
        sibling = sampler if is_sibling else None
        sampler = PoseSampler(mesh.domain, anchor=layer.anchor, sibling=sibling)
    pins = AutoPins(clip, layer.variant, sampler)
    intervals = {
        segment_key(clip, number): CachedSegment(
            poses=segment_poses(clip, number),
            inbetweens=pins.inbetweens(number, sampler),
            velocity_shares=sampler.velocity_shares(every[number], layer.bounds, layer.variant),
            sites=sampler.sites,
        )
        for number in wanted
    }
    sampler.keep_only(keep.union(key.pose for key in clip.keys))
    if needs_correction(clip):
        # Here, so that the first corrected frame does not wait for it.
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
    """Work out the in-between at a frame, exactly as its interval will have it; on a worker thread.

    The sampler is of the mesh and the layer's anchor. Where the whole interval takes no longer, it
    is prepared instead.
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
    """A series in the making; only the worker takes its steps.

    Parameters
    ----------
    interval : CachedSegment
        Prepared.
    distortions : bool
        Whether f_z and f_z̄ are streamed, and not the positions.
    """

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
