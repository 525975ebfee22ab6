"""Detection of edits to applied motion presets."""

import hashlib
from collections.abc import Mapping
from dataclasses import replace
from typing import NamedTuple

from app.document.channels.kinds import DEPTH
from app.document.keyframe import Keyframe
from app.document.layer import Layer
from app.document.model import Document
from app.document.rig.applied_motion import AppliedMotion
from app.texts import ngettext

LEAST_EDIT = 0.1  # pixels; a target that moved by less is as the preset made it


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


def without_motion_springs(layer: Layer, motion: AppliedMotion) -> Layer:
    """Return a layer without the springs of a motion preset; edited springs stay."""
    springs = tuple(each for each in layer.springs if each not in motion.springs)
    return layer if springs == layer.springs else replace(layer, springs=springs)


class MotionEdits(NamedTuple):
    """What a person changed in the keys of a motion preset.

    Attributes
    ----------
    shifts : mapping
        Way of each moved handle in pixels, by the number of the key and the handle's id.
    deleted : frozenset of int
        Numbers of the keys that were deleted.
    others : tuple of Keyframe
        Keys that were inserted or moved in time.
    kept : mapping
        The keys of the preset by their numbers, for their easings and tangents.
    springs : frozenset of int
        Handles whose springs were edited or deleted.
    """

    shifts: Mapping[int, Mapping[int, complex]]
    deleted: frozenset[int]
    others: tuple[Keyframe, ...]
    kept: Mapping[int, Keyframe]
    springs: frozenset[int] = frozenset()

    @property
    def are_any(self) -> bool:
        return bool(self.shifts or self.deleted or self.others)


def find_motion_edits(layer: Layer, motion: AppliedMotion) -> MotionEdits:
    """Return what was changed by hand in one repeat of a motion preset."""
    period = (motion.last - motion.start) // motion.repeat_count
    own = {
        key.frame - motion.start: key
        for key in layer.keys
        if motion.start <= key.frame < motion.start + period
    }
    made = {key.offset: number for number, key in enumerate(motion.made)}
    kept = {made[offset]: key for offset, key in own.items() if offset in made}
    shifts: dict[int, dict[int, complex]] = {}
    for number, key in kept.items():
        ways = {
            handle: target.position - motion.made[number].targets[handle]
            for handle, target in key.pose.targets.items()
            if handle in motion.made[number].targets
        }
        ways = {handle: way for handle, way in ways.items() if abs(way) > LEAST_EDIT}
        shifts |= {number: ways} if ways else {}
    others = tuple(key for offset, key in own.items() if offset not in made)
    gone = frozenset(range(len(motion.made))) - kept.keys() - {0}
    springs = frozenset(each.handle for each in motion.springs if each not in layer.springs)
    return MotionEdits(shifts, gone, others if motion.made else (), kept, springs)


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
