"""Detection of edits to applied motion presets."""

import hashlib

from app.document.channels.kinds import DEPTH
from app.document.keyframe import Keyframe
from app.document.layer import Layer
from app.document.model import Document
from app.document.rig.applied_motion import AppliedMotion
from app.texts import ngettext


def keys_of_motion(layer: Layer, motion: AppliedMotion) -> tuple[Keyframe, ...]:
    """Return the keys of a motion preset, also those that were moved."""
    return tuple(key for key in layer.keys if key.motion == motion.id)


def digest_motion(layer: Layer, motion: AppliedMotion) -> str:
    """Return a digest of a motion's keys, and of the key that it blends in from.

    The digest covers what a person edits: frames, targets, easings, tangent modes, depths and
    cycles. Solving the poses again within other limits or on another mesh does not change it.
    """
    digest, first = hashlib.sha256(), motion.first
    for key in layer.keys:
        if key.motion == motion.id or key.frame == first < motion.start:
            digest.update(repr(_key_content(layer, key, first)).encode())
    for cycle in layer.cycles:
        if cycle.first < motion.last and cycle.covers(first):
            digest.update(repr((cycle.first, cycle.last, cycle.until)).encode())
    return digest.hexdigest()


def is_motion_unedited(layer: Layer, motion: AppliedMotion) -> bool:
    """Return whether the keys are as the motion preset made them."""
    return digest_motion(layer, motion) == motion.digest


def motion_notices(document: Document) -> tuple[str, ...]:
    """Return a notice for each layer with motions that this version cannot read."""
    notices = []
    for layer in document.layers:
        unread = layer.unread_motions
        if unread:
            notices.append(
                ngettext(
                    "{layer!r} has a motion that this version cannot show; the file keeps it: "
                    "{reason}",
                    (
                        "{layer!r} has {count} motions that this version cannot show; the file "
                        "keeps them: {reason}"
                    ),
                    len(unread),
                ).format(layer=layer.name, count=len(unread), reason=unread[0].reason)
            )
    return tuple(notices)


def _key_content(layer: Layer, key: Keyframe, first: int) -> tuple[object, ...]:
    """Return the editable values of a key for the digest."""
    wanted = [
        (identity, target.position, target.rotation)
        for identity, target in sorted(key.pose.targets.items())
    ]
    fronts = sorted(
        (part, each.value)
        for (name, part), keys in layer.channels.items()
        for each in keys
        if name == DEPTH.name and each.frame == key.frame
    )
    way = key.easing.curve, key.tangent_mode.value, key.revolutions
    return key.frame - first, wanted, fronts, way
