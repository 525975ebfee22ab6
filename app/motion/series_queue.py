"""Series of the in-betweens: which of them are built next, a batch at a time, within a budget."""

from collections.abc import Callable, Generator, Iterable
from dataclasses import replace
from functools import partial
from types import MappingProxyType

from app.document import Clip
from app.motion.compared import RememberedFrames
from app.motion.posable_mesh import PosableMesh
from app.motion.prepared import Motion, Pair, PreparedInterval, by_nearness, pair_of
from engine.streaming import Channels, Distortions, Positions, Series, build_series

BUDGET = 2**30  # bytes of the series of one figure
EXPECTED = 100  # bytes a vertex that a series is thought to take before one is built
# Vertices times steps that the worker takes before it looks for more urgent work: some
# hundredths of a second.
BATCH = 400_000


class Build:
    """A series in the making; only the worker takes its steps.

    Parameters
    ----------
    motion : Motion
    pair : Pair
        One of the motion's.
    distortions : bool
        Whether f_z and f_z̄ are streamed, and not the positions.
    """

    def __init__(self, motion: Motion, pair: Pair, *, distortions: bool) -> None:
        if motion.sampler is None:
            raise ValueError("a motion without a sampler has nothing to stream")
        self.mesh: PosableMesh = motion.mesh
        self.pair = pair
        self.distortions = distortions
        self.series: Series | None = None
        inbetweens, sites = motion.ready[pair].inbetweens, motion.sampler.sites
        if isinstance(inbetweens, RememberedFrames):
            raise TypeError("in-betweens for comparison are not streamed")
        self._steps = _steps(
            partial(Distortions.of, inbetweens, sites)
            if distortions
            else partial(Positions.of, inbetweens, sites)
        )
        self._batch = max(1, BATCH // len(motion.mesh.domain.mesh.vertices))

    def is_of(self, motion: Motion | None) -> bool:
        """Tell whether a motion still has use for it."""
        return motion is not None and motion.mesh is self.mesh and self.pair in motion.ready

    def advance(self) -> "Build":
        """Take some steps."""
        for _ in range(self._batch):
            try:
                next(self._steps)
            except StopIteration as stop:
                self.series = stop.value
                break
        return self


def next_build(
    motion: Motion, clip: Clip, frame: int, *, heat: bool, budget: int = BUDGET
) -> Build | None:
    """Return what is to be built next of a motion; None where all that is wanted is there.

    Parameters
    ----------
    motion : Motion
        Of the clip.
    clip : Clip
    frame : int
        Where the playhead is; the intervals nearest to it come first.
    heat : bool
        Whether distortions are shown.
    budget : int
        In bytes. Intervals beyond it stay on the direct path.
    """
    if motion.sampler is None or not motion.knows(clip):
        return None
    used = 0
    for pair in _by_nearness(clip, frame):
        prepared = motion.ready[pair]
        for distortions, series in ((False, prepared.series), (True, prepared.distortions)):
            if distortions and not heat:
                continue
            if series is None:
                known = prepared.extents[distortions]
                if used + (known or _expected(motion, distortions=distortions)) > budget:
                    return None
                return Build(motion, pair, distortions=distortions)
            used += series.nbytes
    return None


def with_series(
    motion: Motion, build: Build, clip: Clip, frame: int, *, budget: int = BUDGET
) -> Motion:
    """Return a motion that has what was built; those farthest from `frame` make room.

    A motion that has moved on to other keys, or to another figure, is returned as it is.
    """
    series = build.series
    if series is None or not build.is_of(motion):
        return motion
    ready = dict(motion.ready)
    prepared = ready[build.pair]
    places, distortions = prepared.extents
    changed = (
        prepared._replace(distortions=series, extents=(places, series.nbytes))
        if build.distortions
        else prepared._replace(series=series, extents=(series.nbytes, distortions))
    )
    ready[build.pair] = changed
    if motion.knows(clip):
        for pair in reversed(_by_nearness(clip, frame)):
            if memory(ready.values()) > budget:
                ready[pair] = ready[pair]._replace(series=None, distortions=None)
    return replace(motion, ready=MappingProxyType(ready))


def memory(ready: Iterable[PreparedInterval]) -> int:
    """Return the bytes that the series of some ready take."""
    return sum(
        series.nbytes
        for prepared in ready
        for series in (prepared.series, prepared.distortions)
        if series is not None
    )


def _expected(motion: Motion, *, distortions: bool) -> int:
    """Return the bytes that another series may take: as many as the largest one so far."""
    kind = [p.distortions if distortions else p.series for p in motion.ready.values()]
    sizes = [series.nbytes for series in kind if series is not None]
    return max(sizes, default=EXPECTED * len(motion.mesh.domain.mesh.vertices))


def _by_nearness(clip: Clip, frame: int) -> list[Pair]:
    """Return the clip's intervals, the one at the frame first; each once."""
    return list(dict.fromkeys(pair_of(clip, interval) for interval in by_nearness(clip, frame)))


def _steps(channels: Callable[[], Channels]) -> Generator[None, None, Series]:
    source = channels()
    yield
    return (yield from build_series(source))
