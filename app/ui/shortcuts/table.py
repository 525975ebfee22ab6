"""All named actions, in menu order. A new action needs only an entry here."""

from functools import partial
from typing import Any

from imgui_bundle import hello_imgui, icons_fontawesome_6 as icons

from app.document import LINEAR, PRESETS
from app.editor import Project, Session, do, error_reports, with_project
from app.editor.actions import editing, playback, tutorials, viewing
from app.editor.actions.layer_setup import cut_out_editing, handle_editing, stiffness_editing
from app.editor.actions.posing.handles import mirror_handles, suggest_handles
from app.editor.actions.posing.motion_presets import apply_motion, joint_placement, preset_setup
from app.editor.actions.posing.pose_drag import pin_selected_handles
from app.editor.actions.project_files import export_settings, exporting, files, recovery, saving
from app.editor.actions.timing import cycles, keys, timeline_drag, tracks
from app.editor.actions.tracking.recording import discard_recording, toggle_recording_armed
from app.editor.actions.viewing import OverlayName
from app.editor.layering.layer_channels import key_camera, toggle_camera_view
from app.editor.layering.layer_list import ask_layer_name
from app.editor.poses import copying, library, paste_destinations, pasting
from app.editor.tools import move_tool
from app.ui.panel import bring_to_front
from app.ui.shortcuts.action_spec import ActionSpec
from app.ui.shortcuts.manual import open_manual_page


def _undo_label(_: Session, project: Project) -> str:
    if project.motion_setup is not None and project.motion_setup.past:
        return "“Move a joint”"
    label = "Give a motion" if project.motion_job is not None else project.history.undo_label
    return "" if label is None else f"“{label}”"


def _redo_label(_: Session, project: Project) -> str:
    label = project.history.redo_label
    return "" if label is None else f"“{label}”"


def _looks_through(session: Session) -> bool:
    return session.project is not None and session.project.is_camera_view


def _copied(session: Session, project: Project) -> str:
    if copying.is_copying_keys(session, project):
        return f"{project.selected_key_count} keys" if project.selected_key_count > 1 else "pose"
    layers = len(project.selected_layers)
    return f"poses of {layers} layers" if layers > 1 else "pose"


def _stretch(_: Session, project: Project) -> str:
    stretch = cycles.selected_range(project)
    return "" if stretch is None else f"frames {stretch[0]} to {stretch[1]}"


def _onto(session: Session, project: Project, way: paste_destinations.PasteMode) -> str:
    """Name the layers that receive the paste, unless it is only the active layer."""
    onto = [
        each.layer for each in paste_destinations.find_paste_destinations(session, project, way)
    ]
    if len(onto) > 1:
        return f"onto {len(onto)} layers"
    return "".join(f"onto {layer.name}" for layer in onto if layer.id != project.active)


def _all(session: Session, _: Project) -> str:
    return "keys" if session.is_timeline_focused else "handles"


def _is_idle(session: Session, project: Project) -> bool:
    """Return whether nothing is active that Esc ends before it clears the selection."""
    in_hand = (
        session.active_tool
        or not session.is_posing
        or project.timeline.gesture
        or project.motion_job
    )
    return not (in_hand or _records(session, project))


def _can_deselect(session: Session, project: Project) -> bool:
    is_chosen = bool(project.selected_handles or project.selected_keys)
    return is_chosen and _is_idle(session, project) and not tutorials.is_tutorial_shown(session)


def _can_leave(session: Session, project: Project) -> bool:
    return tutorials.is_tutorial_shown(session) and _is_idle(session, project)


def _records(session: Session, project: Project) -> bool:
    """Return whether a drag will be recorded, or a recorded drag is not yet kept or discarded."""
    return session.active_tool is None and (session.records or project.recording is not None)


def _gives(session: Session, project: Project) -> bool:
    """Return whether a motion preset is being applied and Esc ends nothing else first."""
    return project.motion_job is not None and session.active_tool is None and session.is_posing


def _has_sides(_: Session, project: Project) -> bool:
    """Return whether a motion preset is being set up for a body seen from the front."""
    return project.motion_setup is not None and project.motion_setup.kind == "biped-front"


def _selected(_: Session, project: Project) -> bool:
    return bool(project.selected_handles)


