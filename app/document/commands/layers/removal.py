"""Documents without a layer."""

from dataclasses import replace

from app.document.channels.kinds import LAYER_KINDS
from app.document.commands.layers import switch_group_commands
from app.document.layer import Layer
from app.document.model import Document


def without_layer(document: Document, identity: int) -> Document:
    """Return a document without a layer, and without the keys that refer to the layer."""
    document = switch_group_commands.without_switch_member(document, identity)
    layers = tuple(
        _without_references_to(each, identity) for each in document.layers if each.id != identity
    )
    return replace(document, layers=layers, size=document.canvas)


def _without_references_to(layer: Layer, other: int) -> Layer:
    """Return a layer without attachments, draw order keys and drivers of another layer."""
    if layer.before_bending is not None:
        before = _without_references_to(layer.before_bending, other)
        if before is not layer.before_bending:
            layer = replace(layer, before_bending=before)
    sliders = tuple(
        replace(each, driver=None) if each.driver == other else each for each in layer.sliders
    )
    if sliders != layer.sliders:
        layer = replace(layer, sliders=sliders)
    joints = tuple(joint for joint in layer.attachments if joint.parent != other)
    if joints != layer.attachments:
        layer = replace(layer, attachments=joints)
    for (name, part), keys in layer.channels.items():
        kind = LAYER_KINDS[name]
        left = (
            key
            for key in keys
            if not any(kind.field_of(key.value, each) == other for each in kind.layer_fields)
        )
        layer = layer.with_keys_of(kind, left, part)
    return layer
