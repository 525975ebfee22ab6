"""Transforms along the chain from a layer to its root ancestor."""

from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np

from app.document import Attachment, Document, Layer, transform_at
from engine.geometry import IDENTITY_MOTION, RigidMotion


class PivotFrame(NamedTuple):
    """Position of a point of a layer in the layer's space, and rotation there."""

    position: complex
    rotation: complex  # of modulus 1


class ChainLink(NamedTuple):
    """A layer and its attachment at a time; None before the first attachment."""

    layer: Layer
    attachment: Attachment | None
    # The layer's own transform. The identity while it has a parent; relative to the detach pose
    # afterwards.
    transform: RigidMotion


def parent_links(
    document: Document, layer: int, frame: float, *, before: bool = False
) -> tuple[ChainLink, ...]:
    """Return the links from a layer, by its id, to its root ancestor at a frame.

    The attachments are in effect from the frame on, or with `before` just before the frame.
    """
    chain = document.parent_chain(layer, frame, before=before)
    at = document.loop_frame(frame)
    links = []
    for each in chain:
        joint, movement = document.attachment_at(each, at, before=before), IDENTITY_MOTION
        if joint is None or joint.parent is None:
            movement = transform_at(document, each, at)
        if joint is not None and joint.parent is None and joint.keep_world_transform:
            movement = movement.compose(transform_at(document, each, joint.kept_from).inverse)
        links.append(ChainLink(each, joint, movement))
    return tuple(links)


def compose_chain(
    chain: Sequence[ChainLink],
    hinge: Callable[[Layer, complex], PivotFrame],
    kept: Callable[[Layer, Attachment], RigidMotion],
) -> RigidMotion:
    """Return the transform of a layer from its chain: the layer, its parent, and so on.

    `hinge` returns position and rotation of a point in its layer's space. `kept` returns the
    transform that an attachment with `keep_world_transform` keeps. It is relative to the parent's
    point, or in the scene after a detach.
    """
    last, released, placement = chain[-1]
    if released is not None and released.keep_world_transform:
        placement = placement.compose(kept(last, released))
    for (child, joint, _), (parent, _, _) in zip(chain[-2::-1], chain[:0:-1], strict=True):
        if joint is None:
            raise ValueError("only the last ancestor has no parent")
        at, own = hinge(parent, joint.parent_point), hinge(child, require_anchor(child))
        held = kept(child, joint) if joint.keep_world_transform else _attachment_transform(joint)
        turn = placement.factor * at.rotation if joint.inherits_rotation else 1.0
        place = placement.factor * at.position + placement.shift + turn * held.shift
        factor = turn * held.factor
        placement = RigidMotion(complex(factor), complex(place - factor * own.position))
    return placement


def _attachment_transform(joint: Attachment) -> RigidMotion:
    """Return the transform of an attached layer relative to the parent's point."""
    return RigidMotion(
        complex(np.exp(-1j * joint.rest_rotation)) if joint.inherits_rotation else 1.0, joint.offset
    )


def blend_transforms(
    layer: Layer, joint: Attachment, first: RigidMotion, last: RigidMotion, share: float
) -> RigidMotion:
    factor = first.factor * np.exp(1j * share * np.angle(last.factor / first.factor))
    # A detached layer is also blended at its anchor, as an attached one.
    anchor = require_anchor(layer) if joint.parent is None else 0j
    place, end = (held.factor * anchor + held.shift for held in (first, last))
    place += share * (end - place)
    return RigidMotion(complex(factor), complex(place - factor * anchor))


def pivot_frame_at(position: complex, fz: complex) -> PivotFrame:
    """Return position and rotation at a point from f and f_z."""
    return PivotFrame(complex(position), complex(fz / abs(fz)))


def require_anchor(layer: Layer) -> complex:
    if layer.anchor is None:
        raise ValueError("a layer that is attached has an anchor")
    return layer.anchor
