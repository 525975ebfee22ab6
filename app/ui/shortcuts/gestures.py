"""What the pointer does, for the sheet of keys; the viewport and the timeline handle it."""

from dataclasses import dataclass

from app.ui.shortcuts.keys import ALT, CTRL, SHIFT, with_key


@dataclass(frozen=True, slots=True)
class Gesture:
    """How something is done, and what that is."""

    how: str
    what: str


GESTURES = (
    Gesture("Click the shape", "Add a handle"),
    Gesture("Drag a handle", "Pose, or key it alone where its track is chosen"),
    Gesture("Drag a key on a track's path", "Move it in the picture"),
    Gesture(with_key(ALT, "let go of a handle"), "Want it there, however far"),
    Gesture("Drag the ring around a handle", "Turn the shape there"),
    Gesture(with_key(ALT, "drag a handle"), "Turn the shape there"),
    Gesture(with_key(CTRL, "turn"), "Turn by steps of 15°"),
    Gesture("Type a number in a drag, Enter", "By pixels or degrees"),
    Gesture("X or Y in a drag", "Keep to an axis"),
    Gesture(with_key(ALT, "click a handle"), "Delete it"),
    Gesture(with_key(CTRL, "click the shape"), "Put the anchor there"),
    Gesture("Drag the anchor onto another layer", "Hang this layer on it"),
    Gesture(with_key(SHIFT, "click a handle"), "Select several"),
    Gesture("Drag beside the shape", "Select by a box"),
    Gesture(with_key(CTRL, with_key(SHIFT, "drag beside the shape")), "Move the whole layer"),
    Gesture("Right click a handle", "Menu"),
    Gesture("Arrows, with Shift ×10", "Nudge the selection, or the whole layer"),
    Gesture("Middle drag, or Space and drag", "Move the view"),
    Gesture("Wheel", "Zoom at the pointer"),
    Gesture("Esc", "Cancel a drag"),
    Gesture("Drag while cutting out", "Keep or remove a part of the picture"),
    Gesture(with_key(ALT, "drag while cutting out"), "The opposite"),
    Gesture("Drag with the knife", "Part what touches"),
    Gesture("Drag a key", "Move it in time"),
    Gesture(with_key(CTRL, "drag a key"), "Copy it"),
    Gesture("Click between keys", "Change the easing"),
    Gesture("Double-click the track", "Insert a key"),
    Gesture("Double-click a marker", "Name it"),
    Gesture("Drag a pose onto the timeline", "Make a key of it"),
    Gesture("Wheel on the timeline", "Scroll"),
    Gesture(with_key(CTRL, "wheel on the timeline"), "Zoom in time"),
)
