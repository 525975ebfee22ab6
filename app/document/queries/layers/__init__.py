"""States of layers at a frame: visibility, order, compositing, clipping, depth and camera.

In: documents.
Out: derived values; the document does not change.
Imports: the values of `app.document`.
"""

from app.document.queries.layers.clipping import without_foreign_clips as without_foreign_clips
from app.document.queries.layers.compositing import (
    CompositeGroup as CompositeGroup,
    composite_layers as composite_layers,
)
from app.document.queries.layers.depth import (
    DEFAULT_DEPTH_EXTENT as DEFAULT_DEPTH_EXTENT,
    DepthPoint as DepthPoint,
    depth_points_at as depth_points_at,
)
from app.document.queries.layers.layer_state import (
    DEFAULT_DRAW_ORDER as DEFAULT_DRAW_ORDER,
    CameraState as CameraState,
    camera_at as camera_at,
    draw_order_key_at as draw_order_key_at,
    keyed_frame as keyed_frame,
    layers_in_draw_order as layers_in_draw_order,
    opacity_at as opacity_at,
    repeating_cycle as repeating_cycle,
    transform_at as transform_at,
)
from app.document.queries.layers.layer_tree import (
    TreeRow as TreeRow,
    layer_tree as layer_tree,
    parent_label as parent_label,
)
from app.document.queries.layers.switch_suggestions import (
    subgroups_with_layers as subgroups_with_layers,
    suggest_switch_groups as suggest_switch_groups,
)
from app.document.queries.layers.visibility import (
    change_frame as change_frame,
    is_switch_in_cycle as is_switch_in_cycle,
    is_visible as is_visible,
    repeated as repeated,
    switch_cycle as switch_cycle,
    turn_frame as turn_frame,
    visibility_keys as visibility_keys,
    with_repeats as with_repeats,
)