def _frees_arrows(session: Session, project: Project) -> bool:
    return not (session.moves or project.selected_handles)


def _can_delete(_: Session, project: Project) -> bool:
    """Return whether keys, handles or a joint of a motion preset are selected."""
    joint = project.motion_setup is not None and project.motion_setup.selected_joint
    return bool(joint or project.selected_handles or project.selected_keys)


def _can_pose(session: Session, _: Project) -> bool:
    return not session.is_posing and session.active_tool is None


def _grouped(_: Session, project: Project) -> bool:
    return any(h.group for h in project.layer.handles if h.id in project.selected_handles)


def _all_locked(session: Session) -> bool:
    project = session.project
    selected = project.selected_handles if project else frozenset[int]()
    return bool(project and selected and all(map(project.layer.is_locked, selected)))


def _has_summary(_: Session, project: Project) -> bool:
    return bool(project.document.import_log)


def _loops(session: Session) -> bool:
    return session.project is not None and session.project.document.loop


def _plays(session: Session) -> bool:
    return session.project is not None and session.project.playhead.since is not None


def _brushes(session: Session, _: Project) -> bool:
    return session.cutting in {"keep", "remove"} or session.material in stiffness_editing.BRUSHES


@with_project
def _rename_layer(session: Session, project: Project) -> None:
    bring_to_front("Layers")
    ask_layer_name(session, project.active)


def _export(session: Session) -> None:
    """Show the export panel. If it is in front already, ask for the file and begin."""
    if bring_to_front("Export"):
        export_settings.ask_destination_and_export(session)


def _overlay(label: str, name: OverlayName, keys: str, **more: Any) -> ActionSpec:
    def is_shown(session: Session) -> bool:
        return bool(getattr(session.overlays, name))

    return ActionSpec(label, do(viewing.toggle_overlay, name), keys, active=is_shown, **more)


def _reset_layout(_: Session) -> None:
    hello_imgui.get_runner_params().docking_params.layout_reset = True


