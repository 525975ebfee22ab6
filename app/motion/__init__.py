"""The motion of a layer on a mesh: one frame, prepared, and as series in time.

In: a clip (a layer in its scene's time) and a frame.
Out: where the vertices are, and how far they reach.
Imports: `app.document`.
"""

from app.motion.corrected_frames import (
    CorrectedFrames as CorrectedFrames,
    FoundCorrections as FoundCorrections,
    corrected_clip as corrected_clip,
)
from app.motion.extents import (
    Box as Box,
    box_around as box_around,
    extent_source as extent_source,
    measure_extent as measure_extent,
    motion_box as motion_box,
)
from app.motion.inbetweens import (
    Animation as Animation,
    Carried as Carried,
    Ground as Ground,
    PoseSampler as PoseSampler,
    is_corrected as is_corrected,
)
from app.motion.interval_store import IntervalPart as IntervalPart, IntervalStore as IntervalStore
from app.motion.intervals import (
    AnyInbetweens as AnyInbetweens,
    Build as Build,
    FoundIntervals as FoundIntervals,
    KnownInterval as KnownInterval,
)
from app.motion.joints import (
    Joints as Joints,
    anchor_of as anchor_of,
    animation_at as animation_at,
    carried_in as carried_in,
    hand_over as hand_over,
    hang as hang,
    hung_animations as hung_animations,
    joints_source as joints_source,
)
from app.motion.paint_order import PaintOrder as PaintOrder
from app.motion.posable_mesh import AttachedPoints as AttachedPoints, PosableMesh as PosableMesh
from app.motion.shown_frame import Shown as Shown, hang_shown as hang_shown, show as show
from app.motion.tracing import MotionPaths as MotionPaths, trace_paths as trace_paths
from app.motion.vertices import Placed as Placed, Streamed as Streamed, Vertices as Vertices
