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
    CompositeGroup,
    Document,
    Layer,
    Pose,
    camera_at,
    clip_of,
    composite_layers,
    is_visible,
    limb_ends,
    transform_at,
    without_foreign_clips,
)
from app.motion.inbetweens.pose_sampler import PoseSampler
from app.motion.layer_frame import LayerFrame, member_frame
from app.motion.layer_stages import LayerStages, exact_budget
from app.motion.parenting.layer_limbs import place_layer
from app.motion.parenting.layer_pull import LayerPull
from app.motion.parenting.parent_transforms import ParentTransforms
from app.motion.parenting.parenting_key import have_same_parents, parenting_key
from engine.geometry import IDENTITY_MOTION, Similarity

# "exact" computes what is missing; "display" returns at once, if need be with placeholders.
Quality = Literal["exact", "display"]
Drawn = TypeVar("Drawn")
FRAMES_BUDGET = 2**28  # bytes of kept frames of an export


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
            and not document.is_deform_group(layer)
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
        samplers, budget = samplers or {}, exact_budget()
        layers = {
            layer.id: LayerStages.exact(clip_of(document, layer.id), samplers.get(layer.id), budget)
            for layer in document.layers
            if layer.deform_group is None
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
            every = [
                each.id
                for each in document.layers
                if is_visible(document, each, frame) and not document.is_deform_group(each.id)
            ]
            wanted = every if only is None else only
            bent = {each: document.deform_layer(document.layer(each)).id for each in wanted}
            moved = {
                each: self._exact(document, each, frame, keep=keep)
                for each in dict.fromkeys(bent.values())
            }
            layers = {
                each: moved[by] if each == by else member_frame(moved[by], clip_of(document, each))
                for each, by in bent.items()
            }
        else:
            shown = {
                layer: stages.displayed_frame(
                    document, int(frame), (poses or {}).get(layer), is_coarse=is_coarse
                )
                for layer, stages in self.layers.items()
                if document.layer(layer).deform_group is None
            }
            layers = self.placed(document, shown, poses or {})
            for layer, stages in self.layers.items():
                if layer not in layers:
                    group = layers[document.deform_layer(document.layer(layer)).id]
                    layers[layer] = member_frame(group, stages.clip(document), stages.shown)
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

    def exact_placement(self, document: Document, layer: int, frame: float) -> Similarity:
        """Return a layer's placement at a frame; what is missing is computed."""
        self.check()
        bent = document.deform_layer(document.layer(layer)).id
        return self._exact_transforms(document).placement(bent, frame)

    def _exact_transforms(self, document: Document) -> ParentTransforms:
        if self._own is None or self._own.document is not document:
            samplers = {layer: each.store.sampler for layer, each in self.layers.items()}
            known = {layer: each for layer, each in samplers.items() if each is not None}
            self._own = ParentTransforms(document, known, self._own or self.transforms)
        return self._own

    def current_transforms(self, document: Document) -> ParentTransforms | None:
        """Return the transforms of a document; None without parents, or while they are unknown."""
        known = self.transforms
        if known is None or known.document is document:
            return known
        key = parenting_key(document)
        return known if key and parenting_key(known.document) == key else None

    def placements(
        self, document: Document, layer: int, frames: Sequence[int]
    ) -> list[Similarity] | None:
        """Return a layer's placements at some frames; None while they are unknown.

        While the layer itself is posed, its earlier transforms stay valid.
        """
        own = document.deform_layer(document.layer(layer))
        layer, transforms = own.id, self.current_transforms(document)
        if not own.attachments and not limb_ends(document, layer):
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
            if not own.attachments and not limb_ends(document, layer):
                placement = transform_at(document, own, each.frame)
            elif transforms is None or any(
                parent.id in corrected
                for parent in (*document.all_ancestors(layer), *limb_ends(document, layer))
            ):
                placement = place_layer(
                    document,
                    layer,
                    each.frame,
                    lambda layer, place: shown[layer.id].pivot_frame_at(place),
                    partial(self._earlier_transform, each.frame),
                )
            else:
                placement = transforms.placement(layer, each.frame, poses)
            same = placement == each.placement
            placed[layer] = each if same else replace(each, placement=placement)
        return placed

    def pull(self, document: Document, layer: int, frame: float) -> LayerPull | None:
        """Return the pull of a layer from where it is shown; None until all layers are shown."""
        shown = {identity: stages.shown for identity, stages in self.layers.items()}
        frames = {identity: each for identity, each in shown.items() if each is not None}
        if frames.keys() < {each.id for each in document.layers}:
            return None
        return LayerPull(
            document,
            layer,
            frame,
            lambda layer, place: frames[layer.id].pivot_frame_at(place),
            partial(self._earlier_transform, frame),
        )

    def _earlier_transform(self, frame: float, layer: Layer, joint: Attachment) -> Similarity:
        """Return the transform that an attachment kept in an earlier document, else identity."""
        earlier = self.transforms
        known = {each.id: each for each in earlier.document.layers} if earlier else {}
        was = known.get(layer.id)
        if earlier is None or was is None or joint not in earlier.document.attachments_of(was):
            return IDENTITY_MOTION
        return earlier.kept_transform(was, joint, frame)
