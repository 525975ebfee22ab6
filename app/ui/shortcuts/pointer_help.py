"""Pointer gestures for the sheet of shortcuts. The viewport and the timeline handle them."""

from dataclasses import dataclass

from app.ui.shortcuts.keys import ALT, CTRL, SHIFT, format_modified


@dataclass(frozen=True, slots=True)
class PointerHelp:
    gesture: str
    effect: str


POINTER_HELP = (
    PointerHelp("Click the shape", "Add a handle"),
    PointerHelp("Drag a handle", "Pose, or key its selected track"),
    PointerHelp("Drag a key on a track's path", "Move it in the picture"),
    PointerHelp(format_modified(ALT, "let go of a handle"), "Keep pulling towards there"),
    PointerHelp("Drag the ring around a handle", "Turn the shape there"),
    PointerHelp(format_modified(ALT, "drag a handle"), "Turn the shape there"),
    PointerHelp(format_modified(CTRL, "turn"), "Turn by steps of 15°"),
    PointerHelp("Type a number in a drag, Enter", "By pixels or degrees"),
    PointerHelp("X or Y in a drag", "Keep to an axis"),
    PointerHelp(format_modified(ALT, "click a handle"), "Delete it"),
    PointerHelp(format_modified(CTRL, "click the shape"), "Put the anchor there"),
    PointerHelp("Drag the anchor onto another layer", "Attach layer"),
    PointerHelp(format_modified(SHIFT, "click a handle"), "Select several"),
    PointerHelp("Drag beside the shape", "Select by a box"),
    PointerHelp(
        format_modified(CTRL, format_modified(SHIFT, "drag beside the shape")),
        "Move whole drawing",
    ),
    PointerHelp("Right click a handle", "Menu"),
    PointerHelp("Arrows, with Shift ×10", "Nudge the selection, or the whole layer"),
    PointerHelp("Middle drag, or Space and drag", "Move the view"),
    PointerHelp("Wheel", "Zoom at the pointer"),
    PointerHelp("Esc", "Cancel a drag"),
    PointerHelp("Drag while cutting out", "Keep or remove a part of the picture"),
    PointerHelp(format_modified(ALT, "drag while cutting out"), "The opposite"),
    PointerHelp("Drag with the knife", "Part what touches"),
    PointerHelp("Drag a key", "Move it in time"),
    PointerHelp(format_modified(CTRL, "drag a key"), "Copy it"),
    PointerHelp("Click between keys", "Change the easing"),
    PointerHelp("Double-click the track", "Insert a key"),
    PointerHelp("Double-click a marker", "Name it"),
    PointerHelp("Drag a pose onto the timeline", "Make a key of it"),
    PointerHelp("Wheel on the timeline", "Scroll"),
    PointerHelp(format_modified(CTRL, "wheel on the timeline"), "Zoom in time"),
)
