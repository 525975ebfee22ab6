"""The document that is edited, saved and rendered: values, commands, history.

In: commands.
Out: frozen, valid documents, and the playhead.
Imports: `engine`, `app.rigging`, `app.cut_out`, `app.errors`, `app.export_formats`; no pictures,
graphics, window or clock.
"""

from app.baseline import Baseline as Baseline
from app.document.channels.cycles import (
    Cycle as Cycle,
    require_no_overlap as require_no_overlap,
    require_repeatable_cycle as require_repeatable_cycle,
)
from app.document.channels.easing import (
    HOLD as HOLD,
    LINEAR as LINEAR,
    PRESETS as PRESETS,
    Easing as Easing,
)
from app.document.channels.key import BaseKey as BaseKey, Key as Key
from app.document.channels.kind import (
    Channel as Channel,
    ChannelKeys as ChannelKeys,
    ChannelKind as ChannelKind,
    KeysByChannel as KeysByChannel,
    Quantity as Quantity,
    ValueField as ValueField,
)
from app.document.channels.kinds import (
    CAMERA as CAMERA,
    DEPTH as DEPTH,
    DRAW_ORDER as DRAW_ORDER,
    FOOTAGE_TIME as FOOTAGE_TIME,
    IK_TARGET as IK_TARGET,
    LAYER_KINDS as LAYER_KINDS,
    MARKER as MARKER,
    OPACITY as OPACITY,
    PARENT as PARENT,
    POSE as POSE,
    SLIDER as SLIDER,
    SWITCH as SWITCH,
    TINT as TINT,
    TRACK as TRACK,
    TRANSFORM as TRANSFORM,
    VISIBILITY as VISIBILITY,
    VOLUME as VOLUME,
    SwitchMember as SwitchMember,
)
from app.document.channels.sliders import (
    BEYOND as BEYOND,
    Slider as Slider,
    SliderPose as SliderPose,
    format_slider_value as format_slider_value,
)
from app.document.channels.sounds import (
    Cue as Cue,
    Mouths as Mouths,
    Sound as Sound,
    SoundFile as SoundFile,
    VolumeKeys as VolumeKeys,
)
from app.document.channels.springs import SPRING_PRESETS as SPRING_PRESETS, Spring as Spring
from app.document.channels.tangent_mode import TangentMode as TangentMode
from app.document.channels.tracks import Track as Track, TrackKey as TrackKey
from app.document.channels.values import (
    MAX_FOOTAGE_SPEED as MAX_FOOTAGE_SPEED,
    MAX_SCALE as MAX_SCALE,
    Camera as Camera,
    DrawOrder as DrawOrder,
    FootageTime as FootageTime,
    IkTarget as IkTarget,
    Transform as Transform,
)
from app.document.checks import LAST_FRAME as LAST_FRAME
from app.document.commands import (
    handle_commands as handle_commands,
    pose_commands as pose_commands,
    scene_commands as scene_commands,
    shape_commands as shape_commands,
    slider_commands as slider_commands,
    sound_commands as sound_commands,
    stiffness_commands as stiffness_commands,
)
from app.document.commands.command import (
    Command as Command,
    combine_commands as combine_commands,
    with_number as with_number,
)
from app.document.commands.keys import (
    channel_commands as channel_commands,
    curve_commands as curve_commands,
    cycle_commands as cycle_commands,
    key_commands as key_commands,
    track_commands as track_commands,
)
from app.document.commands.keys.retime import TimeScale as TimeScale
from app.document.commands.layers import (
    deform_group_commands as deform_group_commands,
    footage_commands as footage_commands,
    group_commands as group_commands,
    joint_commands as joint_commands,
    layer_commands as layer_commands,
    switch_group_commands as switch_group_commands,
)
from app.document.commands.pose_commands import with_all_targets as with_all_targets
from app.document.history.undo_history import History as History
from app.document.history.undo_step import (
    PreviewPose as PreviewPose,
    UnfinishedStepError as UnfinishedStepError,
)
from app.document.keyframe import (
    MAX_REVOLUTIONS as MAX_REVOLUTIONS,
    WEIGHT_PRESETS as WEIGHT_PRESETS,
    Handle as Handle,
    Keyframe as Keyframe,
    LibraryPose as LibraryPose,
    Pose as Pose,
    Target as Target,
)
from app.document.layer import (
    FOLDING_ANGLE as FOLDING_ANGLE,
    FOLDING_JOINTS as FOLDING_JOINTS,
    Layer as Layer,
    PictureFile as PictureFile,
    new_layer as new_layer,
    rest_pose as rest_pose,
)
from app.document.layers.attachments import (
    Attachment as Attachment,
    attachments_repeat as attachments_repeat,
)
from app.document.layers.drawing_files import (
    DrawingFile as DrawingFile,
    FileLayer as FileLayer,
    LayerOrigin as LayerOrigin,
)
from app.document.layers.footage import MOST_PICTURES as MOST_PICTURES, Footage as Footage
from app.document.layers.groups import (
    BLEND_SECTIONS as BLEND_SECTIONS,
    BLENDS as BLENDS,
    GROUP_BLEND_SECTIONS as GROUP_BLEND_SECTIONS,
    MAX_GROUP_DEPTH as MAX_GROUP_DEPTH,
    BlendMode as BlendMode,
    Group as Group,
    ancestor_paths as ancestor_paths,
    common_path as common_path,
)
from app.document.layers.switch_group import SwitchGroup as SwitchGroup
from app.document.model import Document as Document
from app.document.playhead import Playhead as Playhead, loop_length as loop_length
from app.document.queries.applied_motion import (
    MotionEdits as MotionEdits,
    digest_motion as digest_motion,
    find_motion_edits as find_motion_edits,
    is_motion_unedited as is_motion_unedited,
    keys_of_motion as keys_of_motion,
    motion_notices as motion_notices,
    without_motion_springs as without_motion_springs,
)
from app.document.queries.auto_pins import (
    PinnedSegment as PinnedSegment,
    ground_velocity_at as ground_velocity_at,
    pinned_handles as pinned_handles,
    pinned_segments as pinned_segments,
)
from app.document.queries.channel_values.channel_keys import (
    all_keys as all_keys,
    channels_in as channels_in,
    channels_of as channels_of,
    describe_channel as describe_channel,
    display_frame as display_frame,
    frames_in as frames_in,
    keys_in as keys_in,
    layer_keys as layer_keys,
    pose_channel as pose_channel,
    source_frame as source_frame,
    track_channel as track_channel,
    track_display_frame as track_display_frame,
    track_in as track_in,
    track_source_frame as track_source_frame,
)
from app.document.queries.channel_values.curve_tangents import (
    Side as Side,
    TangentHandle as TangentHandle,
    find_tangent_handle as find_tangent_handle,
    find_velocity as find_velocity,
    with_tangent_handle as with_tangent_handle,
    with_velocity as with_velocity,
)
from app.document.queries.channel_values.curves import (
    ChannelCurve as ChannelCurve,
    curves_of as curves_of,
    numbers_at as numbers_at,
    sample_curves as sample_curves,
)
from app.document.queries.channel_values.footage_at import (
    footage_picture_at as footage_picture_at,
    footage_time_at as footage_time_at,
)
from app.document.queries.channel_values.repeats import (
    held_key_at as held_key_at,
    is_switch_in_cycle as is_switch_in_cycle,
    repeating_cycle as repeating_cycle,
    with_repeats as with_repeats,
)
from app.document.queries.channel_values.sliders_at import (
    slider_poses as slider_poses,
    slider_value_at as slider_value_at,
    slider_weights_at as slider_weights_at,
)
from app.document.queries.channel_values.tracks_at import (
    TrackSample as TrackSample,
    spring_root as spring_root,
    track_at as track_at,
    track_cycle as track_cycle,
    velocity_at as velocity_at,
)
from app.document.queries.channel_values.values_at import (
    camera_at as camera_at,
    draw_order_key_at as draw_order_key_at,
    layer_value_at as layer_value_at,
    layers_in_draw_order as layers_in_draw_order,
    opacity_at as opacity_at,
    transform_at as transform_at,
    value_at as value_at,
    volume_at as volume_at,
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
    segment_keys as segment_keys,
    segment_layout as segment_layout,
)
from app.document.queries.layers.clipping import without_foreign_clips as without_foreign_clips
from app.document.queries.layers.compositing import (
    DEFAULT_EFFECTS as DEFAULT_EFFECTS,
    CompositeGroup as CompositeGroup,
    composite_layers as composite_layers,
)
from app.document.queries.layers.depth import (
    DEFAULT_DEPTH_EXTENT as DEFAULT_DEPTH_EXTENT,
    DepthPoint as DepthPoint,
    depth_points_at as depth_points_at,
)
from app.document.queries.layers.layer_bones import (
    bones_above as bones_above,
    layers_with_targets as layers_with_targets,
    limb_ends as limb_ends,
    shared_bone as shared_bone,
)
from app.document.queries.layers.layer_tree import (
    TreeRow as TreeRow,
    layer_tree as layer_tree,
    parent_label as parent_label,
)
from app.document.queries.layers.switch_suggestions import (
    find_switch_members as find_switch_members,
    suggest_switch_groups as suggest_switch_groups,
)
from app.document.queries.layers.visibility import (
    is_visible as is_visible,
    visibility_keys as visibility_keys,
)
from app.document.queries.material.bone_directions import (
    direct_bone as direct_bone,
    with_directed_bones as with_directed_bones,
)
from app.document.queries.material.boundary_stiffness import (
    brushed_stiffness as brushed_stiffness,
    stiff_outline as stiff_outline,
    stiffness_source as stiffness_source,
    with_stiffness as with_stiffness,
)
from app.document.queries.material.limbs import (
    LimbChain as LimbChain,
    Limbs as Limbs,
    PlacedLimbs as PlacedLimbs,
    find_limbs as find_limbs,
    motion_anchor as motion_anchor,
)
from app.document.queries.material.local_limits import limits_along as limits_along
from app.document.queries.memo import memoized_on as memoized_on
from app.document.queries.pose_tangents import (
    PoseSegment as PoseSegment,
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
from app.document.rig.applied_motion import (
    AppliedMotion as AppliedMotion,
    MadeKey as MadeKey,
    UnreadMotion as UnreadMotion,
    require_motions as require_motions,
)
from app.document.rig.chains import Bone as Bone, Chain as Chain, find_chains as find_chains
from app.document.rig.mirror_names import (
    PAIRS as PAIRS,
    SidePairs as SidePairs,
    format_pairs as format_pairs,
    mirrored_handles as mirrored_handles,
    mirrored_handles_by_name as mirrored_handles_by_name,
    mirrored_name as mirrored_name,
    parse_pairs as parse_pairs,
)
from app.document.rig.stiffness import transfer_painted_stiffness as transfer_painted_stiffness
from app.document.settings import (
    FASTEST as FASTEST,
    FRAME_NAMES as FRAME_NAMES,
    FRAMINGS as FRAMINGS,
    LARGEST_EXPORT_SPEED as LARGEST_EXPORT_SPEED,
    LIMIT_PRESETS as LIMIT_PRESETS,
    MOST_EXPORT_REPEATS as MOST_EXPORT_REPEATS,
    NATURAL as NATURAL,
    RUBBERY as RUBBERY,
    SLOWEST as SLOWEST,
    STIFF as STIFF,
    VARIANTS as VARIANTS,
    ExportSettings as ExportSettings,
    FrameRange as FrameRange,
    Framing as Framing,
    Marker as Marker,
    Meshing as Meshing,
    PictureSettings as PictureSettings,
    find_limit_preset as find_limit_preset,
    relax_limits as relax_limits,
)
from engine.variant import Variant as Variant
