"""By what the in-betweens of two keys are known, whichever clip they are in."""

from app.document import Clip, Pose, Variant, pinned_segments, pose_segments

# The maps, their own and those of the keys around that the motion passes through, since handles may
# come and go; turns, joints, bounds, anchor and variant.
SegmentKey = tuple[object, ...]


def segment_key(clip: Clip, interval: int, variant: Variant | None = None) -> SegmentKey:
    """Return the key by which the in-betweens of one of a clip's intervals are known."""
    transit, layer = pose_segments(clip)[interval], clip.layer
    # As numbers, which are hashed far sooner than the dataclass.
    bounds = (layer.bounds.k, layer.bounds.sigma_a, layer.bounds.sigma_b)
    maps = [identity for key in transit.keys for identity in (id(key.pose.phi), id(key.pose.psi))]
    joined = (
        (transit.start, transit.end, transit.apart, bounds) if transit.has_smooth_tangent else ()
    )
    if clip.baseline is None:
        pinned = pinned_segments(clip)[interval]
        pins = () if pinned is None else (pinned.content,)
        return *maps, *transit.revolutions, *joined, layer.anchor, variant or layer.variant, *pins
    rest = (bounds, tuple(handle.position for handle in layer.handles), clip.frames)
    return *maps, *transit.revolutions, *joined, layer.anchor, clip.baseline, *rest


def segment_poses(clip: Clip, interval: int) -> tuple[Pose, ...]:
    """Return the poses by whose identities these are known: they must be kept alive."""
    pinned = pinned_segments(clip)[interval]
    poses = tuple(key.pose for key in pose_segments(clip)[interval].keys)
    return poses if pinned is None else pinned.poses
