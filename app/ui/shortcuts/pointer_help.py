"""Pointer gestures for the sheet of shortcuts. The viewport and the timeline handle them."""

from dataclasses import dataclass

from app.texts import _
from app.ui.shortcuts.keys import ALT, CTRL, SHIFT, format_modified


@dataclass(frozen=True, slots=True)
class PointerHelp:
    gesture: str
    effect: str


POINTER_HELP = (
    PointerHelp(_("Click the shape"), _("Add a handle")),
    PointerHelp(_("Drag a handle"), _("Pose, or key its selected track")),
    PointerHelp(_("Drag a key on a track's path"), _("Move it in the picture")),
    PointerHelp(format_modified(ALT, _("let go of a handle")), _("Keep the target there")),
    PointerHelp(_("Drag the ring around a handle"), _("Turn the shape there")),
    PointerHelp(format_modified(ALT, _("drag a handle")), _("Turn the shape, as its ring does")),
    PointerHelp(_("Drag a grip of the box"), _("Turn or scale several handles, or a layer")),
    PointerHelp(_("Drag the cross in the box"), _("Move the pivot; the picture stays")),
    PointerHelp(format_modified(SHIFT, _("drag a grip")), _("Steps of 15°, same proportions")),
    PointerHelp(_("Type a number in a drag, Enter"), _("By pixels or degrees")),
    PointerHelp(_("X or Y in a drag"), _("Lock to an axis")),
    PointerHelp(format_modified(ALT, _("click a handle")), _("Delete it, as the key Del")),
    PointerHelp(format_modified(CTRL, _("click the shape")), _("Put the anchor there")),
    PointerHelp(_("Drag the anchor onto another layer"), _("Attach layer")),
    PointerHelp(format_modified(SHIFT, _("click a handle")), _("Select several")),
    PointerHelp(_("Drag beside the shape"), _("Select by box")),
    PointerHelp(
        format_modified(CTRL, format_modified(SHIFT, _("drag beside the shape"))),
        _("Move whole drawing"),
    ),
    PointerHelp(_("Right-click a handle"), _("Menu")),
    PointerHelp(_("Arrows, with Shift ×10"), _("Nudge the selection, or the whole layer")),
    PointerHelp(
        format_modified(CTRL, _("arrows, with Shift ×10")), _("Turn and scale the selection")
    ),
    PointerHelp(_("Middle drag, or Space and drag"), _("Move the view")),
    PointerHelp(_("Wheel"), _("Zoom at the pointer")),
    PointerHelp(_("Esc"), _("Cancel a drag")),
    PointerHelp(_("Drag while cutting out"), _("Keep or remove a part of the picture")),
    PointerHelp(format_modified(CTRL, _("drag while cutting out")), _("Swap keep and remove")),
    PointerHelp(_("Drag with the knife"), _("Separate touching parts")),
    PointerHelp(_("Drag a key"), _("Move it in time")),
    PointerHelp(format_modified(CTRL, _("drag a key")), _("Copy it")),
    PointerHelp(_("Click between keys"), _("Change the easing")),
    PointerHelp(_("Double-click the track"), _("Insert a key")),
    PointerHelp(_("Double-click a marker"), _("Name it")),
    PointerHelp(_("Drag a pose onto the timeline"), _("Key the pose")),
    PointerHelp(_("Wheel on the timeline"), _("Scroll")),
    PointerHelp(format_modified(CTRL, _("wheel on the timeline")), _("Zoom in time")),
)
