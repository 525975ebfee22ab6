"""A layer as a window has it, and its twin by another method."""

from dataclasses import dataclass, field, replace
from typing import Self

from app.document import Baseline, Clip, Document, Layer, PictureFile, Variant, clip_of
from app.editor.work.derived import Derived
from app.motion import CorrectedFrames, DeformMesh, DisplayedFrame, InbetweenCache, needs_correction
from app.solving import Rig
from app.storage import CutOutResult, Picture, cut_picture
from engine.arrays import Bytes
from engine.domain import CutOut


@dataclass(slots=True, kw_only=True, eq=False)
class ComparisonRuntime:
    """A layer by another method, which its own is compared with."""

    original: Layer  # the layer as it is
    layer: Layer  # the same by the other variant, where the method is one
    method: Variant | Baseline
    shown: DisplayedFrame | None = None

    def clip(self, document: Document) -> Clip:
        """Return it in the time of its scene."""
        baseline = self.method if isinstance(self.method, Baseline) else None
        return replace(clip_of(document, self.layer.id), layer=self.layer, baseline=baseline)


@dataclass(slots=True, kw_only=True, eq=False)
class LayerRuntime:
    """A layer as a window has it."""

    file: PictureFile
    picture: Picture  # decoded from that
    is_opaque: bool  # whether it has no transparency: its background was found by its colour
    # Its in-betweens on a coarse mesh, and on its own one if that is another and is there.
    store: InbetweenCache
    fine: InbetweenCache | None = None
    shown: DisplayedFrame | None = None  # None before the first frame of the window
    corrected: CorrectedFrames | None = None  # the corrections of its frames
    rig: Rig | None = None  # for the poses to come; None before the first of them
    cut: Derived[CutOut, CutOutResult]  # what is left of the picture, as the newest cut-out has it
    # That made small, for the list of layers.
    small: Derived[CutOutResult, Bytes | None] = field(default_factory=lambda: Derived(None))
    comparison: ComparisonRuntime | None = None  # beside it, while the viewport is split

    @classmethod
    def of(cls, clip: Clip, picture: Picture, *, among: int = 1) -> Self:
        """Return a layer as the window has it at first: its keys are shown; in-betweens follow.

        `among` tells how many layers there are.
        """
        return cls(
            picture=picture,
            is_opaque=picture.is_opaque,
            file=clip.layer.picture,
            store=InbetweenCache(mesh=DeformMesh.coarse(clip.layer.domain, among=among)),
            cut=Derived(
                cut_picture(picture, clip.layer.cut_out, is_alone=among == 1), clip.layer.cut_out
            ),
        )

    def releasable_bytes(self, clip: Clip) -> int:
        """Return how many bytes `rest` lets go, or will once series show all of a clip."""
        if self.store.has_failed(clip, "series"):
            return 0
        stores = filter(None, (self.store, self.fine))
        shown = sum(store.releasable_bytes(clip) for store in stores)
        sampler = self.store.sampler
        outline = 0 if sampler is None else sampler.known.nbytes
        return shown + outline + (0 if self.corrected is None else self.corrected.nbytes)

    def release_intermediates(self, clip: Clip) -> None:
        """Let go of what all that is shown of a clip was made with; an edit needs it again.

        It is most of what a layer with keys takes.
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
