"""Layers that look as if they take turns."""

import re
from collections import Counter

from app.document.layer import Layer
from app.document.layers import ancestor_paths
from app.document.model import Document

# Of these there is one at a time.
MOUTHS = re.compile(r"mouths?|lips?|visemes?|phonemes?", re.IGNORECASE)
# Of these there are two sides, which do not take turns: only where no more than one is seen.
SIDES = re.compile(r"eyes?|(eye)?lids?|brows?|blinks?|hands?|fists?|poses?", re.IGNORECASE)


def suggest_switch_groups(document: Document) -> tuple[tuple[str, tuple[int, ...]], ...]:
    """Return paths of groups that are named like mouths, eyes or hands, with the ids of layers.

    Layers whose names are as "mouth/ah" count as if they were in such a group. Those of which a
    layer is seen at frames of its own, or takes turns already, are left out.
    """
    together: dict[str, list[Layer]] = {group.name: [] for group in document.groups}
    for layer in document.layers:
        # What is painted onto another one, as a tongue onto a mouth, takes no turns with it.
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
    """Return the names of groups right in a group that have several layers.

    These would take turns one by one, as lips and teeth of one mouth: none of them is a whole.
    """
    inside = Counter(each for layer in document.layers for each in ancestor_paths(layer.group))
    found = (group.name.rpartition("/") for group in document.groups if inside[group.name] > 1)
    return tuple(name for around, _, name in found if around == path)


def _place(layer: Layer) -> str:
    """Return the path of the group that a layer is in, by its name, too."""
    # Where a name was taken, its group's path stands before it.
    name = layer.name.removeprefix(f"{layer.group}/") if layer.group else layer.name
    around = [part.strip() for part in name.split("/")[:-1]]
    return "/".join(filter(None, [layer.group, *around]))


def _is_free(document: Document, layer: Layer) -> bool:
    return not layer.visibility_keys and document.switch_group_of(layer.id) is None
