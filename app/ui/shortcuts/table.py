"""All named actions, in menu order. A new action needs only an entry here."""

from functools import partial
from typing import Any

from imgui_bundle import hello_imgui, icons_fontawesome_6 as icons

from app.document import LINEAR, POSE, PRESETS
from app.editor import Project, Session, do, error_reports, with_project
from app.editor.actions import editing, playback, tutorials, viewing
from app.editor.actions.layer_setup import cut_out_editing, handle_editing, stiffness_editing
from app.editor.actions.posing.handles import mirror_handles, suggest_handles
from app.editor.actions.posing.motion_presets import apply_motion, joint_placement, preset_setup
from app.editor.actions.posing.pose_drag import pin_selected_handles
from app.editor.actions.project_files import export_settings, exporting, files, recovery, saving
from app.editor.actions.timing import cycles, keys, timeline_drag, tracks
from app.editor.actions.timing.channel_keys import key_camera, toggle_camera_view
from app.editor.actions.tracking.recording import discard_recording, toggle_recording_armed
from app.editor.actions.viewing import OverlayName
from app.editor.layering.layer_list import ask_layer_name
from app.editor.poses import copying, library, paste_destinations, pasting
from app.editor.tools import move_tool
from app.texts import N_, _, ngettext
from app.ui.panel import bring_to_front
from app.ui.shortcuts.action_spec import ActionSpec
from app.ui.shortcuts.manual import open_manual_page


def _undo_text(_session: Session, project: Project) -> str:
    step = project.history.undo_label
    if project.motion_setup is not None and project.motion_setup.past:
        step = _("Move a joint")
    elif project.motion_job is not None:
        step = _("Apply motion preset")
    return "" if step is None else _("Undo “{step}”").format(step=step)


def _redo_text(_session: Session, project: Project) -> str:
    step = project.history.redo_label
    return "" if step is None else _("Redo “{step}”").format(step=step)


def _looks_through(session: Session) -> bool:
    return session.project is not None and session.project.is_camera_view


def _copy_text(session: Session, project: Project) -> str:
    if copying.is_copying_keys(session, project):
        count = project.selected_key_count
        return ngettext("Copy {count} key", "Copy {count} keys", count).format(count=count)
    count = len(project.selected_layers)
    return ngettext("Copy pose", "Copy poses of {count} layers", count).format(count=count)


def _repeat_text(_session: Session, project: Project) -> str:
    frames = cycles.selected_range(project)
    if frames is None:
        return ""
    return _("Repeat frames {first} to {last}").format(first=frames[0], last=frames[1])


# By the way of pasting: onto another layer than the active one, and onto several layers.
PASTE_TEXTS: dict[paste_destinations.PasteMode, tuple[str, str]] = {
    "as it is": (_("Paste onto {layer}"), _("Paste onto {count} layers")),
    "flipped": (_("Paste flipped onto {layer}"), _("Paste flipped onto {count} layers")),
    "swapped": (_("Paste swapped onto {layer}"), _("Paste swapped onto {count} layers")),
}


def _paste_text(session: Session, project: Project, way: paste_destinations.PasteMode) -> str:
    """Name the layers that receive the paste, unless it is only the active layer."""
    onto = [
        each.layer for each in paste_destinations.find_paste_destinations(session, project, way)
    ]
    onto_layer, onto_layers = PASTE_TEXTS[way]
    if len(onto) > 1:
        return onto_layers.format(count=len(onto))
    return "".join(
        onto_layer.format(layer=layer.name) for layer in onto if layer.id != project.active
    )


def _select_text(session: Session, _project: Project) -> str:
    return _("Select all keys") if session.is_timeline_focused else _("Select all handles")


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


