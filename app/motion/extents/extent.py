"""Bounding boxes of animations."""

from collections.abc import Callable
from itertools import count
from typing import NamedTuple

import numpy as np

from app.document import (
    Document,
    FrameRange,
    export_frame_range,
    frames_for_fit,
    motion_source,
)
from app.errors import LissomError
from app.motion.evaluator import Evaluator
from app.motion.extents.long_extent import MOST_MEASURED, farthest_reach
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
    evaluator: Evaluator,
    frames: FrameRange | None = None,
    progress: Callable[[float], None] = lambda _share: None,
) -> BoundingBox:
    """Return the bounding box of all exported layers in some frames.

    By default these are the frames of an export. Long ranges are sampled. `progress` takes the
    share of the measured frames. Raises a `LissomError` if a position is not finite.
    """
    if not document.exported_layers:
        return BoundingBox(0j, complex(*document.canvas))
    frames = frames_for_fit(document, frames or export_frame_range(document))
    most, measured = min(frames.last - frames.first + 1, MOST_MEASURED), count()

    def reaches(frame: int) -> Floats:
        progress(min(next(measured) / most, 1.0))
        bent = map(document.deform_layer, document.exported_layers)
        ids = dict.fromkeys(layer.id for layer in bent)
        layers = evaluator.evaluate(document, frame, only=ids, keep=True).layers
        boxes = [bounding_box(layer.scene_positions) for layer in layers.values()]
        lower, upper = np.array(boxes).T
        found = np.column_stack([-lower.real, -lower.imag, upper.real, upper.imag])
        if not np.isfinite(found).all():
            raise LissomError(
                _("frame {frame} cannot be drawn: some of its points are not finite").format(
                    frame=frame
                )
            )
        return found

    left, down, right, up = farthest_reach(document, frames, reaches).tolist()
    return BoundingBox(complex(-left, -down), complex(right, up))
