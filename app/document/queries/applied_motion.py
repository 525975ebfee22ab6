"""Whether motions that a layer was given are still as they were made."""

import hashlib

from app.document.keyframe import Keyframe
from app.document.layer import Layer
from app.document.model import Document
from app.document.rig import AppliedMotion


def digest_keys(layer: Layer, first: int, last: int) -> str:
    """Return a digest of what is keyed from one frame to another, both included.

    It is of what a person edits: where keys are, what they want of handles, how they are passed,
    and what repeats. Poses that are solved anew, within other limits or on another mesh, change
    nothing of it.
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
    """Tell whether nothing of a motion was edited since it was given to a layer."""
    return digest_keys(layer, given.first, given.last) == given.digest


def motion_notices(document: Document) -> tuple[str, ...]:
    """Return a line for each layer of which the file has motions that are not shown."""
    notices = []
    for layer in document.layers:
        unread = layer.unread_motions
        if unread:
            count = f"{len(unread)} motions" if len(unread) > 1 else "a motion"
            notices.append(
                f"{layer.name!r} has {count} that this version cannot show, and the file keeps: "
                f"{unread[0].reason}"
            )
    return tuple(notices)


def _key_content(key: Keyframe, first: int) -> tuple[object, ...]:
    """Return what a person says of a key, as its digest takes it."""
    wanted = [
        (identity, target.position, target.rotation)
        for identity, target in sorted(key.pose.targets.items())
    ]
    fronts = sorted(key.depths.items())
    way = key.easing.curve, key.tangent_mode.value, key.revolutions
    return key.frame - first, wanted, fronts, way
