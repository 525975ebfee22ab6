"""Transforms along the chain from a layer to its root ancestor."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from typing import Final, NamedTuple

import numpy as np

from app.document import TRANSFORM, Attachment, Document, Layer, Transform, layer_value_at
from engine.geometry import IDENTITY_MOTION, Similarity

UNMOVED: Final = Transform()


class PivotFrame(NamedTuple):
    """Position of a point of a layer in the layer's space, and rotation there."""

    position: complex
    rotation: complex  # of modulus 1


# Position and rotation of a point in its layer's space.
PivotFrameAt = Callable[[Layer, complex], PivotFrame]
# The transform that an attachment with `keep_world_transform` keeps, without the layer's own. It is
# relative to the parent's point, or in the scene after a detach.
KeptTransform = Callable[[Layer, Attachment], Similarity]


class ChainLink(NamedTuple):
    """A layer and its attachment at a time; None before the first attachment."""

    layer: Layer
    attachment: Attachment | None
    transform: Transform  # the layer's own, about its joint
    # Motion of the scene after a detach, for attachments that do not apply the transform.
    scene_motion: Similarity = IDENTITY_MOTION

    @property
    def has_joint(self) -> bool:
        """Whether the layer turns about its anchor, as posed, and not about its pivot."""
        joint = self.attachment
        return joint is not None and (joint.parent is not None or joint.keep_world_transform)

    def pivot(self, hinge: PivotFrameAt) -> complex:
        """Return the point about which the layer turns, in its own space."""
        if self.has_joint:
            return hinge(self.layer, require_anchor(self.layer)).position
        return self.layer.pivot


def parent_links(
    document: Document,
    layer: int,
    frame: float,
    *,
    before: bool = False,
) -> tuple[ChainLink, ...]:
    """Return the links from a layer, by its id, to its root ancestor at a frame.

    The attachments are in effect from the frame on, or with `before` just before the frame.
    """
    at = document.loop_frame(frame)
    links = []
    for each in document.parent_chain(layer, frame, before=before):
        joint = document.attachment_at(each, at, before=before)
        own = layer_value_at(document, each, TRANSFORM, at) or UNMOVED
        if joint is None or joint.applies_transform:
            links.append(ChainLink(each, joint, own))
        elif joint.parent is None and joint.keep_world_transform:
            begun = layer_value_at(document, each, TRANSFORM, joint.kept_from) or UNMOVED
            motion = own.about(each.pivot).compose(begun.about(each.pivot).inverse)
            links.append(ChainLink(each, joint, UNMOVED, motion))
        else:
            links.append(ChainLink(each, joint, UNMOVED if joint.parent is not None else own))
    return tuple(links)


def turn_links(links: Sequence[ChainLink], turns: Mapping[int, float]) -> tuple[ChainLink, ...]:
    """Return links with rotations of layers at their joints, in radians by id."""
    found = []
    for link in links:
        turn, own = turns.get(link.layer.id), link.transform
        turns_at_joint = link.attachment is None or link.attachment.applies_transform
        if turn and turns_at_joint:
            link = link._replace(transform=replace(own, turn=own.turn + turn))  # noqa: PLW2901
        found.append(link)
    return tuple(found)


def compose_chain(
    chain: Sequence[ChainLink], hinge: PivotFrameAt, kept: KeptTransform
) -> Similarity:
    """Return the transform of a layer from its chain: the layer, its parent, and so on."""
    placement = IDENTITY_MOTION
    for child, parent in zip(chain[::-1], (None, *chain[:0:-1]), strict=True):
        joint, pivot = child.attachment, child.pivot(hinge)
        if parent is None:
            if joint is not None and joint.keep_world_transform:
                placement = child.scene_motion.compose(kept(child.layer, joint))
        elif joint is None:
            raise ValueError("only the last ancestor has no parent")
        else:
            at = hinge(parent.layer, joint.parent_point)
            held = (
                kept(child.layer, joint)
                if joint.keep_world_transform
                else _attachment_transform(joint)
            )
            turn = placement.factor * at.rotation if joint.inherits_rotation else 1.0
            place = placement.factor * at.position + placement.shift + turn * held.shift
            factor = turn * held.factor
            placement = Similarity(complex(factor), complex(place - factor * pivot))
        if child.transform != UNMOVED:
            placement = placement.compose(child.transform.about(pivot))
    return placement


def _attachment_transform(joint: Attachment) -> Similarity:
    """Return the transform of an attached layer relative to the parent's point."""
    if not joint.inherits_rotation:
        return Similarity(1.0, joint.offset)
    return Similarity(complex(np.exp(-1j * joint.rest_rotation)) / joint.rest_scale, joint.offset)


def blend_transforms(
    layer: Layer, joint: Attachment, first: Similarity, last: Similarity, share: float
) -> Similarity:
    ratio = last.factor / first.factor
    size = abs(ratio) ** share
    factor = first.factor * size * np.exp(1j * share * np.angle(ratio))
    # A detached layer is also blended at its anchor, as an attached one.
    anchor = require_anchor(layer) if joint.parent is None else 0j
    place, end = (held.factor * anchor + held.shift for held in (first, last))
    place += share * (end - place)
    return Similarity(complex(factor), complex(place - factor * anchor))


def pivot_frame_at(position: complex, fz: complex) -> PivotFrame:
    """Return position and rotation at a point from f and f_z."""
    return PivotFrame(complex(position), complex(fz / abs(fz)))


def require_anchor(layer: Layer) -> complex:
    if layer.anchor is None:
        raise ValueError("a layer that is attached has an anchor")
    return layer.anchor
