"""Sounds: files of sound on the timeline, each with a channel for its volume."""

import re
from dataclasses import dataclass, field
from math import isfinite

from app.document.channels.key import Key
from app.document.channels.kinds import VOLUME, SwitchMember, require_volume
from app.document.checks import LAST_FRAME, NOTHING, Unknown, require
from app.texts import N_

SHORTEST = 0.001  # seconds that remain of a sound at least


@dataclass(frozen=True, slots=True, kw_only=True)
class SoundFile:
    """The bytes of a sound file as they were found, and what was measured in them."""

    name: str  # of the file, with its suffix
    sha256: str
    size: int  # bytes
    rate: int  # samples per second
    channels: int
    samples: int  # in each channel, counted by decoding
    # None while they are missing; the checksum finds them again.
    data: bytes | None = field(repr=False, compare=False)

    def __post_init__(self) -> None:
        require(
            re.fullmatch("[0-9a-f]{64}", self.sha256) is not None
            and min(self.size, self.rate, self.channels, self.samples) > 0,
            N_("The sound file {name!r} is not described as one."),
            name=self.name,
        )

    @property
    def seconds(self) -> float:
        return self.samples / self.rate


@dataclass(frozen=True, slots=True, kw_only=True)
class Cue:
    """A mouth shape from a moment of a sound file on."""

    seconds: float  # from the file's beginning
    name: str  # such as a phoneme


@dataclass(frozen=True, slots=True, kw_only=True)
class Mouths:
    """The cues of a sound, and the keys of a switch that were made of them."""

    switch: str  # name
    cues: tuple[Cue, ...]
    drawings: tuple[tuple[str, SwitchMember], ...]  # by the names of cues
    keys: tuple[Key[SwitchMember], ...] = ()  # as they were made
    unknown: Unknown = field(default_factory=lambda: NOTHING, repr=False, hash=False)


@dataclass(frozen=True, slots=True, kw_only=True)
class VolumeKeys:
    """The keys of a channel that were made of the volume of a sound."""

    kind: str  # of the channel: a slider's, or a handle's track
    layer: int
    part: int | str
    keys: tuple[tuple[int, complex], ...]  # frames and values, as they were made


@dataclass(frozen=True, slots=True, kw_only=True)
class Sound:
    """A part of a sound file, heard from a frame on at its own speed.

    `skip` and `length` cut the file at its beginning and its end.
    """

    name: str  # unique in the document
    file: SoundFile
    start: float = 0.0  # frame, whole or between two, at which it begins to be heard
    skip: float = 0.0  # seconds of the file before that
    length: float  # seconds that are heard
    volume: float = 1.0  # without keys
    keys: tuple[Key[float], ...] = ()  # of the volume
    muted: bool = False
    mouths: Mouths | None = None
    volume_keys: tuple[VolumeKeys, ...] = ()  # at most one for each channel
    unknown: Unknown = field(default_factory=lambda: NOTHING, repr=False, hash=False)

    def __post_init__(self) -> None:
        require(bool(self.name.strip()), N_("A sound needs a name."))
        require(
            abs(self.start) <= LAST_FRAME,
            N_("The sound {name!r} must begin at a frame from {least:,} to {most:,}."),
            name=self.name,
            least=-LAST_FRAME,
            most=LAST_FRAME,
        )
        require(
            isfinite(self.skip) and isfinite(self.length) and self.skip >= 0 < self.length,
            N_("The sound {name!r} must keep a part of its file."),
            name=self.name,
        )
        require_volume(self.volume)
        VOLUME.require(self.keys, self.name)

    def frame_of(self, seconds: float, fps: float) -> float:
        """Return the frame of a moment of the file, in seconds from its beginning."""
        return self.start + (seconds - self.skip) * fps

    def end(self, fps: float) -> float:
        """Return the frame at which it ends."""
        return self.start + self.length * fps
