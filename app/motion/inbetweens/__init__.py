"""The motion of a clip at some points: in-betweens, and how handles stay and go their own ways.

In: a clip and points.
Out: where they are at any frame, with f_z and f_z̄.
Imports: `app.document`, `app.errors`.
"""

from app.motion.inbetweens.animation import Animation as Animation
from app.motion.inbetweens.auto_pins import AutoPins as AutoPins
from app.motion.inbetweens.correction import SolvedTracks as SolvedTracks
from app.motion.inbetweens.corrections import (
    Corrections as Corrections,
    Ground as Ground,
    have_one_ground as have_one_ground,
    is_corrected as is_corrected,
)
from app.motion.inbetweens.pairs import Pair as Pair, pair_of as pair_of, poses_of as poses_of
from app.motion.inbetweens.pose_sampler import PoseSampler as PoseSampler
from app.motion.inbetweens.swings import Carried as Carried
