"""The clipboard: copied keys and poses."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from app.document import BaseKey, Channel, Keyframe, Layer, Track, TrackKey
from app.editor.work.revised import Revised


@dataclass(frozen=True, slots=True, eq=False)
class CopiedKeys:
    """Copied keys or a single copied pose, with the layer at that time."""

    layer: Layer
    keys: tuple[Keyframe, ...]
    is_pose: bool = False  # whether it is a pose without easing


@dataclass(frozen=True, slots=True, eq=False)
class CopiedTrack:
    """Copied keys of a track, with the track and its layer at that time."""

    layer: Layer
    track: Track
    keys: tuple[TrackKey, ...]


@dataclass(frozen=True, slots=True, eq=False)
class CopiedChannel:
    """Copied keys of another channel, with its layer at that time, if it has one."""

    layer: Layer | None
    channel: Channel[Any]
    keys: tuple[BaseKey, ...]
    is_pose: bool = False  # whether it is the value at a frame, as part of a pose


@dataclass(slots=True, kw_only=True, eq=False)
class Clipboard(Revised):
    """The keys that were copied last."""

    poses: tuple[CopiedKeys, ...] = ()  # one for each copied layer
    tracks: tuple[CopiedTrack, ...] = ()  # one for each copied track
    channels: tuple[CopiedChannel, ...] = ()  # one for each other copied channel

    def put(
        self,
        poses: Sequence[CopiedKeys],
        tracks: Sequence[CopiedTrack] = (),
        channels: Sequence[CopiedChannel] = (),
    ) -> None:
        """Put keys on the clipboard, in place of all earlier ones."""
        self.poses, self.tracks, self.channels = tuple(poses), tuple(tracks), tuple(channels)
