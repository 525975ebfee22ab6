"""The motion of a figure on a mesh: exact, prepared, and as series in time.

In: a clip (a figure in its scene's time) and a frame.
Out: where the vertices are, and how far they reach.
Imports: `app.document`.
"""

from app.motion.extent import Box, box_around, extent_source, measure_extent, motion_box
from app.motion.inbetweens import Animation, PoseSampler
from app.motion.posable_mesh import PosableMesh
from app.motion.prepared import Motion, prepare_motion
from app.motion.series_queue import Build, next_build, with_series
from app.motion.shown_frame import Shown, show
from app.motion.vertices import Placed, Streamed, Vertices

__all__ = [
    "Animation",
    "Box",
    "Build",
    "Motion",
    "Placed",
    "PosableMesh",
    "PoseSampler",
    "Shown",
    "Streamed",
    "Vertices",
    "box_around",
    "extent_source",
    "measure_extent",
    "motion_box",
    "next_build",
    "prepare_motion",
    "show",
    "with_series",
]
