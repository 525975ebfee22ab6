"""Bounding boxes of animations, with few frames or very many.

In: documents, and positions of their layers in a frame.
Out: boxes.
Imports: `app.document`, `app.errors`, the other packages of `app.motion`.
"""

from app.motion.extents.extent import (
    BoundingBox as BoundingBox,
    bounding_box as bounding_box,
    extent_key as extent_key,
    measure_extent as measure_extent,
    motion_bounding_box as motion_bounding_box,
)
