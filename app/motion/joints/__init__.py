"""Where layers that hang on others are, at any time.

In: documents, and what is known of their layers' motion.
Out: rigid motions, after which a layer is in the scene; joints by which nothing moves.
Imports: `app.document`, `app.motion.inbetweens`, `app.motion.tracing`.
"""

from app.motion.joints.chain import (
    Hanging as Hanging,
    Hinge as Hinge,
    along as along,
    chain_of as chain_of,
)
from app.motion.joints.hanging import anchor_of as anchor_of, hand_over as hand_over, hang as hang
from app.motion.joints.joints import (
    HungAnimation as HungAnimation,
    Joints as Joints,
    animation_at as animation_at,
    carried_in as carried_in,
    hung_animations as hung_animations,
    joints_source as joints_source,
)
