"""In-betweens on a mesh by rival methods, for comparison with the layer's variant."""

import numpy as np

from app.baseline import Baseline
from app.document import Clip, keyed_pose_at, motion_anchor, segment_keys, segment_time_at
from app.motion.rival_methods.mesh_keyframes import MeshFrame, MeshInbetweens
from app.motion.rival_methods.preparation import prepare_baseline
from engine.domain import MeshedDomain


class MemoizedFrames:
    """In-betweens of two keys with computed frames kept, since some methods are slow."""

    def __init__(self, inbetweens: MeshInbetweens) -> None:
        self._inbetweens = inbetweens
        self._frames: dict[float, MeshFrame] = {}

    @property
    def nbytes(self) -> int:
        """Bytes of the kept frames."""
        return sum(
            array.nbytes
            for frame in list(self._frames.values())
            for array in (frame.positions, frame.fz, frame.fzbar)
        )

    def frame(self, time: float) -> MeshFrame:
        if time not in self._frames:
            self._frames[time] = self._inbetweens.frame(time)
        return self._frames[time]


def compute_baseline(
    clip: Clip, baseline: Baseline, interval: int, domain: MeshedDomain
) -> MemoizedFrames:
    """Return in-betweens by a rival method, with all whole frames computed.

    The domain's mesh is the displayed mesh. The motion has corners at keys, since these methods
    blend two keys only. Raises an `EngineError` if the method cannot handle these keys.
    """
    keys = [clip.keys[index] for index in segment_keys(clip)[interval]]
    prepared = prepare_baseline(
        baseline,
        [clip.layer.map_of(key.pose) for key in keys],
        domain.mesh.vertices,
        domain.mesh.triangles,
        outline=domain.outline,
        anchor=motion_anchor(clip.layer),
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
