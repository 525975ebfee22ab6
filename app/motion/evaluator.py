"""What a document shows at a frame: the one answer for the window, exports and reports.

Stages: in-betweens with auto-pins, corrections by tracks and springs, transforms by parents, then
visible layers, their order and the camera. Each stage is cached by what determines it.
"""

from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import partial
from typing import Literal, Self, TypeVar

from app.document import (
    Attachment,
    Camera,
    Clip,
    CompositeGroup,
    Document,
    Layer,
    Pose,
    camera_at,
    clip_of,
    composite_layers,
    is_visible,
    keyed_pose_at,
    segment_time_at,
    transform_at,
    without_foreign_clips,
)
from app.motion.corrected_frames import CorrectedFrames
from app.motion.inbetween_cache import InbetweenCache
from app.motion.inbetweens.pose_sampler import PoseSampler
from app.motion.inbetweens.spring_offsets import ParentMotion
from app.motion.layer_frame import LayerFrame, evaluate_layer
from app.motion.meshes.deform_mesh import DeformMesh
from app.motion.parenting.chain import compose_chain, parent_links
from app.motion.parenting.parent_transforms import (
    ParentTransforms,
    have_same_parents,
    parenting_key,
)
from engine.geometry import IDENTITY_MOTION, RigidMotion

# "exact" computes what is missing; "display" returns at once, if need be with placeholders.
Quality = Literal["exact", "display"]
Drawn = TypeVar("Drawn")
SEGMENTS_BUDGET = 2**28  # bytes of prepared segments per layer of an export
FRAMES_BUDGET = 2**28  # bytes of kept frames of an export


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
    def exact(cls, clip: Clip, sibling: PoseSampler | None = None) -> Self:
        """Return the stages of a layer on its own mesh; a sibling's outline data is reused."""
        layer = clip.layer
        if sibling is not None and sibling.domain.cage is not layer.domain.cage:
            sibling = None
        sampler = PoseSampler(layer.domain, anchor=layer.anchor, sibling=sibling)
        store = InbetweenCache(
            mesh=DeformMesh.fine(layer.domain),
            sampler=sampler,
            samples_poses=True,
            budget=SEGMENTS_BUDGET,
            spare=SEGMENTS_BUDGET,
        )
        return cls(layer_id=layer.id, store=store, corrected=CorrectedFrames(clip))

    def clip(self, document: Document) -> Clip:
        """Return the layer in the time of its document."""
        return clip_of(document, self.layer_id)

    def frame(self, document: Document, frame: float, carried: ParentMotion) -> LayerFrame:
        """Return an exact frame in the layer's space; what is missing is computed.

        `carried` returns the layer's transform by its parents at a frame.
        """
        clip, moment = self.clip(document), segment_time_at(self.clip(document), frame)
        store, pose = self.store, keyed_pose_at(clip, moment)
        if not store.is_exact(clip, frame):
            store.add(store.segments_job(clip, [] if pose else [moment.segment])())
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


@dataclass(frozen=True, slots=True, kw_only=True)
class SceneFrame:
    """A frame of a document: its layers on their meshes, placed in the scene."""

    document: Document
    frame: float
    layers: Mapping[int, LayerFrame]  # by layer id

    @property
    def camera(self) -> Camera | None:
        """The camera; None without camera keys."""
        return camera_at(self.document, self.frame)

    @property
    def visible_layers(self) -> dict[int, LayerFrame]:
        """The layers that are visible, by id."""
        document, frame = self.document, self.frame
        return {
            layer: each
            for layer, each in self.layers.items()
            if is_visible(document, document.layer(layer), frame)
        }

    def alone(self, layers: Collection[int]) -> Self:
        """Return the frame with these layers only; those clipped to others are not clipped."""
        return replace(
            self,
            document=without_foreign_clips(self.document, layers),
            layers={layer: each for layer, each in self.layers.items() if layer in layers},
        )

    def composite(self, drawn: Mapping[int, Drawn]) -> tuple[Drawn | CompositeGroup[Drawn], ...]:
        """Return the compositing of the drawn visible layers, by id, from back to front."""
        return composite_layers(self.document, drawn, self.frame)


