"""Commands that change the footage of layers."""

from dataclasses import replace

from app.document.commands.command import command
from app.document.layers.footage import Footage
from app.document.model import Document
from app.texts import _


@command(_("Replace footage"))
def set_footage(document: Document, identity: int, footage: Footage) -> Document:
    """Let a layer show other footage of the same size; its keys stay."""
    return document.with_layer(replace(document.layer(identity), footage=footage))
