"""Applying relations and channels of layers in a pose script to a document."""

from dataclasses import replace
from typing import Any

import numpy as np

from app.document import (
    DEPTH,
    DRAW_ORDER,
    LAYER_KINDS,
    SWITCH,
    VISIBILITY,
    Attachment,
    ChannelKeys,
    ChannelKind,
    Document,
    Key,
    Layer,
    SwitchMember,
    attachments_repeat,
    channels_in,
    describe_channel,
    is_switch_in_cycle,
    is_visible,
    keys_in,
    layer_commands,
    repeating_cycle,
    switch_group_commands,
)
from app.errors import LissomError, join_names
from app.motion import ParentTransforms, anchor_or_default, reparent_in_place
from app.solving.deform_group.bending import bend_as_one
from app.solving.script.layers import ScriptAttachment
from app.solving.script.pose_script import LayerScript, PoseScript
from app.storage import decode_picture
from app.texts import _, message_of
from engine.errors import EngineError


def find_layer(document: Document, name: str) -> Layer:
    names = {layer.name: layer for layer in document.layers}
    if name not in names:
        raise LissomError(
            _("there is no layer {name!r}; choose from: {names}").format(
                name=name, names=join_names([*names])
            )
        )
    return names[name]


def find_member(document: Document, name: str) -> SwitchMember:
    """Return the layer of a name, or else the group with this path, as a member of a switch."""
    if any(group.name == name for group in document.groups):
        is_layer = any(layer.name == name for layer in document.layers)
        return find_layer(document, name).id if is_layer else name
    return find_layer(document, name).id


def with_deform_groups(document: Document, script: PoseScript) -> Document:
    """Return a document in which the script's layers bend as one; each group is a new layer."""
    for part in script.layers:
        if not part.members:
            continue
        try:
            members = [find_layer(document, name) for name in part.members]
            pictures = {each.id: decode_picture(each.picture.data, each.name) for each in members}
            made = bend_as_one(document, pictures.keys(), pictures, name=part.layer)
        except (LissomError, EngineError) as error:
            raise LissomError(
                _("layers {layers}: {error}").format(
                    layers=join_names(part.members), error=message_of(error)
                )
            ) from error
        if part.layer in {layer.name for layer in document.layers}:
            text = _("the group of {layers} needs a name of its own, not {name!r}")
            raise LissomError(text.format(layers=join_names(part.members), name=part.layer))
        document = made.command(document)
    return document


def with_attachments(document: Document, identity: int, part: LayerScript) -> Document:
    """Return a document with the script's attachments, on undeformed layers.

    A joint without a point is at the parent's point nearest to the layer's anchor.
    """
    layer = document.layer(identity)
    if not part.attach:
        return document
    given = part.attach[0].at if part.anchor is None else part.anchor
    anchor = anchor_or_default(layer) if given is None else given
    joints = tuple(_attachment(document, joint, anchor) for joint in part.attach)
    if part.anchor is None and not layer.covers(np.array([anchor])).all():
        raise LissomError(
            _(
                "it is attached at ({x:g}, {y:g}), where only {parent!r} has a shape. Give the "
                "layer an anchor, or choose a point on both layers"
            ).format(x=anchor.real, y=anchor.imag, parent=part.attach[0].to)
        )
    return document.with_layer(replace(layer, anchor=anchor, attachments=joints))


def _attachment(document: Document, joint: ScriptAttachment, anchor: complex) -> Attachment:
    at, parent = joint.at, None if joint.to is None else find_layer(document, joint.to)
    parent = parent and document.deform_layer(parent)
    if parent is not None and at is None:
        at = complex(parent.domain.nearest(np.array([anchor]))[0])
    elif parent is not None and at is not None and not parent.covers(np.array([at])).all():
        raise LissomError(
            _(
                "it is attached at ({x:g}, {y:g}), but {parent!r} has no shape there; choose a "
                "point on both layers"
            ).format(x=at.real, y=at.imag, parent=parent.name)
        )
    return Attachment(
        parent=None if parent is None else parent.id,
        parent_point=at or 0j,
        inherits_rotation=joint.turns,
        frame=joint.frame,
        keep_world_transform=joint.keeps,
    )


def with_world_transforms(document: Document, script: PoseScript) -> Document:
    """Return a posed document; attachments without a point get the nearest point.

    The nearest point is known only after all layers are posed.
    """
    for part in script.layers:
        for joint in part.attach:
            if part.layer is None or joint.to is None or joint.at is not None:
                continue
            child = find_layer(document, part.layer)
            parent = document.deform_layer(find_layer(document, joint.to))
            nearest = reparent_in_place(
                ParentTransforms(document), child.id, parent.id, joint.frame, turns=joint.turns
            )
            document = layer_commands.attach_layer(child.id, anchor_or_default(child), nearest)(
                document
            )
    return document


def resolve_channels(document: Document, layer: Layer, part: LayerScript) -> ChannelKeys:
    """Return the channels of a layer, with the ids of handles and layers."""
    handles = {handle.name: handle.id for handle in layer.handles}
    channels: dict[tuple[str, int | str | None], tuple[Key[Any], ...]] = {}
    for (name, handle), keys in part.channels.items():
        kind = LAYER_KINDS[name]
        try:
            resolved = tuple(_with_layer_ids(document, kind, key) for key in keys)
        except LissomError as error:
            raise LissomError(f"{_(kind.label)}: {error}") from error
        channels[name, None if handle is None else handles[str(handle)]] = resolved
    return channels


