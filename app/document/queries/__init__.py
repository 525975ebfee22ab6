"""What follows from a document: which keys a moment blends, what is in front, what falls short.

In: figures, poses and handles.
Out: answers; nothing is changed.
Imports: the values of `app.document`.
"""

from app.document.queries.clips import Clip, clip_of, closes, intervals
from app.document.queries.fronts import USUAL_EXTENT, Front, fronts_at, is_visible
from app.document.queries.shortfall import Extremes, Shortfall, falls_short, find_shortfall
from app.document.queries.timeline import (
    Moment,
    changed_stretches,
    exported_frames,
    frame_times,
    framed_frames,
    resting_pose,
    time_of,
)
from app.document.queries.transits import Transit, transits

__all__ = [
    "USUAL_EXTENT",
    "Clip",
    "Extremes",
    "Front",
    "Moment",
    "Shortfall",
    "Transit",
    "changed_stretches",
    "clip_of",
    "closes",
    "exported_frames",
    "falls_short",
    "find_shortfall",
    "frame_times",
    "framed_frames",
    "fronts_at",
    "intervals",
    "is_visible",
    "resting_pose",
    "time_of",
    "transits",
]
