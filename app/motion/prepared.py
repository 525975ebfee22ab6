"""What is ready to be shown of a figure: its poses and in-betweens on one of its meshes.

Preparing in-betweens takes a while and happens on the worker thread; showing them must never wait.
A `Motion` is frozen: it knows the in-betweens of the poses that it was prepared for, and says so
where it is asked about others.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from types import MappingProxyType
from typing import NamedTuple

from app.document import Clip, Pose, intervals, resting_pose, time_of, transits
from app.motion.compared import RememberedFrames, prepare_compared
from app.motion.inbetweens import PoseSampler
from app.motion.paint_order import painted_triangles
from app.motion.posable_mesh import PosableMesh
from app.motion.vertices import Placed, Streamed, Vertices
from engine.arrays import Complexes
from engine.interpolation import Inbetweens, Joint
from engine.streaming import Series

# By what the in-betweens of two keys are known: the maps, their own and those of the keys around
# that the motion passes through, since handles may come and go; turns, joints, bounds and variant.
Pair = tuple[object, ...]


class PreparedInterval(NamedTuple):
    """The in-betweens of some poses, which it keeps alive so that their identities stay theirs.

    `kept` tells how much of its velocity the motion has at both ends. The series of the
    positions and of f_z and f_z̄ are None until they are built; `extents` are the bytes that they
    took when they last were, 0 where that is not known.
    """

    poses: tuple[Pose, ...]
    inbetweens: Inbetweens | RememberedFrames
    kept: tuple[float, float]
    series: Series | None = None
    distortions: Series | None = None
    extents: tuple[int, int] = (0, 0)


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Motion:
    """The motion of a figure on a mesh, as far as it is prepared.

    Parameters
    ----------
    mesh : PosableMesh
    clip : Clip
        What it was prepared for.
    sampler : PoseSampler, optional
        Of the worker alone; None as long as nothing moves.
    ready : mapping of Pair to PreparedInterval
        Of the poses that follow each other.
    """

    mesh: PosableMesh
    clip: Clip
    sampler: PoseSampler | None
    ready: Mapping[Pair, PreparedInterval]

    @classmethod
    def at_rest(cls, clip: Clip, mesh: PosableMesh) -> "Motion":
        """Return the motion that knows the keys only."""
        return cls(mesh=mesh, clip=clip, sampler=None, ready={})

    def vertices(self, clip: Clip, frame: float) -> Vertices | None:
        """Return where the vertices are at a frame; None where that is not prepared."""
        moment = time_of(clip, frame)
        resting = resting_pose(clip, moment)
        triangles = painted_triangles(self.mesh.domain.mesh, clip, frame)
        if resting is not None:
            return Placed(positions=self.mesh.posed(resting), triangles=triangles)
        prepared = self._prepared(clip, moment.interval)
        if prepared is None:
            return None
        if prepared.series is not None and prepared.series.covers(moment.weight):
            return Streamed(prepared.series, prepared.distortions, moment.weight, triangles)
        positions = prepared.inbetweens.frame(moment.weight).positions
        return Placed(positions=positions, triangles=triangles)

    def positions(self, clip: Clip, frame: float) -> Complexes | None:
        """Return where the vertices are at a frame, worked out; None where that is not prepared."""
        vertices = self.vertices(clip, frame)
        return None if vertices is None else vertices.positions

    def knows(self, clip: Clip) -> bool:
        """Tell whether all in-betweens of a clip are prepared."""
        if clip.figure.domain is not self.mesh.source:
            return False
        every = range(len(intervals(clip)))
        return all(self._prepared(clip, interval) is not None for interval in every)

    def lacks(self, clip: Clip, frame: float) -> bool:
        """Tell whether a frame is an in-between that is not prepared."""
        moment = time_of(clip, frame)
        is_between = resting_pose(clip, moment) is None
        return is_between and self._prepared(clip, moment.interval) is None

    def inbetweens(self, clip: Clip, interval: int) -> Inbetweens | RememberedFrames:
        """Return the in-betweens of one of a clip's intervals, which must be prepared."""
        prepared = self._prepared(clip, interval)
        if prepared is None:
            raise ValueError(f"the in-betweens of interval {interval} are not prepared")
        return prepared.inbetweens

    def kept(self, clip: Clip) -> Mapping[int, float] | None:
        """Return how much of its velocity the bounds leave to the motion at keys, by their frames.

        From 0, a stop, to 1; of those that it passes through. None where that is not known.
        """
        found: dict[int, float] = {}
        for interval, transit in enumerate(transits(clip)):
            prepared = self._prepared(clip, interval)
            if prepared is None:
                return None
            first = int(isinstance(transit.start, Joint))
            ends, keys = (transit.start, transit.end), transit.keys[first : first + 2]
            for end, key, kept in zip(ends, keys, prepared.kept, strict=True):
                if isinstance(end, Joint):
                    found[key.frame] = kept
        return found

    def _prepared(self, clip: Clip, interval: int) -> PreparedInterval | None:
        if clip.figure.anchor != self.clip.figure.anchor:
            return None
        return self.ready.get(pair_of(clip, interval))


