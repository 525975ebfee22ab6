"""Bounding boxes of animations."""

from collections.abc import Callable, Mapping
from typing import NamedTuple

import numpy as np

from app.document import (
    Document,
    FrameRange,
    clip_of,
    export_frame_range,
    frames_for_fit,
    motion_source,
)
from app.errors import LissomError
from app.motion.corrected_frames import CorrectedFrames
from app.motion.extents.long_extent import farthest_reach
from app.motion.inbetween_cache import InbetweenCache
from app.motion.parenting.parent_transforms import ParentTransforms
from app.texts import _
from engine.arrays import Complexes, Floats


class BoundingBox(NamedTuple):
    """A rectangle by its lower left and upper right corners."""

    lower: complex
    upper: complex

    def contains(self, other: "BoundingBox", *, slack: float) -> bool:
        """Return whether the other box exceeds this one by at most `slack` on each side."""
        below, above = other.lower - self.lower, self.upper - other.upper
        return min(below.real, below.imag, above.real, above.imag) >= -slack

    def joined(self, other: "BoundingBox") -> "BoundingBox":
        """Return the smallest box around both."""
        return bounding_box(np.array([*self, *other]))


def bounding_box(points: Complexes) -> BoundingBox:
    """Return the bounding box of points (n,), n ≥ 1."""
    x, y = points.real, points.imag
    return BoundingBox(complex(x.min(), y.min()), complex(x.max(), y.max()))


def extent_key(document: Document) -> tuple[object, ...]:
    """Return the values that determine the extent of a document; equal for equal extents."""
    motions = [(motion_source(each), each in document.exported_layers) for each in document.layers]
    frames = frames_for_fit(document, export_frame_range(document))
    return (*motions, document.frames, document.loop, document.fps, frames)


def measure_extent(
    document: Document,
    stores: Mapping[int, InbetweenCache],
    joints: ParentTransforms | None = None,
    corrected: Mapping[int, CorrectedFrames] | None = None,
) -> BoundingBox:
    """Return the bounding box of an export's motion.

    `stores` have all in-betweens, and `corrected` all corrections, by layer id. Earlier transforms
    `joints` are reused.
    """
    clips = {layer: clip_of(document, layer) for layer in stores}
    frames = frames_for_fit(document, export_frame_range(document))
    samplers = {layer: store.sampler for layer, store in stores.items()}
    joints = ParentTransforms(
        document, {layer: each for layer, each in samplers.items() if each}, joints
    )

    def place(layer: int, frame: int) -> Complexes | None:
        own = corrected.get(layer) if corrected else None
        correction = own.at(clips[layer], frame) if own else None
        positions = stores[layer].positions(clips[layer], frame, correction)
        return None if positions is None else joints.placement(layer, frame).apply(positions)

    box = motion_bounding_box(document, frames, place)
    if box is None:
        raise ValueError("the in-betweens are not prepared")
    return box


class _Missing(Exception):  # noqa: N818 - it ends a search
    """A frame is not computed yet."""


def motion_bounding_box(
    document: Document, frames: FrameRange, place: Callable[[int, int], Complexes | None]
) -> BoundingBox | None:
    """Return the bounding box of all layers in these frames; long ranges are sampled.

    `place` returns the vertex positions of a layer, by its id, in a frame. None ends the search.
    Raises a `LissomError` if a position is not finite.
    """
    if not document.exported_layers:
        return BoundingBox(0j, complex(*document.canvas))

    def reaches(frame: int) -> Floats:
        boxes = []
        for layer in document.exported_layers:
            positions = place(layer.id, frame)
            if positions is None:
                raise _Missing
            boxes.append(bounding_box(positions))
        lower, upper = np.array(boxes).T
        found = np.column_stack([-lower.real, -lower.imag, upper.real, upper.imag])
        if not np.isfinite(found).all():
            raise LissomError(
                _("frame {frame} cannot be drawn: some of its points are not finite").format(
                    frame=frame
                )
            )
        return found

    try:
        left, down, right, up = farthest_reach(document, frames, reaches).tolist()
    except _Missing:
        return None
    return BoundingBox(complex(-left, -down), complex(right, up))
