"""Commands on groups of layers: members, order, opacity and blend modes."""

from collections.abc import Collection, Mapping, Sequence
from dataclasses import replace
from typing import Any

from app.document.commands.command import command
from app.document.commands.layers import switch_group_commands
from app.document.commands.layers.layer_commands import (
    group_at,
    unique_name,
    without_empty_groups,
)
from app.document.layer import Layer
from app.document.layers.groups import BlendMode, Group, ancestor_paths, common_path
from app.document.model import Document
from app.errors import LissomError
from app.texts import _


@command(_("Group layers"))
def group_layers(document: Document, identities: Collection[int], path: str) -> Document:
    """Put layers in a group, or with "" outside all groups; missing groups are created.

    The layers keep their order and go in front of the group's layers. In an empty group, they go
    where the foremost of them was.
    """
    missing = _missing_groups(document, path)
    chosen = [layer for layer in document.layers if layer.id in identities]
    if all(layer.group == path for layer in chosen):
        return document
    others = [layer for layer in document.layers if layer.id not in identities]
    place = _place_in_group(document.layers, others, path)
    others[place:place] = [replace(layer, group=path) for layer in chosen]
    grouped = replace(
        document,
        layers=tuple(others),
        groups=(*document.groups, *missing),
        size=document.canvas,
    )
    return without_empty_groups(grouped)


@command(_("Add groups"))
def add_groups(document: Document, groups: Sequence[Group]) -> Document:
    """Add missing groups, still without layers."""
    known = {group.name for group in document.groups}
    new = tuple(group for group in groups if group.name not in known)
    return replace(document, groups=(*document.groups, *new)) if new else document


@command(_("Move group"))
def move_group_into(document: Document, path: str, around: str) -> Document:
    """Move a group into another group, in front of its layers, or with "" outside all groups."""
    _, others = _apart(document, path)
    return _put_group(document, path, around, _place_in_group(document.layers, others, around))


@command(_("Move group"))
def reorder_group(document: Document, path: str, beside: int, *, in_front: bool) -> Document:
    """Move a group directly in front of or behind a layer outside the group.

    The group joins and leaves outer groups as a moved layer does.
    """
    run, others = _apart(document, path)
    place = others.index(document.layer(beside)) + in_front
    around = group_at(others, place, replace(run[0], group=path.rpartition("/")[0]))
    return _put_group(document, path, around, place)


@command(_("Rename group"))
def rename_group(document: Document, path: str, name: str) -> Document:
    """Rename a group; no group beside it may have the name."""
    document.group(path)
    name = name.strip()
    if "/" in name:
        raise LissomError(
            _("The name of a group must not contain a slash, unlike {name!r}.").format(name=name)
        )
    to = f"{path.rpartition('/')[0]}/{name}".removeprefix("/")
    if to == path:
        return document
    if any(group.name == to for group in document.groups):
        raise LissomError(
            _("A group named {name!r} already exists; choose another name.").format(name=name)
        )
    return _moved(document, document.layers, document.groups, {path: to})


@command(_("Ungroup layers"))
def ungroup_layers(document: Document, path: str) -> Document:
    """Dissolve a group; its layers and subgroups take over its opacity and stay hidden if it was.

    Overlapping layers of a translucent group shine through each other afterwards.
    """
    document = switch_group_commands.without_switch_member(document, path)
    gone, around = document.group(path), path.rpartition("/")[0]
    taken = {group.name for group in document.groups if path not in ancestor_paths(group.name)}
    to = {path: around}
    for group in document.groups:
        outer, _, name = group.name.rpartition("/")
        if outer == path:
            to[group.name] = unique_name(f"{around}/{name}" if around else name, taken)
            taken.add(to[group.name])

    def freed(each: Layer | Group) -> dict[str, Any]:
        return {"hidden": each.hidden or gone.hidden, "opacity": each.opacity * gone.opacity}

    layers = tuple(
        replace(layer, **freed(layer)) if layer.group == path else layer
        for layer in document.layers
    )
    groups = tuple(
        replace(group, **freed(group)) if group.name in to else group
        for group in document.groups
        if group is not gone
    )
    return _moved(document, layers, groups, to)


@command(_("Set group's opacity"))
def set_group_opacity(document: Document, path: str, opacity: float) -> Document:
    return _changed(document, path, opacity=float(opacity))


@command(_("Show or hide group"))
def set_group_hidden(document: Document, path: str, *, hidden: bool) -> Document:
    return _changed(document, path, hidden=hidden)


@command(_("Set group's blend"))
def set_group_blend(document: Document, path: str, blend: BlendMode) -> Document:
    return _changed(document, path, blend=blend)


def _missing_groups(document: Document, path: str) -> list[Group]:
    known = {group.name for group in document.groups}
    return [Group(name=each) for each in ancestor_paths(path) if each not in known]


def _place_in_group(before: Sequence[Layer], others: Sequence[Layer], path: str) -> int:
    """Return the index for layers that join a group, or are its first, among the other layers."""
    for around in reversed(ancestor_paths(path)):
        members = [
            index for index, other in enumerate(others) if around in ancestor_paths(other.group)
        ]
        if members:
            return members[-1] + 1
    kept = {id(other) for other in others}
    foremost = max(index for index, layer in enumerate(before) if id(layer) not in kept)
    place = sum(id(layer) in kept for layer in before[:foremost])
    # Not inside another group.
    while 0 < place < len(others) and common_path(others[place - 1].group, others[place].group):
        place += 1
    return place


def _apart(document: Document, path: str) -> tuple[list[Layer], list[Layer]]:
    """Return the layers of a group, and all other layers."""
    document.group(path)
    run = [layer for layer in document.layers if path in ancestor_paths(layer.group)]
    return run, [layer for layer in document.layers if layer not in run]


def _put_group(document: Document, path: str, around: str, place: int) -> Document:
    """Return the document with a group inside another, at an index among the other layers."""
    if path in ancestor_paths(around):
        raise LissomError(_("The group {path!r} cannot be moved into itself.").format(path=path))
    run, others = _apart(document, path)
    layers = (*others[:place], *run, *others[place:])
    outer, *_rest, name = path.rpartition("/")
    if around == outer and layers == document.layers:
        return document
    inner = [group for group in document.groups if path in ancestor_paths(group.name)]
    rest = [group for group in document.groups if group not in inner]
    to = unique_name(f"{around}/{name}".removeprefix("/"), {group.name for group in rest})
    whole = replace(document, size=document.canvas)
    # An outer group comes before the groups inside it.
    return without_empty_groups(_moved(whole, layers, [*rest, *inner], {path: to}))


def _moved(
    document: Document, layers: Sequence[Layer], groups: Sequence[Group], to: Mapping[str, str]
) -> Document:
    """Return the document with these layers and groups, and with some group paths renamed."""

    def moved(path: str) -> str:
        for outer in reversed(ancestor_paths(path)):
            if outer in to:
                return to[outer] + path[len(outer) :]
        return path

    layers = tuple(
        layer if moved(layer.group) == layer.group else replace(layer, group=moved(layer.group))
        for layer in layers
    )
    switches = switch_group_commands.with_renamed_members(
        document.switch_groups, {group.name: moved(group.name) for group in groups}
    )
    groups = tuple(replace(group, name=moved(group.name)) for group in groups)
    return replace(document, layers=layers, groups=groups, switch_groups=switches)


def _changed(document: Document, path: str, **changes: Any) -> Document:
    group = document.group(path)
    changed = replace(group, **changes)
    if changed == group:
        return document
    groups = tuple(changed if each is group else each for each in document.groups)
    return replace(document, groups=groups)
