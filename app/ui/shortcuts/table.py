"""All actions that have a name, in the order of the menus: adding one is adding it here."""

from imgui_bundle import hello_imgui, imgui
from imgui_bundle import icons_fontawesome_6 as icons

from app.document import LINEAR, PRESETS
from app.editor import Session, do, layering
from app.editor.actions import (
    cutting,
    editing,
    exporting,
    files,
    keys,
    playback,
    posing,
    saving,
    timeline_pointing,
    viewing,
)
from app.editor.poses import copying, flipping, library
from app.ui.shortcuts.binding import Binding, always

Key = imgui.Key


def _edits(session: Session) -> bool:
    project = session.project
    return project is not None and bool(project.selected or project.chosen_of)


def _undoable(session: Session) -> bool:
    return session.project is not None and session.project.history.undo_label is not None


def _redoable(session: Session) -> bool:
    return session.project is not None and session.project.history.redo_label is not None


def _no_handles_selected(session: Session) -> bool:
    return session.project is not None and not session.project.selected


def _previews(session: Session) -> bool:
    return session.project is not None and session.project.document.preview is not None


def _several(session: Session) -> bool:
    return session.project is not None and len(session.project.selected) > 1


def _some(session: Session) -> bool:
    return session.project is not None and bool(session.project.selected)


def _grouped(session: Session) -> bool:
    project = session.project
    return project is not None and any(
        handle.group for handle in project.figure.handles if handle.id in project.selected
    )


def _all_locked(session: Session) -> bool:
    project = session.project
    return (
        project is not None
        and bool(project.selected)
        and all(map(project.figure.is_locked, project.selected))
    )


def _brushes(session: Session) -> bool:
    return session.cutting in {"keep", "remove"}


def _undone(session: Session) -> str | None:
    return session.project.history.undo_label if session.project else None


def _redone(session: Session) -> str | None:
    return session.project.history.redo_label if session.project else None


def _rename_layer(session: Session) -> None:
    """Ask for the name of the layer that is posed, in the list of layers."""
    if session.project is None:
        return
    for panel in hello_imgui.get_runner_params().docking_params.dockable_windows:
        if panel.label.endswith("###Layers"):
            panel.focus_window_at_next_frame = True
    layering.ask_name(session, session.project.active)


def _reset_layout(_: Session) -> None:
    """Put the panels back where they are at first."""
    hello_imgui.get_runner_params().docking_params.layout_reset = True


