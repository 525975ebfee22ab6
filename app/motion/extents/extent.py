"""How far an animation moves over the plane."""

from collections.abc import Callable, Mapping
from typing import NamedTuple

import numpy as np

from app.document import (
    Document,
    FrameRange,
    clip_of,
    exported_frames,
    framed_frames,
    motion_source,
)
from app.errors import LissomError
from app.motion.corrected_frames import CorrectedFrames
from app.motion.extents.long_extent import farthest_reach
from app.motion.interval_store import IntervalStore
from app.motion.joints import Joints
from engine.arrays import Complexes, Floats


class Box(NamedTuple):
    """A rectangle from its lower left to its upper right corner."""

    lower: complex
    upper: complex

    def contains(self, other: "Box", *, slack: float) -> bool:
        """Tell whether the other box sticks out nowhere by more than `slack`."""
        below, above = other.lower - self.lower, self.upper - other.upper
        return min(below.real, below.imag, above.real, above.imag) >= -slack

    def joined(self, other: "Box") -> "Box":
        """Return the smallest box around both."""
        return box_around(np.array([*self, *other]))


def box_around(points: Complexes) -> Box:
    """Return the smallest box around points (n,), of which there is at least one."""
    x, y = points.real, points.imag
    return Box(complex(x.min(), y.min()), complex(x.max(), y.max()))


def extent_source(document: Document) -> tuple[object, ...]:
    """Return all of a document that its extent depends on; equal where the extent is."""
    motions = [(motion_source(each), each in document.exported) for each in document.layers]
    frames = framed_frames(document, exported_frames(document))
    return (*motions, document.frames, document.loop, document.fps, frames)


def measure_extent(
    document: Document,
    stores: Mapping[int, IntervalStore],
    joints: Joints | None = None,
    corrected: Mapping[int, CorrectedFrames] | None = None,
) -> Box:
    """Return the box around all that an export of a document shows.

    Parameters
    ----------
    stores : mapping of int to IntervalStore
        One for each layer, by its id, that has its in-betweens.
    joints : Joints, optional
        What is true of them is used again.
    corrected : mapping of int to CorrectedFrames, optional
        Whole, by the layers' ids.
    """
    clips = {layer: clip_of(document, layer) for layer in stores}
    frames = framed_frames(document, exported_frames(document))
    samplers = {layer: store.sampler for layer, store in stores.items()}
    joints = Joints(document, {layer: each for layer, each in samplers.items() if each}, joints)

    def place(layer: int, frame: int) -> Complexes | None:
        own = corrected.get(layer) if corrected else None
        correction = own.at(clips[layer], frame) if own else None
        positions = stores[layer].positions(clips[layer], frame, correction)
        return None if positions is None else joints.placement(layer, frame).on(positions)

    box = motion_box(document, frames, place)
    if box is None:
        raise ValueError("the in-betweens are not prepared")
    return box


class _Missing(Exception):  # noqa: N818 - it ends a search
    """A frame is not there yet."""


def motion_box(
    document: Document, frames: FrameRange, place: Callable[[int, int], Complexes | None]
) -> Box | None:
    """Return the box around all layers in all of these frames, of which few may be measured.

    Parameters
    ----------
    frames : FrameRange
    place : callable
        Returns where the vertices of a layer, by its id, are in a frame; None ends the search.

    Raises
    ------
    LissomError
        If a vertex is nowhere.
    """
    if not document.exported:
        return Box(0j, complex(*document.canvas))

    def reaches(frame: int) -> Floats:
        boxes = []
        for layer in document.exported:
            positions = place(layer.id, frame)
            if positions is None:
                raise _Missing
            boxes.append(box_around(positions))
        lower, upper = np.array(boxes).T
        found = np.column_stack([-lower.real, -lower.imag, upper.real, upper.imag])
        if not np.isfinite(found).all():
            raise LissomError(f"frame {frame} cannot be drawn: its points are not all finite")
        return found

    try:
        left, down, right, up = farthest_reach(document, frames, reaches).tolist()
    except _Missing:
        return None
    return Box(complex(-left, -down), complex(right, up))
