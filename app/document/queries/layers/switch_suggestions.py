"""Suggestions of layers for switch groups."""

import re
from collections import Counter

from app.document.channels.kinds import VISIBILITY
from app.document.layer import Layer
from app.document.layers.groups import ancestor_paths
from app.document.model import Document

# Parts of which a character has one.
MOUTHS = re.compile(r"mouths?|lips?|visemes?|phonemes?", re.IGNORECASE)
# Parts with two sides, which are visible together: suggested only if at most one is visible.
SIDES = re.compile(r"eyes?|(eye)?lids?|brows?|blinks?|hands?|fists?|poses?", re.IGNORECASE)


def suggest_switch_groups(document: Document) -> tuple[tuple[str, tuple[int, ...]], ...]:
    """Return group paths named like mouths, eyes or hands, with the ids of their layers.

    A layer name such as "mouth/ah" counts as a group. Groups with a layer that has visibility keys
    or a switch group are left out.
    """
    together: dict[str, list[Layer]] = {group.name: [] for group in document.groups}
    for layer in document.layers:
        # Clipped layers, such as a tongue in a mouth, are not alternatives.
        if not layer.clipped:
            together.setdefault(_place(layer), []).append(layer)
    found = []
    for path, members in together.items():
        if len(members) < 2:
            continue
        words = re.split(r"[^a-zA-Z]+", path.rpartition("/")[2])
        shown = sum(not layer.hidden for layer in members)
        is_mouth = any(MOUTHS.fullmatch(word) for word in words)
        is_one = any(SIDES.fullmatch(word) for word in words) and shown <= 1
        is_free = all(_is_free(document, layer) for layer in members)
        if is_free and (is_mouth or is_one):
            found.append((path, tuple(layer.id for layer in members)))
    return tuple(found)


def subgroups_with_layers(document: Document, path: str) -> tuple[str, ...]:
    """Return the names of direct subgroups with several layers.

    A switch group of their layers would show parts of a whole one by one, such as lips and teeth.
    """
    inside = Counter(each for layer in document.layers for each in ancestor_paths(layer.group))
    found = (group.name.rpartition("/") for group in document.groups if inside[group.name] > 1)
    return tuple(name for around, _, name in found if around == path)


def _place(layer: Layer) -> str:
    """Return the path of a layer's group, with the groups in the layer's name."""
    # If a name was in use, the importer put the group's path before it.
    name = layer.name.removeprefix(f"{layer.group}/") if layer.group else layer.name
    around = [part.strip() for part in name.split("/")[:-1]]
    return "/".join(filter(None, [layer.group, *around]))


def _is_free(document: Document, layer: Layer) -> bool:
    return not layer.keys_of(VISIBILITY) and document.switch_group_of(layer.id) is None
