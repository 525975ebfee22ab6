"""Commands on deform groups: layers as members of one mesh, with one set of handles."""

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from app.document.channels.kinds import LAYER_KINDS
from app.document.commands.command import command
from app.document.commands.layers.layer_commands import (
    next_layer_id,
    remove_layer,
    unique_layer_name,
)
from app.document.layer import Layer
from app.document.layers.attachments import Attachment
from app.document.layers.groups import common_path
from app.document.model import Document
from app.texts import _


@command(_("Bend as one"))
def bend_as_one(
    document: Document, group: Layer, members: Sequence[Layer], heir: int | None
) -> Document:
    """Put a deform group in front of its members, which are still layers from now on.

    Parameters
    ----------
    group : Layer
        Has the mesh, handles, keys and parents. Its id is free.
    members : sequence of Layer
        The members as still pictures; their ids are those of layers of the document.
    heir : int or None
        Id of the member whose handles and keys the group takes over.
    """
    bent = {each.id: _as_member(document, each, group.id).with_cycles_of(group) for each in members}
    order = [layer for layer in document.layers if layer.id in bent]
    place = document.layers.index(order[-1])
    path = order[0].group
    for layer in order:
        path = common_path(path, layer.group)
    whole = replace(group, group=path, name=unique_layer_name(document, group.name))
    layers = [bent.get(layer.id, layer) for layer in document.layers]
    layers.insert(place + 1, whole)
    layers = [_reparented(each, dict.fromkeys(bent, group.id), heir) for each in layers]
    return replace(document, layers=tuple(layers), size=document.canvas)


def _as_member(document: Document, still: Layer, group: int) -> Layer:
    before = document.layer(still.id)
    channels = {
        (name, part): keys
        for (name, part), keys in still.channels.items()
        if not LAYER_KINDS[name].moves_layer
    }
    return replace(
        still,
        anchor=None,
        attachments=(),
        channels=channels,
        ik_parents=None,
        deform_group=group,
        before_bending=before,
    )


def _reparented(layer: Layer, to: Mapping[int, int], heir: int | None) -> Layer:
    """Return a layer whose parents and drivers that became members are their deform group."""
    joints = tuple(
        replace(joint, parent=to.get(joint.parent, joint.parent))
        if joint.parent is not None
        else joint
        for joint in layer.attachments
    )
    sliders = tuple(
        replace(each, driver=to[heir]) if heir is not None and each.driver == heir else each
        for each in layer.sliders
    )
    if joints == layer.attachments and sliders == layer.sliders:
        return layer
    return replace(layer, attachments=joints, sliders=sliders)


@command(_("Part"))
def part_deform_group(document: Document, identity: int, restored: Mapping[int, Layer]) -> Document:
    """Delete a deform group; its members have their own meshes again.

    `restored` has the members as of `layer_before_bending`, by id. Layers that are attached to the
    group are attached to the front member at the joint, or else to the front member.
    """
    layers = tuple(restored.get(layer.id, layer) for layer in document.layers)
    there = {layer.id: layer for layer in layers}
    front = [layer for layer in reversed(layers) if layer.id in restored]

    def reattached(joint: Attachment) -> Attachment:
        if joint.parent is None:
            return joint
        if joint.parent != identity:
            # Meanwhile the parent of an earlier time may have become a member itself.
            by = there[joint.parent].deform_group
            return joint if by is None else replace(joint, parent=by)
        at = np.array([joint.parent_point])
        parent = next((each for each in front if each.covers(at).all()), front[0])
        place = complex(parent.domain.nearest(at)[0])
        return replace(joint, parent=parent.id, parent_point=place)

    def joined(layer: Layer) -> Layer:
        joints = tuple(
            reattached(joint)
            for joint in layer.attachments
            if joint.parent is None or joint.parent in there
        )
        return layer if joints == layer.attachments else replace(layer, attachments=joints)

    layers = tuple(map(joined, layers))
    whole = replace(document, layers=layers, size=document.canvas)
    first, last = whole.keyed_range
    frames = replace(
        whole.frames, first=min(whole.frames.first, first), last=max(whole.frames.last, last)
    )
    return remove_layer(identity)(replace(whole, frames=frames))


def layer_before_bending(member: Layer) -> Layer:
    """Return a member with the mesh, handles and keys that it had before it became one.

    It keeps what belongs to it alone: name, order, opacity, blend, clipping and visibility.
    """
    before = member.before_bending
    if before is None:
        return replace(member, deform_group=None)
    moving = {
        (name, part): keys
        for (name, part), keys in before.channels.items()
        if part is not None or LAYER_KINDS[name].moves_layer
    }
    return replace(
        before,
        name=member.name,
        opacity=member.opacity,
        blend=member.blend,
        clipped=member.clipped,
        group=member.group,
        hidden=member.hidden,
        locked=member.locked,
        reference=member.reference,
        origin=member.origin,
        cycles=before.cycles,
        channels={**moving, **member.channels},
    )


@command(_("Duplicate layer"))
def duplicate_deform_group(document: Document, identity: int) -> Document:
    """Copy a deform group with its members, each in front of its original."""
    free, group = next_layer_id(document), document.layer(identity)
    copied = (group, *document.deform_members(identity))
    ids = {layer.id: free + number for number, layer in enumerate(copied)}
    layers: list[Layer] = []
    for layer in document.layers:
        layers.append(layer)
        if layer.id in ids:
            name = unique_layer_name(document, f"{layer.name} copy")
            by = None if layer.deform_group is None else ids[layer.deform_group]
            layers.append(replace(layer, id=ids[layer.id], name=name, deform_group=by))
    return replace(document, layers=tuple(layers), size=document.canvas)
