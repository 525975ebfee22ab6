"""The document that is edited, saved and rendered: values, commands, history.

In: commands.
Out: frozen documents, each of them valid, and where time stands in them.
Imports: `engine`, `app.errors`, `app.export_formats`; no pictures, graphics, window or clock.
"""

from app.document.body import (
    PAIRS as PAIRS,
    Bone as Bone,
    SidePairs as SidePairs,
    carried_over as carried_over,
    mirrored_name as mirrored_name,
    pairs_by_name as pairs_by_name,
    partners_of as partners_of,
    read_pairs as read_pairs,
    written_pairs as written_pairs,
)
from app.document.commands import (
    Command as Command,
    Settled as Settled,
    choice_commands as choice_commands,
    exchanged as exchanged,
    figure_commands as figure_commands,
    group_commands as group_commands,
    handle_commands as handle_commands,
    key_commands as key_commands,
    layer_commands as layer_commands,
    material_commands as material_commands,
    pose_commands as pose_commands,
    scene_commands as scene_commands,
    track_commands as track_commands,
)
from app.document.figure import (
    Figure as Figure,
    PictureFile as PictureFile,
    new_figure as new_figure,
)
from app.document.history import History as History, UnkeyedPose as UnkeyedPose
from app.document.keyframe import (
    HOLDS as HOLDS,
    MOST_TURNS as MOST_TURNS,
    Handle as Handle,
    KeptPose as KeptPose,
    Keyframe as Keyframe,
    Pose as Pose,
    Target as Target,
)
from app.document.layering import (
    BLENDS as BLENDS,
    DEEPEST as DEEPEST,
    GROUP_BLENDS as GROUP_BLENDS,
    Attachment as Attachment,
    BlendMode as BlendMode,
    CameraKey as CameraKey,
    Choice as Choice,
    Group as Group,
    GroupBlend as GroupBlend,
    MoveKey as MoveKey,
    OpacityKey as OpacityKey,
    Placing as Placing,
    Switch as Switch,
    Turn as Turn,
    paths_to as paths_to,
)
from app.document.model import Document as Document
from app.document.playhead import Playhead as Playhead
from app.document.queries import (
    USUAL_EXTENT as USUAL_EXTENT,
    Clip as Clip,
    Composite as Composite,
    Extremes as Extremes,
    Front as Front,
    Moment as Moment,
    Shortfall as Shortfall,
    Shot as Shot,
    TrackPlace as TrackPlace,
    Transit as Transit,
    are_as_stiff as are_as_stiff,
    brushed_stiffness as brushed_stiffness,
    camera_at as camera_at,
    changed_stretches as changed_stretches,
    clip_of as clip_of,
    closes as closes,
    comes_round as comes_round,
    composed as composed,
    exported_frames as exported_frames,
    falls_short as falls_short,
    find_shortfall as find_shortfall,
    frame_times as frame_times,
    framed_frames as framed_frames,
    fronts_at as fronts_at,
    in_order as in_order,
    intervals as intervals,
    is_visible as is_visible,
    limb_of as limb_of,
    movement_at as movement_at,
    opacity_at as opacity_at,
    resting_pose as resting_pose,
    sights_of as sights_of,
    stiff_outline as stiff_outline,
    stiffened as stiffened,
    time_of as time_of,
    track_at as track_at,
    transits as transits,
    velocity_at as velocity_at,
)
from app.document.settings import (
    FRAME_NAMES as FRAME_NAMES,
    FRAMINGS as FRAMINGS,
    LAST_FRAME as LAST_FRAME,
    NATURAL as NATURAL,
    RUBBERY as RUBBERY,
    STIFF as STIFF,
    STRETCHES as STRETCHES,
    VARIANTS as VARIANTS,
    ExportSettings as ExportSettings,
    FormatPictures as FormatPictures,
    FrameRange as FrameRange,
    Framing as Framing,
    Marker as Marker,
    Meshing as Meshing,
    loosened as loosened,
    stretch_of as stretch_of,
)
from app.document.timing import (
    HOLD as HOLD,
    LINEAR as LINEAR,
    PRESETS as PRESETS,
    SPRINGS as SPRINGS,
    Easing as Easing,
    Passing as Passing,
    Spring as Spring,
    Track as Track,
    TrackKey as TrackKey,
)
from engine.variant import Baseline as Baseline, Variant as Variant
