"""The cached stages of a layer's frames, from which frames are evaluated."""

from dataclasses import dataclass
from typing import Self

from app.document import (
    Clip,
    Document,
    Pose,
    clip_of,
    keyed_pose_at,
    segment_time_at,
)
from app.motion.caches.corrected_frames import CorrectedFrames, reuse_corrections
from app.motion.caches.inbetween_cache import InbetweenCache
from app.motion.caches.segment_memory import MemoryBudget
from app.motion.inbetweens.pose_sampler import PoseSampler
from app.motion.inbetweens.spring_offsets import ParentMotion
from app.motion.layer_frame import LayerFrame, evaluate_layer
from app.motion.meshes.deform_mesh import DeformMesh

EXACT_BUDGET = 2**28  # bytes of prepared segments of an export


def exact_budget() -> MemoryBudget:
    """Return the budget of the segments of exact frames, all of which no clip needs later."""
    return MemoryBudget(EXACT_BUDGET, spare=EXACT_BUDGET)


@dataclass(slots=True, kw_only=True, eq=False)
class LayerStages:
    """The cached stages of a layer: in-betweens on one or two meshes, and corrections.

    `shown` is the last frame for display, which stays while the next one is computed.
    """

    layer_id: int
    store: InbetweenCache  # on a mesh that may be coarser than the layer's own
    fine: InbetweenCache | None = None  # on the layer's own mesh, if it is finer and prepared
    corrected: CorrectedFrames | None = None
    shown: LayerFrame | None = None

    @classmethod
    def exact(
        cls, clip: Clip, sibling: PoseSampler | None = None, budget: MemoryBudget | None = None
    ) -> Self:
        """Return the stages of a layer on its own mesh; a sibling's outline data is reused."""
        layer = clip.layer
        sampler = PoseSampler(layer, sibling=sibling)
        store = InbetweenCache(
            mesh=DeformMesh.fine(layer.domain),
            sampler=sampler,
            samples_poses=True,
            budget=budget or exact_budget(),
        )
        return cls(layer_id=layer.id, store=store, corrected=CorrectedFrames(clip))

    def clip(self, document: Document) -> Clip:
        """Return the layer in the time of its document."""
        return clip_of(document, self.layer_id)

    def frame(self, document: Document, frame: float, carried: ParentMotion) -> LayerFrame:
        """Return an exact frame in the layer's space; what is missing is computed.

        `carried` returns the layer's transform by its parents at a frame.
        """
        clip, store = self.clip(document), self.store
        moment = segment_time_at(clip, frame)
        pose = keyed_pose_at(clip, moment)
        if not store.is_exact(clip, frame):
            store.add(store.segments_job(clip, [] if pose else [moment.segment])())
        if self.corrected is not None:
            self.corrected = reuse_corrections(document, self.layer_id, self.corrected)
        if (
            store.sampler is not None
            and self.corrected is not None
            and not self.corrected.is_exact(clip, frame)
        ):
            self.corrected.compute(frame, store.sampler, carried)
        return evaluate_layer(clip, frame, None, [store], None, self.corrected)

    def displayed_frame(
        self, document: Document, frame: int, pose: Pose | None, *, is_coarse: bool
    ) -> LayerFrame:
        """Return the best available frame, at once."""
        fine = [] if self.fine is None or is_coarse else [self.fine]
        caches = [*fine, self.store]
        return evaluate_layer(self.clip(document), frame, pose, caches, self.shown, self.corrected)
