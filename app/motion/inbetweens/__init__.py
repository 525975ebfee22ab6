"""The motion of a clip at given points: in-betweens, auto-pins, tracks and springs.

In: a clip and points.
Out: positions at any frame, with f_z and f_z̄.
Imports: `app.document`, `app.errors`.
"""

from app.motion.inbetweens.animation import Animation as Animation
from app.motion.inbetweens.auto_pins import AutoPins as AutoPins
from app.motion.inbetweens.frame_corrector import (
    BaseMotionFrame as BaseMotionFrame,
    FrameCorrector as FrameCorrector,
    have_same_base_frames as have_same_base_frames,
    needs_correction as needs_correction,
)
from app.motion.inbetweens.pose_sampler import PoseSampler as PoseSampler
from app.motion.inbetweens.secondary_correction import SecondaryCorrection as SecondaryCorrection
from app.motion.inbetweens.segment_keys import (
    SegmentKey as SegmentKey,
    segment_key as segment_key,
    segment_poses as segment_poses,
)
from app.motion.inbetweens.spring_offsets import ParentMotion as ParentMotion