MENUS: dict[str, dict[str, ActionSpec]] = {
    "File": {
        "open": ActionSpec("Open…", do(files.ask_file_to_open), "Ctrl+O", needs_project=False),
        "save": ActionSpec("Save", do(saving.save), "Ctrl+S", has_separator=True),
        "save as": ActionSpec("Save as…", do(saving.save_as), "Ctrl+Shift+S"),
        "export": ActionSpec("Export…", do(_export), "Ctrl+E", has_separator=True),
        "export again": ActionSpec(
            "Export again", do(export_settings.repeat_export), "Ctrl+Shift+E"
        ),
        "copy picture": ActionSpec("Copy picture", do(exporting.copy_picture), "Ctrl+Shift+C"),
        "unsaved work": ActionSpec(
            "Unsaved work…", do(recovery.show_recovery), has_separator=True, needs_project=False
        ),
        "close": ActionSpec("Close", do(saving.close_project), "Ctrl+W", has_separator=True),
        "quit": ActionSpec("Quit", do(saving.request_quit), "Ctrl+Q", needs_project=False),
    },
    "Edit": {
        "undo": ActionSpec(
            "Undo",
            do(editing.undo),
            "Ctrl+Z",
            condition=_undo_label,
            repeats_while_held=True,
            detail=_undo_label,
        ),
        "redo": ActionSpec(
            "Redo",
            do(editing.redo),
            "Ctrl+Shift+Z, Ctrl+Y",
            condition=_redo_label,
            repeats_while_held=True,
            detail=_redo_label,
        ),
        "copy": ActionSpec(
            "Copy", do(copying.copy_pose_or_keys), "Ctrl+C", has_separator=True, detail=_copied
        ),
        "copy all": ActionSpec(
            "Copy poses of all layers",
            do(copying.copy_all_poses),
            "Ctrl+Alt+C",
            condition=lambda _, project: len(project.document.layers) > 1,
        ),
        "paste": ActionSpec(
            "Paste",
            do(pasting.paste_copied),
            "Ctrl+V",
            detail=partial(_onto, way="as it is"),
            explain_disabled=partial(pasting.paste_disabled_reason, way="as it is"),
        ),
        "paste flipped": ActionSpec(
            "Paste flipped",
            do(pasting.paste_copied, "flipped"),
            "Ctrl+Shift+V",
            icon=icons.ICON_FA_PASTE,
            hint="Put what was copied in a key at this frame, mirrored: left and right exchange",
            detail=partial(_onto, way="flipped"),
            explain_disabled=partial(pasting.paste_disabled_reason, way="flipped"),
        ),
        "paste swapped": ActionSpec(
            "Paste swapped",
            do(pasting.paste_copied, "swapped"),
            "Ctrl+Shift+X",
            icon=icons.ICON_FA_RIGHT_LEFT,
            hint="Put what was copied in a key at this frame: near and far, or left and right, "
            "exchange, and nothing is mirrored",
            detail=partial(_onto, way="swapped"),
            explain_disabled=partial(pasting.paste_disabled_reason, way="swapped"),
        ),
        "paste on selected": ActionSpec(
            "Paste on selected handles",
            do(pasting.paste_on_selected),
            "Ctrl+Alt+V",
            explain_disabled=partial(pasting.paste_on_selected_disabled_reason, way="as it is"),
        ),
        "flip on selected": ActionSpec(
            "Paste flipped on selected",
            do(pasting.paste_on_selected, "flipped"),
            "Ctrl+Alt+Shift+V",
            explain_disabled=partial(pasting.paste_on_selected_disabled_reason, way="flipped"),
        ),
        "keep pose": ActionSpec(
            "Save pose",
            do(library.save_pose_to_library),
            "Shift+K",
            icon=icons.ICON_FA_PLUS,
            hint="Put this pose into the library of poses",
        ),
        "select all": ActionSpec(
            "Select all", do(editing.select_all), "Ctrl+A", has_separator=True, detail=_all
        ),
        "deselect": ActionSpec(
            "Deselect", do(editing.deselect_all), "Escape", condition=_can_deselect
        ),
        "move": ActionSpec(
            "Move whole drawing",
            do(move_tool.toggle_move_tool),
            "V",
            icon=icons.ICON_FA_UP_DOWN_LEFT_RIGHT,
            hint="Drags and arrows move all of the layer, as it is, in this frame",
            active=lambda session: session.moves,
            has_separator=True,
        ),
        "cut out": ActionSpec(
            "Cut out by a brush",
            do(cut_out_editing.toggle_cut_brush),
            "X",
            active=lambda session: session.cutting is not None,
        ),
        "smaller brush": ActionSpec(
            "Smaller brush",
            do(cut_out_editing.shrink_brush),
            "LeftBracket",
            condition=_brushes,
            repeats_while_held=True,
        ),
        "larger brush": ActionSpec(
            "Larger brush",
            do(cut_out_editing.enlarge_brush),
            "RightBracket",
            condition=_brushes,
            repeats_while_held=True,
        ),
        "pose": ActionSpec(
            "Back to posing", do(move_tool.return_to_posing), "Escape", condition=_can_pose
        ),
        "delete": ActionSpec(
            "Delete",
            do(editing.delete_selection),
            "Delete, Backspace",
            condition=_can_delete,
        ),
        "rename layer": ActionSpec("Rename layer", do(_rename_layer), "F2", has_separator=True),
    },
    "Handles": {
        "suggest handles": ActionSpec(
            "Suggest handles",
            do(suggest_handles),
            icon=icons.ICON_FA_WAND_MAGIC_SPARKLES,
            hint="Put handles on body and head and at tips and joints of limbs, each with a name",
        ),
        "pin here": ActionSpec(
            "Pin here",
            do(pin_selected_handles),
            "P",
            icon=icons.ICON_FA_THUMBTACK,
            hint="Let the selected handles stay where they are in this frame",
            condition=_selected,
            has_separator=True,
        ),
        "lock": ActionSpec(
            "Lock",
            do(handle_editing.toggle_handles_locked),
            "Shift+L",
            icon=icons.ICON_FA_LOCK,
            hint="Locked handles hold their places and are not dragged",
            condition=_selected,
            active=_all_locked,
        ),
        "key handle": ActionSpec(
            "Key this handle only",
            do(tracks.key_selected_handles),
            "Shift+I",
            icon=icons.ICON_FA_KEY,
            hint="Give it a key of its own in this frame: it gets a track beside the keys of poses",
            condition=_selected,
            has_separator=True,
        ),
        "stiffen": ActionSpec(
            "Make parts stiff",
            do(stiffness_editing.toggle_stiffness_tool, "stiff"),
            "G",
            icon=icons.ICON_FA_CUBE,
            hint="Brush over what is to bend and stretch less than the rest",
            active=lambda session: session.material in stiffness_editing.BRUSHES,
            has_separator=True,
        ),
        "bone": ActionSpec(
            "Draw bones",
            do(stiffness_editing.toggle_stiffness_tool, "bone"),
            "Shift+B",
            icon=icons.ICON_FA_BONE,
            hint="Drag from a handle to another one: the limb between them is stiff",
            active=lambda session: session.material == "bone",
        ),
        "bone between": ActionSpec(
            "Bone between two handles",
            do(stiffness_editing.add_bone_between_selected),
            condition=lambda _, project: len(project.selected_handles) == 2,
        ),
        "group": ActionSpec(
            "Group",
            do(handle_editing.group_handles),
            "Ctrl+G",
            icon=icons.ICON_FA_OBJECT_GROUP,
            hint="Select and drag these handles together from now on",
            condition=lambda _, project: len(project.selected_handles) > 1,
            has_separator=True,
        ),
        "ungroup": ActionSpec(
            "Ungroup",
            do(handle_editing.ungroup_handles),
            "Ctrl+Shift+G",
            icon=icons.ICON_FA_OBJECT_UNGROUP,
            hint="Let each of these handles be dragged alone",
            condition=_grouped,
        ),
        "mirror": ActionSpec(
            "Mirror",
            do(mirror_handles),
            icon=icons.ICON_FA_LEFT_RIGHT,
            hint="Add partners on the other side, named by .L and .R or left and right",
            condition=_selected,
            has_separator=True,
        ),
        "mirrored": ActionSpec(
            "Select partners",
            do(handle_editing.select_mirrored),
            "Shift+M",
            icon=icons.ICON_FA_RIGHT_LEFT,
            hint="Select the handles on the other side that have the same names",
            condition=_selected,
        ),
    },
    "Motion": {
        "give motion": ActionSpec(
            "Apply motion preset…",
            do(preset_setup.begin_motion_setup),
            "A",
            icon=icons.ICON_FA_PERSON_WALKING,
            hint="Let it walk, wave or breathe: say where its joints are, and which motion it is",
            explain_disabled=preset_setup.motion_disabled_reason,
            active=lambda session: session.project is not None and session.project.motion_setup,
        ),
        "mirror joints": ActionSpec(
            "Mirror joints",
            do(joint_placement.mirror_joints),
            icon=icons.ICON_FA_LEFT_RIGHT,
            hint="Put the joints of one side where those of the other one are, seen in a mirror",
            condition=_has_sides,
            has_separator=True,
        ),
        "find joints": ActionSpec(
            "Detect joints",
            do(joint_placement.reset_joints),
            icon=icons.ICON_FA_WAND_MAGIC_SPARKLES,
            hint="Put all joints back where they were found",
            condition=lambda _, project: (
                project.motion_setup is not None and project.motion_setup.suggested
            ),
        ),
        "no motion": ActionSpec(
            "Cancel motion preset",
            do(apply_motion.cancel_motion_job),
            "Escape",
            condition=_gives,
            has_separator=True,
        ),
    },
    "View": {
        "fit": ActionSpec(
            "Fit pose",
            do(viewing.zoom_to_pose),
            "Home",
            icon=icons.ICON_FA_EXPAND,
            hint="Show all of the shape as it is in this frame",
        ),
        "fit motion": ActionSpec("Fit motion", do(viewing.zoom_to_motion), "Shift+Home"),
        "fit selection": ActionSpec("Fit selection", do(viewing.zoom_to_selection), "F"),
        "fit picture": ActionSpec("Fit picture", do(viewing.set_view, None)),
        "actual size": ActionSpec("Actual size", do(viewing.zoom_to_actual_size), "1"),
        "look through": ActionSpec(
            "Look through the camera",
            do(toggle_camera_view),
            hint="Show what the camera shows in each frame, until you look elsewhere",
            condition=lambda _, project: bool(project.document.camera),
            active=_looks_through,
        ),
        "handles": _overlay(
            "Handles",
            "handles",
            "H",
            icon=icons.ICON_FA_CIRCLE_DOT,
            hint="Show or hide the handles",
            has_separator=True,
        ),
        "wireframe": _overlay(
            "Wireframe",
            "wireframe",
            "W",
            icon=icons.ICON_FA_DRAW_POLYGON,
            hint="Show the triangles",
        ),
        "outline": _overlay(
            "Outline",
            "outline",
            "C",
            icon=icons.ICON_FA_VECTOR_SQUARE,
            hint="Show the edge of the shape",
        ),
        "heat map": ActionSpec(
            "Heat map",
            do(viewing.toggle_heat_map),
            "D",
            icon=icons.ICON_FA_TEMPERATURE_HALF,
            hint="Colour the shape by its distortion",
            active=lambda session: session.overlays.heat_map != "none",
        ),
        "split view": ActionSpec(
            "Split view",
            do(viewing.toggle_comparison),
            "U",
            icon=icons.ICON_FA_TABLE_COLUMNS,
            hint="Compare with another method, under a divider that can be dragged",
            active=lambda session: session.compare_view is not None,
        ),
        "onion skin": _overlay(
            "Onion skin",
            "onion",
            "O",
            icon=icons.ICON_FA_GHOST,
            hint="Show the poses before and after",
        ),
        "mirror axis": _overlay("Mirror axis", "mirror", "Ctrl+M", mac_keys="Ctrl+Shift+M"),
        "motion paths": _overlay(
            "Motion paths",
            "paths",
            "J",
            icon=icons.ICON_FA_ROUTE,
            hint="Show where the selected handles go, with a dot for each frame",
        ),
        "theme": ActionSpec(
            "Light or dark", do(viewing.toggle_theme), needs_project=False, has_separator=True
        ),
        "larger": ActionSpec(
            "Larger interface",
            do(viewing.enlarge_interface),
            "Ctrl+Equal, Ctrl+KeypadAdd",
            needs_project=False,
        ),
        "smaller": ActionSpec(
            "Smaller interface",
            do(viewing.shrink_interface),
            "Ctrl+Minus, Ctrl+KeypadSubtract",
            needs_project=False,
        ),
        "reset layout": ActionSpec(
            "Reset layout", do(_reset_layout), has_separator=True, needs_project=False
        ),
    },
    "Time": {
        "play": ActionSpec(
            "Play",
            do(playback.toggle_play),
            icon=icons.ICON_FA_PLAY,
            hint="Play or stop",
            active=_plays,
            key_text="Space",
        ),
        "start": ActionSpec(
            "First frame", do(playback.go_to_start), "Ctrl+PageUp", icon=icons.ICON_FA_BACKWARD_FAST
        ),
        "end": ActionSpec(
            "Last frame", do(playback.go_to_end), "Ctrl+PageDown", icon=icons.ICON_FA_FORWARD_FAST
        ),
        "back": ActionSpec(
            "Previous frame",
            do(playback.step_frames, -1),
            "PageUp",
            icon=icons.ICON_FA_BACKWARD_STEP,
            repeats_while_held=True,
        ),
        "on": ActionSpec(
            "Next frame",
            do(playback.step_frames, 1),
            "PageDown",
            icon=icons.ICON_FA_FORWARD_STEP,
            repeats_while_held=True,
        ),
        "previous key": ActionSpec(
            "Previous key",
            do(playback.go_to_key, -1),
            "DownArrow",
            condition=_frees_arrows,
            repeats_while_held=True,
        ),
        "next key": ActionSpec(
            "Next key",
            do(playback.go_to_key, 1),
            "UpArrow",
            condition=_frees_arrows,
            repeats_while_held=True,
        ),
        "insert key": ActionSpec(
            "Insert key",
            do(keys.insert_key_in_row),
            "I",
            icon=icons.ICON_FA_DIAMOND,
            hint="Keep this pose in a key",
            has_separator=True,
        ),
        "loop": ActionSpec(
            "Loop",
            do(keys.toggle_loop),
            "L",
            icon=icons.ICON_FA_REPEAT,
            hint="Loop: the end leads back to the start",
            active=_loops,
        ),
        "auto-key": ActionSpec(
            "Auto-key",
            do(viewing.toggle_auto_key),
            "K",
            icon=icons.ICON_FA_KEY,
            hint="Posing makes and changes keys",
            active=lambda session: session.preferences.auto_key,
        ),
        "record": ActionSpec(
            "Record a drag",
            do(toggle_recording_armed),
            "R",
            icon=icons.ICON_FA_CIRCLE,
            hint="Record how the next handle is dragged, while the timeline plays",
            condition=lambda session, _: session.cutting is None,
            active=lambda session: session.records,
        ),
        "record nothing": ActionSpec(
            "Discard recording", do(discard_recording), "Escape", condition=_records
        ),
        "preview start": ActionSpec(
            "Start preview range here", do(keys.start_preview_at_playhead), "B", has_separator=True
        ),
        "preview end": ActionSpec("End preview range here", do(keys.end_preview_at_playhead), "N"),
        "preview none": ActionSpec(
            "Play all frames",
            do(keys.clear_preview_range),
            "Alt+P",
            condition=lambda _, project: project.document.preview is not None,
        ),
        "marker": ActionSpec(
            "Add marker", do(keys.add_marker_at_playhead), "M", has_separator=True
        ),
        "key camera": ActionSpec(
            "Key the camera",
            do(key_camera),
            icon=icons.ICON_FA_VIDEO,
            hint="From here on frames show what the viewport shows now",
        ),
        "previous marker": ActionSpec(
            "Previous marker",
            do(playback.go_to_marker, -1),
            "Shift+PageUp",
            repeats_while_held=True,
        ),
        "next marker": ActionSpec(
            "Next marker", do(playback.go_to_marker, 1), "Shift+PageDown", repeats_while_held=True
        ),
        "fit time": ActionSpec(
            "Fit timeline",
            do(timeline_drag.fit_timeline),
            "Ctrl+Home",
            icon=icons.ICON_FA_ARROWS_LEFT_RIGHT_TO_LINE,
            hint="Show all frames",
        ),
    },
    "Keys": {
        "pass": ActionSpec("Next tangent mode", do(keys.use_next_tangent_mode), "T"),
        "ease": ActionSpec("Ease in and out", do(keys.ease_selected_keys, PRESETS["in-out"]), "F9"),
        "ease in": ActionSpec("Ease in", do(keys.ease_selected_keys, PRESETS["in"]), "Shift+F9"),
        "ease out": ActionSpec(
            "Ease out", do(keys.ease_selected_keys, PRESETS["out"]), "Ctrl+Shift+F9"
        ),
        "ease not": ActionSpec("Linear", do(keys.ease_selected_keys, LINEAR), "Alt+F9"),
        "repeat": ActionSpec(
            "Repeat",
            do(cycles.create_cycle),
            detail=_stretch,
            condition=lambda _, project: cycles.selected_range(project),
            has_separator=True,
        ),
        "repeats into keys": ActionSpec(
            "Bake repeats", do(cycles.bake_cycle), condition=cycles.cycle_at_playhead
        ),
        "repeat no more": ActionSpec(
            "Stop repeating", do(cycles.end_cycle), condition=cycles.cycle_at_playhead
        ),
    },
    "Help": {
        "manual": ActionSpec("Manual", do(open_manual_page), "F1", needs_project=False),
        "shortcuts": ActionSpec(
            "Keys and mouse", do(viewing.show_shortcuts), "Shift+F1", needs_project=False
        ),
        "first animation": ActionSpec(
            "Make a giraffe bow",
            do(tutorials.begin_tutorial),
            needs_project=False,
            has_separator=True,
        ),
        "leave guide": ActionSpec(
            "Leave the guide", do(tutorials.end_tutorial), "Escape", condition=_can_leave
        ),
        "report": ActionSpec(
            "Report a problem…", do(error_reports.show_kept_or_new_report), needs_project=False
        ),
        "import": ActionSpec("Import log", do(viewing.show_import_log), condition=_has_summary),
    },
}
BINDINGS = {name: binding for menu in MENUS.values() for name, binding in menu.items()}
