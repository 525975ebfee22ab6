"""Bones of several layers: the parents that bend when a layer is dragged or has an IK target."""

from app.document.channels.kinds import IK_TARGET
from app.document.layer import Layer
from app.document.model import Document


def bones_above(
    document: Document, layer: int, frame: float, *, before: bool = False
) -> tuple[Layer, ...]:
    """Return the parents of a layer that bend as bones at a frame, from the root on.

    A layer without a parent is a bone if it has an anchor, or if `ik_parents` counts it.
    """
    own, *parents = document.parent_chain(layer, frame, before=before)
    children = _children(document)
    found: list[Layer] = []
    for parent in parents[: own.ik_parents]:
        child = found[-1] if found else own
        if own.ik_parents is None and (
            children[parent.id] != {child.id} or (parent is parents[-1] and parent.anchor is None)
        ):
            break
        found.append(parent)
    return tuple(reversed(found))


def layers_with_targets(document: Document) -> tuple[Layer, ...]:
    """Return the layers with IK targets at some frame."""
    return tuple(layer for layer in document.layers if layer.keys_of(IK_TARGET))


def limb_ends(document: Document, layer: int) -> tuple[Layer, ...]:
    """Return the layers whose IK targets may move a layer at some frame."""
    whole = {layer, *(each.id for each in document.all_ancestors(layer))}
    return tuple(
        end
        for end in layers_with_targets(document)
        if whole & {end.id, *(each.id for each in document.all_ancestors(end.id))}
    )


def shared_bone(document: Document, layer: int, frame: float) -> tuple[Layer, Layer] | None:
    """Return a bone of a layer with an IK target that another such layer bends, and that layer."""
    own = bones_above(document, layer, frame)
    for end in layers_with_targets(document) if document.layer(layer).keys_of(IK_TARGET) else ():
        if end.id == layer:
            continue
        for bone in bones_above(document, end.id, frame):
            if bone in own:
                return bone, end
    return None


def _children(document: Document) -> dict[int, set[int]]:
    """Return the ids of all layers that have a layer as parent at some frame, by its id."""
    children: dict[int, set[int]] = {}
    for layer in document.layers:
        for joint in layer.attachments:
            if joint.parent is not None:
                children.setdefault(joint.parent, set()).add(layer.id)
    return children
