"""Cache keys of the in-betweens of two keys, independent of the clip."""

from app.document import (
    Clip,
    Pose,
    Variant,
    keyed_pose_at,
    motion_anchor,
    pinned_segments,
    pose_segments,
    segment_time_at,
    slider_poses,
    slider_weights_at,
)

# Ids of the maps (handles may be added and deleted) of both keys and of the neighbour keys at
# smooth ends; full turns, tangents, limits, anchor and variant.
SegmentKey = tuple[object, ...]


def segment_key(clip: Clip, interval: int, variant: Variant | None = None) -> SegmentKey:
    """Return the cache key of a segment's in-betweens."""
    segment, layer = pose_segments(clip)[interval], clip.layer
    # As numbers, which hash much faster than the dataclass.
    bounds = (layer.widest_bounds.k, layer.widest_bounds.sigma_a, layer.widest_bounds.sigma_b)
    maps = [identity for key in segment.keys for identity in (id(key.pose.phi), id(key.pose.psi))]
    joined = (
        (segment.start, segment.end, segment.apart, bounds) if segment.has_smooth_tangent else ()
    )
    if clip.baseline is None:
        pinned = pinned_segments(clip)[interval]
        pins = () if pinned is None else (pinned.content,)
        return (
            *maps,
            *segment.revolutions,
            *joined,
            motion_anchor(layer),
            variant or layer.variant,
            *pins,
        )
    rest = (bounds, tuple(handle.position for handle in layer.handles), clip.frames)
    return *maps, *segment.revolutions, *joined, motion_anchor(layer), clip.baseline, *rest


def segment_poses(clip: Clip, interval: int) -> tuple[Pose, ...]:
    """Return the poses whose ids are in the cache key; they must be kept alive."""
    pinned = pinned_segments(clip)[interval]
    poses = tuple(key.pose for key in pose_segments(clip)[interval].keys)
    return poses if pinned is None else pinned.poses


def frame_content(clip: Clip, frame: float, variant: Variant | None = None) -> tuple[object, ...]:
    """Return the values that determine a frame before tracks and springs.

    They keep the poses alive. Limits, anchor and stiffness of the layer are left out.
    """
    sliders = slider_poses(clip), slider_weights_at(clip, frame)
    moment = segment_time_at(clip, frame)
    resting = keyed_pose_at(clip, moment)
    if resting is not None:
        return resting, sliders
    pair = segment_key(clip, moment.segment, variant)
    return segment_poses(clip, moment.segment), pair, moment.weight, sliders
