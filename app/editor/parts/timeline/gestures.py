"""Drags of the pointer in the timeline."""

from dataclasses import dataclass, field
from typing import Any, Literal

from app.document import Channel, KeysByChannel

Edge = Literal["preview start", "preview range", "preview end", "animation end"]


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class TimeDrag:
    """A drag in the timeline, of keys and edges in the document before it."""

    start: float  # frame of the press
    gesture: object = field(default_factory=object)  # its commands are one undo step


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class KeyDrag(TimeDrag):
    """Drag of keys, or of copies of them."""

    keys: KeysByChannel  # before the drag
    channel: Channel[Any]  # of the pressed key
    pressed: int  # frame of the pressed key
    mark: KeysByChannel  # keys that the pressed mark stands for
    copies: bool
    by: int = 0  # offset in frames


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class EdgeDrag(TimeDrag):
    """Drag of an end of the preview range, of the whole range, or of the animation's end."""

    edge: Edge


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class CycleDrag(TimeDrag):
    """Drag of the end of a cycle that begins at a frame, or of the end of its repeats."""

    layer: int
    first: int
    is_stretch: bool  # whether it is the end of the first pass


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class SoundDrag(TimeDrag):
    """Drag of a sound in time, or of one of its ends."""

    sound: str  # name
    part: Literal["whole", "begin", "end"]


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class KeyBox:
    """A box of time and lanes that selects keys."""

    start: float  # frame of the press
    channel: Channel[Any]  # lane of the press
    keeps: KeysByChannel  # other selected keys


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class ScrubDrag:
    """Drag of the playhead, which is `offset` frames later than the pointer."""

    offset: float = 0.0


TimeGesture = TimeDrag | KeyBox | ScrubDrag
