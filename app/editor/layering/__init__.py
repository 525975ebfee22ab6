"""Editing layers: selecting, ordering, hiding, replacing and attaching them.

In: a session, and the ids of layers.
Out: changed or reordered layers; the active layer.
Imports: `app.editor`, `app.document`, `app.motion`, `app.solving`, `app.storage`.
"""

from app.editor.layering.layer_channels import (
    change_camera_key as change_camera_key,
    delete_camera_key as delete_camera_key,
    delete_draw_order_key as delete_draw_order_key,
    delete_opacity_key as delete_opacity_key,
    delete_transform_key as delete_transform_key,
    key_camera as key_camera,
    key_draw_order as key_draw_order,
    key_opacity as key_opacity,
    key_transform as key_transform,
    toggle_camera_view as toggle_camera_view,
)
from app.editor.layering.layer_list import (
    add_layers_to_group as add_layers_to_group,
    ask_layer_name as ask_layer_name,
    delete_visibility_key as delete_visibility_key,
    duplicate_layer as duplicate_layer,
    group_layers as group_layers,
    is_layer_at as is_layer_at,
    layer_at as layer_at,
    move_layer as move_layer,
    move_layers_beside as move_layers_beside,
    note_listed_layer as note_listed_layer,
    put_layers_in_group as put_layers_in_group,
    rename_group as rename_group,
    rename_layer as rename_layer,
    set_blend_mode as set_blend_mode,
    set_group_opacity as set_group_opacity,
    set_layer_opacity as set_layer_opacity,
    toggle_clipping as toggle_clipping,
    toggle_group_hidden as toggle_group_hidden,
    toggle_layers_hidden as toggle_layers_hidden,
    toggle_layers_locked as toggle_layers_locked,
    toggle_reference as toggle_reference,
    toggle_visibility_key as toggle_visibility_key,
    ungroup_layers as ungroup_layers,
)
from app.editor.layering.layer_selection import (
    reset_tree_rows as reset_tree_rows,
    select_layers as select_layers,
    select_layers_up_to as select_layers_up_to,
    set_active_layer as set_active_layer,
    solo_layers as solo_layers,
    toggle_layers_selected as toggle_layers_selected,
    toggle_tree_row as toggle_tree_row,
)
from app.editor.layering.parenting import (
    attach_layer as attach_layer,
    attach_layers as attach_layers,
    delete_layers as delete_layers,
    delete_parent_key as delete_parent_key,
    detach_layer as detach_layer,
    is_same_or_descendant as is_same_or_descendant,
    reparent_layer as reparent_layer,
    set_inherits_rotation as set_inherits_rotation,
)
from app.editor.layering.pictures import (
    add_layers as add_layers,
    ask_pictures_to_add as ask_pictures_to_add,
    ask_replacement_picture as ask_replacement_picture,
    drop_files as drop_files,
    make_posable as make_posable,
    make_still as make_still,
    replace_picture as replace_picture,
    set_drop_target as set_drop_target,
)
from app.editor.layering.switches import (
    add_to_switch as add_to_switch,
    create_switch as create_switch,
    delete_switch as delete_switch,
    dismiss_switch_suggestion as dismiss_switch_suggestion,
    key_switch as key_switch,
    remove_from_switch as remove_from_switch,
    rename_switch as rename_switch,
)
