"""Values of sliders, and weights of their poses, at a frame."""

from functools import lru_cache
from typing import NamedTuple

from app.document.channels.kinds import SLIDER
from app.document.keyframe import Pose
from app.document.queries.channel_values.values_at import interpolated_value
from app.document.queries.clips import Clip, SliderChannel
from app.document.settings import FrameRange
from app.rigging import SpringResponse, simulate_spring


class _Timing(NamedTuple):
    """What the values of sliders depend on besides their keys."""

    frames: FrameRange
    loop: bool
    fps: float


def slider_value_at(clip: Clip, channel: SliderChannel, frame: float) -> complex:
    """Return the value of a clip's slider at a frame, with its delay and its spring."""
    timing = _Timing(clip.frames, clip.loop, clip.fps)
    value = _driving_value(channel, timing, frame)
    if channel.slider.spring is not None:
        value += complex(_swing(channel, timing).at(frame - clip.frames.first))
    return channel.slider.clamp(value)


def _driving_value(channel: SliderChannel, timing: _Timing, frame: float) -> complex:
    at = frame - channel.slider.delay
    value = interpolated_value(timing, SLIDER, channel.keys, at, channel.cycles)
    return channel.value if value is None else value


@lru_cache(maxsize=64)
def _swing(channel: SliderChannel, timing: _Timing) -> SpringResponse:
    """Return the swing of a slider about its driving value."""
    first, last = timing.frames.first, timing.frames.last
    frequency, damping = channel.slider.spring or (1.0, 1.0)
    values = [_driving_value(channel, timing, frame) for frame in range(first, last + 1)]
    is_loop = timing.loop and last > first
    return simulate_spring(values, timing.fps, frequency=frequency, damping=damping, loop=is_loop)


def slider_poses(clip: Clip) -> tuple[tuple[Pose, int], ...]:
    """Return the poses of a clip's sliders with their full turns, but not undeformed ones."""
    named = {kept.name: kept.pose for kept in clip.layer.library}
    return tuple(
        (named[each.pose], each.turns)
        for channel in clip.sliders
        for each in channel.slider.poses
        if each.pose is not None
    )


def slider_weights_at(clip: Clip, frame: float) -> tuple[float, ...]:
    """Return the weight of each of the `slider_poses` at a frame."""
    weights: list[float] = []
    for channel in clip.sliders:
        of_poses = channel.slider.weights(slider_value_at(clip, channel, frame)).tolist()
        poses = zip(channel.slider.poses, of_poses, strict=True)
        weights += [weight for each, weight in poses if each.pose is not None]
    return tuple(weights)
