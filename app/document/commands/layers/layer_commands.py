"""Commands on layers: add, delete, order, blend, visibility, attachments and depth."""

from collections.abc import Collection, Sequence
from dataclasses import replace

import numpy as np

from app.document.channels.kinds import VISIBILITY
from app.document.commands.command import command, layer_command, with_number
from app.document.commands.handle_commands import with_handles
from app.document.commands.layers import switch_group_commands
from app.document.commands.layers.hidden import with_layer_shown
from app.document.commands.layers.removal import without_layer
from app.document.keyframe import Pose, Target
from app.document.layer import Layer
from app.document.layers.attachments import Attachment
from app.document.layers.groups import BlendMode, ancestor_paths, common_path
from app.document.model import Document
from app.document.queries.channel_values.repeats import keyed_frame
from app.errors import ImportLog, LissomError
from app.texts import N_, _

LAST_LAYER = N_("A document must have at least one layer. Add another layer first.")


@command(_("Add layer"))
def add_layer(document: Document, layer: Layer, index: int | None = None) -> Document:
    """Add a layer in front of all others, or at an index from back to front.

    The id must be free, as from `next_layer_id`. A name in use gets a number.
    """
    layers = list(document.layers)
    place = len(layers) if index is None else index
    group, name = group_at(layers, place, layer), unique_layer_name(document, layer.name)
    layers.insert(place, replace(layer, name=name, group=group))
    # The canvas keeps its size even if it was that of the rearmost picture.
    return replace(document, layers=tuple(layers), size=document.canvas)


@command(_("Add layers"))
def append_import_log(document: Document, summary: ImportLog) -> Document:
    return replace(document, import_log=document.import_log + summary) if summary else document


@command(_("Replace layer"))
def replace_layer(document: Document, identity: int, layer: Layer) -> Document:
    """Replace a layer with another of the same id.

    Child layers stay attached. A joint beside the new shape moves to its nearest point.
    """
    size = document.canvas
    changed = keep_attachments(identity)(document.with_layer(replace(layer, id=identity)))
    return changed if changed.canvas == size else replace(changed, size=size)


@command(_("Move joints onto shape"))
def keep_attachments(document: Document, identity: int) -> Document:
    """Move joints that are not on the layer's shape to the nearest points of the shape."""
    domain = document.layer(identity).domain
    for child in document.layers:
        places = np.array([joint.parent_point for joint in child.attachments], dtype=np.complex128)
        nearest = domain.nearest(places) if len(places) else places
        joints = tuple(
            replace(joint, parent_point=complex(at))
            if joint.parent == identity and at != joint.parent_point
            else joint
            for joint, at in zip(child.attachments, nearest, strict=True)
        )
        if joints != child.attachments:
            document = document.with_layer(replace(child, attachments=joints))
    return document


@command(_("Duplicate layer"))
def duplicate_layer(document: Document, identity: int) -> Document:
    """Put a copy of a layer in front of it, in the same switch group."""
    layer = document.layer(identity)
    index = document.layers.index(layer)
    copy = replace(
        layer, id=next_layer_id(document), name=unique_layer_name(document, f"{layer.name} copy")
    )
    layers = (*document.layers[: index + 1], copy, *document.layers[index + 1 :])
    choices = tuple(
        replace(each, members=(*each.members, copy.id)) if identity in each.members else each
        for each in document.switch_groups
    )
    return replace(document, layers=layers, switch_groups=choices, size=document.canvas)


@command(_("Delete layer"))
def remove_layer(document: Document, identity: int) -> Document:
    """Delete a layer, and the keys of other layers that refer to the layer.

    A deform group is deleted with its members, and without members it is deleted, too.
    """
    by = document.layer(identity).deform_group
    if by is not None and len(document.deform_members(by)) == 1:
        identity = by
    gone = [*(each.id for each in document.deform_members(identity)), identity]
    if len(document.layers) == len(gone):
        raise LissomError(_(LAST_LAYER))
    for each in gone:
        document = without_layer(document, each)
    return without_empty_groups(document)


@command(_("Move layer"))
def move_layer(document: Document, identity: int, index: int) -> Document:
    """Move a layer to an index in the order from back to front.

    The layer stays in its groups as long as it lies next to another member. It joins groups between
    whose members it lies.
    """
    layer = document.layer(identity)
    others = [other for other in document.layers if other is not layer]
    if not 0 <= index <= len(others):
        raise LissomError(
            _("There are {count} layers, so a layer cannot be number {index}.").format(
                count=len(others) + 1, index=index + 1
            )
        )
    if document.layers[index] is layer:
        return document
    group = group_at(others, index, layer)
    others.insert(index, layer if group == layer.group else replace(layer, group=group))
    moved = replace(document, layers=tuple(others), size=document.canvas)
    return without_empty_groups(moved)


@command(_("Rename layer"))
def rename_layer(document: Document, identity: int, name: str) -> Document:
    """Rename a layer; the name must be free."""
    return _with(document, identity, name=name.strip())


@command(_("Set opacity"))
def set_opacity(document: Document, identity: int, opacity: float) -> Document:
    return _with(document, identity, opacity=float(opacity))


@command(_("Set blend"))
def set_blend(document: Document, identity: int, blend: BlendMode) -> Document:
    return _with(document, identity, blend=blend)


@command(_("Clip layer"))
def set_clipped(document: Document, identity: int, *, clipped: bool) -> Document:
    """Turn clipping of a layer to the layer or group below it on or off."""
    return _with(document, identity, clipped=clipped)


