"""Visibility at a frame."""

from functools import lru_cache

from app.document.channels.key import Key
from app.document.channels.kinds import VISIBILITY
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
    decides the visibility of its members.
    """
    if document.is_in_hidden(layer):
        return HIDDEN
    switch = document.switch_group_of(layer.id)
    if switch is None:
        keys = layer.keys_of(VISIBILITY)
        if layer.hidden:
            return HIDDEN
        return repeated_keys(keys, layer.cycles, document.frames.last, not keys or keys[0].value)
    return _visibility_keys_in(with_repeats(document, switch), layer.id, document.frames.first)


@lru_cache(maxsize=256)
def _visibility_keys_in(switch: SwitchGroup, identity: int, first: int) -> tuple[Key[bool], ...]:
    """Return a member's visibility keys, derived from the switch keys, from `first` on."""
    keys: list[Key[bool]] = []
    later = ((key.frame, key.value) for key in switch.keys if key.frame > first)
    for frame, shown in ((first, switch.layer_at(first)), *later):
        visible = shown == identity
        if not keys or keys[-1].value != visible:
            keys.append(VISIBILITY.key(frame, visible))
    return () if len(keys) == 1 and keys[0].value else tuple(keys)
