"""A few points of a layer over time, and the paths of its handles.

In: a clip and points.
Out: where they are in every frame, each worked out once.
Imports: `app.document`, `app.motion.inbetweens`.
"""

from app.motion.tracing.motion_paths import MotionPaths as MotionPaths, trace_paths as trace_paths
from app.motion.tracing.point_trails import PointTrails as PointTrails
