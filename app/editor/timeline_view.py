"""How the person looks at the timeline, and what the pointer does there."""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Literal, NamedTuple, Self

from app.document import (
    Clip,
    Cycle,
    Document,
    FrameRange,
    Keyframe,
    Layer,
    Pose,
    Track,
    TrackKey,
    measure_target_errors,
)
from app.editor.work import Derived

SMALLEST, LARGEST = 0.002, 4.0  # em that a frame takes
MARGIN = 1.4  # em left and right of frames that are fitted
ROOM = 0.04  # of the width, right of the last frame: there keys can be dragged on
Edge = Literal["preview start", "preview range", "preview end", "animation end"]


class TrackRow(NamedTuple):
    """The row of a track: the ids of its layer, and of the first of its handles."""

    layer: int
    handle: int


# The row of the poses of a layer, by its id, or that of a track.
KeyRow = int | TrackRow
# The frames of some keys, by their rows.
KeysByRow = Mapping[KeyRow, frozenset[int]]


def layer_of(row: KeyRow) -> int:
    """Return the id of the layer whose keys are in a row."""
    return row.layer if isinstance(row, TrackRow) else row


def row_of(layer: Layer, track: Track | None) -> KeyRow:
    """Return the row of a track of a layer, or that of its poses."""
    return layer.id if track is None else TrackRow(layer.id, track.handles[0])


def keys_in(document: Document, row: KeyRow) -> tuple[Keyframe, ...] | tuple[TrackKey, ...]:
    """Return the keys of a row; none where it is not there any more."""
    layer = next((each for each in document.layers if each.id == layer_of(row)), None)
    if layer is None or not isinstance(row, TrackRow):
        return () if layer is None else layer.keys
    track = layer.track_of(row.handle)
    return () if track is None or track.handles[0] != row.handle else track.keys


def frames_in(document: Document, row: KeyRow) -> frozenset[int]:
    """Return the frames that have a key in a row, of a track without its delay."""
    return frozenset(key.frame for key in keys_in(document, row))


def display_frame(document: Document, track: Track | None, frame: int) -> int:
    """Return the frame at which a key is seen: a track's is late by its delay.

    In a loop it comes round, and so it does in a cycle that takes the track.
    """
    seen = frame + (0 if track is None else track.delay)
    cycle = None if track is None else _cycle_of(document, track)
    if cycle is not None:
        return seen if seen <= cycle.last else int(cycle.source_frame(seen))
    first, last = document.frames.first, document.frames.last
    return seen - (last - first) if document.loop and seen > last else seen


def _cycle_of(document: Document, track: Track) -> Cycle | None:
    """Return the cycle with which a track repeats, if there is one."""
    layer = next((each for each in document.layers if track in each.tracks), None)
    cycles = () if layer is None else layer.cycles
    return next((cycle for cycle in cycles if cycle.repeats_keys(track.keys)), None)


def source_frame(document: Document, track: Track, seen: int) -> int | None:
    """Return the frame of the key of a track that is seen at a frame; None where none can be."""
    first, last = document.frames.first, document.frames.last
    own, cycle = seen - track.delay, _cycle_of(document, track)
    if cycle is not None and cycle.covers(seen):
        return own if own in track.key_frames else int(cycle.source_frame(own))
    if own < first and document.loop:
        own += last - first
    return None if own < first else own


