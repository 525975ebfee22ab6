"""Transforms of attached layers at any time.

In: documents, and cached motion of their layers.
Out: rigid motions from layers to the scene; attachments that keep a layer in place.
Imports: `app.document`, `app.motion.inbetweens`, `app.motion.tracing`.
"""

from app.motion.parenting.attach import (
    anchor_or_default as anchor_or_default,
    attach_in_place as attach_in_place,
    reparent_in_place as reparent_in_place,
)
from app.motion.parenting.chain import (
    ChainLink as ChainLink,
    PivotFrame as PivotFrame,
    compose_chain as compose_chain,
    parent_links as parent_links,
)
from app.motion.parenting.parent_transforms import (
    HungAnimation as HungAnimation,
    ParentTransforms as ParentTransforms,
    find_parent_motion as find_parent_motion,
    hung_animations as hung_animations,
    layer_animation as layer_animation,
    parenting_key as parenting_key,
)
