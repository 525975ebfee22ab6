"""Groups whose layers look as if they take turns."""

import re

from app.document.figure import Figure
from app.document.layering import Group
from app.document.model import Document

# Of these there is one at a time.
MOUTHS = re.compile(r"mouths?|lips?|visemes?|phonemes?", re.IGNORECASE)
# Of these there are two sides, which do not take turns: only where no more than one is seen.
SIDES = re.compile(r"eyes?|(eye)?lids?|brows?|blinks?|hands?|fists?|poses?", re.IGNORECASE)


def alternates(document: Document) -> tuple[tuple[Group, tuple[int, ...]], ...]:
    """Return the groups that are named like mouths, eyes or hands, with the ids of their layers.

    Those of which a layer is seen at frames of its own, or takes turns already, are left out.
    """
    found = []
    for group in document.groups:
        members = [figure for figure in document.figures if figure.group == group.name]
        words = re.split(r"[^a-zA-Z]+", group.name.rpartition("/")[2])
        shown = sum(not figure.hidden for figure in members)
        is_mouth = any(MOUTHS.fullmatch(word) for word in words)
        is_one = any(SIDES.fullmatch(word) for word in words) and shown <= 1
        is_free = all(_is_free(document, figure) for figure in members)
        if len(members) > 1 and is_free and (is_mouth or is_one):
            found.append((group, tuple(figure.id for figure in members)))
    return tuple(found)


def _is_free(document: Document, figure: Figure) -> bool:
    return not figure.switches and document.choice_of(figure.id) is None
