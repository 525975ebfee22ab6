"""How far an animation moves over the plane."""

from typing import NamedTuple

import numpy as np

from app.document.model import Document
from app.document.timeline import exported_frames
from app.export.framing import Box, box_around
from app.motion import Motion


class Reach(NamedTuple):
    """The box around all that an export shows, and what of the document it follows from."""

    source: tuple[object, ...]
    box: Box


def source_of(document: Document) -> tuple[object, ...]:
    """Return all of a document that its reach depends on; equal where the reach is."""
    return (
        document.domain,
        document.keys,
        document.frames,
        document.loop,
        document.anchor,
        document.variant,
        exported_frames(document),
    )


def measure_reach(document: Document, motion: Motion) -> Reach | None:
    """Measure a document's reach; None where the motion does not know all of its in-betweens."""
    frames = exported_frames(document)
    corners: list[complex] = []
    for frame in range(frames.first, frames.last + 1):
        positions = motion.positions(document, frame)
        if positions is None:
            return None
        corners += box_around(positions)
    return Reach(source_of(document), box_around(np.array(corners)))
