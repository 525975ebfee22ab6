"""From the layers that carry to the one that hangs on them, by joints."""

from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np

from app.document import Attachment, Document, Layer, transform_at
from engine.geometry import IDENTITY_MOTION, RigidMotion


class PivotFrame(NamedTuple):
    """Where a point of a layer by itself is, and by what the layer turns there."""

    position: complex
    rotation: complex  # of modulus 1


class ChainLink(NamedTuple):
    """A layer, and the joint by which it hangs at a time; None where it never hung before."""

    layer: Layer
    attachment: Attachment | None
    # By which it moves by itself: not while it hangs, and from where it was when it was let go.
    transform: RigidMotion


def parent_links(
    document: Document, layer: int, frame: float, *, before: bool = False
) -> tuple[ChainLink, ...]:
    """Return the links from a layer, by its id, to the one that all hangs on at a frame.

    As they are from the frame on, or just before it.
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
    """Return where a layer is that hangs on a chain of others.

    Parameters
    ----------
    chain : sequence of ChainLink
        The layer, the one that it hangs on, and so on.
    hinge : callable
        Returns how a point of a layer is moved and turned, the layer by itself.
    kept : callable
        Returns how a layer is held by a joint that keeps its place: turned and moved beside the
        point of the parent, or where it was let go.
    """
    last, released, placement = chain[-1]
    if released is not None and released.keep_world_transform:
        placement = placement.compose(kept(last, released))
    for (child, joint, _), (parent, _, _) in zip(chain[-2::-1], chain[:0:-1], strict=True):
        if joint is None:
            raise ValueError("only the last carrier hangs on nothing")
        at, own = hinge(parent, joint.parent_point), hinge(child, require_anchor(child))
        held = kept(child, joint) if joint.keep_world_transform else _attachment_transform(joint)
        turn = placement.factor * at.rotation if joint.inherits_rotation else 1.0
        place = placement.factor * at.position + placement.shift + turn * held.shift
        factor = turn * held.factor
        placement = RigidMotion(complex(factor), complex(place - factor * own.position))
    return placement


def _attachment_transform(joint: Attachment) -> RigidMotion:
    """Return how a layer is held by a joint: turned and moved beside the point of the parent."""
    return RigidMotion(
        complex(np.exp(-1j * joint.rest_rotation)) if joint.inherits_rotation else 1.0, joint.offset
    )


def blend_transforms(
    layer: Layer, joint: Attachment, first: RigidMotion, last: RigidMotion, share: float
) -> RigidMotion:
    """Return how a joint holds a layer on the way from one way of holding it to another."""
    factor = first.factor * np.exp(1j * share * np.angle(last.factor / first.factor))
    # What is let go is held by its anchor, too, as what hangs on something is.
    anchor = require_anchor(layer) if joint.parent is None else 0j
    place, end = (held.factor * anchor + held.shift for held in (first, last))
    place += share * (end - place)
    return RigidMotion(complex(factor), complex(place - factor * anchor))


def pivot_frame_at(position: complex, fz: complex) -> PivotFrame:
    """Return where a point is and how the layer is turned there, by f and f_z."""
    return PivotFrame(complex(position), complex(fz / abs(fz)))


def require_anchor(layer: Layer) -> complex:
    """Return the anchor of a layer that is attached."""
    if layer.anchor is None:
        raise ValueError("a layer that is attached has an anchor")
    return layer.anchor
