"""Comparing documents by what determines the transforms of their layers."""

from app.document import IK_TARGET, TRANSFORM, Document, Layer, clip_of, limb_ends


def parenting_key(document: Document) -> tuple[object, ...]:
    """Return the values that determine the transforms; empty without attachments."""
    involved = [
        each
        for child in document.layers
        if child.attachments
        for each in (child, *document.all_ancestors(child.id))
    ]
    return tuple(clip_of(document, each.id) for each in dict.fromkeys(involved))


def have_same_parents(before: Document, document: Document, layer: Layer) -> bool:
    """Return whether a layer of a document has the same parents as in an earlier document."""
    own = next((each for each in before.layers if each.id == layer.id), None)
    return (
        own is not None
        and (before.frames, before.loop) == (document.frames, document.loop)
        and _of_parents(own) == _of_parents(layer)
        and all(
            each in before.layers
            for each in (*document.all_ancestors(layer.id), *limb_ends(document, layer.id))
            if each is not layer
        )
    )


def _of_parents(layer: Layer) -> tuple[object, ...]:
    moves = layer.keys_of(TRANSFORM), layer.keys_of(IK_TARGET)
    limb = layer.ik_parents, layer.pole_side
    return layer.attachments, layer.anchor, layer.domain, moves, limb, layer.cycles
