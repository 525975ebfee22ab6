"""One in-between alone, to be shown before the others of its interval are prepared."""

from dataclasses import dataclass

from app.document import Clip, Pose, time_of, transits
from app.motion.posable_mesh import PosableMesh
from app.motion.prepared import Motion, Pair, pair_of
from engine.arrays import Complexes


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Glimpse:
    """An in-between of some poses, which it keeps alive so that their identities stay theirs.

    Parameters
    ----------
    mesh : PosableMesh
    anchor : complex or None
        The figure's.
    pair : Pair
    poses : tuple of Pose
    weight : float
        Its time between the two keys, in [0, 1].
    positions : complex128, shape (v,)
        Of the mesh's vertices.
    """

    mesh: PosableMesh
    anchor: complex | None
    pair: Pair
    poses: tuple[Pose, ...]
    weight: float
    positions: Complexes

    def is_of(self, clip: Clip, interval: int) -> bool:
        """Tell whether it is an in-between of one of a clip's intervals, as they are now."""
        return (
            self.mesh.source is clip.figure.domain
            and self.anchor == clip.figure.anchor
            and self.pair == pair_of(clip, interval)
        )


def can_glimpse(clip: Clip, motion: Motion, frame: float) -> bool:
    """Tell whether a frame is an in-between that a motion lacks, and all is there to make it."""
    return (
        motion.sampler is not None
        and motion.sampler.anchor == clip.figure.anchor
        and motion.mesh.source is clip.figure.domain
        and clip.baseline is None
        and motion.lacks(clip, frame)
    )


def glimpse_at(clip: Clip, motion: Motion, frame: float) -> Glimpse:
    """Return the in-between at a frame, exactly as the motion will have it; on a worker thread.

    Raises
    ------
    ValueError
        If the motion has no sampler yet.
    """
    if motion.sampler is None:
        raise ValueError("a motion without a sampler has no in-betweens")
    moment, figure = time_of(clip, frame), clip.figure
    transit = transits(clip)[moment.interval]
    alone = motion.sampler.frame_of(transit, figure.bounds, figure.variant, moment.weight)
    return Glimpse(
        mesh=motion.mesh,
        anchor=figure.anchor,
        pair=pair_of(clip, moment.interval),
        poses=tuple(key.pose for key in transit.keys),
        weight=moment.weight,
        positions=alone.positions,
    )
