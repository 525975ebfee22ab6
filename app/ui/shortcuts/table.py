"""All actions that have a name, in the order of the menus: adding one is adding it here."""

from imgui_bundle import hello_imgui, icons_fontawesome_6 as icons, imgui

from app.document import LINEAR, PRESETS
from app.editor import Project, Session, do, layering, with_project
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
from app.ui.shortcuts.binding import Binding
from app.ui.shortcuts.keys import ALT, CTRL, SHIFT

Key = imgui.Key


def _undo_label(_: Session, project: Project) -> str | None:
    return project.history.undo_label


def _redo_label(_: Session, project: Project) -> str | None:
    return project.history.redo_label


def _selected(_: Session, project: Project) -> bool:
    return bool(project.selected)


def _none_selected(_: Session, project: Project) -> bool:
    return not project.selected


def _grouped(_: Session, project: Project) -> bool:
    return any(h.group for h in project.figure.handles if h.id in project.selected)


def _all_locked(_: Session, project: Project) -> bool:
    return bool(project.selected) and all(map(project.figure.is_locked, project.selected))


def _brushes(session: Session, _: Project) -> bool:
    return session.cutting in {"keep", "remove"}


@with_project
def _rename_layer(session: Session, project: Project) -> None:
    """Ask for the name of the layer that is posed, in the list of layers."""
    for panel in hello_imgui.get_runner_params().docking_params.dockable_windows:
        if panel.label.endswith("###Layers"):
            panel.focus_window_at_next_frame = True
    layering.ask_name(session, project.active)


def _reset_layout(_: Session) -> None:
    """Put the panels back where they are at first."""
    hello_imgui.get_runner_params().docking_params.layout_reset = True


