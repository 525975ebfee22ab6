"""In-betweens of one interval on a mesh: by what they are known, and how a worker makes them."""

from collections.abc import Callable, Generator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial

from app.document import Clip, Pose, time_of, transits
from app.motion.compared import RememberedFrames, prepare_compared
from app.motion.inbetweens import PoseSampler
from app.motion.posable_mesh import PosableMesh
from engine.arrays import Complexes
from engine.interpolation import Inbetweens, Sites
from engine.streaming import Channels, Distortions, Positions, Series, build_series

# By what the in-betweens of two keys are known: the maps, their own and those of the keys around
# that the motion passes through, since handles may come and go; turns, joints, bounds, anchor and
# variant. The same keys have the same, whichever clip they are in.
Pair = tuple[object, ...]
# All in-betweens of two keys, ready to be evaluated.
Prepared = Inbetweens | RememberedFrames

# Vertices times steps of a series that the worker takes before it looks for more urgent work: some
# hundredths of a second.
BATCH = 400_000


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class OneFrame:
    """One in-between alone, worked out before the others of its interval.

    Parameters
    ----------
    pair : Pair
    weight : float
        Its time between the two keys, in [0, 1].
    positions : complex128, shape (v,)
        Of the mesh's vertices.
    """

    pair: Pair
    weight: float
    positions: Complexes


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Interval:
    """What is known of the in-betweens of some poses.

    Parameters
    ----------
    poses : tuple of Pose
        Kept alive, so that the identities by which their in-betweens are known stay theirs.
    one : OneFrame, optional
    inbetweens : Prepared, optional
        All of them, prepared.
    kept : tuple of float
        How much of its velocity the motion has at both ends.
    sites : Sites, optional
        Where they were prepared; None for methods whose in-betweens are not streamed.
    series, distortions : Series, optional
        Of the positions, and of f_z and f_z̄.
    extents : tuple of int
        The bytes that these two took before they made room for others; 0 where they never did.
    """

    poses: tuple[Pose, ...]
    one: OneFrame | None = None
    inbetweens: Prepared | None = None
    kept: tuple[float, float] = (1.0, 1.0)
    sites: Sites | None = None
    series: Series | None = None
    distortions: Series | None = None
    extents: tuple[int, int] = (0, 0)

    @property
    def streamed(self) -> int:
        """Bytes of the series."""
        return sum(each.nbytes for each in (self.series, self.distortions) if each is not None)

    @property
    def nbytes(self) -> int:
        """Bytes of all of it; of its keys' samples those of one, as neighbours share them."""
        found = self.streamed + (0 if self.one is None else self.one.positions.nbytes)
        if self.inbetweens is not None:
            found += self.inbetweens.nbytes
        if self.inbetweens is not None and not isinstance(self.inbetweens, RememberedFrames):
            found += self.inbetweens.passage.ends[0].nbytes
        return found

    def joined(self, newer: "Interval") -> "Interval":
        """Return what is known by both."""
        prepared = self if newer.inbetweens is None else newer
        return replace(
            prepared,
            one=newer.one or self.one,
            series=newer.series or self.series,
            distortions=newer.distortions or self.distortions,
            extents=self.extents,
        )

    def without_series(self) -> "Interval":
        """Return it with the bytes that its series took in place of them."""
        taken = [
            known if series is None else series.nbytes
            for series, known in zip((self.series, self.distortions), self.extents, strict=True)
        ]
        return replace(self, series=None, distortions=None, extents=(taken[0], taken[1]))


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Found:
    """What a worker has found of some intervals.

    Parameters
    ----------
    sampler : PoseSampler or None
        By which; None where none was needed.
    intervals : mapping of Pair to Interval
    """

    sampler: PoseSampler | None
    intervals: Mapping[Pair, Interval]


def pair_of(clip: Clip, interval: int) -> Pair:
    """Return by what the in-betweens of one of a clip's intervals are known."""
    transit, figure = transits(clip)[interval], clip.figure
    maps = [identity for key in transit.keys for identity in (id(key.pose.phi), id(key.pose.psi))]
    joined = (transit.start, transit.end, figure.bounds) if transit.is_joined else ()
    if clip.baseline is None:
        return *maps, *transit.turns, *joined, figure.anchor, figure.variant
    places = tuple(handle.position for handle in figure.handles)
    rest = (figure.bounds, places, clip.frames)
    return *maps, *transit.turns, *joined, figure.anchor, clip.baseline, *rest


