"""The document that is edited, saved and rendered: values, commands, history.

In: commands.
Out: frozen documents, each of them valid, and where time stands in them.
Imports: `engine`, `app.errors`, `app.export_formats`; no pictures, graphics, window or clock.
"""

from app.document import handle_commands, key_commands, settings_commands
from app.document.checks import Unknown
from app.document.commands import Command
from app.document.easing import HOLD, LINEAR, PRESETS, Easing
from app.document.handle_commands import add_handle
from app.document.history import History
from app.document.keyframe import MOST_TURNS, Handle, Keyframe, Pose, Target
from app.document.model import Document, PictureFile, new_document
from app.document.playhead import Playhead
from app.document.settings import (
    FRAMINGS,
    LAST_FRAME,
    VARIANTS,
    ExportSettings,
    FrameRange,
    Framing,
    Meshing,
    Variant,
)
from app.document.settings_commands import replace_domain, set_anchor, set_bounds
from app.document.timeline import (
    Moment,
    closes,
    exported_frames,
    frame_times,
    intervals,
    resting_pose,
    time_of,
)

__all__ = [
    "FRAMINGS",
    "HOLD",
    "LAST_FRAME",
    "LINEAR",
    "MOST_TURNS",
    "PRESETS",
    "VARIANTS",
    "Command",
    "Document",
    "Easing",
    "ExportSettings",
    "FrameRange",
    "Framing",
    "Handle",
    "History",
    "Keyframe",
    "Meshing",
    "Moment",
    "PictureFile",
    "Playhead",
    "Pose",
    "Target",
    "Unknown",
    "Variant",
    "add_handle",
    "closes",
    "exported_frames",
    "frame_times",
    "handle_commands",
    "intervals",
    "key_commands",
    "new_document",
    "replace_domain",
    "resting_pose",
    "set_anchor",
    "set_bounds",
    "settings_commands",
    "time_of",
]
