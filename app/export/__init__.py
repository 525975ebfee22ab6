"""From a document to picture files, each of them whole or absent, with bounded memory.

In: a document, its motion, and what the person asks for.
Out: PNG frames, animated pictures, sprite sheets, video.
Imports: `app.render`, `app.motion`.
"""

from app.export.framing import frame_view, shown_box
from app.export.painting import painter
from app.export.plan import (
    SUFFIXES,
    VIDEO_REMEDY,
    ExportPlan,
    ExportRequest,
    Poses,
    check_request,
    plan_export,
)
from app.export.png import encode_png
from app.export.run import export
from app.export.spritesheet import sheet_grid

__all__ = [
    "SUFFIXES",
    "VIDEO_REMEDY",
    "ExportPlan",
    "ExportRequest",
    "Poses",
    "check_request",
    "encode_png",
    "export",
    "frame_view",
    "painter",
    "plan_export",
    "sheet_grid",
    "shown_box",
]
