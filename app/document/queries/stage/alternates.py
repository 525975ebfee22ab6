"""Layers that look as if they take turns."""

import re
from collections import Counter

from app.document.figure import Figure
from app.document.layering import paths_to
from app.document.model import Document

# Of these there is one at a time.
MOUTHS = re.compile(r"mouths?|lips?|visemes?|phonemes?", re.IGNORECASE)
# Of these there are two sides, which do not take turns: only where no more than one is seen.
SIDES = re.compile(r"eyes?|(eye)?lids?|brows?|blinks?|hands?|fists?|poses?", re.IGNORECASE)


def alternates(document: Document) -> tuple[tuple[str, tuple[int, ...]], ...]:
    """Return paths of groups that are named like mouths, eyes or hands, with the ids of layers.

    Layers whose names are as "mouth/ah" count as if they were in such a group. Those of which a
    layer is seen at frames of its own, or takes turns already, are left out.
    """
    together: dict[str, list[Figure]] = {group.name: [] for group in document.groups}
    for figure in document.figures:
        # What is painted onto another one, as a tongue onto a mouth, takes no turns with it.
        if not figure.clipped:
            together.setdefault(_place(figure), []).append(figure)
    found = []
    for path, members in together.items():
        if len(members) < 2:
            continue
        words = re.split(r"[^a-zA-Z]+", path.rpartition("/")[2])
        shown = sum(not figure.hidden for figure in members)
        is_mouth = any(MOUTHS.fullmatch(word) for word in words)
        is_one = any(SIDES.fullmatch(word) for word in words) and shown <= 1
        is_free = all(_is_free(document, figure) for figure in members)
        if is_free and (is_mouth or is_one):
            found.append((path, tuple(figure.id for figure in members)))
    return tuple(found)


def whole_groups(document: Document, path: str) -> tuple[str, ...]:
    """Return the names of groups right in a group that have several layers.

    These would take turns one by one, as lips and teeth of one mouth: none of them is a whole.
    """
    inside = Counter(each for figure in document.figures for each in paths_to(figure.group))
    found = (group.name.rpartition("/") for group in document.groups if inside[group.name] > 1)
    return tuple(name for around, _, name in found if around == path)


def _place(figure: Figure) -> str:
    """Return the path of the group that a layer is in, by its name, too."""
    # Where a name was taken, its group's path stands before it.
    name = figure.name.removeprefix(f"{figure.group}/") if figure.group else figure.name
    around = [part.strip() for part in name.split("/")[:-1]]
    return "/".join(filter(None, [figure.group, *around]))


def _is_free(document: Document, figure: Figure) -> bool:
    return not figure.switches and document.choice_of(figure.id) is None
