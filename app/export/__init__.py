"""From a document to picture files, each of them whole or absent, with bounded memory.

In: a document, its motion, and what the person asks for.
Out: PNG frames, animated pictures, sprite sheets, video, models.
Imports: `app.render`, `app.motion`, `app.storage`.
"""

from app.export.clipboard import (
    clipboard_program as clipboard_program,
    put_on_clipboard as put_on_clipboard,
)
from app.export.destination import (
    FRAMES as FRAMES,
    PROJECT as PROJECT,
    FrameNames as FrameNames,
    data_file as data_file,
    folder_within as folder_within,
    suited as suited,
)
from app.export.framing import frame_view as frame_view, shown_box as shown_box
from app.export.moving_shape import with_light_meshes as with_light_meshes
from app.export.painting import Painter as Painter
from app.export.plan import (
    ExportPlan as ExportPlan,
    ExportRequest as ExportRequest,
    check_request as check_request,
    plan_export as plan_export,
    replaced_files as replaced_files,
)
from app.export.poses import KeptPoses as KeptPoses, Poses as Poses
from app.export.run_shapes import ShapeExport as ShapeExport
from app.export.writers import sheet_grid as sheet_grid
