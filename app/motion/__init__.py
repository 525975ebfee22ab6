"""The motion of a document on a mesh: exact, prepared, and as series in time.

In: a document and a frame.
Out: where the vertices are, and how far they reach.
Imports: `app.document`.
"""

from app.motion.extent import Box, Reach, box_around, measure_reach, source_of
from app.motion.inbetweens import Animation, Stage
from app.motion.prepared import Figure, Motion, prepare_motion
from app.motion.series_queue import Build, next_build, with_series
from app.motion.shown_frame import Shown, show
from app.motion.vertices import Streamed, Vertices

__all__ = [
    "Animation",
    "Box",
    "Build",
    "Figure",
    "Motion",
    "Reach",
    "Shown",
    "Stage",
    "Streamed",
    "Vertices",
    "box_around",
    "measure_reach",
    "next_build",
    "prepare_motion",
    "show",
    "source_of",
    "with_series",
]
