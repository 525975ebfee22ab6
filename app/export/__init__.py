"""From a document to picture files, each of them whole or absent, with bounded memory.

In: a document, its motion, and what the person asks for.
Out: PNG frames, animated pictures, sprite sheets, video, models.
Imports: `app.render`, `app.motion`, `app.storage`.
"""

from app.export.clipboard import clipboard_program, put_on_clipboard
from app.export.destination import PROJECT, FrameNames, data_file, folder_within, suited
from app.export.framing import frame_view, shown_box
from app.export.moving_shape import with_light_meshes
from app.export.painting import Painter
from app.export.plan import (
    ExportPlan,
    ExportRequest,
    check_request,
    missing,
    plan_export,
    replaced_files,
)
from app.export.poses import KeptPoses, Poses
from app.export.run import export
from app.export.run_shapes import ShapeExport
from app.export.writers import sheet_grid

__all__ = [
    "PROJECT",
    "ExportPlan",
    "ExportRequest",
    "FrameNames",
    "KeptPoses",
    "Painter",
    "Poses",
    "ShapeExport",
    "check_request",
    "clipboard_program",
    "data_file",
    "export",
    "folder_within",
    "frame_view",
    "missing",
    "plan_export",
    "put_on_clipboard",
    "replaced_files",
    "sheet_grid",
    "shown_box",
    "suited",
    "with_light_meshes",
]