@command(_("Show or hide layer"))
def set_hidden(document: Document, identity: int, *, hidden: bool) -> Document:
    """Hide a layer at all frames, or show it."""
    return _with(document, identity, hidden=hidden)


@command(_("Show layer"))
def show_layer(document: Document, identity: int) -> Document:
    """Show a layer and the groups around it; their other members become hidden."""
    return with_layer_shown(document, identity)


@command(_("Lock or unlock layer"))
def set_locked(document: Document, identity: int, *, locked: bool) -> Document:
    """Let clicks on the drawing pass through a layer, or not."""
    return _with(document, identity, locked=locked)


@command(_("Set reference"))
def set_reference(document: Document, identity: int, *, reference: bool) -> Document:
    """Exclude a layer from exports, or include it."""
    return _with(document, identity, reference=reference)


@command(_("Set visibility key"))
def key_visibility(document: Document, identity: int, frame: int, *, visible: bool) -> Document:
    """Show or hide a layer from a frame on.

    In a cycle, the key repeats. A layer that was hidden at all frames stays hidden before the
    frame.
    """
    layer = document.layer(identity)
    keys = layer.keys_of(VISIBILITY)
    frame = keyed_frame(VISIBILITY, keys, layer.cycles, frame)
    if visible and (layer.hidden or document.is_in_hidden(layer)):
        document = with_layer_shown(document, identity)
        layer = document.layer(identity)
        keys = keys or (VISIBILITY.key(0, value=False),)
    others = [key for key in keys if key.frame != frame]
    if not keys and frame > 0:
        # The layer keeps its visibility before the frame.
        others = [VISIBILITY.key(0, not visible)]
    ordered = sorted([*others, VISIBILITY.key(frame, visible)], key=lambda key: key.frame)
    return document.with_layer(layer.with_keys_of(VISIBILITY, ordered))


@command(_("Attach"))
def attach_layer(document: Document, identity: int, anchor: complex, joint: Attachment) -> Document:
    """Attach a layer by its anchor to a point of another layer from a frame on.

    An attachment key at that frame is replaced, and circles are refused. `app.motion` computes the
    joint that keeps the layer in place.
    """
    joints = [each for each in document.layer(identity).attachments if each.frame != joint.frame]
    joints = sorted([*joints, joint], key=lambda each: each.frame)
    return _with(document, identity, anchor=anchor, attachments=tuple(joints))


@command(_("Detach"))
def detach_layer(document: Document, identity: int, factor: complex, shift: complex) -> Document:
    """Remove all parents of a layer, and transform its poses to where it was seen at one frame.

    All poses are rotated by `factor`, of modulus 1, and then translated by `shift`.
    """
    layer = document.layer(identity)
    if not layer.attachments:
        return document
    poses = (_transformed_pose(layer, pose, factor, shift) for pose in layer.poses)
    return document.with_layer(layer.with_poses(poses, attachments=()))


@layer_command(_("Set depth"))
def set_depth(layer: Layer, identity: int, front: float, extent: float | None) -> Layer:
    """Set the default depth around a handle and its radius."""
    return with_handles(layer, {identity}, depth=float(front), extent=extent)


def next_layer_id(document: Document) -> int:
    return 1 + max(layer.id for layer in document.layers)


def unique_layer_name(document: Document, name: str) -> str:
    """Return a free layer name: this name, or this name with a number."""
    return unique_name(name, {layer.name for layer in document.layers})


def unique_name(name: str, taken: Collection[str]) -> str:
    """Return a free name: this name, or this name with a number."""
    return with_number(name, taken, 2) if name in taken else name


def without_empty_groups(document: Document) -> Document:
    """Return the document without groups that contain no layer."""
    filled = {path for layer in document.layers for path in ancestor_paths(layer.group)}
    groups = tuple(group for group in document.groups if group.name in filled)
    if groups == document.groups:
        return document
    for path in {group.name for group in document.groups} - filled:
        document = switch_group_commands.without_switch_member(document, path)
    return replace(document, groups=groups)


def group_at(others: Sequence[Layer], index: int, layer: Layer) -> str:
    """Return the group of a layer after it is put at an index among the others."""
    own, beside = layer.group, [each.group for each in others[max(index - 1, 0) : index + 1]]
    amid = common_path(*beside) if len(beside) == 2 else ""
    if amid and amid not in ancestor_paths(own):
        return amid
    stays = max((common_path(own, group) for group in beside), key=len, default="")
    shared = max((common_path(own, each.group) for each in others), key=len, default="")
    # A layer leaves groups whose other members all lie elsewhere; it keeps a group of its own.
    return own if stays == shared else stays


def _with(document: Document, identity: int, **changes: object) -> Document:
    layer = document.layer(identity)
    if all(getattr(layer, name) == value for name, value in changes.items()):
        return document
    return document.with_layer(replace(layer, **changes))  # type: ignore[arg-type]


def _transformed_pose(layer: Layer, pose: Pose, factor: complex, shift: complex) -> Pose:
    moved = layer.map_of(pose).moved(factor, shift)
    turn = float(np.angle(factor))
    targets = {
        identity: Target(
            position=factor * target.position + shift,
            rotation=None if target.rotation is None else target.rotation + turn,
            unknown=target.unknown,
        )
        for identity, target in pose.targets.items()
    }
    return replace(pose.with_map(moved), targets=targets)