@dataclass(frozen=True, slots=True)
class TimeRangeView:
    """The stretch of time that is on the screen."""

    start: float  # the frame at its left edge
    scale: float  # how many em a frame takes

    @classmethod
    def fitting(cls, frames: FrameRange, width: float) -> Self:
        """Return the strip that shows all frames within a width in em."""
        free = max(width * (1 - ROOM) - 2 * MARGIN, 1.0)
        scale = min(free / max(frames.last - frames.first, 1), LARGEST)
        return cls(frames.first - MARGIN / scale, scale)

    def place(self, frame: float) -> float:
        """Return how many em a frame is from the left edge."""
        return (frame - self.start) * self.scale

    def frame(self, place: float) -> float:
        """Return the frame at a place in em."""
        return self.start + place / self.scale

    def zoomed(self, factor: float, place: float) -> Self:
        """Return the strip in which frames are wider by a factor, and the one at `place` stays."""
        scale = min(max(self.scale * factor, SMALLEST), LARGEST)
        return replace(self, start=self.frame(place) - place / scale, scale=scale)

    def panned(self, by: float) -> Self:
        """Return the strip some em later."""
        return replace(self, start=self.start + by / self.scale)

    def kept_near(self, frames: FrameRange, width: float) -> Self:
        """Return the strip moved so that it shows frames from its middle on, or up to there."""
        half = width / 2 / self.scale
        return replace(self, start=min(max(self.start, frames.first - half), frames.last - half))

    def showing(self, frame: float, width: float, *, turns: bool) -> Self:
        """Return the strip moved so that it shows a frame; this one if it does already.

        Parameters
        ----------
        frame : float
        width : float
            In em.
        turns : bool
            Whether to go on by a whole page, and not by as little as possible.
        """
        place = self.place(frame)
        if 0 <= place <= width:
            return self
        if turns:
            return self.panned(place - MARGIN)
        return self.panned(place if place < 0 else place - width)


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class TimeDrag:
    """The pointer moves something in time."""

    start: float  # the pointer's frame at the press
    before: Document  # at the press
    after: Document  # with what is moved where it is now


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class KeyDrag(TimeDrag):
    """The pointer moves keys, or copies of them."""

    keys: KeysByRow  # as they are in `before`
    row: KeyRow  # of the one under the pointer, which is of the active layer
    pressed: int  # its frame
    copies: bool
    by: int = 0  # how far they are, in frames


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class EdgeDrag(TimeDrag):
    """The pointer moves an end of the preview range, all of it, or the animation's end."""

    edge: Edge


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class MarkerDrag(TimeDrag):
    """The pointer moves a marker from a frame in `before` to where it is `at` now."""

    marker: int
    at: int


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class CameraDrag(TimeDrag):
    """The pointer moves a key of the camera from a frame in `before` to where it is `at` now."""

    key: int
    at: int


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class SwitchDrag(TimeDrag):
    """The pointer moves where a layer is shown or hidden: from a frame in `before` to `at`."""

    layer: int
    switch: int
    at: int


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class CycleDrag(TimeDrag):
    """The pointer moves the end of what repeats from a frame on, or of its repeats."""

    layer: int
    first: int
    is_stretch: bool  # whether it is its own end


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class TurnDrag(TimeDrag):
    """The pointer moves where a layer of a choice comes to be seen, from `turn` to `at`."""

    choice: str
    turn: int
    at: int


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class KeyBox:
    """The pointer spans a stretch of time and rows to choose the keys there."""

    start: float  # the pointer's frame at the press
    row: KeyRow  # that the pointer was on
    keeps: KeysByRow  # the keys that are chosen besides


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class ScrubDrag:
    """The pointer moves the playhead, which is `offset` frames later than the pointer."""

    offset: float = 0.0


TimeGesture = TimeDrag | KeyBox | ScrubDrag


# By how many pixels handles, by their ids, fall short of their targets in each key's pose.
KeyErrors = Mapping[Pose, Mapping[int, float]]


def measure_key_errors(layer: Layer, earlier: Derived[Layer, KeyErrors]) -> KeyErrors:
    """Measure the poses of a layer; those that were measured before are not again."""
    source = earlier.source
    is_alike = source is not None and _measured_by(layer) == _measured_by(source)
    known = earlier.value if is_alike else {}
    lags: dict[Pose, Mapping[int, float]] = {}
    for pose in (key.pose for key in layer.keys):
        usual = (
            measure_target_errors(layer, pose).errors if layer.handles and pose not in known else {}
        )
        lags[pose] = known.get(pose, usual)
    return lags


def _measured_by(layer: Layer) -> tuple[object, ...]:
    """Return all of a layer, besides its poses, that shortfalls depend on."""
    return layer.domain, layer.handles, layer.sprung_handles


@dataclass(slots=True, kw_only=True, eq=False)
class TimelineState:
    """What may change of a project's timeline besides the document."""

    time_range: TimeRangeView | None = None  # what it shows; None fits all frames
    gesture: TimeGesture | None = None
    # What it shows while the gesture lasts: nothing may move under the pointer.
    gesture_time_range: TimeRangeView | None = None
    # The frame that was shown last, so that the strip follows the playhead only when it moves.
    last_shown_frame: int = 0
    # By how many em the rows of layers are scrolled down, where there are more than have room.
    scrolled: float = 0.0
    # The row that was chosen last, and the layers whose tracks had rows then, so that the rows
    # are scrolled to it only when that is another one.
    last_shown_rows: tuple[KeyRow, frozenset[int]] | None = None
    expanded_layers: frozenset[int] = frozenset()  # the layers whose tracks have rows
    target_errors: Derived[Layer, KeyErrors] = field(default_factory=lambda: Derived({}))
    # The frames at which keys of a row are seen, in their order.
    keyed_frames: Derived[tuple[Document, KeyRow], tuple[int, ...]] = field(
        default_factory=lambda: Derived(())
    )
    # The frames of keys that the limits slow down, and by which shares, as far as that was known
    # when so many results had been delivered.
    slowed: Derived[tuple[Clip, int], Mapping[int, float]] = field(
        default_factory=lambda: Derived({})
    )
