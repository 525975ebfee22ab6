"""Drags of the pointer in the timeline."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, Literal, NamedTuple

from app.document import Channel, ChannelCurve, KeysByChannel, Side

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


class GraphPlace(NamedTuple):
    """A place of the pointer in the graph."""

    frame: float
    numbers: Mapping[str, float]  # by unit
    axis: Literal["time", "value"] | None = None  # the only one that a drag changes


@dataclass(frozen=True, slots=True)
class CurvePoint:
    """A key in one of the curves of its channel."""

    curve: ChannelCurve
    frame: int


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class PointDrag(KeyDrag):
    """Drag of points of curves in time and value."""

    points: frozenset[CurvePoint]  # before the drag
    numbers: Mapping[str, float]  # at the press, by unit
    is_speed: bool  # whether the numbers are velocities
    point: CurvePoint  # pressed
    was_chosen: bool  # whether the pressed point was selected before


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class PointScale(TimeDrag):
    """Drag of a grip of the box around selected points: it scales their time or value."""

    keys: KeysByChannel  # before the drag
    points: frozenset[CurvePoint]
    numbers: Mapping[str, float]  # at the press, by unit
    fixed_frame: int | None  # None if the time stays
    fixed_numbers: Mapping[str, float]  # empty if the values stay
    # From what is fixed to the dragged edge: frames, and numbers by unit.
    length: float
    heights: Mapping[str, float]


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class TangentDrag(TimeDrag):
    """Drag of a handle of a key's tangent."""

    point: CurvePoint
    side: Side


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
class PointBox(KeyBox):
    """A box of time and value that selects points of curves."""

    numbers: Mapping[str, float]  # at the press, by unit
    points: frozenset[CurvePoint]  # other selected points


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class ScrubDrag:
    """Drag of the playhead, which is `offset` frames later than the pointer."""

    offset: float = 0.0


TimeGesture = TimeDrag | KeyBox | ScrubDrag
GraphGesture = PointDrag | PointScale | TangentDrag | PointBox
