"""Position between keys at a frame, changed frames, and frames of an export."""

from fractions import Fraction
from itertools import pairwise
from typing import Any, NamedTuple

from app.document.channels.key import BaseKey
from app.document.channels.kind import Channel
from app.document.channels.kinds import TRANSFORM
from app.document.keyframe import Pose
from app.document.layer import Layer
from app.document.model import Document
from app.document.queries.channel_values.channel_keys import channels_in, channels_of, keys_in
from app.document.queries.channel_values.tracks_at import track_at
from app.document.queries.channel_values.values_at import camera_at, transform_at, value_at
from app.document.queries.clips import Clip, clip_of
from app.document.queries.key_segments import clip_segments, segment_at_frame
from app.document.queries.pose_tangents import pose_segments
from app.document.settings import FrameRange, require_fps
from app.errors import LissomError
from app.texts import _
from engine.geometry import Similarity

# Pixels: tolerance for rounding.
SAME_PLACE = 1e-6
SAME_FACTOR = 1e-9


class SegmentTime(NamedTuple):
    """A position between the two keys of a segment; `segment_keys` lists the keys."""

    segment: int
    # Time within the segment's in-betweens, from 0 at the first key to 1 at the second. If only
    # these two keys are blended, the time is the weight of the second.
    weight: float


def segment_time_at(clip: Clip, frame: float) -> SegmentTime:
    """Return the segment and the weight at a frame.

    The first and the last pose hold outside the keys. In a loop the last key leads to the first,
    and the last frame equals the first; frames outside wrap around. In a cycle, the repeated frame
    counts. Fractions lie between frames.
    """
    if len(clip.keys) == 1:
        return SegmentTime(0, 0.0)
    interval, span, share = segment_at_frame(clip, frame)
    eased = clip.keys[span.first].easing(share)
    return SegmentTime(interval, pose_segments(clip)[interval].weight(eased))


def keyed_pose_at(clip: Clip, moment: SegmentTime) -> Pose | None:
    """Return the pose of a single key at this time; None between two keys."""
    keys = clip.keys
    if moment.weight not in (0.0, 1.0) or len(keys) == 1:
        return None if len(keys) > 1 else keys[0].pose
    return keys[clip_segments(clip)[moment.segment][moment.weight == 1.0]].pose


def changed_ranges(before: Document, after: Document) -> list[FrameRange]:
    """Return the frames in which two documents differ: keys, segments and markers.

    Changes of the whole drawing, for example of handles or of a domain, are not listed.
    """
    stretches: list[FrameRange] = []
    others = {layer.id: layer for layer in before.layers}
    for layer in after.layers:
        other = others.get(layer.id)
        is_alike = other and other.domain is layer.domain and other.handles == layer.handles
        if other and is_alike and other.keys is not layer.keys:
            stretches += _changed_keys(other, layer)
        if other:
            changed = {*other.cycles} ^ {*layer.cycles}
            stretches += [FrameRange(each.first, each.until or each.last) for each in changed]
            frames = {after.frames.clamp(frame) for frame in _changed_in_tracks(other, layer)}
            stretches += [FrameRange(frame, frame) for frame in sorted(frames)]
    old, new = _keys_by_channel(before), _keys_by_channel(after)
    frames = {
        key.frame
        for channel in old | new
        for key in {*old.get(channel, ())} ^ {*new.get(channel, ())}
    }
    return stretches + [FrameRange(frame, frame) for frame in sorted(frames)]


def _keys_by_channel(document: Document) -> dict[Channel[Any], tuple[BaseKey, ...]]:
    """Return the keys of all channels except poses and tracks."""
    return {
        channel: keys_in(document, channel)
        for channel in channels_in(document)
        if not channel.kind.is_blended
    }


def _changed_keys(before: Layer, after: Layer) -> list[FrameRange]:
    """Return the frames of changed pose keys; the whole segment if only the easing changed."""
    keys = {key.frame: key for key in before.keys}
    following = dict(pairwise(key.frame for key in after.keys))
    stretches = [FrameRange(frame, frame) for frame in keys.keys() - after.key_frames]
    for key in after.keys:
        old = keys.get(key.frame)
        if old is None or old.pose is not key.pose:
            stretches.append(FrameRange(key.frame, key.frame))
        elif old is not key:
            stretches.append(FrameRange(key.frame, following.get(key.frame, key.frame)))
    return stretches


