"""The motion of a figure on a mesh: one frame, prepared, and as series in time.

In: a clip (a figure in its scene's time) and a frame.
Out: where the vertices are, and how far they reach.
Imports: `app.document`.
"""

from app.motion.extent import Box, box_around, extent_source, measure_extent, motion_box
from app.motion.inbetweens import Animation, PoseSampler
from app.motion.interval_store import IntervalPart, IntervalStore
from app.motion.intervals import AnyInbetweens, Build, FoundIntervals, KnownInterval, OneFrame
from app.motion.joints import HERE, Joints, Placement, hung_animations, joints_source
from app.motion.motion_paths import MotionPaths, trace_paths
from app.motion.paint_order import PaintOrder
from app.motion.posable_mesh import AttachedPoints, PosableMesh
from app.motion.shown_frame import Shown, hang_shown, show
from app.motion.vertices import Placed, Streamed, Vertices

__all__ = [
    "HERE",
    "Animation",
    "AnyInbetweens",
    "AttachedPoints",
    "Box",
    "Build",
    "FoundIntervals",
    "IntervalPart",
    "IntervalStore",
    "Joints",
    "KnownInterval",
    "MotionPaths",
    "OneFrame",
    "PaintOrder",
    "Placed",
    "Placement",
    "PosableMesh",
    "PoseSampler",
    "Shown",
    "Streamed",
    "Vertices",
    "box_around",
    "extent_source",
    "hang_shown",
    "hung_animations",
    "joints_source",
    "measure_extent",
    "motion_box",
    "show",
    "trace_paths",
]
