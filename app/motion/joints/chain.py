"""From the layers that carry to the one that hangs on them, by joints."""

from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np

from app.document import Attachment, Document, Layer, movement_at
from engine.geometry import HERE, RigidMotion


class Hinge(NamedTuple):
    """Where a point of a layer by itself is, and by what the layer turns there."""

    place: complex
    turn: complex  # of modulus 1


class Hanging(NamedTuple):
    """A layer, and the joint by which it hangs at a time; None where it never hung before."""

    layer: Layer
    joint: Attachment | None
    # By which it moves by itself: not while it hangs, and from where it was when it was let go.
    movement: RigidMotion


def chain_of(
    document: Document, layer: int, frame: float, *, before: bool = False
) -> tuple[Hanging, ...]:
    """Return the links from a layer, by its id, to the one that all hangs on at a frame.

    As they are from the frame on, or just before it.
    """
    chain = document.carriers(layer, frame, before=before)
    at = document.in_time(frame)
    links = []
    for each in chain:
        joint, movement = document.joint_at(each, at, before=before), HERE
        if joint is None or joint.to is None:
            movement = movement_at(document, each, at)
        if joint is not None and joint.to is None and joint.keeps:
            movement = movement.after(movement_at(document, each, joint.kept_from).inverse)
        links.append(Hanging(each, joint, movement))
    return tuple(links)


def along(
    chain: Sequence[Hanging],
    hinge: Callable[[Layer, complex], Hinge],
    kept: Callable[[Layer, Attachment], RigidMotion],
) -> RigidMotion:
    """Return where a layer is that hangs on a chain of others.

    Parameters
    ----------
    chain : sequence of Hanging
        The layer, the one that it hangs on, and so on.
    hinge : callable
        Returns how a point of a layer is moved and turned, the layer by itself.
    kept : callable
        Returns how a layer is held by a joint that keeps its place: turned and moved beside the
        point of the parent, or where it was let go.
    """
    last, released, placement = chain[-1]
    if released is not None and released.keeps:
        placement = placement.after(kept(last, released))
    for (child, joint, _), (parent, _, _) in zip(chain[-2::-1], chain[:0:-1], strict=True):
        if joint is None:
            raise ValueError("only the last carrier hangs on nothing")
        at, own = hinge(parent, joint.at), hinge(child, require_anchor(child))
        held = kept(child, joint) if joint.keeps else _held(joint)
        turn = placement.factor * at.turn if joint.turns else 1.0
        place = placement.factor * at.place + placement.shift + turn * held.shift
        factor = turn * held.factor
        placement = RigidMotion(complex(factor), complex(place - factor * own.place))
    return placement


def _held(joint: Attachment) -> RigidMotion:
    """Return how a layer is held by a joint: turned and moved beside the point of the parent."""
    return RigidMotion(complex(np.exp(-1j * joint.rest)) if joint.turns else 1.0, joint.offset)


def between(
    layer: Layer, joint: Attachment, first: RigidMotion, last: RigidMotion, share: float
) -> RigidMotion:
    """Return how a joint holds a layer on the way from one way of holding it to another."""
    factor = first.factor * np.exp(1j * share * np.angle(last.factor / first.factor))
    # What is let go is held by its anchor, too, as what hangs on something is.
    anchor = require_anchor(layer) if joint.to is None else 0j
    place, end = (held.factor * anchor + held.shift for held in (first, last))
    place += share * (end - place)
    return RigidMotion(complex(factor), complex(place - factor * anchor))


def hinge_at(position: complex, fz: complex) -> Hinge:
    """Return where a point is and how the layer is turned there, by f and f_z."""
    return Hinge(complex(position), complex(fz / abs(fz)))


def require_anchor(layer: Layer) -> complex:
    """Return the anchor of a layer that is attached."""
    if layer.anchor is None:
        raise ValueError("a layer that is attached has an anchor")
    return layer.anchor
