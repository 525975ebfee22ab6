"""Auto-pins: handles with equal targets in two neighbouring keys stay there in between."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from app.baseline import Baseline
from app.document.channels.easing import HOLD
from app.document.keyframe import Keyframe, Pose
from app.document.layer import Layer
from app.document.queries.clips import Clip
from app.document.queries.key_segments import clip_segments
from app.document.queries.material.boundary_stiffness import stiffness_source
from app.document.queries.memo import memoized_on
from app.document.queries.pose_tangents import adjacent_segments, pose_segments
from app.document.rig.chains import find_chains
from app.document.settings import FrameRange
from engine.arrays import Booleans, Floats, freeze

SAME_TARGET_DISTANCE = 0.5  # pixels between two targets that count as equal


class PinnedSegment(NamedTuple):
    """The pins of a segment."""

    is_pinned: Booleans  # (h,): handles pinned throughout the segment
    # Velocity of the ground in pixels per frame to the right. Ends of limbs are pinned to the
    # ground, other handles to the picture.
    ground_velocity: float
    fading: Booleans  # (2, h): other handles, pinned in the segment before, and after
    neighbours: tuple[int | None, int | None]  # their numbers, if a pin fades to or from them
    content: tuple[object, ...]  # equal for equal pins, as long as the poses exist
    poses: tuple[Pose, ...]  # all poses that determine the pins

    def weights(self, time: float) -> Floats:
        """Return the pin weight of each handle at a time of the segment, from 0 to 1."""
        rest = 1.0 - time
        fading: Floats = rest**3 * self.fading[0] + time**3 * self.fading[1]
        return np.where(self.is_pinned, 1.0, fading)


def pinned_handles(clip: Clip) -> Booleans:
    """Return a table (k, h): whether a handle is pinned in a segment of the clip."""
    return _pinned(clip.layer, clip.frames, clip.loop, clip.baseline)


def pinned_segments(clip: Clip) -> tuple[PinnedSegment | None, ...]:
    """Return the pins of each segment of the clip; None without pins and without limbs."""
    return _segments(clip.layer, clip.frames, clip.loop, clip.baseline)


@memoized_on
def _pinned(
    layer: Layer,
    frames: FrameRange,
    loop: bool,  # noqa: FBT001 - a field of the clip
    baseline: Baseline | None,
) -> Booleans:
    clip = Clip(layer=layer, frames=frames, loop=loop, fps=1.0, baseline=baseline)
    keys = clip.keys
    following = {spring.handle for spring in layer.springs if spring.enabled}
    pinned = np.zeros((len(clip_segments(clip)), len(layer.handles)), dtype=bool)
    if not layer.has_auto_pins or baseline is not None:
        return freeze(pinned)
    ends = {chain.end for chain in find_chains(layer.bones)}
    for number, span in enumerate(clip_segments(clip)):
        one, other = keys[span.first], keys[span.last]
        # Full turns between equal targets are intended; a pin would undo them.
        if one.easing == HOLD or one.revolutions:
            continue
        # Ends of limbs stand on the ground, which moves under a body that walks in place.
        way = ground_velocity_at(clip, number) * span.frames
        for index, handle in enumerate(layer.handles):
            if handle.is_unpinned or handle.id in following:
                continue
            first, second = (key.pose.targets[handle.id].position for key in (one, other))
            moved = second - first - (way if handle.id in ends else 0.0)
            pinned[number, index] = handle.locked or abs(moved) < SAME_TARGET_DISTANCE
    return freeze(pinned)


@memoized_on
def _segments(
    layer: Layer,
    frames: FrameRange,
    loop: bool,  # noqa: FBT001 - a field of the clip
    baseline: Baseline | None,
) -> tuple[PinnedSegment | None, ...]:
    clip = Clip(layer=layer, frames=frames, loop=loop, fps=1.0, baseline=baseline)
    pinned = pinned_handles(clip)
    has_limbs = bool(layer.bone_joints) and baseline is None
    if not (pinned.any() or has_limbs):
        return (None,) * len(pinned)
    found: list[PinnedSegment | None] = []
    for number, (at_start, at_end) in enumerate(adjacent_segments(clip)):
        fading = np.zeros((2, pinned.shape[1]), dtype=bool)
        for side, other in enumerate((at_start.before, at_end.after)):
            if other is not None:
                fading[side] = pinned[other] & ~pinned[number]
        if not (pinned[number].any() or fading.any() or has_limbs):
            found.append(None)
            continue
        before, after = (
            other if fading[side].any() else None
            for side, other in enumerate((at_start.before, at_end.after))
        )
        around = [each for each in (before, number, after) if each is not None]
        keys = [key for each in around for key in pose_segments(clip)[each].keys]
        content = (
            pinned[number].tobytes(),
            ground_velocity_at(clip, number),
            fading.tobytes(),
            tuple(handle.position for handle in layer.handles),
            layer.has_parent,
            stiffness_source(layer),
            tuple(bone.ends for bone in layer.bones if bone.is_limb),
            _fixed_angles(layer, pose_segments(clip)[number].keys),
            tuple(_velocity_sources(clip, each) for each in around) if len(around) > 1 else (),
            (layer.widest_bounds.k, layer.widest_bounds.sigma_a, layer.widest_bounds.sigma_b),
        )
        poses = tuple(dict.fromkeys(key.pose for key in keys))
        found.append(
            PinnedSegment(
                is_pinned=freeze(pinned[number].copy()),
                ground_velocity=ground_velocity_at(clip, number),
                fading=freeze(fading),
                neighbours=(before, after),
                content=content,
                poses=poses,
            )
        )
    return tuple(found)


def _fixed_angles(layer: Layer, keys: Sequence[Keyframe]) -> tuple[frozenset[int], ...]:
    """Return the handles of a layer with bones that have an angle, for each key."""
    if not layer.bone_joints:
        return ()
    return tuple(
        frozenset(i for i, target in key.pose.targets.items() if target.rotation is not None)
        for key in keys
    )


def ground_velocity_at(clip: Clip, number: int) -> float:
    """Return the velocity of the ground in a segment, in pixels per frame to the right.

    It differs from 0 between two keys of a motion preset that walks in place.
    """
    span, keys = clip_segments(clip)[number], clip.keys
    one, other = keys[span.first], keys[span.last]
    if one.motion is None or one.motion != other.motion:
        return 0.0
    motions = (each for each in clip.layer.motions if each.id == one.motion)
    return next((each.ground_velocity for each in motions), 0.0)


def _velocity_sources(clip: Clip, number: int) -> tuple[object, ...]:
    """Return the values that determine the velocities of a segment, besides its poses."""
    segment, span = pose_segments(clip)[number], clip_segments(clip)[number]
    maps = tuple((id(key.pose.phi), id(key.pose.psi)) for key in segment.keys)
    easing = clip.keys[span.first].easing
    return (
        maps,
        segment.revolutions,
        segment.start,
        segment.end,
        segment.apart,
        span.frames,
        easing,
    )
