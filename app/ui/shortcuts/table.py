"""The menus: all named actions, in groups that separators part, and submenus."""

from app.editor.actions import dialog_actions, editing, playback, tutorials, viewing
from app.editor.actions.action_spec import ActionSpec
from app.editor.actions.layer_setup import cut_out_editing, handle_editing, stiffness_editing
from app.editor.actions.posing import handles, limb_editing, pose_drag
from app.editor.actions.posing.motion_presets import (
    apply_motion,
    joint_placement,
    preset_setup,
    rigging,
)
from app.editor.actions.project_files import export_settings, exporting, files, recovery, saving
from app.editor.actions.timing import (
    channel_keys,
    cycles,
    graph,
    keys,
    sounds,
    timeline_drag,
    tracks,
)
from app.editor.actions.tracking import recording
from app.editor.layering import footage, layer_list, layer_posing, reloading
from app.editor.poses import copying, library, pasting, pasting_targets
from app.editor.tools import move_tool
from app.texts import N_
from app.ui.shortcuts import window_actions

MENUS: dict[str, tuple[tuple[ActionSpec, ...], ...]] = {
    N_("File"): (
        (files.ask_file_to_open,),
        (saving.save, saving.save_as),
        (reloading.reload_drawing,),
        (window_actions.show_export, export_settings.repeat_export, exporting.copy_picture),
        (recovery.show_recovery,),
        (saving.close_project, saving.request_quit),
    ),
    N_("Edit"): (
        (editing.undo, editing.redo),
        (
            *(copying.copy_pose_or_keys, copying.copy_all_poses),
            *(pasting.PASTE, pasting.PASTE_FLIPPED, pasting.PASTE_SWAPPED),
            *(pasting_targets.paste_on_selected, pasting_targets.FLIP_ON_SELECTED),
            pasting_targets.PASTE_ON_LIMB,
            *(pasting_targets.FLIP_ON_LIMB, pasting_targets.SWAP_ON_LIMB),
            library.save_pose_to_library,
        ),
        (editing.select_all, editing.deselect_all),
        (
            *(move_tool.toggle_move_tool, cut_out_editing.toggle_cut_brush),
            *(cut_out_editing.shrink_brush, cut_out_editing.enlarge_brush),
            *(move_tool.return_to_posing, editing.delete_selection),
        ),
        (layer_list.rename_active_layer,),
    ),
    N_("View"): (
        (
            *(
                viewing.zoom_to_pose,
                viewing.zoom_to_motion,
                viewing.zoom_to_selection,
                viewing.FIT_PICTURE,
            ),
            *(viewing.zoom_to_actual_size, channel_keys.toggle_camera_view),
        ),
        (
            *(viewing.HANDLES, viewing.OUTLINE, viewing.ONION_SKIN),
            *(viewing.MIRROR_AXIS, viewing.MOTION_PATHS),
        ),
        (
            *(viewing.toggle_measuring, viewing.toggle_heat_map),
            *(viewing.toggle_comparison, viewing.WIREFRAME),
        ),
        (viewing.toggle_theme, viewing.enlarge_interface, viewing.shrink_interface),
        (viewing.toggle_panel, window_actions.reset_layout),
    ),
    N_("Handles"): (
        (handles.suggest_handles,),
        (pose_drag.pin_selected_handles, handle_editing.toggle_handles_locked),
        (tracks.key_selected_handles,),
        (
            stiffness_editing.MAKE_STIFF,
            stiffness_editing.DRAW_BONES,
            stiffness_editing.add_bone_between_selected,
            limb_editing.flip_selected_joints,
        ),
        (
            layer_posing.flip_layer_limb,
            layer_posing.plant_layer,
            layer_posing.release_layer,
        ),
        (handle_editing.group_handles, handle_editing.ungroup_handles),
        (handles.mirror_handles, handle_editing.select_mirrored),
    ),
    N_("Animate"): (
        (playback.toggle_play, keys.toggle_loop, viewing.toggle_auto_key, keys.insert_key_in_row),
        (recording.toggle_recording_armed, recording.discard_recording),
        (
            *(playback.go_to_start, playback.go_to_end),
            *(playback.PREVIOUS_FRAME, playback.NEXT_FRAME),
            *(playback.PREVIOUS_KEY, playback.NEXT_KEY),
            *(playback.PREVIOUS_MARKER, playback.NEXT_MARKER),
        ),
        (keys.start_preview_at_playhead, keys.end_preview_at_playhead, keys.clear_preview_range),
        (keys.use_next_tangent_mode, *keys.EASE_KEYS),
        (cycles.create_cycle, cycles.bake_cycle, cycles.end_cycle),
        (keys.add_marker_at_playhead, channel_keys.key_camera, timeline_drag.fit_timeline),
        (graph.toggle_graph, graph.toggle_speed),
        (preset_setup.begin_motion_setup, rigging.rig_layer),
        (sounds.ask_sound_to_add, footage.ask_footage_to_add, footage.ask_reference_to_add),
        (footage.collect_footage,),
        (joint_placement.mirror_joints, joint_placement.reset_joints),
        (apply_motion.cancel_motion_job, rigging.cancel_rigging),
    ),
    N_("Help"): (
        (window_actions.open_manual_page, dialog_actions.show_shortcuts),
        (
            *(tutorials.begin_tutorial, tutorials.end_tutorial),
            *(dialog_actions.REPORT, dialog_actions.show_import_log),
        ),
    ),
}
# Groups that are submenus, by their first entries.
SUBMENUS: dict[ActionSpec, str] = {
    viewing.toggle_measuring: N_("Measure"),
    playback.go_to_start: N_("Playhead"),
    keys.start_preview_at_playhead: N_("Preview range"),
    keys.use_next_tangent_mode: N_("Easing"),
    cycles.create_cycle: N_("Repeats"),
    joint_placement.mirror_joints: N_("Joints"),
}
ACTIONS = {spec.label: spec for groups in MENUS.values() for group in groups for spec in group}
# Esc ends the first of these that is active.
ENDED_BY_ESC = (
    editing.cancel_change,
    move_tool.return_to_posing,
    apply_motion.cancel_motion_job,
    rigging.cancel_rigging,
    exporting.cancel_preparing,
    recording.discard_recording,
    tutorials.end_tutorial,
    editing.deselect_all,
)