MENUS: dict[str, dict[str, Binding]] = {
    "File": {
        "open": Binding(
            label="Open…",
            action=do(files.ask_open),
            keys=(CTRL | int(Key.o),),
            needs_project=False,
        ),
        "save": Binding(
            label="Save", action=do(saving.save), keys=(CTRL | int(Key.s),), parted=True
        ),
        "save as": Binding(
            label="Save as…", action=do(saving.save_as), keys=(CTRL | SHIFT | int(Key.s),)
        ),
        "export": Binding(
            label="Export…", action=do(exporting.ask), keys=(CTRL | int(Key.e),), parted=True
        ),
        "export again": Binding(
            label="Export again", action=do(exporting.repeat), keys=(CTRL | SHIFT | int(Key.e),)
        ),
        "copy picture": Binding(
            label="Copy picture",
            action=do(exporting.copy_picture),
            keys=(CTRL | SHIFT | int(Key.c),),
        ),
        "unsaved work": Binding(label="Unsaved work…", action=do(files.show_recovery), parted=True),
        "close": Binding(
            label="Close", action=do(saving.close), keys=(CTRL | int(Key.w),), parted=True
        ),
        "quit": Binding(
            label="Quit",
            action=do(saving.quit_lissom),
            keys=(CTRL | int(Key.q),),
            needs_project=False,
        ),
    },
    "Edit": {
        "undo": Binding(
            label="Undo",
            action=do(editing.undo),
            keys=(CTRL | int(Key.z),),
            possible=_undo_label,
            repeats=True,
            detail=_undo_label,
        ),
        "redo": Binding(
            label="Redo",
            action=do(editing.redo),
            keys=(CTRL | SHIFT | int(Key.z), CTRL | int(Key.y)),
            possible=_redo_label,
            repeats=True,
            detail=_redo_label,
        ),
        "copy pose": Binding(
            label="Copy pose", action=do(copying.copy), keys=(CTRL | int(Key.c),), parted=True
        ),
        "paste pose": Binding(
            label="Paste pose",
            action=do(copying.paste),
            keys=(CTRL | int(Key.v),),
            possible=copying.copied_for,
        ),
        "paste flipped": Binding(
            label="Paste flipped",
            action=do(flipping.paste),
            keys=(CTRL | SHIFT | int(Key.v),),
            icon=icons.ICON_FA_PASTE,
            hint="Put the copied pose in a key at this frame, left and right exchanged",
            possible=copying.copied_here,
        ),
        "paste on selected": Binding(
            label="Paste on selected handles",
            action=do(copying.paste_on_selected),
            keys=(CTRL | ALT | int(Key.v),),
            possible=copying.copied_for_selected,
        ),
        "flip on selected": Binding(
            label="Paste flipped on selected",
            action=do(flipping.paste_on_selected),
            keys=(CTRL | ALT | SHIFT | int(Key.v),),
            possible=copying.copied_for_selected,
        ),
        "keep pose": Binding(
            label="Keep pose",
            action=do(library.keep),
            keys=(SHIFT | int(Key.k),),
            icon=icons.ICON_FA_PLUS,
            hint="Put this pose into the library of poses",
        ),
        "select all": Binding(
            label="Select all handles",
            action=do(editing.select_all),
            keys=(CTRL | int(Key.a),),
            parted=True,
        ),
        "cut out": Binding(
            label="Cut out by a brush",
            action=do(cutting.begin_or_swap),
            keys=(Key.x,),
            active=lambda session, _: session.cutting is not None,
            parted=True,
        ),
        "smaller brush": Binding(
            label="Smaller brush",
            action=do(cutting.shrink_brush),
            keys=(Key.left_bracket,),
            possible=_brushes,
            repeats=True,
        ),
        "larger brush": Binding(
            label="Larger brush",
            action=do(cutting.enlarge_brush),
            keys=(Key.right_bracket,),
            possible=_brushes,
            repeats=True,
        ),
        "stop cutting": Binding(
            label="Stop cutting out",
            action=do(cutting.take_up, None),
            keys=(Key.escape,),
            possible=lambda session, _: session.cutting is not None and session.pointer is None,
        ),
        "delete": Binding(
            label="Delete",
            action=do(editing.delete),
            keys=(Key.delete, Key.backspace),
            possible=lambda _, project: project.selected or project.chosen_of,
        ),
        "rename layer": Binding(
            label="Rename layer", action=do(_rename_layer), keys=(Key.f2,), parted=True
        ),
    },
    "Handles": {
        "suggest handles": Binding(
            label="Suggest handles",
            action=do(posing.suggest_handles),
            icon=icons.ICON_FA_WAND_MAGIC_SPARKLES,
            hint="Put handles at the tips of limbs and in the middle of the body",
        ),
        "pin here": Binding(
            label="Pin here",
            action=do(posing.pin_here),
            keys=(Key.p,),
            icon=icons.ICON_FA_THUMBTACK,
            hint="Let the selected handles stay where they are in this frame",
            possible=_selected,
            parted=True,
        ),
        "lock": Binding(
            label="Lock",
            action=do(editing.lock),
            keys=(SHIFT | int(Key.l),),
            icon=icons.ICON_FA_LOCK,
            hint="Locked handles hold their places and are not dragged",
            possible=_selected,
            active=_all_locked,
        ),
        "group": Binding(
            label="Group",
            action=do(editing.group),
            keys=(CTRL | int(Key.g),),
            icon=icons.ICON_FA_OBJECT_GROUP,
            hint="Select and drag these handles together from now on",
            possible=lambda _, project: len(project.selected) > 1,
            parted=True,
        ),
        "ungroup": Binding(
            label="Ungroup",
            action=do(editing.ungroup),
            keys=(CTRL | SHIFT | int(Key.g),),
            icon=icons.ICON_FA_OBJECT_UNGROUP,
            hint="Let each of these handles be dragged alone",
            possible=_grouped,
        ),
        "mirror": Binding(
            label="Mirror",
            action=do(posing.mirror_handles),
            icon=icons.ICON_FA_LEFT_RIGHT,
            hint="Add partners on the other side, named by .L and .R or left and right",
            possible=_selected,
            parted=True,
        ),
        "mirrored": Binding(
            label="Select partners",
            action=do(editing.select_mirrored),
            keys=(SHIFT | int(Key.m),),
            icon=icons.ICON_FA_RIGHT_LEFT,
            hint="Select the handles on the other side that have the same names",
            possible=_selected,
        ),
    },
    "View": {
        "fit": Binding(
            label="Fit pose",
            action=do(viewing.fit_pose),
            keys=(Key.home,),
            icon=icons.ICON_FA_EXPAND,
            hint="Show all of the shape as it is in this frame",
        ),
        "fit motion": Binding(
            label="Fit motion", action=do(viewing.fit_motion), keys=(SHIFT | int(Key.home),)
        ),
        "fit selection": Binding(
            label="Fit selection", action=do(viewing.fit_selection), keys=(Key.f,)
        ),
        "fit picture": Binding(label="Fit picture", action=do(viewing.look_from, None)),
        "actual size": Binding(
            label="Actual size",
            action=do(viewing.actual_size),
            keys=(Key._1,),  # noqa: SLF001 - its public name begins so
        ),
        "handles": Binding(
            label="Handles",
            action=do(viewing.toggle, "handles"),
            keys=(Key.h,),
            icon=icons.ICON_FA_CIRCLE_DOT,
            hint="Show or hide the handles",
            active=lambda session, _: session.overlays.handles,
            parted=True,
        ),
        "wireframe": Binding(
            label="Wireframe",
            action=do(viewing.toggle, "wireframe"),
            keys=(Key.w,),
            icon=icons.ICON_FA_DRAW_POLYGON,
            hint="Show the triangles",
            active=lambda session, _: session.overlays.wireframe,
        ),
        "outline": Binding(
            label="Outline",
            action=do(viewing.toggle, "outline"),
            keys=(Key.c,),
            icon=icons.ICON_FA_VECTOR_SQUARE,
            hint="Show the edge of the shape",
            active=lambda session, _: session.overlays.outline,
        ),
        "heat map": Binding(
            label="Heat map",
            action=do(viewing.toggle_heat_map),
            keys=(Key.d,),
            icon=icons.ICON_FA_TEMPERATURE_HALF,
            hint="Colour the shape by its distortion",
            active=lambda session, _: session.overlays.heat_map != "none",
        ),
        "split view": Binding(
            label="Split view",
            action=do(viewing.toggle_split),
            keys=(Key.u,),
            icon=icons.ICON_FA_TABLE_COLUMNS,
            hint="Compare with another method, under a divider that can be dragged",
            active=lambda session, _: session.split is not None,
        ),
        "onion skin": Binding(
            label="Onion skin",
            action=do(viewing.toggle, "onion"),
            keys=(Key.o,),
            icon=icons.ICON_FA_GHOST,
            hint="Show the poses before and after",
            active=lambda session, _: session.overlays.onion,
        ),
        "mirror axis": Binding(
            label="Mirror axis",
            action=do(viewing.toggle, "mirror"),
            keys=(CTRL | int(Key.m),),
            mac_keys=(CTRL | SHIFT | int(Key.m),),
            active=lambda session, _: session.overlays.mirror,
        ),
        "motion paths": Binding(
            label="Motion paths",
            action=do(viewing.toggle, "paths"),
            keys=(Key.j,),
            icon=icons.ICON_FA_ROUTE,
            hint="Show where the selected handles go, with a dot for each frame",
            active=lambda session, _: session.overlays.paths,
        ),
        "theme": Binding(
            label="Light or dark",
            action=do(viewing.toggle_theme),
            needs_project=False,
            parted=True,
        ),
        "larger": Binding(
            label="Larger interface",
            action=do(viewing.scale_up),
            keys=(CTRL | int(Key.equal), CTRL | int(Key.keypad_add)),
            needs_project=False,
        ),
        "smaller": Binding(
            label="Smaller interface",
            action=do(viewing.scale_down),
            keys=(CTRL | int(Key.minus), CTRL | int(Key.keypad_subtract)),
            needs_project=False,
        ),
        "reset layout": Binding(
            label="Reset layout", action=do(_reset_layout), parted=True, needs_project=False
        ),
    },
    "Time": {
        "play": Binding(
            label="Play",
            action=do(playback.toggle_play),
            icon=icons.ICON_FA_PLAY,
            hint="Play or stop",
            active=lambda _, project: project.playhead.since is not None,
            told="Space",
        ),
        "start": Binding(
            label="First frame",
            action=do(playback.to_start),
            keys=(CTRL | int(Key.page_up),),
            icon=icons.ICON_FA_BACKWARD_FAST,
        ),
        "end": Binding(
            label="Last frame",
            action=do(playback.to_end),
            keys=(CTRL | int(Key.page_down),),
            icon=icons.ICON_FA_FORWARD_FAST,
        ),
        "back": Binding(
            label="Previous frame",
            action=do(playback.step, -1),
            keys=(Key.page_up,),
            icon=icons.ICON_FA_BACKWARD_STEP,
            repeats=True,
        ),
        "on": Binding(
            label="Next frame",
            action=do(playback.step, 1),
            keys=(Key.page_down,),
            icon=icons.ICON_FA_FORWARD_STEP,
            repeats=True,
        ),
        "previous key": Binding(
            label="Previous key",
            action=do(playback.to_key, -1),
            keys=(Key.down_arrow,),
            possible=_none_selected,
            repeats=True,
        ),
        "next key": Binding(
            label="Next key",
            action=do(playback.to_key, 1),
            keys=(Key.up_arrow,),
            possible=_none_selected,
            repeats=True,
        ),
        "insert key": Binding(
            label="Insert key",
            action=do(posing.insert_key),
            keys=(Key.i,),
            icon=icons.ICON_FA_DIAMOND,
            hint="Keep this pose in a key",
            parted=True,
        ),
        "loop": Binding(
            label="Loop",
            action=do(keys.toggle_loop),
            keys=(Key.l,),
            icon=icons.ICON_FA_REPEAT,
            hint="Loop: the end leads back to the start",
            active=lambda _, project: project.document.loop,
        ),
        "auto-key": Binding(
            label="Auto-key",
            action=do(viewing.toggle_auto_key),
            keys=(Key.k,),
            icon=icons.ICON_FA_KEY,
            hint="Posing makes and changes keys",
            active=lambda session, _: session.preferences.auto_key,
        ),
        "preview start": Binding(
            label="Start preview range here",
            action=do(keys.start_preview_here),
            keys=(Key.b,),
            parted=True,
        ),
        "preview end": Binding(
            label="End preview range here", action=do(keys.end_preview_here), keys=(Key.n,)
        ),
        "preview none": Binding(
            label="Play all frames",
            action=do(keys.play_all),
            keys=(ALT | int(Key.p),),
            possible=lambda _, project: project.document.preview is not None,
        ),
        "marker": Binding(
            label="Add marker", action=do(keys.mark_here), keys=(Key.m,), parted=True
        ),
        "previous marker": Binding(
            label="Previous marker",
            action=do(playback.to_marker, -1),
            keys=(SHIFT | int(Key.page_up),),
            repeats=True,
        ),
        "next marker": Binding(
            label="Next marker",
            action=do(playback.to_marker, 1),
            keys=(SHIFT | int(Key.page_down),),
            repeats=True,
        ),
        "fit time": Binding(
            label="Fit timeline",
            action=do(timeline_pointing.fit),
            keys=(CTRL | int(Key.home),),
            icon=icons.ICON_FA_ARROWS_LEFT_RIGHT_TO_LINE,
            hint="Show all frames",
        ),
    },
    "Keys": {
        "pass": Binding(label="Pass keys otherwise", action=do(keys.pass_otherwise), keys=(Key.t,)),
        "ease": Binding(
            label="Ease in and out", action=do(keys.ease, PRESETS["in-out"]), keys=(Key.f9,)
        ),
        "ease in": Binding(
            label="Ease in", action=do(keys.ease, PRESETS["in"]), keys=(SHIFT | int(Key.f9),)
        ),
        "ease out": Binding(
            label="Ease out",
            action=do(keys.ease, PRESETS["out"]),
            keys=(CTRL | SHIFT | int(Key.f9),),
        ),
        "ease not": Binding(
            label="Linear", action=do(keys.ease, LINEAR), keys=(ALT | int(Key.f9),)
        ),
    },
    "Help": {
        "shortcuts": Binding(
            label="Keys and mouse",
            action=do(viewing.show_shortcuts),
            keys=(Key.f1,),
            needs_project=False,
        ),
    },
}
BINDINGS = {name: binding for menu in MENUS.values() for name, binding in menu.items()}
