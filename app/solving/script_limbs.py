"""Limbs of layers in a pose script."""

from itertools import pairwise

import numpy as np

from app.document import IK_TARGET, Document, bones_above, joint_commands, layers_with_targets
from app.errors import LissomError
from app.motion import ParentTransforms, require_anchor
from app.solving.script.pose_script import PoseScript
from app.solving.script_scene import find_layer
from app.texts import _

REACHED = 0.5  # pixels from an IK target
SHORTEST = 0.5  # pixels: least length of a bone


def with_limbs(document: Document, script: PoseScript) -> Document:
    """Return a document whose layers bend as the script says."""
    for limb in script.limbs:
        *parents, end = [find_layer(document, name) for name in limb.layers]
        frame = document.frames.first
        chain = document.parent_chain(end.id, frame)[1 : len(limb.layers)]
        wanted = tuple(reversed(parents))
        for child, parent, found in zip(
            (end, *wanted), wanted, (*chain, *[None] * len(wanted)), strict=False
        ):
            if found is not parent:
                raise LissomError(
                    _(
                        "bones: {child!r} is not attached to {parent!r}. Name the layers from "
                        "root to end, each attached to the one before"
                    ).format(child=child.name, parent=parent.name)
                )
        joints = [layer.pivot for layer in (*parents, end)]
        for (one, layer), (other, at) in pairwise(zip((*parents, end), joints, strict=True)):
            if abs(layer - at) < SHORTEST:
                raise LissomError(
                    _(
                        "bones: {one!r} and {other!r} have their joints at the same place. Move "
                        "one of them, so that {one!r} has a length"
                    ).format(one=one.name, other=other.name)
                )
        document = joint_commands.set_ik_parents(end.id, len(parents))(document)
        document = joint_commands.set_pole_side(end.id, side=limb.side)(document)
    return document


def warn_missed_targets(document: Document) -> list[str]:
    """Return notices of keys of IK targets that their bones do not reach."""
    notices, transforms = [], ParentTransforms(document)
    for layer in layers_with_targets(document):
        if not bones_above(document, layer.id, document.frames.first):
            text = _("{layer} has IK targets, but no parent bends with it; name them in bones")
            notices.append(text.format(layer=layer.name))
            continue
        pivot = require_anchor(layer)
        for key in layer.keys_of(IK_TARGET):
            if key.value.mix < 1:
                continue
            posed = transforms.animation(layer.id, np.array([pivot])).positions(key.frame)
            place = transforms.placement(layer.id, key.frame).apply(posed)[0]
            error = abs(key.value.place - place)
            if error > REACHED:
                notices.append(
                    _(
                        "frame {frame}: {layer} is {error:.1f} px from its IK target, beyond the "
                        "reach of its bones"
                    ).format(frame=key.frame, layer=layer.name, error=error)
                )
    return notices
