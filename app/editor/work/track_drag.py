"""What a hand does with a track: a handle that it carries, and a drag that is recorded."""

from dataclasses import dataclass, field
from typing import NamedTuple

from app.document import Document, Playhead, Track
from app.editor.work.promise import Promise


@dataclass(slots=True, kw_only=True, eq=False)
class TrackDrag(Promise):
    """A handle at a frame, wanted elsewhere or turned by its own track.

    It is a promise until the track has the key, which it gets once it is known what that is
    relative to.

    Parameters
    ----------
    layer, handle : int
        Ids; the handle is the first one of the track's.
    frame : int
        Of the scene.
    gesture : object
        What is one step of undo together.
    place : complex
        Where the handle is wanted, on the layer by itself.
    turn : float, optional
        By how much the shape is to be turned there, in radians; the place is then where the handle
        is, for a track that wants it nowhere yet.
    """

    label: str = "Keys of a handle"
    layer: int
    handle: int
    frame: int
    gesture: object
    place: complex
    turn: float | None = None


class RecordedSample(NamedTuple):
    """Where in the scene a handle was dragged: when, in frames, which go on where a loop ends."""

    time: float
    place: complex


@dataclass(slots=True, kw_only=True, eq=False)
class Recording:
    """A drag of a handle that is recorded while the timeline plays.

    Parameters
    ----------
    layer, handle : int
        Ids; the handle is the first one of the track's.
    gesture : object
        What is one step of undo together.
    before : Track, optional
        The handle's track as it was.
    playhead : Playhead
        As it runs since the drag began.
    last : int
        The frame at which it is over at the latest; in a loop it counts on.
    speed : float
        Of the playhead before.
    place : complex
        Where in the scene the handle is wanted now.
    scale : float
        How many pixels of the screen one of the picture took, when it began.
    smoothing : float
        From 0 to 1.
    samples : list of RecordedSample
    is_over : bool
        Whether the hand has let go.
    has_moved : bool
        Whether the hand was moved. Else it was a click, unless the body moved under it.
    after : Document, optional
        The document with the recorded track; None until it has that.
    """

    layer: int
    handle: int
    gesture: object
    before: Track | None
    playhead: Playhead
    last: int
    speed: float
    place: complex
    scale: float
    smoothing: float
    samples: list[RecordedSample] = field(default_factory=list)
    is_over: bool = False
    has_moved: bool = True
    after: Document | None = None
