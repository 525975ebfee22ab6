"""From a document to picture files, each of them whole or absent, with bounded memory.

In: a document, its motion, and an export request.
Out: PNG frames, animated pictures, sprite sheets, video, models.
Imports: `app.render`, `app.motion`, `app.storage`.
"""

from app.export.decimation import with_reduced_meshes as with_reduced_meshes
from app.export.destination import (
    FRAMES as FRAMES,
    PROJECT as PROJECT,
    FrameNames as FrameNames,
    choose_frame_folder as choose_frame_folder,
    data_file as data_file,
    with_suffix_for as with_suffix_for,
)
from app.export.frame_renderer import FrameRenderer as FrameRenderer
from app.export.framing import find_shown_box as find_shown_box, frame_view as frame_view
from app.export.mesh_export import MeshExport as MeshExport
from app.export.plan import (
    ExportPlan as ExportPlan,
    plan_export as plan_export,
)
from app.export.request import (
    ExportRequest as ExportRequest,
    check_request as check_request,
    export_times as export_times,
    list_overwritten_files as list_overwritten_files,
)
from app.export.writers.clipboard import (
    clipboard_program as clipboard_program,
    put_on_clipboard as put_on_clipboard,
)
from app.export.writers.spritesheet import sheet_grid as sheet_grid