@dataclass(slots=True, kw_only=True, eq=False)
class Evaluator:
    """Evaluates frames of documents from the cached stages of their layers, by id.

    `transforms` are the newest complete transforms by parents, possibly of an earlier document.
    `check` is called before anything is computed, and may raise an exception to end the work.
    """

    layers: Mapping[int, LayerStages]
    transforms: ParentTransforms | None = None
    check: Callable[[], None] = lambda: None
    # Transforms of the document whose exact frames were evaluated last.
    _own: ParentTransforms | None = field(init=False, default=None)
    _room: int = field(init=False, default_factory=lambda: FRAMES_BUDGET)
    # Kept frames by document, layer and frame.
    _known: dict[tuple[Document, int, float], LayerFrame] = field(init=False, default_factory=dict)

    @classmethod
    def exact(
        cls,
        document: Document,
        samplers: Mapping[int, PoseSampler] | None = None,
        check: Callable[[], None] = lambda: None,
    ) -> Self:
        """Return an evaluator of a document on the layers' own meshes, with caches of its own.

        The outline data of earlier samplers, by layer id, is reused.
        """
        samplers = samplers or {}
        layers = {
            layer.id: LayerStages.exact(clip_of(document, layer.id), samplers.get(layer.id))
            for layer in document.layers
        }
        return cls(layers=layers, check=check)

    def evaluate(
        self,
        document: Document,
        frame: float,
        quality: Quality = "exact",
        *,
        only: Collection[int] | None = None,
        poses: Mapping[int, Pose] | None = None,
        is_coarse: bool = False,
        keep: bool = False,
    ) -> SceneFrame:
        """Return a frame of a document.

        Parameters
        ----------
        only : collection of int, optional
            Ids of the layers to evaluate; by default all that are visible, for display also hidden
            ones.
        poses : mapping of int to Pose, optional
            For display: poses that are not in the document, shown in place of the layers' own.
        is_coarse : bool
            For display: whether fine meshes are too slow now.
        keep : bool
            Whether exact layers are kept, within a budget, until they are evaluated once more.
        """
        if quality == "exact":
            every = [each.id for each in document.layers if is_visible(document, each, frame)]
            wanted = every if only is None else only
            layers = {each: self._exact(document, each, frame, keep=keep) for each in wanted}
        else:
            shown = {
                layer: stages.displayed_frame(
                    document, int(frame), (poses or {}).get(layer), is_coarse=is_coarse
                )
                for layer, stages in self.layers.items()
            }
            layers = self.placed(document, shown, poses or {})
        return SceneFrame(document=document, frame=frame, layers=layers)

    def _exact(self, document: Document, layer: int, frame: float, *, keep: bool) -> LayerFrame:
        self.check()
        found = self._known.pop((document, layer, frame), None)
        if found is not None:
            self._room += found.nbytes
        else:
            transforms = self._exact_transforms(document)
            carried = partial(transforms.parent_transform, layer)
            found = self.layers[layer].frame(document, frame, carried)
            found = replace(found, placement=transforms.placement(layer, frame))
        if keep and found.nbytes <= self._room:
            self._room -= found.nbytes
            self._known[document, layer, frame] = found
        return found

    def _exact_transforms(self, document: Document) -> ParentTransforms:
        if self._own is None or self._own.document is not document:
            samplers = {layer: each.store.sampler for layer, each in self.layers.items()}
            known = {layer: each for layer, each in samplers.items() if each is not None}
            self._own = ParentTransforms(document, known, self._own or self.transforms)
        return self._own

    def current_transforms(self, document: Document) -> ParentTransforms | None:
        """Return the transforms of a document; None without parents, or while they are unknown."""
        known, key = self.transforms, parenting_key(document)
        is_current = known is not None and bool(key) and parenting_key(known.document) == key
        return known if is_current else None

    def placements(
        self, document: Document, layer: int, frames: Sequence[int]
    ) -> list[RigidMotion] | None:
        """Return a layer's placements at some frames; None while they are unknown.

        While the layer itself is posed, its earlier transforms stay valid.
        """
        own, transforms = document.layer(layer), self.current_transforms(document)
        if not own.attachments:
            return [transform_at(document, own, frame) for frame in frames]
        if transforms is None and self.transforms is not None:
            is_same = have_same_parents(self.transforms.document, document, own)
            transforms = self.transforms if is_same else None
        if transforms is None:
            return None
        return [transforms.placement(layer, frame) for frame in frames]

    def placed(
        self, document: Document, shown: Mapping[int, LayerFrame], poses: Mapping[int, Pose]
    ) -> dict[int, LayerFrame]:
        """Return frames for display with their placements in the scene.

        Without current transforms, placements have the accuracy of the meshes. So do children of a
        displayed pose with a correction, which the transforms do not contain. Until the transforms
        exist, those of an earlier document serve attachments with `keep_world_transform`.
        """
        transforms = self.current_transforms(document)
        corrected = {each for each in poses.keys() & shown.keys() if shown[each].correction}
        placed = {}
        for layer, each in shown.items():
            own = document.layer(layer)
            ancestors = document.all_ancestors(layer)
            if not own.attachments:
                placement = transform_at(document, own, each.frame)
            elif transforms is None or any(parent.id in corrected for parent in ancestors):
                placement = compose_chain(
                    parent_links(document, layer, each.frame),
                    lambda layer, place: shown[layer.id].pivot_frame_at(place),
                    partial(self._earlier_transform, each.frame),
                )
            else:
                placement = transforms.placement(layer, each.frame, poses)
            same = placement == each.placement
            placed[layer] = each if same else replace(each, placement=placement)
        return placed

    def _earlier_transform(self, frame: float, layer: Layer, joint: Attachment) -> RigidMotion:
        """Return the transform that an attachment kept in an earlier document, else identity."""
        earlier = self.transforms
        known = {each.id: each for each in earlier.document.layers} if earlier else {}
        was = known.get(layer.id)
        if earlier is None or was is None or joint not in earlier.document.attachments_of(was):
            return IDENTITY_MOTION
        return earlier.kept_transform(was, joint, frame)