# Whole numbers: combined as members, these keys fail to form a flag in Python 3.11.2.
CTRL, SHIFT, ALT = int(Key.mod_ctrl), int(Key.mod_shift), int(Key.mod_alt)
BINDINGS: dict[str, Binding] = {
    "open": Binding(
        label="Open…",
        action=do(files.ask_open),
        menu="File",
        keys=(CTRL | int(Key.o),),
        icon=icons.ICON_FA_FOLDER_OPEN,
        hint="Open a picture or a project",
        possible=always,
    ),
    "save": Binding(
        label="Save",
        action=do(saving.save),
        menu="File",
        keys=(CTRL | int(Key.s),),
        icon=icons.ICON_FA_FLOPPY_DISK,
        parted=True,
    ),
    "save as": Binding(
        label="Save as…", action=do(saving.save_as), menu="File", keys=(CTRL | SHIFT | int(Key.s),)
    ),
    "export": Binding(
        label="Export…",
        action=do(exporting.ask),
        menu="File",
        keys=(CTRL | int(Key.e),),
        icon=icons.ICON_FA_FILE_EXPORT,
        parted=True,
    ),
    "export again": Binding(
        label="Export again",
        action=do(exporting.repeat),
        menu="File",
        keys=(CTRL | SHIFT | int(Key.e),),
    ),
    "copy picture": Binding(
        label="Copy picture",
        action=do(exporting.copy_picture),
        menu="File",
        keys=(CTRL | SHIFT | int(Key.c),),
        hint="Put the picture of the pose on the clipboard",
    ),
    "unsaved work": Binding(
        label="Unsaved work…", action=do(files.show_recovery), menu="File", parted=True
    ),
    "close": Binding(
        label="Close",
        action=do(saving.close),
        menu="File",
        keys=(CTRL | int(Key.w),),
        parted=True,
    ),
    "quit": Binding(
        label="Quit",
        action=do(saving.quit_lissom),
        menu="File",
        keys=(CTRL | int(Key.q),),
        possible=always,
    ),
    "undo": Binding(
        label="Undo",
        action=do(editing.undo),
        menu="Edit",
        keys=(CTRL | int(Key.z),),
        icon=icons.ICON_FA_ARROW_ROTATE_LEFT,
        possible=_undoable,
        repeats=True,
        detail=_undone,
    ),
    "redo": Binding(
        label="Redo",
        action=do(editing.redo),
        menu="Edit",
        keys=(CTRL | SHIFT | int(Key.z), CTRL | int(Key.y)),
        icon=icons.ICON_FA_ARROW_ROTATE_RIGHT,
        possible=_redoable,
        repeats=True,
        detail=_redone,
    ),
    "copy pose": Binding(
        label="Copy pose",
        action=do(copying.copy),
        menu="Edit",
        keys=(CTRL | int(Key.c),),
        icon=icons.ICON_FA_COPY,
        hint="Copy the chosen keys, or the pose that is shown",
        parted=True,
    ),
    "paste pose": Binding(
        label="Paste pose",
        action=do(copying.paste),
        menu="Edit",
        keys=(CTRL | int(Key.v),),
        icon=icons.ICON_FA_PASTE,
        hint="Put the copied pose in a key at this frame",
        possible=copying.can_paste,
    ),
    "paste flipped": Binding(
        label="Paste flipped",
        action=do(flipping.paste),
        menu="Edit",
        keys=(CTRL | SHIFT | int(Key.v),),
        hint="Put the copied pose in a key at this frame, left and right exchanged",
        possible=copying.can_paste_here,
    ),
    "paste on selected": Binding(
        label="Paste on selected handles",
        action=do(copying.paste_on_selected),
        menu="Edit",
        keys=(CTRL | ALT | int(Key.v),),
        hint="Move only the selected handles to where they were in the copied pose",
        possible=copying.can_paste_on_selected,
    ),
    "flip on selected": Binding(
        label="Paste flipped on selected",
        action=do(flipping.paste_on_selected),
        menu="Edit",
        keys=(CTRL | ALT | SHIFT | int(Key.v),),
        hint="Move only the selected handles, to where their partners were",
        possible=copying.can_paste_on_selected,
    ),
    "keep pose": Binding(
        label="Keep pose",
        action=do(library.keep),
        menu="Edit",
        keys=(SHIFT | int(Key.k),),
        icon=icons.ICON_FA_PLUS,
        hint="Put this pose into the library of poses",
    ),
    "select all": Binding(
        label="Select all handles",
        action=do(editing.select_all),
        menu="Edit",
        keys=(CTRL | int(Key.a),),
        parted=True,
    ),
    "cut out": Binding(
        label="Cut out by a brush",
        action=do(cutting.begin_or_swap),
        menu="Edit",
        keys=(Key.x,),
        icon=icons.ICON_FA_SCISSORS,
        hint="Say by a brush what of the picture is kept; again: let it keep or remove",
        active=lambda session: session.cutting is not None,
        parted=True,
    ),
    "smaller brush": Binding(
        label="Smaller brush",
        action=do(cutting.shrink_brush),
        menu="Edit",
        keys=(Key.left_bracket,),
        possible=_brushes,
        repeats=True,
    ),
    "larger brush": Binding(
        label="Larger brush",
        action=do(cutting.enlarge_brush),
        menu="Edit",
        keys=(Key.right_bracket,),
        possible=_brushes,
        repeats=True,
    ),
    "stop cutting": Binding(
        label="Stop cutting out",
        action=do(cutting.take_up, None),
        menu="Edit",
        keys=(Key.escape,),
        possible=lambda session: session.cutting is not None and session.pointer is None,
    ),
    "delete": Binding(
        label="Delete",
        action=do(editing.delete),
        menu="Edit",
        keys=(Key.delete, Key.backspace),
        icon=icons.ICON_FA_TRASH,
        possible=_edits,
    ),
    "rename layer": Binding(
        label="Rename layer",
        action=do(_rename_layer),
        menu="Edit",
        keys=(Key.f2,),
        icon=icons.ICON_FA_PEN,
        hint="Give the layer that is posed another name",
        parted=True,
    ),
    "suggest handles": Binding(
        label="Suggest handles",
        action=do(posing.suggest_handles),
        menu="Handles",
        icon=icons.ICON_FA_WAND_MAGIC_SPARKLES,
        hint="Put handles at the tips of limbs and in the middle of the body",
    ),
    "pin here": Binding(
        label="Pin here",
        action=do(posing.pin_here),
        menu="Handles",
        keys=(Key.p,),
        icon=icons.ICON_FA_THUMBTACK,
        hint="Let the selected handles stay where they are in this frame",
        possible=_some,
        parted=True,
    ),
    "lock": Binding(
        label="Lock",
        action=do(editing.lock),
        menu="Handles",
        keys=(SHIFT | int(Key.l),),
        icon=icons.ICON_FA_LOCK,
        hint="Locked handles hold their places and are not dragged",
        possible=_some,
        active=_all_locked,
    ),
    "group": Binding(
        label="Group",
        action=do(editing.group),
        menu="Handles",
        keys=(CTRL | int(Key.g),),
        icon=icons.ICON_FA_OBJECT_GROUP,
        hint="Select and drag these handles together from now on",
        possible=_several,
        parted=True,
    ),
    "ungroup": Binding(
        label="Ungroup",
        action=do(editing.ungroup),
        menu="Handles",
        keys=(CTRL | SHIFT | int(Key.g),),
        icon=icons.ICON_FA_OBJECT_UNGROUP,
        hint="Let each of these handles be dragged alone",
        possible=_grouped,
    ),
    "mirror": Binding(
        label="Mirror",
        action=do(posing.mirror_handles),
        menu="Handles",
        icon=icons.ICON_FA_LEFT_RIGHT,
        hint="Add partners on the other side, named by .L and .R or left and right",
        possible=_some,
        parted=True,
    ),
    "mirrored": Binding(
        label="Select partners",
        action=do(editing.select_mirrored),
        menu="Handles",
        keys=(SHIFT | int(Key.m),),
        icon=icons.ICON_FA_RIGHT_LEFT,
        hint="Select the handles on the other side that have the same names",
        possible=_some,
    ),
    "fit": Binding(
        label="Fit pose",
        action=do(viewing.fit_pose),
        menu="View",
        keys=(Key.home,),
        icon=icons.ICON_FA_EXPAND,
        hint="Show all of the shape as it is in this frame",
        in_bar=True,
    ),
    "fit motion": Binding(
        label="Fit motion",
        action=do(viewing.fit_motion),
        menu="View",
        keys=(SHIFT | int(Key.home),),
        hint="Show all places that the shape gets to",
    ),
    "fit selection": Binding(
        label="Fit selection",
        action=do(viewing.fit_selection),
        menu="View",
        keys=(Key.f,),
        hint="Show the selected handles from near, or the whole shape",
    ),
    "fit picture": Binding(label="Fit picture", action=do(viewing.look_from, None), menu="View"),
    "actual size": Binding(
        label="Actual size",
        action=do(viewing.actual_size),
        menu="View",
        keys=(Key._1,),  # noqa: SLF001 - its public name begins so
    ),
    "handles": Binding(
        label="Handles",
        action=do(viewing.toggle, "handles"),
        menu="View",
        keys=(Key.h,),
        icon=icons.ICON_FA_CIRCLE_DOT,
        hint="Show or hide the handles",
        active=lambda session: session.overlays.handles,
        parted=True,
        in_bar=True,
    ),
    "wireframe": Binding(
        label="Wireframe",
        action=do(viewing.toggle, "wireframe"),
        menu="View",
        keys=(Key.w,),
        icon=icons.ICON_FA_DRAW_POLYGON,
        hint="Show the triangles",
        active=lambda session: session.overlays.wireframe,
        in_bar=True,
    ),
    "outline": Binding(
        label="Outline",
        action=do(viewing.toggle, "outline"),
        menu="View",
        keys=(Key.c,),
        icon=icons.ICON_FA_VECTOR_SQUARE,
        hint="Show the edge of the shape",
        active=lambda session: session.overlays.outline,
        in_bar=True,
    ),
    "heat map": Binding(
        label="Heat map",
        action=do(viewing.toggle_heat_map),
        menu="View",
        keys=(Key.d,),
        icon=icons.ICON_FA_TEMPERATURE_HALF,
        hint="Colour the shape by its distortion",
        active=lambda session: session.overlays.heat_map != "none",
        in_bar=True,
    ),
    "split view": Binding(
        label="Split view",
        action=do(viewing.toggle_split),
        menu="View",
        keys=(Key.u,),
        icon=icons.ICON_FA_TABLE_COLUMNS,
        hint="Compare with another method, under a divider that can be dragged",
        active=lambda session: session.split is not None,
        in_bar=True,
    ),
    "onion skin": Binding(
        label="Onion skin",
        action=do(viewing.toggle, "onion"),
        menu="View",
        keys=(Key.o,),
        icon=icons.ICON_FA_GHOST,
        hint="Show the poses before and after",
        active=lambda session: session.overlays.onion,
        in_bar=True,
    ),
    "mirror axis": Binding(
        label="Mirror axis",
        action=do(viewing.toggle, "mirror"),
        menu="View",
        keys=(CTRL | int(Key.m),),
        mac_keys=(CTRL | SHIFT | int(Key.m),),
        hint="Show where flipped poses are mirrored",
        active=lambda session: session.overlays.mirror,
    ),
    "motion paths": Binding(
        label="Motion paths",
        action=do(viewing.toggle, "paths"),
        menu="View",
        keys=(Key.j,),
        icon=icons.ICON_FA_ROUTE,
        hint="Show where the selected handles go, with a dot for each frame",
        active=lambda session: session.overlays.paths,
        in_bar=True,
    ),
    "theme": Binding(
        label="Light or dark",
        action=do(viewing.toggle_theme),
        menu="View",
        icon=icons.ICON_FA_CIRCLE_HALF_STROKE,
        hint="Change between the light and the dark theme",
        possible=always,
        parted=True,
    ),
    "larger": Binding(
        label="Larger interface",
        action=do(viewing.scale_up),
        menu="View",
        keys=(CTRL | int(Key.equal), CTRL | int(Key.keypad_add)),
        possible=always,
    ),
    "smaller": Binding(
        label="Smaller interface",
        action=do(viewing.scale_down),
        menu="View",
        keys=(CTRL | int(Key.minus), CTRL | int(Key.keypad_subtract)),
        possible=always,
    ),
    "reset layout": Binding(
        label="Reset layout",
        action=do(_reset_layout),
        menu="View",
        parted=True,
        hint="Put all panels back where they were at first",
        possible=always,
    ),
    "play": Binding(
        label="Play",
        action=do(playback.toggle_play),
        menu="Time",
        icon=icons.ICON_FA_PLAY,
        hint="Play or stop",
        active=lambda session: (
            session.project is not None and session.project.playhead.since is not None
        ),
        told="Space",
    ),
    "start": Binding(
        label="First frame",
        action=do(playback.to_start),
        menu="Time",
        keys=(CTRL | int(Key.page_up),),
        icon=icons.ICON_FA_BACKWARD_FAST,
    ),
    "end": Binding(
        label="Last frame",
        action=do(playback.to_end),
        menu="Time",
        keys=(CTRL | int(Key.page_down),),
        icon=icons.ICON_FA_FORWARD_FAST,
    ),
    "back": Binding(
        label="Previous frame",
        action=do(playback.step, -1),
        menu="Time",
        keys=(Key.page_up,),
        icon=icons.ICON_FA_BACKWARD_STEP,
        repeats=True,
    ),
    "on": Binding(
        label="Next frame",
        action=do(playback.step, 1),
        menu="Time",
        keys=(Key.page_down,),
        icon=icons.ICON_FA_FORWARD_STEP,
        repeats=True,
    ),
    "previous key": Binding(
        label="Previous key",
        action=do(playback.to_key, -1),
        menu="Time",
        keys=(Key.down_arrow,),
        possible=_no_handles_selected,
        repeats=True,
    ),
    "next key": Binding(
        label="Next key",
        action=do(playback.to_key, 1),
        menu="Time",
        keys=(Key.up_arrow,),
        possible=_no_handles_selected,
        repeats=True,
    ),
    "insert key": Binding(
        label="Insert key",
        action=do(posing.insert_key),
        menu="Time",
        keys=(Key.i,),
        icon=icons.ICON_FA_DIAMOND,
        hint="Keep this pose in a key",
        parted=True,
    ),
    "loop": Binding(
        label="Loop",
        action=do(keys.toggle_loop),
        menu="Time",
        keys=(Key.l,),
        icon=icons.ICON_FA_REPEAT,
        hint="Loop: the end leads back to the start",
        active=lambda session: session.project is not None and session.project.document.loop,
    ),
    "auto-key": Binding(
        label="Auto-key",
        action=do(viewing.toggle_auto_key),
        menu="Time",
        keys=(Key.k,),
        icon=icons.ICON_FA_KEY,
        hint="Posing makes and changes keys",
        active=lambda session: session.preferences.auto_key,
        in_bar=True,
    ),
    "preview start": Binding(
        label="Start preview range here",
        action=do(keys.start_preview_here),
        menu="Time",
        keys=(Key.b,),
        parted=True,
    ),
    "preview end": Binding(
        label="End preview range here", action=do(keys.end_preview_here), menu="Time", keys=(Key.n,)
    ),
    "preview none": Binding(
        label="Play all frames",
        action=do(keys.play_all),
        menu="Time",
        keys=(ALT | int(Key.p),),
        hint="Clear the preview range",
        possible=_previews,
    ),
    "marker": Binding(
        label="Add marker",
        action=do(keys.mark_here),
        menu="Time",
        keys=(Key.m,),
        icon=icons.ICON_FA_BOOKMARK,
        hint="Name this frame",
        parted=True,
    ),
    "previous marker": Binding(
        label="Previous marker",
        action=do(playback.to_marker, -1),
        menu="Time",
        keys=(SHIFT | int(Key.page_up),),
        repeats=True,
    ),
    "next marker": Binding(
        label="Next marker",
        action=do(playback.to_marker, 1),
        menu="Time",
        keys=(SHIFT | int(Key.page_down),),
        repeats=True,
    ),
    "fit time": Binding(
        label="Fit timeline",
        action=do(timeline_pointing.fit),
        menu="Time",
        keys=(CTRL | int(Key.home),),
        icon=icons.ICON_FA_ARROWS_LEFT_RIGHT_TO_LINE,
        hint="Show all frames",
    ),
    "pass": Binding(
        label="Pass keys otherwise",
        action=do(keys.pass_otherwise),
        menu="Keys",
        keys=(Key.t,),
        hint="Through, in a corner, with a stop, or hold: the next way for the chosen keys",
    ),
    "ease": Binding(
        label="Ease in and out",
        action=do(keys.ease, PRESETS["in-out"]),
        menu="Keys",
        keys=(Key.f9,),
        hint="Let the ways from the chosen keys begin and end slowly",
    ),
    "ease in": Binding(
        label="Ease in",
        action=do(keys.ease, PRESETS["in"]),
        menu="Keys",
        keys=(SHIFT | int(Key.f9),),
        hint="Let the ways from the chosen keys begin slowly",
    ),
    "ease out": Binding(
        label="Ease out",
        action=do(keys.ease, PRESETS["out"]),
        menu="Keys",
        keys=(CTRL | SHIFT | int(Key.f9),),
        hint="Let the ways from the chosen keys end slowly",
    ),
    "ease not": Binding(
        label="Linear",
        action=do(keys.ease, LINEAR),
        menu="Keys",
        keys=(ALT | int(Key.f9),),
        hint="Let time run evenly from the chosen keys on",
    ),
    "shortcuts": Binding(
        label="Keys and mouse",
        action=do(viewing.show_shortcuts),
        menu="Help",
        keys=(Key.f1,),
        icon=icons.ICON_FA_KEYBOARD,
        possible=always,
    ),
}
