"""The motion of a figure on a mesh: exact, prepared, and as series in time.

In: a clip (a figure in its scene's time) and a frame.
Out: where the vertices are, and how far they reach.
Imports: `app.document`.
"""

from app.motion.extent import Box, box_around, extent_source, measure_extent, motion_box
from app.motion.glimpse import Glimpse, can_glimpse, glimpse_at
from app.motion.inbetweens import Animation, PoseSampler
from app.motion.joints import HERE, Joints, Placement, hung_animations, joints_source
from app.motion.motion_paths import MotionPaths, trace_paths
from app.motion.paint_order import painted_depths, painted_triangles
from app.motion.posable_mesh import AttachedPoints, PosableMesh
from app.motion.prepared import Motion, prepare_motion
from app.motion.series_queue import Build, next_build, with_series
from app.motion.shown_frame import Shown, hang_shown, show
from app.motion.vertices import Placed, Streamed, Vertices

__all__ = [
    "HERE",
    "Animation",
    "AttachedPoints",
    "Box",
    "Build",
    "Glimpse",
    "Joints",
    "Motion",
    "MotionPaths",
    "Placed",
    "Placement",
    "PosableMesh",
    "PoseSampler",
    "Shown",
    "Streamed",
    "Vertices",
    "box_around",
    "can_glimpse",
    "extent_source",
    "glimpse_at",
    "hang_shown",
    "hung_animations",
    "joints_source",
    "measure_extent",
    "motion_box",
    "next_build",
    "painted_depths",
    "painted_triangles",
    "prepare_motion",
    "show",
    "trace_paths",
    "with_series",
]
