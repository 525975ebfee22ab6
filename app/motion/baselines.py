"""In-betweens by the methods that the layers' own variants are compared with, on a mesh."""

import numpy as np

from app.document import Clip, keyed_pose_at, segment_keys, segment_time_at
from engine.baselines import Baseline, MeshFrame, MeshInbetweens, prepare_baseline
from engine.domain import MeshedDomain


class MemoizedFrames:
    """In-betweens of two keys whose frames are worked out once: some methods take long for one."""

    def __init__(self, inbetweens: MeshInbetweens) -> None:
        self._inbetweens = inbetweens
        self._frames: dict[float, MeshFrame] = {}

    @property
    def nbytes(self) -> int:
        """Bytes of the frames."""
        return sum(
            array.nbytes
            for frame in list(self._frames.values())
            for array in (frame.positions, frame.fz, frame.fzbar)
        )

    def frame(self, time: float) -> MeshFrame:
        """Return the in-between at a time in [0, 1]."""
        if time not in self._frames:
            self._frames[time] = self._inbetweens.frame(time)
        return self._frames[time]


def compute_baseline(
    clip: Clip, baseline: Baseline, interval: int, domain: MeshedDomain
) -> MemoizedFrames:
    """Return a clip's in-betweens by a baseline, with those of all whole frames worked out.

    The mesh of the domain is the one that is shown. Through keys the motion has corners: none of
    these methods passes them at one velocity.

    Raises
    ------
    EngineError
        If the method is not for these keys.
    """
    keys = [clip.keys[index] for index in segment_keys(clip)[interval]]
    prepared = prepare_baseline(
        baseline,
        [clip.layer.map_of(key.pose) for key in keys],
        domain.mesh.vertices,
        domain.mesh.triangles,
        outline=domain.outline,
        anchor=clip.layer.anchor,
        turns=[keys[0].revolutions],
        handles=np.array([handle.position for handle in clip.layer.handles], dtype=np.complex128),
        bounds=clip.layer.bounds,
    )
    remembered = MemoizedFrames(prepared.segments[0])
    for frame in range(clip.frames.first, clip.frames.last + 1):
        moment = segment_time_at(clip, frame)
        if moment.segment == interval and keyed_pose_at(clip, moment) is None:
            remembered.frame(moment.weight)
    return remembered
