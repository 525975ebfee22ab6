"""The window's runtime values of a layer, and of its comparison by another method."""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Self

from app.cut_out import CutOut
from app.document import Baseline, Clip, Document, History, Layer, PictureFile, Variant, clip_of
from app.editor.work.derived import Derived
from app.editor.work.revised import Revised
from app.motion import (
    DeformMesh,
    InbetweenCache,
    LayerFrame,
    LayerStages,
    MemoryBudget,
    SceneFrame,
    needs_correction,
)
from app.solving import Rig
from app.storage import CutOutResult, Picture, cut_picture, decode_picture
from engine.arrays import Bytes


@dataclass(slots=True, kw_only=True, eq=False)
class ComparisonRuntime(LayerStages):
    """A layer animated by another method, for comparison with its own; both share their cache."""

    original: Layer  # the layer with its own method
    layer: Layer  # the layer with the other variant, if the method is a variant
    method: Variant | Baseline

    def clip(self, document: Document) -> Clip:
        """Return the compared layer in the time of its document."""
        baseline = self.method if isinstance(self.method, Baseline) else None
        return replace(clip_of(document, self.layer_id), layer=self.layer, baseline=baseline)


@dataclass(slots=True, kw_only=True, eq=False)
class LayerRuntime(LayerStages):
    """The window's runtime values of a layer: decoded picture, cached stages and shown frame."""

    file: PictureFile
    picture: Picture  # the decoded picture
    is_opaque: bool  # whether the picture has no transparent pixels
    rig: Rig | None = None  # for solving poses; None before the first one
    cut: Derived[CutOut, CutOutResult]  # the picture after the newest cut-out
    # The small picture for the list of layers.
    small: Derived[CutOutResult, Bytes | None] = field(default_factory=lambda: Derived(None))
    comparison: ComparisonRuntime | None = None  # the compared method, while the viewport is split

    @classmethod
    def of(cls, clip: Clip, picture: Picture, *, among: int = 1) -> Self:
        """Return the initial runtime of a layer: its keys are shown, and in-betweens follow.

        `among` is the number of layers.
        """
        mesh = DeformMesh.coarse(clip.layer.domain, among=among)
        return cls(
            layer_id=clip.layer.id,
            picture=picture,
            is_opaque=picture.is_opaque,
            file=clip.layer.picture,
            store=InbetweenCache(mesh=mesh.prepared(clip, clip.frames.first)),
            cut=Derived(
                cut_picture(picture, clip.layer.cut_out, is_alone=among == 1), clip.layer.cut_out
            ),
        )

    def releasable_bytes(self, clip: Clip) -> int:
        """Return the bytes that `release_intermediates` frees, now or once all series are there."""
        if self.store.has_failed(clip, "series"):
            return 0
        stores = filter(None, (self.store, self.fine))
        shown = sum(store.releasable_bytes(clip) for store in stores)
        sampler = self.store.sampler
        outline = 0 if sampler is None else sampler.known.nbytes
        return shown + outline + (0 if self.corrected is None else self.corrected.nbytes)

    def release_intermediates(self, clip: Clip) -> None:
        """Free the intermediate values of a clip's in-betweens; an edit computes them again.

        They are most of the memory of a layer with keys.
        """
        stores = [store for store in (self.store, self.fine) if store is not None]
        if needs_correction(clip) or not all(store.has(clip) for store in stores):
            return
        for store in stores:
            store.release_intermediates()
        if self.corrected is not None:
            self.corrected.rest()
        if self.store.sampler is not None:
            self.store.sampler.known.forget_transform()


@dataclass(slots=True, kw_only=True, eq=False)
class LayerRuntimes(Revised):
    """The runtimes of a document's layers, as many as it has layers."""

    layers: dict[int, LayerRuntime]  # by layer id
    # Of the in-betweens of all layers.
    budget: MemoryBudget = field(default_factory=MemoryBudget)
    # The displayed frame, and the same frame by the compared method.
    displayed: SceneFrame | None = None
    compared: SceneFrame | None = None
    # Decoded pictures, also of layers that undo may bring back.
    pictures: dict[PictureFile, Picture] = field(default_factory=dict)

    def show(self, displayed: SceneFrame, compared: SceneFrame) -> None:
        """Display a frame; its layers stay until the next ones are known."""
        for layer, each in displayed.layers.items():
            self.layers[layer].shown = each
        for layer, each in compared.layers.items():
            if (comparison := self.layers[layer].comparison) is not None:
                comparison.shown = each
        # An equal frame is no change.
        self.displayed = self.displayed if displayed == self.displayed else displayed
        self.compared = self.compared if compared == self.compared else compared

    @property
    def shown_frames(self) -> dict[int, LayerFrame]:
        """The shown frames, by layer id."""
        shown = {layer: runtime.shown for layer, runtime in self.layers.items()}
        return {layer: frame for layer, frame in shown.items() if frame is not None}

    def show_again(self, frames: Mapping[int, LayerFrame]) -> None:
        """Go on from earlier frames: a later frame was a preview."""
        for layer in frames.keys() & self.layers.keys():
            self.layers[layer].shown = frames[layer]

    def __post_init__(self) -> None:
        for runtime in self.layers.values():
            runtime.store.memory.join(self.budget)

    def keep_picture(self, file: PictureFile, picture: Picture) -> None:
        """Keep a decoded picture for a layer that will use it."""
        self.pictures[file] = picture

    def put(self, layer: int, runtime: LayerRuntime) -> None:
        """Use a runtime that was prepared for a new layer."""
        self.layers[layer] = runtime
        runtime.store.memory.join(self.budget)

    def match(self, document: Document, history: History) -> None:
        """Make missing runtimes of layers, and delete those of layers that are gone."""
        for identity in self.layers.keys() - {layer.id for layer in document.layers}:
            del self.layers[identity]
        # Pictures of layers that undo and redo may bring back are kept as well.
        spare = self.pictures.keys() - {layer.picture for layer in document.layers}
        for file in spare - history.picture_files if spare else ():
            del self.pictures[file]
        for layer in document.layers:
            runtime = self.layers.get(layer.id)
            if runtime is not None and runtime.file is layer.picture:
                self.pictures[layer.picture] = runtime.picture
                continue
            if layer.picture not in self.pictures:
                self.pictures[layer.picture] = decode_picture(layer.picture.data, layer.name)
            clip, picture = clip_of(document, layer.id), self.pictures[layer.picture]
            self.put(layer.id, LayerRuntime.of(clip, picture, among=len(document.layers)))
