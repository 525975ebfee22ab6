"""Targets that become keys of tracks, and a recorded drag."""

from dataclasses import dataclass, field
from typing import NamedTuple

from app.document import Playhead
from app.editor.work.pending_change import PendingChange
from app.rigging import FittedKeys
from app.texts import _


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class TrackTarget:
    """A new target or rotation of a handle at a frame, for its own track.

    Attributes
    ----------
    handle : int
        The first handle of the track.
    frame : int
        In scene time.
    place : complex
        Target of the handle, in the layer's own space.
    turn : float, optional
        Rotation of the shape there, in radians. For a track without a target, `place` is then the
        present place of the handle.
    """

    layer: int
    handle: int
    frame: int
    place: complex
    turn: float | None = None


@dataclass(slots=True, kw_only=True, eq=False)
class PendingTrackKey(PendingChange):
    """A track target of a drag that waits for the base motion of its track."""

    label: str = _("Keys of a handle")
    target: TrackTarget
    gesture: object


class RecordedSample(NamedTuple):
    """A dragged place of a handle in the scene, at a frame that counts on over loop ends."""

    time: float
    place: complex


@dataclass(slots=True, kw_only=True, eq=False)
class Recording:
    """A drag of a handle that is recorded while the timeline plays.

    Attributes
    ----------
    handle : int
        The first handle of the track.
    gesture : object
        Edits of one gesture are one undo step.
    playhead : Playhead
        The playhead that has run since the drag began.
    last : int
        The frame at which the recording ends at the latest; in a loop it counts on.
    speed : float
        Playback speed before the recording.
    place : complex
        Present target of the handle, in the scene.
    scale : float
        Screen pixels per picture pixel at the start.
    smoothing : float
        From 0 to 1.
    has_moved : bool
        Whether the pointer has moved. Otherwise it is a click, unless the body moved under it.
    is_written : bool
        Whether the track has the recorded keys.
    fits : dict
        Fitted keys by the step of smoothing, of the scale and the values in `fits_of`.
    """

    layer: int
    handle: int
    gesture: object
    playhead: Playhead
    last: int
    speed: float
    place: complex
    scale: float
    smoothing: float
    samples: list[RecordedSample] = field(default_factory=list)
    is_over: bool = False
    has_moved: bool = True
    is_written: bool = False
    fits_of: tuple[float, list[complex]] = field(default_factory=lambda: (0.0, []))
    fits: dict[int, FittedKeys] = field(default_factory=dict)

    def keep_fits_of(self, source: tuple[float, list[complex]]) -> None:
        """Forget fits of another scale or of other values."""
        if self.fits_of != source:
            self.fits_of, self.fits = source, {}