def prepare_motion(
    clip: Clip,
    earlier: Motion,
    sibling: PoseSampler | None = None,
    *,
    at_most: int | None = None,
    frame: float = 0,
    recalled: Sequence[Clip] = (),
) -> Motion:
    """Return the motion of a clip with its in-betweens; on the worker thread.

    Parameters
    ----------
    clip : Clip
    earlier : Motion
        On the same mesh; what it prepared is used again.
    sibling : PoseSampler, optional
        What it knows of the same outline and cage is used again.
    at_most : int, optional
        How many intervals to prepare; the others stay as they are. By default all.
    frame : float
        Those nearest to it are prepared first.
    recalled : sequence of Clip
        The figure at other times of its history. What is known of them stays so.
    """
    sampler, known = earlier.sampler, earlier.ready
    if clip.figure.anchor != earlier.clip.figure.anchor:
        sampler, sibling, known = None, earlier.sampler or sibling, {}
    ready: dict[Pair, PreparedInterval] = {}
    made = 0
    figure, every = clip.figure, transits(clip)
    for interval in by_nearness(clip, frame):
        transit, pair = every[interval], pair_of(clip, interval)
        if pair in ready:
            # The same poses again: copied keys, or a loop that goes to and fro.
            continue
        if pair in known:
            ready[pair] = known[pair]
        if pair in known or made == at_most:
            continue
        made += 1
        poses = tuple(key.pose for key in transit.keys)
        if clip.baseline is not None:
            compared = prepare_compared(clip, clip.baseline, interval, earlier.mesh.domain)
            ready[pair] = PreparedInterval(poses, compared, (1.0, 1.0))
            continue
        sampler = sampler or PoseSampler(
            earlier.mesh.domain, anchor=clip.figure.anchor, sibling=sibling
        )
        inbetweens = sampler.inbetweens_of(transit, figure.bounds, figure.variant)
        kept = sampler.kept(transit, figure.bounds, figure.variant)
        ready[pair] = PreparedInterval(poses, inbetweens, kept)
    for other in recalled:
        pairs = {pair_of(other, interval) for interval in range(len(intervals(other)))}
        ready |= {pair: known[pair] for pair in pairs & known.keys() - ready.keys()}
    if sampler is not None:
        sampler.keep_only([pose for prepared in ready.values() for pose in prepared.poses])
    return Motion(mesh=earlier.mesh, clip=clip, sampler=sampler, ready=MappingProxyType(ready))


def by_nearness(clip: Clip, frame: float) -> list[int]:
    """Return the numbers of a clip's intervals, that at the frame first."""
    current = time_of(clip, frame).interval
    return sorted(range(len(intervals(clip))), key=lambda i: (abs(i - current), i < current))


def pair_of(clip: Clip, interval: int) -> Pair:
    """Return by what the in-betweens of one of a clip's intervals are known."""
    transit = transits(clip)[interval]
    maps = [identity for key in transit.keys for identity in (id(key.pose.phi), id(key.pose.psi))]
    joined = (transit.start, transit.end, clip.figure.bounds) if transit.is_joined else ()
    frames = (clip.frames,) if clip.baseline is not None else ()
    return *maps, *transit.turns, *joined, clip.baseline or clip.figure.variant, *frames