def _changed_in_tracks(before: Layer, after: Layer) -> set[int]:
    """Return the frames of changed track keys, or of all keys of otherwise changed tracks."""
    one, other = (
        {(track.handles, track.delay, key) for track in layer.tracks for key in track.keys}
        for layer in (before, after)
    )
    if one != other:
        return {delay + key.frame for _, delay, key in one ^ other}
    tracks = set(before.tracks) ^ set(after.tracks)
    return {track.delay + key.frame for track in tracks for key in track.keys}


def export_frame_range(document: Document) -> FrameRange:
    """Return the default range of an export.

    A loop exported whole omits its last frame if that equals the first.
    """
    if document.export.frames is not None:
        return document.export.frames
    frames = document.frames
    is_loop = document.loop and frames.first < frames.last
    if is_loop and _is_same(document, frames.first, frames.last):
        return FrameRange(frames.first, frames.last - 1)
    return frames


def frames_for_fit(document: Document, exported: FrameRange) -> FrameRange:
    """Return the frames that the framing "fit" contains.

    They include the whole animation, so that a later export of a part has the same framing.
    """
    frames = document.frames
    return FrameRange(min(frames.first, exported.first), max(frames.last, exported.last))


def _is_same(document: Document, first: int, second: int) -> bool:
    """Return whether two frames show the same pose, or poses with the same targets."""
    clips = (clip_of(document, layer.id) for layer in document.layers)
    return _moves_alike(document, first, second) and all(
        _poses_alike(clip, segment_time_at(clip, first), segment_time_at(clip, second))
        and all(
            track_at(track, clip, first) == track_at(track, clip, second)
            for track in clip.layer.tracks
        )
        for clip in clips
    )


def _moves_alike(document: Document, first: int, second: int) -> bool:
    """Return whether the camera and all interpolated channels of all layers are equal."""
    shots = [camera_at(document, frame) for frame in (first, second)]
    pairs: list[list[Similarity]] = [
        [shot.canvas_motion(document.canvas) for shot in shots if shot is not None]
    ]
    pairs += [
        [transform_at(document, each, frame) for frame in (first, second)]
        for each in document.layers
    ]
    # Full turns return to the same place up to rounding.
    return all(
        abs(one.factor - other.factor) <= SAME_FACTOR and abs(one.shift - other.shift) <= SAME_PLACE
        for one, other in filter(None, pairs)
    ) and all(
        value_at(document, channel, first) == value_at(document, channel, second)
        for layer in document.layers
        for channel in channels_of(layer)
        if channel.kind.components and channel.kind is not TRANSFORM
    )


def _poses_alike(clip: Clip, first: SegmentTime, second: SegmentTime) -> bool:
    if first == second:
        return True
    one, other = keyed_pose_at(clip, first), keyed_pose_at(clip, second)
    if one is None or other is None:
        return False
    return one is other or all(
        abs(target.position - other.targets[handle].position) <= SAME_PLACE
        and target.rotation == other.targets[handle].rotation
        for handle, target in one.targets.items()
        # Springs move these handles; their targets in poses have no effect.
        if handle not in clip.layer.sprung_handles
    )


def frame_times(document: Document, frames: FrameRange, fps: float | None = None) -> list[float]:
    """Return the frame, possibly fractional, of each picture of an export.

    `fps` is by default the document's rate. The last frame is included only if the rate meets it.
    Raises a `LissomError` if the rate is out of its range.
    """
    if fps is None:
        return [float(frame) for frame in range(frames.first, frames.last + 1)]
    require_fps(fps, _("The export's speed"))
    if fps > 100 * document.fps:
        raise LissomError(
            _(
                "The export's frames per second must be at most {largest:g}, a hundred times the "
                "document's own, not {fps:g}."
            ).format(largest=100 * document.fps, fps=fps)
        )
    # Exact arithmetic, so that rounding neither drops the last picture nor adds one.
    step = Fraction(document.fps) / Fraction(fps)
    count = (frames.last - frames.first) // step + 1
    return [float(frames.first + index * step) for index in range(count)]
