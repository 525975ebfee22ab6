"""What is in front at a frame."""

from typing import NamedTuple

from app.document.layer import Layer
from app.document.queries.clips import Clip
from engine.geometry import diameter

# Of the drawing's diameter: how far a depth reaches that is given no extent.
DEFAULT_DEPTH_EXTENT = 0.15


class DepthPoint(NamedTuple):
    """A point of the drawing that is in front, or behind, and how far around it that holds."""

    place: complex  # at rest
    depth: float  # from −1, behind, to 1, in front
    extent: float  # in pixels


def depth_points_at(clip: Clip, frame: float) -> tuple[DepthPoint, ...]:
    """Return what is in front, or behind, at a frame; what is neither is left out.

    A key's depths hold from its frame on until another key gives others; before the first one the
    handles' own do, or in a loop what the last one left. In a cycle each repeat begins with what
    was in front before the first one.
    """
    layer = clip.layer
    depths = {handle.id: handle.depth for handle in layer.handles}
    if clip.loop and clip.period and frame not in clip.frames:
        frame = clip.frames.first + (frame - clip.frames.first) % clip.period
    is_before_all = clip.loop and frame < clip.keys[0].frame
    for key in clip.keys:
        if key.depths and (is_before_all or _has_been(layer, key.frame, frame)):
            depths.update(key.depths)
    if not any(depths.values()):
        return ()
    usual = DEFAULT_DEPTH_EXTENT * diameter(layer.domain.outline)
    return tuple(
        DepthPoint(handle.position, depths[handle.id], handle.extent or usual)
        for handle in layer.handles
        if depths[handle.id]
    )


def _has_been(layer: Layer, key: int, frame: float) -> bool:
    """Tell whether what a key says holds at a frame, as far as no later one says else.

    What those of a cycle say holds until a repeat, or all of them, are over.
    """
    cycle = layer.cycle_containing(key)
    if cycle is None:
        return key <= frame
    end = frame if cycle.until is None else min(frame, cycle.until)
    return key <= frame and key <= cycle.source_frame(end)
