"""Commands on the joints of layers: bones, pole sides and transforms."""

from dataclasses import replace

from app.document.commands.command import command
from app.document.model import Document
from app.texts import _


@command(_("Set pole side"))
def set_pole_side(document: Document, identity: int, *, side: int) -> Document:
    """Set the side to which the bones of a layer bend; 0 keeps the side of their transforms."""
    return document.with_layer(replace(document.layer(identity), pole_side=side))


@command(_("Set IK parents"))
def set_ik_parents(document: Document, identity: int, count: int | None) -> Document:
    """Set how many parents bend with a layer; None finds them by their children."""
    return document.with_layer(replace(document.layer(identity), ik_parents=count))


@command(_("Apply transform"))
def apply_transform(document: Document, identity: int) -> Document:
    """Let a layer's own transform act at all its joints."""
    layer = document.layer(identity)
    joints = (replace(each, applies_transform=True) for each in layer.attachments)
    return document.with_layer(replace(layer, attachments=tuple(joints)))
