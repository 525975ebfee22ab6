"""The export formats: each has one module and one entry of a table.

In: a plan, and its frames as straight-alpha pixels, or its layers as meshes.
Out: files that are whole or absent.
Imports: `app.export.plan`, `app.export.morph_mesh`, `app.storage`, Pillow; PyAV only for a video.
"""

from app.export.writers.frame_writer import FrameWriter as FrameWriter
from app.export.writers.spritesheet import sheet_grid as sheet_grid
from app.export.writers.table import (
    DATA_WRITERS as DATA_WRITERS,
    FILE_WRITERS as FILE_WRITERS,
    FOLDER_WRITERS as FOLDER_WRITERS,
    SHAPE_WRITERS as SHAPE_WRITERS,
    open_writer as open_writer,
)