def prepare_intervals(
    clip: Clip,
    wanted: Sequence[int],
    mesh: PosableMesh,
    sampler: PoseSampler | None = None,
    *,
    sibling: PoseSampler | None = None,
    keep: frozenset[Pose] = frozenset(),
) -> Found:
    """Prepare the in-betweens of some of a clip's intervals; on a worker thread.

    Parameters
    ----------
    clip : Clip
    wanted : sequence of int
        Numbers of the intervals.
    mesh : PosableMesh
    sampler : PoseSampler, optional
        What it knows is used again, if it is of the mesh and the figure's anchor.
    sibling : PoseSampler, optional
        What it knows of the same outline and cage is used again.
    keep : frozenset of Pose
        Whose samples are kept beside those of the clip.
    """
    figure = clip.figure
    intervals: dict[Pair, Interval] = {}
    for number in wanted:
        transit = transits(clip)[number]
        poses = tuple(key.pose for key in transit.keys)
        if clip.baseline is not None:
            compared = prepare_compared(clip, clip.baseline, number, mesh.domain)
            intervals[pair_of(clip, number)] = Interval(poses=poses, inbetweens=compared)
            continue
        if sampler is None or sampler.anchor != figure.anchor:
            known = sampler or sibling
            if known is not None and known.domain.cage is not mesh.domain.cage:
                known = None
            sampler = PoseSampler(mesh.domain, anchor=figure.anchor, sibling=known)
        intervals[pair_of(clip, number)] = Interval(
            poses=poses,
            inbetweens=sampler.inbetweens_of(transit, figure.bounds, figure.variant),
            kept=sampler.kept(transit, figure.bounds, figure.variant),
            sites=sampler.sites,
        )
    if sampler is not None and clip.baseline is None:
        sampler.keep_only(keep.union(key.pose for key in clip.keys))
    return Found(sampler=sampler, intervals=intervals)


def prepare_frame(
    clip: Clip,
    frame: float,
    mesh: PosableMesh,
    sampler: PoseSampler,
    *,
    keep: frozenset[Pose] = frozenset(),
) -> Found:
    """Work out the in-between at a frame, exactly as its interval will have it; on a worker thread.

    Where the whole interval takes no longer, it is prepared instead.

    Parameters
    ----------
    clip : Clip
    frame : float
    mesh : PosableMesh
    sampler : PoseSampler
        Of the mesh and the figure's anchor.
    keep : frozenset of Pose
        As in `prepare_intervals`.
    """
    moment, figure = time_of(clip, frame), clip.figure
    if not sampler.makes_single_frames(figure.variant):
        return prepare_intervals(clip, [moment.interval], mesh, sampler, keep=keep)
    transit, pair = transits(clip)[moment.interval], pair_of(clip, moment.interval)
    alone = sampler.frame_of(transit, figure.bounds, figure.variant, moment.weight)
    one = OneFrame(pair=pair, weight=moment.weight, positions=alone.positions)
    poses = tuple(key.pose for key in transit.keys)
    return Found(sampler=sampler, intervals={pair: Interval(poses=poses, one=one)})


class Build:
    """A series in the making; only the worker takes its steps.

    Parameters
    ----------
    pair : Pair
    interval : Interval
        Prepared.
    distortions : bool
        Whether f_z and f_z̄ are streamed, and not the positions.
    """

    def __init__(self, pair: Pair, interval: Interval, *, distortions: bool) -> None:
        inbetweens, sites = interval.inbetweens, interval.sites
        if inbetweens is None or sites is None or isinstance(inbetweens, RememberedFrames):
            raise TypeError("only in-betweens that are prepared at sites are streamed")
        self.pair = pair
        self.distortions = distortions
        self.series: Series | None = None
        self._poses = interval.poses
        self._steps = _steps(
            partial(Distortions.of, inbetweens, sites)
            if distortions
            else partial(Positions.of, inbetweens, sites)
        )
        self._batch = max(1, BATCH // len(sites.points))

    @property
    def found(self) -> Found:
        """What it has come to; nothing before its end."""
        if self.series is None:
            return Found(sampler=None, intervals={})
        interval = Interval(
            poses=self._poses,
            series=None if self.distortions else self.series,
            distortions=self.series if self.distortions else None,
        )
        return Found(sampler=None, intervals={self.pair: interval})

    def advance(self) -> "Build":
        """Take some steps."""
        for _ in range(self._batch):
            try:
                next(self._steps)
            except StopIteration as stop:
                self.series = stop.value
                break
        return self


def _steps(channels: Callable[[], Channels]) -> Generator[None, None, Series]:
    source = channels()
    yield
    return (yield from build_series(source))
