"""Layers and groups that may become switch groups."""

import re
from collections.abc import Collection

from app.document.channels.kinds import VISIBILITY, SwitchMember
from app.document.layer import Layer
from app.document.layers.groups import ancestor_paths
from app.document.model import Document

# Parts of which a character has one.
MOUTHS = re.compile(r"mouths?|lips?|visemes?|phonemes?", re.IGNORECASE)
# Parts with two sides, which are visible together: suggested only if at most one is visible.
SIDES = re.compile(r"eyes?|(eye)?lids?|brows?|blinks?|hands?|fists?|poses?", re.IGNORECASE)


def suggest_switch_groups(
    document: Document,
) -> tuple[tuple[str, tuple[SwitchMember, ...]], ...]:
    """Return group paths named like mouths, eyes or hands, with their layers and subgroups.

    A layer name such as "mouth/ah" counts as a group. Groups with a layer that has visibility keys
    are left out, and groups with a member of a switch group.
    """
    together: dict[str, list[SwitchMember]] = {group.name: [] for group in document.groups}
    for group in document.groups:
        # Clipped layers and groups, such as a tongue in a mouth, are not alternatives.
        around = group.name.rpartition("/")[0]
        if around and not group.clipped:
            together[around].append(group.name)
    for layer in document.layers:
        if not layer.clipped:
            together.setdefault(_place(layer), []).append(layer.id)
    found = []
    for path, members in together.items():
        if len(members) < 2:
            continue
        words = re.split(r"[^a-zA-Z]+", path.rpartition("/")[2])
        shown = sum(not _is_hidden(document, member) for member in members)
        is_mouth = any(MOUTHS.fullmatch(word) for word in words)
        is_one = any(SIDES.fullmatch(word) for word in words) and shown <= 1
        is_free = all(_is_free(document, member) for member in members)
        if is_free and (is_mouth or is_one):
            found.append((path, tuple(members)))
    return tuple(found)


def find_switch_members(document: Document, layers: Collection[int]) -> tuple[SwitchMember, ...]:
    """Return the members of a switch of these layers: whole groups among them, and other layers.

    The group of all of them is none.
    """
    inside: dict[str, set[int]] = {}
    for layer in document.layers:
        for path in ancestor_paths(layer.group):
            inside.setdefault(path, set()).add(layer.id)
    whole = {path for path, ids in inside.items() if ids < {*layers}}
    members: list[SwitchMember] = []
    for layer in document.layers:
        if layer.id in layers:
            found = (each for each in ancestor_paths(layer.group) if each in whole)
            members.append(next(found, layer.id))
    return tuple(dict.fromkeys(members))


def _is_hidden(document: Document, member: SwitchMember) -> bool:
    if isinstance(member, str):
        return document.group(member).hidden
    return document.layer(member).hidden


def _place(layer: Layer) -> str:
    """Return the path of a layer's group, with the groups in the layer's name."""
    # If a name was in use, the importer put the group's path before it.
    name = layer.name.removeprefix(f"{layer.group}/") if layer.group else layer.name
    around = [part.strip() for part in name.split("/")[:-1]]
    return "/".join(filter(None, [layer.group, *around]))


def _is_free(document: Document, member: SwitchMember) -> bool:
    if document.switch_group_of(member) is not None:
        return False
    return isinstance(member, str) or not document.layer(member).keys_of(VISIBILITY)
