"""Points of a layer over time, and motion paths of its handles.

In: a clip and points.
Out: positions in every frame, each computed once.
Imports: `app.document`, `app.motion.inbetweens`.
"""

from app.motion.tracing.motion_paths import MotionPaths as MotionPaths, trace_paths as trace_paths
from app.motion.tracing.point_trails import PointTrails as PointTrails
