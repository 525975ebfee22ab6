"""Joints of layers that moved in their file."""

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from app.document import Attachment, Layer

NOWHERE: complex = 0j


def with_moved_joints(
    layer: Layer, shifts: Mapping[int, complex], layers: Mapping[int, Layer]
) -> Layer:
    """Return a layer whose joints follow the shifts of the layer and of its parents.

    A layer that moved on its parent takes the joint along, if the joint is then still on the
    parent's shape; otherwise the joint keeps its place on the parent, with an offset.

    Parameters
    ----------
    shifts : mapping of int to complex
        Shifts of the artwork by layer id.
    layers : mapping of int to Layer
        The layers after the reload, by id.
    """
    own = shifts.get(layer.id, NOWHERE)

    def moved(joint: Attachment) -> Attachment:
        by = NOWHERE if joint.parent is None else shifts.get(joint.parent, NOWHERE)
        if joint.parent is None or (not own and not by):
            return joint
        beside = joint.parent_point + own
        parent = layers.get(joint.parent)
        if own == by or (parent is not None and parent.covers(np.array([beside])).all()):
            return replace(joint, parent_point=beside)
        return replace(joint, parent_point=joint.parent_point + by, offset=joint.offset + own - by)

    joints = tuple(map(moved, layer.attachments))
    return layer if joints == layer.attachments else replace(layer, attachments=joints)
