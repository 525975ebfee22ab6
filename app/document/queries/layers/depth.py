"""Depth of the drawing at a frame."""

from typing import NamedTuple

from app.document.channels.kinds import DEPTH
from app.document.keyframe import Handle
from app.document.queries.channel_values.repeats import held_key_at, repeated_keys
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

    Before the first key of a handle, its own depth holds, or in a loop the depth of its last key.
    """
    layer = clip.layer
    if not any(handle.depth for handle in layer.handles) and not layer.channels:
        return ()
    if clip.loop and clip.period and frame not in clip.frames:
        frame = clip.frames.first + (frame - clip.frames.first) % clip.period
    depths = {handle.id: _depth_at(clip, handle, frame) for handle in layer.handles}
    if not any(depths.values()):
        return ()
    usual = DEFAULT_DEPTH_EXTENT * diameter(layer.domain.outline)
    return tuple(
        DepthPoint(handle.position, depths[handle.id], handle.extent or usual)
        for handle in layer.handles
        if depths[handle.id]
    )


def _depth_at(clip: Clip, handle: Handle, frame: float) -> float:
    keys, end = clip.layer.keys_of(DEPTH, handle.id), clip.frames.last
    if not keys:
        return handle.depth
    keys = repeated_keys(keys, clip.layer.cycles, end, handle.depth)
    key = held_key_at(keys, frame)
    if key is None and clip.loop:
        key = held_key_at(keys, end)
    return handle.depth if key is None else key.value
