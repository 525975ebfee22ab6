"""The document that is edited, saved and rendered: values, commands, history.

In: commands.
Out: frozen documents, each of them valid, and where time stands in them.
Imports: `engine`, `app.errors`, `app.export_formats`; no pictures, graphics, window or clock.
"""

from app.document.checks import Unknown
from app.document.commands import (
    Command,
    figure_commands,
    handle_commands,
    key_commands,
    layer_commands,
    pose_commands,
    scene_commands,
)
from app.document.easing import HOLD, LINEAR, PRESETS, Easing
from app.document.figure import Figure, PictureFile, new_figure
from app.document.handle_pairs import mirrored_name, pairs_by_name
from app.document.history import History, UnkeyedPose
from app.document.keyframe import MOST_TURNS, Handle, KeptPose, Keyframe, Pose, Target
from app.document.layering import Attachment, Switch
from app.document.model import Document
from app.document.playhead import Playhead
from app.document.queries import (
    Clip,
    Extremes,
    Front,
    Moment,
    Shortfall,
    changed_stretches,
    clip_of,
    closes,
    exported_frames,
    falls_short,
    find_shortfall,
    frame_times,
    framed_frames,
    fronts_at,
    intervals,
    is_visible,
    resting_pose,
    time_of,
)
from app.document.settings import (
    FRAME_NAMES,
    FRAMINGS,
    LAST_FRAME,
    NATURAL,
    RUBBERY,
    STIFF,
    STRETCHES,
    VARIANTS,
    ExportSettings,
    FrameRange,
    Framing,
    Marker,
    Meshing,
    ShapeDetail,
    SheetLayout,
    loosened,
    stretch_of,
)
from engine.variant import Variant

__all__ = [
    "FRAME_NAMES",
    "FRAMINGS",
    "HOLD",
    "LAST_FRAME",
    "LINEAR",
    "MOST_TURNS",
    "NATURAL",
    "PRESETS",
    "RUBBERY",
    "STIFF",
    "STRETCHES",
    "VARIANTS",
    "Attachment",
    "Clip",
    "Command",
    "Document",
    "Easing",
    "ExportSettings",
    "Extremes",
    "Figure",
    "FrameRange",
    "Framing",
    "Front",
    "Handle",
    "History",
    "KeptPose",
    "Keyframe",
    "Marker",
    "Meshing",
    "Moment",
    "PictureFile",
    "Playhead",
    "Pose",
    "ShapeDetail",
    "SheetLayout",
    "Shortfall",
    "Switch",
    "Target",
    "UnkeyedPose",
    "Unknown",
    "Variant",
    "changed_stretches",
    "clip_of",
    "closes",
    "exported_frames",
    "falls_short",
    "figure_commands",
    "find_shortfall",
    "frame_times",
    "framed_frames",
    "fronts_at",
    "handle_commands",
    "intervals",
    "is_visible",
    "key_commands",
    "layer_commands",
    "loosened",
    "mirrored_name",
    "new_figure",
    "pairs_by_name",
    "pose_commands",
    "resting_pose",
    "scene_commands",
    "stretch_of",
    "time_of",
]
