"""How far an animation moves over the plane."""

from typing import NamedTuple

import numpy as np

from app.document import Document, exported_frames
from app.motion.prepared import Motion
from engine.arrays import Complexes


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
