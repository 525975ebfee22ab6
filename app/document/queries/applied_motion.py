"""Detection of edits to applied motion presets."""

import hashlib

from app.document.keyframe import Keyframe
from app.document.layer import Layer
from app.document.model import Document
from app.document.rig.applied_motion import AppliedMotion
from app.texts import ngettext


def digest_keys(layer: Layer, first: int, last: int) -> str:
    """Return a digest of the keys from one frame to another, both included.

    The digest covers what a person edits: frames, targets, easings, tangent modes, depths and
    cycles. Solving the poses again within other limits or on another mesh does not change it.
    """
    digest = hashlib.sha256()
    for key in layer.keys:
        if first <= key.frame <= last:
            digest.update(repr(_key_content(key, first)).encode())
    for cycle in layer.cycles:
        if cycle.first < last and cycle.covers(first):
            digest.update(repr((cycle.first, cycle.last, cycle.until)).encode())
    return digest.hexdigest()


def is_motion_unedited(layer: Layer, given: AppliedMotion) -> bool:
    """Return whether the keys are as the motion preset made them."""
    return digest_keys(layer, given.first, given.last) == given.digest


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


def _key_content(key: Keyframe, first: int) -> tuple[object, ...]:
    """Return the editable values of a key for the digest."""
    wanted = [
        (identity, target.position, target.rotation)
        for identity, target in sorted(key.pose.targets.items())
    ]
    fronts = sorted(key.depths.items())
    way = key.easing.curve, key.tangent_mode.value, key.revolutions
    return key.frame - first, wanted, fronts, way
