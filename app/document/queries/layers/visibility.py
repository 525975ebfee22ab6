"""Visibility at a frame."""

from functools import lru_cache

from app.document.channels.key import Key
from app.document.channels.kinds import VISIBILITY, SwitchMember
from app.document.layer import Layer
from app.document.layers.switch_group import SwitchGroup
from app.document.model import Document
from app.document.queries.channel_values.repeats import held_key_at, repeated_keys, with_repeats

HIDDEN = (VISIBILITY.key(0, value=False),)


def is_visible(document: Document, layer: Layer, frame: float) -> bool:
    keys = visibility_keys(document, layer)
    return (held_key_at(keys, frame) or keys[0]).value if keys else True


def visibility_keys(document: Document, layer: Layer) -> tuple[Key[bool], ...]:
    """Return the visibility keys in effect; the first holds before its frame too.

    Without keys, the layer is always visible. A hidden group hides its layers. A switch group alone
    decides the visibility of its members. A layer in a group of a switch is visible while the group
    is chosen and its own keys show it. A member of a deform group is visible while both are.
    """
    if layer.deform_group is None:
        return _own_visibility_keys(document, layer)
    group = _own_visibility_keys(document, document.deform_layer(layer))
    own = _own_visibility_keys(document, layer)
    return _both(group, own) if group and own else group or own


def _own_visibility_keys(document: Document, layer: Layer) -> tuple[Key[bool], ...]:
    if document.is_in_hidden(layer):
        return HIDDEN
    switches, first = document.switches_around(layer), document.frames.first
    if layer.hidden and not any(member == layer.id for _switch, member in switches):
        return HIDDEN
    own = layer.keys_of(VISIBILITY)
    keys = repeated_keys(own, layer.cycles, document.frames.last, not own or own[0].value)
    for switch, member in switches:
        inside = _visibility_keys_in(with_repeats(document, switch), member, first)
        keys = _both(inside, keys) if inside and keys else inside or keys
    return keys


@lru_cache(maxsize=256)
def _visibility_keys_in(
    switch: SwitchGroup, member: SwitchMember, first: int
) -> tuple[Key[bool], ...]:
    """Return a member's visibility keys, derived from the switch keys, from `first` on."""
    keys: list[Key[bool]] = []
    later = ((key.frame, key.value) for key in switch.keys if key.frame > first)
    for frame, shown in ((first, switch.member_at(first)), *later):
        visible = shown == member
        if not keys or keys[-1].value != visible:
            keys.append(VISIBILITY.key(frame, visible))
    return () if len(keys) == 1 and keys[0].value else tuple(keys)


@lru_cache(maxsize=256)
def _both(one: tuple[Key[bool], ...], other: tuple[Key[bool], ...]) -> tuple[Key[bool], ...]:
    """Return the visibility keys of a layer that is visible while both rows of keys show it."""
    keys: list[Key[bool]] = []
    for frame in sorted({key.frame for key in (*one, *other)}):
        visible = all((held_key_at(row, frame) or row[0]).value for row in (one, other))
        if not keys or keys[-1].value != visible:
            keys.append(VISIBILITY.key(frame, visible))
    return () if len(keys) == 1 and keys[0].value else tuple(keys)