def _with_layer_ids(document: Document, kind: ChannelKind[Any], key: Key[Any]) -> Key[Any]:
    """Return a key with ids of layers instead of their names."""
    names = {field: kind.field_of(key.value, field) for field in kind.layer_fields}
    found = {
        field: find_layer(document, name).id for field, name in names.items() if name is not None
    }
    return replace(key, value=replace(key.value, **found)) if found else key


def with_switch_groups(document: Document, script: PoseScript) -> Document:
    """Return a document with the script's switch groups, whatever is hidden in the drawing."""
    for given in script.choices:
        try:
            members = {name: find_member(document, name) for name in given.layers}
        except LissomError as error:
            raise LissomError(
                _("switch {name!r}: {error}").format(name=given.name, error=error)
            ) from error
        form = switch_group_commands.create_switch_group(given.name, tuple(members.values()))
        document = form(document)
        keys = tuple(SWITCH.key(key.frame, members[key.value]) for key in given.keys)
        (*others, made) = document.switch_groups
        document = replace(document, switch_groups=(*others, replace(made, keys=keys)))
    return document


def warn_unused_cycles(layer: Layer, part: LayerScript) -> list[str]:
    """Return notices of cycles without keys, and of channels that do not repeat in a cycle."""
    keyed = [key.frame for key in part.keys]
    keyed += [key.frame for keys in layer.channels.values() for key in keys]
    notices = [
        _("{cycle} contain no key, so nothing repeats; set a key there").format(
            cycle=cycle.description
        )
        for cycle in part.cycles
        if not (
            any(map(cycle.contains, keyed))
            or any(cycle.repeats_keys(track.keys) for track in layer.tracks)
            or attachments_repeat(layer.attachments, cycle)
        )
    ]
    for (name, _part), keys in layer.channels.items():
        kind = LAYER_KINDS[name]
        cycle = next((each for each in layer.cycles if each.repeats_keys(keys)), None)
        if cycle is None or kind.is_held or len(keys) < 2:
            continue
        if repeating_cycle(kind, keys, layer.cycles) is None:
            notices.append(
                _(
                    "{channel} does not repeat, because it ends differently than it starts in "
                    "{cycle}"
                ).format(channel=_(kind.label), cycle=cycle.description)
            )
    for cycle in part.cycles:
        changes = any(cycle.first < joint.frame < cycle.last for joint in layer.attachments)
        if changes and not attachments_repeat(layer.attachments, cycle):
            notices.append(
                _(
                    "its attachments do not repeat with {cycle}: the parent also changes in the "
                    "repeats, or differs at their start and end"
                ).format(cycle=cycle.description)
            )
    return notices


def warn_unused_switches(document: Document) -> list[str]:
    """Return notices of switch groups whose cycle some of their layers lack."""
    notices = []
    for choice in document.switch_groups:
        layers = document.moving_layers(choice)
        cycles = dict.fromkeys(cycle for each in layers for cycle in each.cycles)
        cycle = next((each for each in cycles if is_switch_in_cycle(choice, each)), None)
        others = [each.name for each in layers if cycle not in each.cycles]
        if cycle is not None and others:
            notices.append(
                _(
                    "switch {name!r}: its keys do not repeat, because {cycle} do not repeat in "
                    "{layers}. Give all its layers that cycle, or leave the cycle out"
                ).format(name=choice.name, cycle=cycle.description, layers=", ".join(others))
            )
    return notices


def warn_invisible_layers(document: Document, script: PoseScript) -> list[str]:
    """Return notices of layers in the script that are never visible."""
    first, last = document.frames.first, document.frames.last
    notices = []
    for part in script.layers:
        if part.layer is None:
            continue
        layer = find_layer(document, part.layer)
        choice = document.switch_group_of(layer.id)
        late = [key.frame for key in layer.keys_of(VISIBILITY) if key.value and key.frame > last]
        if any(is_visible(document, layer, frame) for frame in range(first, last + 1)):
            continue
        if choice is not None:
            notices.append(
                _("{layer} is never visible: the switch {name!r} never shows it").format(
                    layer=part.layer, name=choice.name
                )
            )
        elif (VISIBILITY.name, None) not in part.channels:
            notices.append(
                _(
                    "{layer} is hidden in the drawing and never visible; show it with "
                    '"visible": [[0, true]]'
                ).format(layer=part.layer)
            )
        elif late:
            notices.append(
                _(
                    "{layer} is never visible: it is shown from frame {frame} on, but the "
                    "animation ends at frame {last}"
                ).format(layer=part.layer, frame=late[0], last=last)
            )
        else:
            notices.append(
                _('{layer} is never visible: its "visible" shows it at no frame').format(
                    layer=part.layer
                )
            )
    late_changes = [
        (_("switch {name!r}: {layer}").format(name=given.name, layer=key.value), key.frame)
        for given in script.choices
        for key in given.keys
    ]
    for part in script.layers:
        parent = _("the parent of {layer}").format(layer=part.layer)
        late_changes += [(parent, joint.frame) for joint in part.attach]
    for channel in channels_in(document):
        if channel.kind in (DRAW_ORDER, DEPTH):
            what = describe_channel(document, channel)
            late_changes += [(what, key.frame) for key in keys_in(document, channel)]
    return notices + [
        _("{what} from frame {frame} on has no effect: the animation ends at frame {last}").format(
            what=what, frame=frame, last=last
        )
        for what, frame in late_changes
        if frame > last
    ]
