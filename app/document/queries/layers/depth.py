"""Depth of the drawing at a frame."""

from typing import NamedTuple

from app.document.layer import Layer
from app.document.queries.clips import Clip
from engine.geometry import diameter

# Default radius of a depth as a fraction of the drawing's diameter.
DEFAULT_DEPTH_EXTENT = 0.15


class DepthPoint(NamedTuple):
    """A point of the drawing with a depth and its radius."""

    place: complex  # at rest
    depth: float  # from −1, behind, to 1, in front
    extent: float  # in pixels


def depth_points_at(clip: Clip, frame: float) -> tuple[DepthPoint, ...]:
    """Return the points with a depth other than 0 at a frame.

    A key's depths hold from its frame on until a later key changes them. Before the first key, the
    depths of the handles hold, or in a loop the depths after the last key. Each repeat of a cycle
    begins with the depths before the first one.
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
    """Return whether a key's depths have taken effect at a frame.

    Depths of a key in a cycle hold until the repeat or all repeats end.
    """
    cycle = layer.cycle_containing(key)
    if cycle is None:
        return key <= frame
    end = frame if cycle.until is None else min(frame, cycle.until)
    return key <= frame and key <= cycle.source_frame(end)