def _can_delete(session: Session, project: Project) -> bool:
    """Return whether keys, handles, a joint of a motion preset or a channel are selected."""
    joint = project.motion_setup is not None and project.motion_setup.selected_joint
    is_channel = session.is_timeline_focused and project.channel.kind is not POSE
    return bool(joint or project.selected_handles or project.selected_keys or is_channel)


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
    N_("File"): {
        "open": ActionSpec(_("Open…"), do(files.ask_file_to_open), "Ctrl+O", needs_project=False),
        "save": ActionSpec(_("Save"), do(saving.save), "Ctrl+S", has_separator=True),
        "save as": ActionSpec(_("Save as…"), do(saving.save_as), "Ctrl+Shift+S"),
        "export": ActionSpec(_("Export…"), do(_export), "Ctrl+E", has_separator=True),
        "export again": ActionSpec(
            _("Export again"), do(export_settings.repeat_export), "Ctrl+Shift+E"
        ),
        "copy picture": ActionSpec(_("Copy picture"), do(exporting.copy_picture), "Ctrl+Shift+C"),
        "unsaved work": ActionSpec(
            _("Unsaved work…"), do(recovery.show_recovery), has_separator=True, needs_project=False
        ),
        "close": ActionSpec(_("Close"), do(saving.close_project), "Ctrl+W", has_separator=True),
        "quit": ActionSpec(_("Quit"), do(saving.request_quit), "Ctrl+Q", needs_project=False),
    },
    N_("Edit"): {
        "undo": ActionSpec(
            _("Undo"),
            do(editing.undo),
            "Ctrl+Z",
            condition=_undo_text,
            repeats_while_held=True,
            detail=_undo_text,
        ),
        "redo": ActionSpec(
            _("Redo"),
            do(editing.redo),
            "Ctrl+Shift+Z, Ctrl+Y",
            condition=_redo_text,
            repeats_while_held=True,
            detail=_redo_text,
        ),
        "copy": ActionSpec(
            _("Copy"),
            do(copying.copy_pose_or_keys),
            "Ctrl+C",
            has_separator=True,
            detail=_copy_text,
        ),
        "copy all": ActionSpec(
            _("Copy poses of all layers"),
            do(copying.copy_all_poses),
            "Ctrl+Alt+C",
            condition=lambda _, project: len(project.document.layers) > 1,
        ),
        "paste": ActionSpec(
            _("Paste"),
            do(pasting.paste_copied),
            "Ctrl+V",
            detail=partial(_paste_text, way="as it is"),
            explain_disabled=partial(pasting.paste_disabled_reason, way="as it is"),
        ),
        "paste flipped": ActionSpec(
            _("Paste flipped"),
            do(pasting.paste_copied, "flipped"),
            "Ctrl+Shift+V",
            icon=icons.ICON_FA_PASTE,
            hint=_("Paste into a key at this frame, mirrored: left and right change places"),
            detail=partial(_paste_text, way="flipped"),
            explain_disabled=partial(pasting.paste_disabled_reason, way="flipped"),
        ),
        "paste swapped": ActionSpec(
            _("Paste swapped"),
            do(pasting.paste_copied, "swapped"),
            "Ctrl+Shift+X",
            icon=icons.ICON_FA_RIGHT_LEFT,
            hint=_(
                "Paste into a key at this frame: near and far, or left and right, change places. "
                "Nothing is mirrored."
            ),
            detail=partial(_paste_text, way="swapped"),
            explain_disabled=partial(pasting.paste_disabled_reason, way="swapped"),
        ),
        "paste on selected": ActionSpec(
            _("Paste on selected handles"),
            do(pasting.paste_on_selected),
            "Ctrl+Alt+V",
            explain_disabled=partial(pasting.paste_on_selected_disabled_reason, way="as it is"),
        ),
        "flip on selected": ActionSpec(
            _("Paste flipped on selected"),
            do(pasting.paste_on_selected, "flipped"),
            "Ctrl+Alt+Shift+V",
            explain_disabled=partial(pasting.paste_on_selected_disabled_reason, way="flipped"),
        ),
        "keep pose": ActionSpec(
            _("Save pose"),
            do(library.save_pose_to_library),
            "Shift+K",
            icon=icons.ICON_FA_PLUS,
            hint=_("Add this pose to the library"),
        ),
        "select all": ActionSpec(
            _("Select all"),
            do(editing.select_all),
            "Ctrl+A",
            has_separator=True,
            detail=_select_text,
        ),
        "deselect": ActionSpec(
            _("Deselect"), do(editing.deselect_all), "Escape", condition=_can_deselect
        ),
        "move": ActionSpec(
            _("Move whole drawing"),
            do(move_tool.toggle_move_tool),
            "V",
            icon=icons.ICON_FA_UP_DOWN_LEFT_RIGHT,
            hint=_("Move the whole layer in this frame, by drag or arrow keys"),
            active=lambda session: session.moves,
            has_separator=True,
        ),
        "cut out": ActionSpec(
            _("Cut-out brush"),
            do(cut_out_editing.toggle_cut_brush),
            "X",
            active=lambda session: session.cutting is not None,
        ),
        "smaller brush": ActionSpec(
            _("Smaller brush"),
            do(cut_out_editing.shrink_brush),
            "LeftBracket",
            condition=_brushes,
            repeats_while_held=True,
        ),
        "larger brush": ActionSpec(
            _("Larger brush"),
            do(cut_out_editing.enlarge_brush),
            "RightBracket",
            condition=_brushes,
            repeats_while_held=True,
        ),
        "pose": ActionSpec(
            _("Back to posing"), do(move_tool.return_to_posing), "Escape", condition=_can_pose
        ),
        "delete": ActionSpec(
            _("Delete"),
            do(editing.delete_selection),
            "Delete, Backspace",
            condition=_can_delete,
        ),
        "rename layer": ActionSpec(_("Rename layer"), do(_rename_layer), "F2", has_separator=True),
    },
    N_("Handles"): {
        "suggest handles": ActionSpec(
            _("Suggest handles"),
            do(suggest_handles),
            icon=icons.ICON_FA_WAND_MAGIC_SPARKLES,
            hint=_("Add named handles on body and head, and at tips and joints of limbs"),
        ),
        "pin here": ActionSpec(
            _("Pin here"),
            do(pin_selected_handles),
            "P",
            icon=icons.ICON_FA_THUMBTACK,
            hint=_("Keep the selected handles where they are in this frame"),
            condition=_selected,
            has_separator=True,
        ),
        "lock": ActionSpec(
            _("Lock"),
            do(handle_editing.toggle_handles_locked),
            "Shift+L",
            icon=icons.ICON_FA_LOCK,
            hint=_("Locked handles keep their places and cannot be dragged"),
            condition=_selected,
            active=_all_locked,
        ),
        "key handle": ActionSpec(
            _("Key this handle only"),
            do(tracks.key_selected_handles),
            "Shift+I",
            icon=icons.ICON_FA_KEY,
            hint=_("Key only this handle at this frame, on a track of its own"),
            condition=_selected,
            has_separator=True,
        ),
        "stiffen": ActionSpec(
            _("Make parts stiff"),
            do(stiffness_editing.toggle_stiffness_tool, "stiff"),
            "G",
            icon=icons.ICON_FA_CUBE,
            hint=_("Brush over parts that bend and stretch less"),
            active=lambda session: session.material in stiffness_editing.BRUSHES,
            has_separator=True,
        ),
        "bone": ActionSpec(
            _("Draw bones"),
            do(stiffness_editing.toggle_stiffness_tool, "bone"),
            "Shift+B",
            icon=icons.ICON_FA_BONE,
            hint=_("Drag from one handle to another: the limb between them is stiff"),
            active=lambda session: session.material == "bone",
        ),
        "bone between": ActionSpec(
            _("Add bone"),
            do(stiffness_editing.add_bone_between_selected),
            condition=lambda _, project: len(project.selected_handles) == 2,
        ),
        "group": ActionSpec(
            _("Group"),
            do(handle_editing.group_handles),
            "Ctrl+G",
            icon=icons.ICON_FA_OBJECT_GROUP,
            hint=_("Select and drag these handles together"),
            condition=lambda _, project: len(project.selected_handles) > 1,
            has_separator=True,
        ),
        "ungroup": ActionSpec(
            _("Ungroup"),
            do(handle_editing.ungroup_handles),
            "Ctrl+Shift+G",
            icon=icons.ICON_FA_OBJECT_UNGROUP,
            hint=_("Stop selecting and dragging these handles together"),
            condition=_grouped,
        ),
        "mirror": ActionSpec(
            _("Mirror"),
            do(mirror_handles),
            icon=icons.ICON_FA_LEFT_RIGHT,
            hint=_("Add partners on the other side, named .L and .R or left and right"),
            condition=_selected,
            has_separator=True,
        ),
        "mirrored": ActionSpec(
            _("Select partners"),
            do(handle_editing.select_mirrored),
            "Shift+M",
            icon=icons.ICON_FA_RIGHT_LEFT,
            hint=_("Select the handles with the same names on the other side"),
            condition=_selected,
        ),
    },
    N_("Motion"): {
        "give motion": ActionSpec(
            _("Apply motion preset…"),
            do(preset_setup.begin_motion_setup),
            "A",
            icon=icons.ICON_FA_PERSON_WALKING,
            hint=_("Make the layer walk, wave or breathe: place its joints and choose a motion"),
            explain_disabled=preset_setup.motion_disabled_reason,
            active=lambda session: session.project is not None and session.project.motion_setup,
        ),
        "mirror joints": ActionSpec(
            _("Mirror joints"),
            do(joint_placement.mirror_joints),
            icon=icons.ICON_FA_LEFT_RIGHT,
            hint=_("Mirror the joints of one side to the other side"),
            condition=_has_sides,
            has_separator=True,
        ),
        "find joints": ActionSpec(
            _("Detect joints"),
            do(joint_placement.reset_joints),
            icon=icons.ICON_FA_WAND_MAGIC_SPARKLES,
            hint=_("Move all joints back to where they were detected"),
            condition=lambda _, project: (
                project.motion_setup is not None and project.motion_setup.suggested
            ),
        ),
        "no motion": ActionSpec(
            _("Cancel motion preset"),
            do(apply_motion.cancel_motion_job),
            "Escape",
            condition=_gives,
            has_separator=True,
        ),
    },
    N_("View"): {
        "fit": ActionSpec(
            _("Fit pose"),
            do(viewing.zoom_to_pose),
            "Home",
            icon=icons.ICON_FA_EXPAND,
            hint=_("Show the whole shape in this frame"),
        ),
        "fit motion": ActionSpec(_("Fit motion"), do(viewing.zoom_to_motion), "Shift+Home"),
        "fit selection": ActionSpec(_("Fit selection"), do(viewing.zoom_to_selection), "F"),
        "fit picture": ActionSpec(_("Fit picture"), do(viewing.set_view, None)),
        "actual size": ActionSpec(_("Actual size"), do(viewing.zoom_to_actual_size), "1"),
        "look through": ActionSpec(
            _("Look through the camera"),
            do(toggle_camera_view),
            hint=_("Show the camera's picture in each frame, until you move the view"),
            condition=lambda _, project: bool(project.document.camera),
            active=_looks_through,
        ),
        "handles": _overlay(
            _("Handles"),
            "handles",
            "H",
            icon=icons.ICON_FA_CIRCLE_DOT,
            hint=_("Show or hide the handles"),
            has_separator=True,
        ),
        "wireframe": _overlay(
            _("Wireframe"),
            "wireframe",
            "W",
            icon=icons.ICON_FA_DRAW_POLYGON,
            hint=_("Show the triangles"),
        ),
        "outline": _overlay(
            _("Outline"),
            "outline",
            "C",
            icon=icons.ICON_FA_VECTOR_SQUARE,
            hint=_("Show the edge of the shape"),
        ),
        "heat map": ActionSpec(
            _("Heat map"),
            do(viewing.toggle_heat_map),
            "D",
            icon=icons.ICON_FA_TEMPERATURE_HALF,
            hint=_("Colour the shape by its distortion"),
            active=lambda session: session.overlays.heat_map != "none",
        ),
        "split view": ActionSpec(
            _("Split view"),
            do(viewing.toggle_comparison),
            "U",
            icon=icons.ICON_FA_TABLE_COLUMNS,
            hint=_("Compare with another method, beside a divider that can be dragged"),
            active=lambda session: session.compare_view is not None,
        ),
        "onion skin": _overlay(
            _("Onion skin"),
            "onion",
            "O",
            icon=icons.ICON_FA_GHOST,
            hint=_("Show the poses before and after"),
        ),
        "mirror axis": _overlay(_("Mirror axis"), "mirror", "Ctrl+M", mac_keys="Ctrl+Shift+M"),
        "motion paths": _overlay(
            _("Motion paths"),
            "paths",
            "J",
            icon=icons.ICON_FA_ROUTE,
            hint=_("Show the paths of the selected handles, with a dot for each frame"),
        ),
        "theme": ActionSpec(
            _("Light or dark"), do(viewing.toggle_theme), needs_project=False, has_separator=True
        ),
        "larger": ActionSpec(
            _("Larger interface"),
            do(viewing.enlarge_interface),
            "Ctrl+Equal, Ctrl+KeypadAdd",
            needs_project=False,
        ),
        "smaller": ActionSpec(
            _("Smaller interface"),
            do(viewing.shrink_interface),
            "Ctrl+Minus, Ctrl+KeypadSubtract",
            needs_project=False,
        ),
        "reset layout": ActionSpec(
            _("Reset layout"), do(_reset_layout), has_separator=True, needs_project=False
        ),
    },
    N_("Time"): {
        "play": ActionSpec(
            _("Play"),
            do(playback.toggle_play),
            icon=icons.ICON_FA_PLAY,
            hint=_("Play or stop"),
            active=_plays,
            key_text=_("Space"),
        ),
        "start": ActionSpec(
            _("First frame"),
            do(playback.go_to_start),
            "Ctrl+PageUp",
            icon=icons.ICON_FA_BACKWARD_FAST,
        ),
        "end": ActionSpec(
            _("Last frame"),
            do(playback.go_to_end),
            "Ctrl+PageDown",
            icon=icons.ICON_FA_FORWARD_FAST,
        ),
        "back": ActionSpec(
            _("Previous frame"),
            do(playback.step_frames, -1),
            "PageUp",
            icon=icons.ICON_FA_BACKWARD_STEP,
            repeats_while_held=True,
        ),
        "on": ActionSpec(
            _("Next frame"),
            do(playback.step_frames, 1),
            "PageDown",
            icon=icons.ICON_FA_FORWARD_STEP,
            repeats_while_held=True,
        ),
        "previous key": ActionSpec(
            _("Previous key"),
            do(playback.go_to_key, -1),
            "DownArrow",
            condition=_frees_arrows,
            repeats_while_held=True,
        ),
        "next key": ActionSpec(
            _("Next key"),
            do(playback.go_to_key, 1),
            "UpArrow",
            condition=_frees_arrows,
            repeats_while_held=True,
        ),
        "insert key": ActionSpec(
            _("Insert key"),
            do(keys.insert_key_in_row),
            "I",
            icon=icons.ICON_FA_DIAMOND,
            hint=_("Set a key with the current pose"),
            has_separator=True,
        ),
        "loop": ActionSpec(
            _("Loop"),
            do(keys.toggle_loop),
            "L",
            icon=icons.ICON_FA_REPEAT,
            hint=_("Loop the animation: its end continues at its start"),
            active=_loops,
        ),
        "auto-key": ActionSpec(
            _("Auto-key"),
            do(viewing.toggle_auto_key),
            "K",
            icon=icons.ICON_FA_KEY,
            hint=_("Set keys by posing"),
            active=lambda session: session.settings.preferences.auto_key,
        ),
        "record": ActionSpec(
            _("Record drag"),
            do(toggle_recording_armed),
            "R",
            icon=icons.ICON_FA_CIRCLE,
            hint=_("Record the next drag of a handle, while the timeline plays"),
            condition=lambda session, _: session.cutting is None,
            active=lambda session: session.records,
        ),
        "record nothing": ActionSpec(
            _("Discard recording"), do(discard_recording), "Escape", condition=_records
        ),
        "preview start": ActionSpec(
            _("Set preview start"),
            do(keys.start_preview_at_playhead),
            "B",
            has_separator=True,
        ),
        "preview end": ActionSpec(_("Set preview end"), do(keys.end_preview_at_playhead), "N"),
        "preview none": ActionSpec(
            _("Play all frames"),
            do(keys.clear_preview_range),
            "Alt+P",
            condition=lambda _, project: project.document.preview is not None,
        ),
        "marker": ActionSpec(
            _("Add marker"), do(keys.add_marker_at_playhead), "M", has_separator=True
        ),
        "key camera": ActionSpec(
            _("Key the camera"),
            do(key_camera),
            icon=icons.ICON_FA_VIDEO,
            hint=_("Key the camera at this frame: it shows what the viewport shows now"),
        ),
        "previous marker": ActionSpec(
            _("Previous marker"),
            do(playback.go_to_marker, -1),
            "Shift+PageUp",
            repeats_while_held=True,
        ),
        "next marker": ActionSpec(
            _("Next marker"),
            do(playback.go_to_marker, 1),
            "Shift+PageDown",
            repeats_while_held=True,
        ),
        "fit time": ActionSpec(
            _("Fit timeline"),
            do(timeline_drag.fit_timeline),
            "Ctrl+Home",
            icon=icons.ICON_FA_ARROWS_LEFT_RIGHT_TO_LINE,
            hint=_("Show all frames"),
        ),
    },
    N_("Keys"): {
        "pass": ActionSpec(_("Next tangent mode"), do(keys.use_next_tangent_mode), "T"),
        "ease": ActionSpec(
            _("Ease in and out"), do(keys.ease_selected_keys, PRESETS["in-out"]), "F9"
        ),
        "ease in": ActionSpec(_("Ease in"), do(keys.ease_selected_keys, PRESETS["in"]), "Shift+F9"),
        "ease out": ActionSpec(
            _("Ease out"), do(keys.ease_selected_keys, PRESETS["out"]), "Ctrl+Shift+F9"
        ),
        "ease not": ActionSpec(_("Linear"), do(keys.ease_selected_keys, LINEAR), "Alt+F9"),
        "repeat": ActionSpec(
            _("Repeat"),
            do(cycles.create_cycle),
            detail=_repeat_text,
            condition=lambda _, project: cycles.selected_range(project),
            has_separator=True,
        ),
        "repeats into keys": ActionSpec(
            _("Bake repeats"), do(cycles.bake_cycle), condition=cycles.cycle_at_playhead
        ),
        "repeat no more": ActionSpec(
            _("Stop repeating"), do(cycles.end_cycle), condition=cycles.cycle_at_playhead
        ),
    },
    N_("Help"): {
        "manual": ActionSpec(_("Manual"), do(open_manual_page), "F1", needs_project=False),
        "shortcuts": ActionSpec(
            _("Keys and mouse"), do(viewing.show_shortcuts), "Shift+F1", needs_project=False
        ),
        "first animation": ActionSpec(
            _("Your first animation"),
            do(tutorials.begin_tutorial),
            needs_project=False,
            has_separator=True,
        ),
        "leave guide": ActionSpec(
            _("End guide"), do(tutorials.end_tutorial), "Escape", condition=_can_leave
        ),
        "report": ActionSpec(
            _("Report a problem…"), do(error_reports.show_kept_or_new_report), needs_project=False
        ),
        "import": ActionSpec(_("Import log"), do(viewing.show_import_log), condition=_has_summary),
    },
}
BINDINGS = {name: binding for menu in MENUS.values() for name, binding in menu.items()}
