"""Values derived from a document: segments, tangents, tracks, target errors, layer states.

In: layers, poses and handles.
Out: derived values; the document does not change.
Imports: the values of `app.document`.
"""

from app.document.queries.applied_motion import (
    digest_keys as digest_keys,
    is_motion_unedited as is_motion_unedited,
    motion_notices as motion_notices,
)
from app.document.queries.auto_pins import (
    PinnedSegment as PinnedSegment,
    pinned_handles as pinned_handles,
    pinned_segments as pinned_segments,
)
from app.document.queries.boundary_stiffness import (
    bone_region as bone_region,
    brushed_stiffness as brushed_stiffness,
    have_same_stiffness as have_same_stiffness,
    stiff_outline as stiff_outline,
    with_stiffness as with_stiffness,
)
from app.document.queries.clips import (
    Clip as Clip,
    clip_of as clip_of,
    motion_source as motion_source,
)
from app.document.queries.key_segments import (
    Segment as Segment,
    clip_segments as clip_segments,
    loop_segment as loop_segment,
    segment_at_frame as segment_at_frame,
    segment_keys as segment_keys,
    segment_layout as segment_layout,
)
from app.document.queries.layers import (
    DEFAULT_DEPTH_EXTENT as DEFAULT_DEPTH_EXTENT,
    DEFAULT_DRAW_ORDER as DEFAULT_DRAW_ORDER,
    CameraState as CameraState,
    CompositeGroup as CompositeGroup,
    DepthPoint as DepthPoint,
    TreeRow as TreeRow,
    camera_at as camera_at,
    change_frame as change_frame,
    composite_layers as composite_layers,
    depth_points_at as depth_points_at,
    draw_order_key_at as draw_order_key_at,
    is_switch_in_cycle as is_switch_in_cycle,
    is_visible as is_visible,
    keyed_frame as keyed_frame,
    layer_tree as layer_tree,
    layers_in_draw_order as layers_in_draw_order,
    opacity_at as opacity_at,
    parent_label as parent_label,
    repeated as repeated,
    repeating_cycle as repeating_cycle,
    subgroups_with_layers as subgroups_with_layers,
    suggest_switch_groups as suggest_switch_groups,
    switch_cycle as switch_cycle,
    transform_at as transform_at,
    turn_frame as turn_frame,
    visibility_keys as visibility_keys,
    with_repeats as with_repeats,
    without_foreign_clips as without_foreign_clips,
)
from app.document.queries.memo import memoized_on as memoized_on
from app.document.queries.pose_tangents import (
    PoseSegment as PoseSegment,
    adjacent_segments as adjacent_segments,
    have_same_map as have_same_map,
    pose_segments as pose_segments,
)
from app.document.queries.target_error import (
    DistortionRange as DistortionRange,
    TargetErrors as TargetErrors,
    measure_target_errors as measure_target_errors,
    misses_target as misses_target,
)
from app.document.queries.timeline import (
    SegmentTime as SegmentTime,
    changed_ranges as changed_ranges,
    export_frame_range as export_frame_range,
    frame_times as frame_times,
    frames_for_fit as frames_for_fit,
    keyed_pose_at as keyed_pose_at,
    segment_time_at as segment_time_at,
)
from app.document.queries.tracks import (
    TrackSample as TrackSample,
    spring_root as spring_root,
    track_at as track_at,
    track_cycle as track_cycle,
    velocity_at as velocity_at,
)
