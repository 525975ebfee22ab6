"""How far an animation moves over the plane, in few frames or very many.

In: documents, and where their layers are in a frame.
Out: boxes.
Imports: `app.document`, `app.errors`, what else is in `app.motion`.
"""

from app.motion.extents.extent import (
    Box as Box,
    box_around as box_around,
    extent_source as extent_source,
    measure_extent as measure_extent,
    motion_box as motion_box,
)
