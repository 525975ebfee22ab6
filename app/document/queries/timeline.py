"""Which two keys a moment lies between, and how far it is from one to the other."""

from collections.abc import Iterable
from fractions import Fraction
from itertools import pairwise
from typing import NamedTuple, Protocol

from app.document.keyframe import Pose
from app.document.layer import Layer
from app.document.model import Document
from app.document.queries.clips import Clip, clip_of
from app.document.queries.key_segments import clip_segments, segment_at_frame
from app.document.queries.layers import camera_at, opacity_at, transform_at
from app.document.queries.pose_tangents import pose_segments
from app.document.queries.tracks import track_at
from app.document.settings import FrameRange, require_fps
from app.errors import LissomError
from engine.geometry import RigidMotion, Similarity

# Pixels: a handle at rest is where the identity takes it, up to rounding.
SAME_PLACE = 1e-6
SAME_FACTOR = 1e-9


class SegmentTime(NamedTuple):
    """A place between the two keys of an interval, of which `intervals` tells."""

    segment: int
    # How far it is from the former, 0, to the latter, 1: the time of the interval's in-betweens.
    # Where these blend the two keys alone, it is the weight of the latter.
    weight: float


class _HasFrame(Protocol):
    @property
    def frame(self) -> int: ...


class _Key(NamedTuple):
    """A key, and whose it is."""

    whose: int | str
    frame: int
    key: object


def segment_time_at(clip: Clip, frame: float) -> SegmentTime:
    """Return the moment that a frame shows.

    Before the first key and after the last one their poses stand still. In a loop the last key
    leads on to the first one across the end of the animation, whose last frame is its first one
    again; frames beyond the ends come round. In a cycle it is that of the frame that repeats there.
    Fractions lie between frames.
    """
    if len(clip.keys) == 1:
        return SegmentTime(0, 0.0)
    interval, span, share = segment_at_frame(clip, frame)
    eased = clip.keys[span.first].easing(share)
    return SegmentTime(interval, pose_segments(clip)[interval].weight(eased))


def keyed_pose_at(clip: Clip, moment: SegmentTime) -> Pose | None:
    """Return the pose of the one key that a moment shows unblended; None where it blends two."""
    keys = clip.keys
    if moment.weight not in (0.0, 1.0) or len(keys) == 1:
        return None if len(keys) > 1 else keys[0].pose
    return keys[clip_segments(clip)[moment.segment][moment.weight == 1.0]].pose


def changed_ranges(before: Document, after: Document) -> list[FrameRange]:
    """Return where in time two documents differ: keys of all kinds, the ways from poses, markers.

    A change of everything that is shown, such as of handles or of a domain, is nowhere.
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
    frames = {key.frame for key in _keys_beside(before) ^ _keys_beside(after)}
    return stretches + [FrameRange(frame, frame) for frame in sorted(frames)]


def _keys_beside(document: Document) -> set[_Key]:
    """Return all that stands at a frame but keys of poses and of tracks, and whose it is."""
    rows: list[tuple[int | str, Iterable[_HasFrame]]] = [
        ("markers", document.markers),
        ("camera", document.camera),
        *((choice.name, choice.keys) for choice in document.switch_groups),
    ]
    for layer in document.layers:
        moved = (
            layer.transform_keys,
            layer.opacity_keys,
            layer.draw_order_keys,
            layer.visibility_keys,
            layer.attachments,
        )
        rows += [(layer.id, row) for row in moved]
    return {_Key(whose, key.frame, key) for whose, row in rows for key in row}


def _changed_keys(before: Layer, after: Layer) -> list[FrameRange]:
    """Return the frames of the keys that differ, each up to the next one if only its way does."""
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
    """Return the frames of tracks' keys that differ, or of all keys of tracks that differ else."""
    one, other = (
        {(track.handles, track.delay, key) for track in layer.tracks for key in track.keys}
        for layer in (before, after)
    )
    if one != other:
        return {delay + key.frame for _, delay, key in one ^ other}
    tracks = set(before.tracks) ^ set(after.tracks)
    return {track.delay + key.frame for track in tracks for key in track.keys}


def export_frame_range(document: Document) -> FrameRange:
    """Return the frames that an export covers unless told otherwise.

    Of a loop that is exported whole, the last frame is left out where it is the first one again.
    """
    if document.export.frames is not None:
        return document.export.frames
    frames = document.frames
    is_loop = document.loop and frames.first < frames.last
    if is_loop and _is_same(document, frames.first, frames.last):
        return FrameRange(frames.first, frames.last - 1)
    return frames


def frames_for_fit(document: Document, exported: FrameRange) -> FrameRange:
    """Return the frames whose motion an export shows whole where it is fitted into the frame.

    All of the animation's are among them, so that some frames exported anew match those of before.
    """
    frames = document.frames
    return FrameRange(min(frames.first, exported.first), max(frames.last, exported.last))


def _is_same(document: Document, first: int, second: int) -> bool:
    """Tell whether two frames show the same pose, or two that were solved for the same wishes."""
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
    """Tell whether the camera, and all layers as a whole, are alike at two frames."""
    shots = [camera_at(document, frame) for frame in (first, second)]
    pairs: list[list[RigidMotion | Similarity]] = [
        [shot.canvas_motion(document.canvas) for shot in shots if shot is not None]
    ]
    pairs += [
        [transform_at(document, each, frame) for frame in (first, second)]
        for each in document.layers
    ]
    # After a whole turn things are where they were, up to rounding.
    return all(
        abs(one.factor - other.factor) <= SAME_FACTOR and abs(one.shift - other.shift) <= SAME_PLACE
        for one, other in filter(None, pairs)
    ) and all(
        opacity_at(document, each, first) == opacity_at(document, each, second)
        for each in document.layers
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
        # Those that follow are not wished anywhere: poses have them where the body carries them.
        if handle not in clip.layer.sprung_handles
    )


def frame_times(document: Document, frames: FrameRange, fps: float | None = None) -> list[float]:
    """Return the frame, whole or between two, that each picture of an export shows.

    Parameters
    ----------
    frames : FrameRange
        Both ends included; the last one only if the export's rate falls on it.
    fps : float, optional
        Pictures per second; the document's own rate by default.

    Raises
    ------
    LissomError
        If the rate is out of its range.
    """
    if fps is None:
        return [float(frame) for frame in range(frames.first, frames.last + 1)]
    require_fps(fps, "The export's speed")
    if fps > 100 * document.fps:
        raise LissomError(
            f"The export's frames per second must be at most {100 * document.fps:g}, a hundred "
            f"times the document's own, not {fps:g}."
        )
    # In exact arithmetic, so that rounding neither drops the last picture nor adds one.
    step = Fraction(document.fps) / Fraction(fps)
    count = (frames.last - frames.first) // step + 1
    return [float(frames.first + index * step) for index in range(count)]
