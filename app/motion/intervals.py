"""In-betweens of one interval on a mesh: their key in a store, and how a worker makes them."""

from collections.abc import Generator, Mapping, Sequence
from typing import NamedTuple

from app.document import Clip, Pose, time_of, transits
from app.motion.compared import RememberedFrames, prepare_compared
from app.motion.inbetweens import AutoPins, Pair, PoseSampler, is_corrected, pair_of, poses_of
from app.motion.posable_mesh import PosableMesh
from engine.arrays import Complexes
from engine.interpolation import Inbetweens, Sites
from engine.streaming import Channels, Distortions, Positions, Series, build_series

# All in-betweens of two keys, ready to be evaluated.
AnyInbetweens = Inbetweens | RememberedFrames

# Vertices times steps of a series that the worker takes before it looks for more urgent work: some
# hundredths of a second.
BATCH = 400_000


class OneFrame(NamedTuple):
    """One in-between alone, at a time between the two keys in [0, 1]."""

    pair: Pair
    weight: float
    positions: Complexes  # of the mesh's vertices, (v,)


class KnownInterval(NamedTuple):
    """What is known of the in-betweens of some poses.

    It keeps the poses alive, so that the identities by which their in-betweens are known stay
    theirs. `kept` tells how much of its velocity the motion has at both ends; methods that are not
    streamed have no sites. The series are of the positions, and of f_z and f_z̄.
    """

    poses: tuple[Pose, ...]
    one: OneFrame | None = None
    inbetweens: AnyInbetweens | None = None
    kept: tuple[float, float] | None = None
    sites: Sites | None = None
    series: Series | None = None
    distortions: Series | None = None

    @property
    def is_there(self) -> bool:
        """Whether all of it can be shown: it is prepared, or its series leaves nothing out."""
        return self.inbetweens is not None or self.is_streamed

    @property
    def is_streamed(self) -> bool:
        """Whether the series of the positions has all of it."""
        return self.series is not None and self.series.is_whole

    @property
    def sizes(self) -> tuple[int, int, int]:
        """Bytes of what is prepared, with the samples of one key, and of both series."""
        own = 0 if self.one is None else self.one.positions.nbytes
        if self.inbetweens is not None:
            own += self.inbetweens.nbytes
        if isinstance(self.inbetweens, Inbetweens):
            # Those of the other key are its neighbour's.
            own += self.inbetweens.passage.ends[0].nbytes
        streamed = [each.nbytes if each else 0 for each in (self.series, self.distortions)]
        return own, streamed[0], streamed[1]

    def joined(self, newer: "KnownInterval") -> "KnownInterval":
        """Return what is known by both."""
        pairs = zip(newer, self, strict=True)
        return KnownInterval._make(new if new is not None else old for new, old in pairs)


class FoundIntervals(NamedTuple):
    """What a worker has found of some intervals, and by which sampler, where that took one."""

    sampler: PoseSampler | None
    intervals: Mapping[Pair, KnownInterval]


def prepare_intervals(
    clip: Clip,
    wanted: Sequence[int],
    mesh: PosableMesh,
    sampler: PoseSampler | None = None,
    *,
    keep: frozenset[Pose] = frozenset(),
) -> FoundIntervals:
    """Prepare the in-betweens of some of a clip's intervals; on a worker thread.

    Parameters
    ----------
    wanted : sequence of int
        Numbers of the intervals.
    mesh : PosableMesh
    sampler : PoseSampler, optional
        Of the mesh and the layer's anchor, or else one whose knowledge of the outline is used
        again, if it is of the same.
    keep : frozenset of Pose
        Whose samples are kept beside those of the clip.
    """
    layer, every = clip.layer, transits(clip)
    if clip.baseline is not None:
        return FoundIntervals(
            sampler=None,
            intervals={
                pair_of(clip, number): KnownInterval(
                    poses=poses_of(clip, number),
                    inbetweens=prepare_compared(clip, clip.baseline, number, mesh.domain),
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
        pair_of(clip, number): KnownInterval(
            poses=poses_of(clip, number),
            inbetweens=pins.inbetweens(number, sampler),
            kept=sampler.kept(every[number], layer.bounds, layer.variant),
            sites=sampler.sites,
        )
        for number in wanted
    }
    sampler.keep_only(keep.union(key.pose for key in clip.keys))
    if is_corrected(clip):
        # Here, so that the first corrected frame does not wait for it.
        _ = sampler.basis
    return FoundIntervals(sampler=sampler, intervals=intervals)


def prepare_frame(
    clip: Clip,
    frame: float,
    mesh: PosableMesh,
    sampler: PoseSampler,
    *,
    keep: frozenset[Pose] = frozenset(),
) -> FoundIntervals:
    """Work out the in-between at a frame, exactly as its interval will have it; on a worker thread.

    The sampler is of the mesh and the layer's anchor. Where the whole interval takes no longer, it
    is prepared instead.
    """
    moment, layer = time_of(clip, frame), clip.layer
    if not sampler.makes_single_frames(layer.variant):
        return prepare_intervals(clip, [moment.interval], mesh, sampler, keep=keep)
    pair, pins = pair_of(clip, moment.interval), AutoPins(clip, layer.variant, sampler)
    alone = pins.frame(moment.interval, sampler, moment.weight)
    one = OneFrame(pair, moment.weight, alone.positions)
    return FoundIntervals(sampler, {pair: KnownInterval(poses_of(clip, moment.interval), one=one)})


class Build:
    """A series in the making; only the worker takes its steps.

    Parameters
    ----------
    interval : KnownInterval
        Prepared.
    distortions : bool
        Whether f_z and f_z̄ are streamed, and not the positions.
    """

    def __init__(self, pair: Pair, interval: KnownInterval, *, distortions: bool) -> None:
        inbetweens, sites = interval.inbetweens, interval.sites
        if inbetweens is None or sites is None or isinstance(inbetweens, RememberedFrames):
            raise TypeError("only in-betweens that are prepared at sites are streamed")
        self.pair = pair
        self.poses = interval.poses
        self.distortions = distortions
        self.series: Series | None = None
        self._steps = self._build(inbetweens, sites)
        self._batch = max(1, BATCH // len(sites.points))

    def advance(self) -> "Build":
        """Take some steps."""
        for _ in range(self._batch):
            try:
                next(self._steps)
            except StopIteration as stop:
                self.series = stop.value
                break
        return self

    def _build(self, inbetweens: Inbetweens, sites: Sites) -> Generator[None, None, Series]:
        source: Channels = (Distortions if self.distortions else Positions).of(inbetweens, sites)
        yield
        return (yield from build_series(source))
