"""The playhead, and the person's view of the timeline."""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from math import inf
from typing import Any

from app.document import (
    Channel,
    Clip,
    Document,
    Layer,
    Playhead,
    Pose,
    measure_target_errors,
)
from app.editor.parts.timeline.gestures import TimeGesture
from app.editor.parts.timeline.time_range import TimeRangeView
from app.editor.work.derived import Derived
from app.editor.work.revised import Revised
from app.editor.work.track_keys import Recording
from app.sound import SoundMix

# Target errors in pixels, by handle id, of each key's pose.
KeyErrors = Mapping[Pose, Mapping[int, float]]


def measure_key_errors(layer: Layer, earlier: Derived[Layer, KeyErrors]) -> KeyErrors:
    """Measure the target errors of a layer's poses; known errors are reused."""
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
    """Return all values of a layer, besides its poses, that target errors depend on."""
    return layer.domain, layer.handles, layer.sprung_handles


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class HeardSound:
    """What is heard, or was heard last."""

    playhead: Playhead  # as it followed the sound
    source: tuple[object, ...] | None = None  # values that the mix depends on
    mix: SoundMix | None = None


@dataclass(slots=True, kw_only=True, eq=False)
class TimelineState(Revised):
    """The playhead, and the view of a project's timeline."""

    playhead: Playhead = field(default_factory=Playhead)
    heard: HeardSound | None = None
    moved_at: float = -inf  # the clock's seconds when the playhead last moved
    recording: Recording | None = None  # until accepted or discarded
    time_range: TimeRangeView | None = None  # visible range; None fits all frames
    gesture: TimeGesture | None = None
    # Visible range during the gesture, fixed so that nothing moves under the pointer.
    gesture_time_range: TimeRangeView | None = None
    # The last shown frame, so that the range follows the playhead only when it moves.
    last_shown_frame: int = 0
    # Scroll offset of the layer rows, in em.
    scrolled: float = 0.0
    # The last selected row and expanded layers: the rows scroll to the selected row only
    # after a change.
    last_shown_rows: tuple[Channel[Any], frozenset[int]] | None = None
    expanded_layers: frozenset[int] = frozenset()  # layers whose channels have lanes
    target_errors: Derived[Layer, KeyErrors] = field(default_factory=lambda: Derived({}))
    # Shown frames of a channel's keys, in order.
    keyed_frames: Derived[tuple[Document, Channel[Any]], tuple[int, ...]] = field(
        default_factory=lambda: Derived(())
    )
    # Frames of keys that the limits slow down, with the shares, by clip and number of delivered
    # results.
    slowed: Derived[tuple[Clip, int], Mapping[int, float]] = field(
        default_factory=lambda: Derived({})
    )

    def seek(self, frame: int, now: float) -> None:
        """Put the playhead on a frame; it goes on to play if it plays."""
        self.playhead = self.playhead.seek(frame, now)

    def toggle_play(self, document: Document, now: float) -> None:
        turn = self.playhead.play if self.playhead.since is None else self.playhead.pause
        self.playhead = turn(document, now)

    def note_heard(self, heard: HeardSound | None) -> None:
        self.heard = heard

    def lead(self, since: float) -> None:
        """Let the playhead play as if it had begun at a reading of the clock, as its sound did."""
        self.playhead = replace(self.playhead, since=since)
        if self.heard is not None:
            self.heard = replace(self.heard, playhead=self.playhead)

    def pause(self, document: Document, now: float) -> None:
        self.playhead = self.playhead.pause(document, now)

    def set_speed(self, speed: float, document: Document, now: float) -> None:
        self.playhead = self.playhead.at_speed(speed, document, now)

    def start_recording(self, take: Recording) -> None:
        """Play a recording with its own playhead."""
        self.recording, self.playhead = take, take.playhead

    def stop_recording(self) -> None:
        """Put the playhead back on its frame and speed at the start of the recording."""
        if (take := self.recording) is not None:
            self.playhead = replace(take.playhead, since=None, speed=take.speed)

    def forget_recording(self) -> None:
        self.recording = None

    def keep_existing(self, document: Document) -> None:
        """Keep the playhead on a frame of a document."""
        self.playhead = replace(self.playhead, frame=document.frames.clamp(self.playhead.frame))

    def note_move(self, now: float) -> None:
        """Note that another frame is shown."""
        self.moved_at = now

    def note_rest(self) -> None:
        """Note that the playhead rests on the shown frame."""
        self.moved_at = -inf

    def show_range(self, time_range: TimeRangeView | None) -> None:
        """Show a range of time, or all frames; during a gesture, until it ends."""
        if self.gesture is None:
            self.time_range = time_range
        else:
            self.gesture_time_range = time_range

    def note_shown_frame(self, frame: int) -> None:
        """Note that the visible range follows the playhead to a frame."""
        self.last_shown_frame = frame

    def scroll_rows(self, to: float, selected: Channel[Any]) -> None:
        """Scroll the rows to em below the first row; the selected row counts as shown."""
        self.scrolled, self.last_shown_rows = to, (selected, self.expanded_layers)

    def begin_gesture(self, gesture: TimeGesture, time_range: TimeRangeView) -> None:
        """Begin a gesture; the shown range of time is fixed until it ends."""
        self.gesture, self.gesture_time_range = gesture, time_range

    def move_gesture(self, gesture: TimeGesture) -> None:
        """Replace the gesture by its next state."""
        self.gesture = gesture

    def end_gesture(self) -> None:
        """End the gesture; a range that did not show all frames is that of the gesture."""
        if self.time_range is not None:
            self.time_range = self.gesture_time_range
        self.gesture = self.gesture_time_range = None

    def toggle_lanes(self, layer: int) -> bool:
        """Show or hide the lanes of a layer's channels, and return whether they are shown."""
        self.expanded_layers ^= {layer}
        return layer in self.expanded_layers

    def show_lanes(self, layer: int) -> None:
        self.expanded_layers |= {layer}
