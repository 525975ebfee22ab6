"""Values of sliders, and weights of their poses, at a frame."""

from app.document.channels.kinds import SLIDER
from app.document.keyframe import Pose
from app.document.queries.channel_values.values_at import interpolated_value
from app.document.queries.clips import Clip, SliderChannel


def slider_value_at(clip: Clip, channel: SliderChannel, frame: float) -> complex:
    """Return the value of a clip's slider at a frame, with its delay."""
    at = frame - channel.slider.delay
    value = interpolated_value(clip, SLIDER, channel.keys, at, channel.cycles)
    return channel.slider.clamp(channel.value if value is None else value)


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
