"""Pasting keys of channels with values: onto the same channels, or onto layers by their names."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

from app.document import (
    IK_TARGET,
    PARENT,
    TRANSFORM,
    BaseKey,
    Channel,
    Document,
    Key,
    Layer,
    Quantity,
    channel_commands,
    frames_in,
    mirrored_name,
    source_frame,
)
from app.editor.parts.clipboard import CopiedChannel
from app.editor.poses.paste_destinations import (
    PasteMode,
    find_receiving_layers,
    match_handles,
)
from app.editor.project import Project
from app.editor.session import Session
from app.errors import LissomError
from app.texts import message_of

Pasted = Mapping[Channel[Any], Sequence[BaseKey]]


def pasteable_keys(session: Session, project: Project, way: PasteMode) -> Pasted:
    """Return the copied keys of channels with values, by the channel that can take them.

    Channels of the scene and parents go to themselves, others to layers as poses do. A flip mirrors
    transforms, and a swap goes to partners by name.
    """
    document, pasted = project.document, dict[Channel[Any], Sequence[BaseKey]]()
    layers = {each.layer.id for each in session.clipboard.poses}
    layers |= {each.layer.id for each in session.clipboard.tracks}
    layers |= {each.layer.id for each in session.clipboard.channels if each.layer is not None}
    for each in session.clipboard.channels:
        source = each.layer
        if source is None:
            if way == "as it is" and _exists(document, each.channel):
                pasted[each.channel] = each.keys
        elif each.channel.kind is PARENT:
            if document.find_layer(source.id) is not None and way == "as it is":
                pasted[each.channel] = each.keys
        else:
            is_alone = len(layers) == 1
            for layer in find_receiving_layers(project, source, way, is_alone=is_alone):
                channel = _transferred_channel(document, each, source, layer, way)
                if channel is not None:
                    pasted[channel] = [
                        _transferred_key(document, each, key, way) for key in each.keys
                    ]
    return pasted


def paste_keys(
    session: Session, project: Project, pasted: Pasted, by: int, gesture: object
) -> None:
    """Paste keys `by` frames later, and select them.

    A single key of a channel changes all repeats, as a single pose does.
    """
    for channel, keys in pasted.items():
        moved = [key.retimed(key.frame + by, 1.0) for key in keys]
        start = project.document.frames.first
        is_pose = any(each.is_pose for each in session.clipboard.channels)
        if is_pose and channel.kind is TRANSFORM and moved[0].frame > start:
            # Before its first key the layer stays as it was.
            moved = [
                *(
                    []
                    if frames_in(project.document, channel)
                    else [TRANSFORM.key(start, TRANSFORM.default)]
                ),
                *moved,
            ]
        if len(moved) == 1:
            source = source_frame(project.document, channel, moved[0].frame)
            moved = [each if source is None else each.retimed(source, 1.0) for each in moved]
        try:
            project.history.do(channel_commands.insert_keys({channel: moved}), gesture=gesture)
        except LissomError as error:
            session.notices.show(message_of(error))
            continue
        frames = frozenset(key.frame for key in moved)
        project.selection.add_keys(channel, frames)


def _exists(document: Document, channel: Channel[Any]) -> bool:
    names = {each.name for each in document.switch_groups}
    return channel.part is None or channel.part in names


def _transferred_channel(
    document: Document, copied: CopiedChannel, source: Layer, layer: Layer, way: PasteMode
) -> Channel[Any] | None:
    """Return the channel of a layer that takes copied keys; None if a handle is missing."""
    part = copied.channel.part
    if isinstance(part, int):
        pairs = match_handles(source, layer, document.pairs, way)
        part = next((own for own, other in pairs.items() if other == part), None)
        if part is None:
            return None
    return Channel(copied.channel.kind, layer.id, part)


def _transferred_key(
    document: Document, copied: CopiedChannel, key: BaseKey, way: PasteMode
) -> BaseKey:
    """Return a copied key for another layer: mirrored, or with references to partner layers."""
    if not isinstance(key, Key) or way == "as it is":
        return key
    kind, value = copied.channel.kind, key.value
    if kind is TRANSFORM and way == "flipped":
        value = replace(value, shift=-value.shift.conjugate(), turn=-value.turn)
    if kind is IK_TARGET and way == "flipped" and copied.layer is not None:
        # The scene is mirrored at the axis of the layer at the root.
        axis = (copied.layer, *document.all_ancestors(copied.layer.id))[-1].axis
        value = replace(value, place=2 * axis - value.place.conjugate(), turn=-value.turn)
    names = {each.name: each.id for each in document.layers}
    ids = {identity: name for name, identity in names.items()}
    for each in kind.fields:
        other = kind.field_of(value, each.name) if each.quantity is Quantity.LAYER else None
        if other in ids:
            partner = names.get(mirrored_name(ids[other], document.pairs) or "", other)
            value = replace(value, **{each.name: partner}) if len(kind.fields) > 1 else partner
    return key if value == key.value else replace(key.without_velocity(), value=value)
