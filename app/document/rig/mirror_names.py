"""Mirror pairs of handles and layers, by name or by position."""

from collections.abc import Iterable, Iterator, Mapping
from functools import lru_cache

import numpy as np

from app.document.checks import require, require_distinct
from app.document.keyframe import Handle
from app.errors import LissomError
from app.texts import N_, _
from engine.arrays import Complexes
from engine.geometry import diameter

# Fraction of the shape's diameter: handles that mirror each other this closely form a pair.
PAIR_DISTANCE = 0.03
# Words or whole names for one side and for the other.
SidePairs = tuple[tuple[str, str], ...]
SIDES: SidePairs = (("L", "R"), ("left", "right"))
MAX_PAIRS = 1_000  # each name is compared with all pairs
PAIRS: SidePairs = (*SIDES, ("near", "far"))
NO_PAIR = N_(
    "“{words}” is not a pair. Write two words or whole names with a slash between, as in "
    "near/far, and commas between pairs."
)


@lru_cache(maxsize=4096)
def mirrored_name(name: str, pairs: SidePairs = PAIRS) -> str | None:
    """Return the mirrored name of a handle or a layer; None without a side in the name.

    A pair of whole names comes first. A longer word counts at the borders of words, as in
    "handLeftUpper", but not in "bright" or "cleft". A single letter counts if it stands alone:
    ".L", "_r", "L arm", "arm.l.001". The last of several counts, as in "right tail.L". The case is
    kept.
    """
    both_ways = [*pairs, *((other, word) for word, other in pairs)]
    for word, other in both_ways:
        if name == word:
            return other
    found = [
        (start, form, instead)
        for word, other in both_ways
        for form, instead in _forms(word, other).items()
        for start in _places(name, form)
    ]
    if not found:
        return None
    start, form, instead = max(found, key=lambda each: (each[0], len(each[1])))
    return name[:start] + instead + name[start + len(form) :]


def _forms(word: str, other: str) -> Mapping[str, str]:
    """Return the spellings of a word, each with the same spelling of the other word."""
    ways = (str.upper, str.capitalize, str.lower)
    return {way(word): way(other) for way in ways} | {word: other}


def _places(name: str, form: str) -> Iterator[int]:
    """Yield the positions of a form in a name where it stands as a word of its own."""
    start = name.find(form)
    while start >= 0:
        before, after = name[:start][-1:], name[start + len(form) :][:1]
        if len(form) == 1:
            is_word = not (before.isalnum() or after.isalnum())
        else:
            begins = not before.isalpha() or (before.islower() and form[0].isupper())
            is_number = (before + form[0]).isdecimal() and before != ""
            is_number |= (form[-1] + after).isdecimal() and after != ""
            is_word = begins and not after.islower() and not is_number
        if is_word:
            yield start
        start = name.find(form, start + 1)


def require_pairs(pairs: SidePairs) -> None:
    """Refuse empty words and words that occur twice."""
    require(
        len(pairs) <= MAX_PAIRS,
        N_("There can be at most {most:,} pairs, not {count:,}."),
        most=MAX_PAIRS,
        count=len(pairs),
    )
    words = [word.casefold() for pair in pairs for word in pair]
    require(
        all(word.strip() for word in words), N_("A pair must have two words, such as near and far.")
    )
    require_distinct(words, N_("“{value}” is in two pairs; it can have only one partner."))


def parse_pairs(text: str) -> SidePairs:
    """Return the pairs in a text such as "L/R, near/far".

    Raises a `LissomError` if the text is not a list of pairs.
    """
    pairs = []
    for part in filter(str.strip, text.split(",")):
        words = tuple(word.strip() for word in part.split("/"))
        if len(words) != 2:
            raise LissomError(_(NO_PAIR).format(words=part.strip()))
        pairs.append((words[0], words[1]))
    require_pairs(tuple(pairs))
    return tuple(pairs)


def format_pairs(pairs: SidePairs) -> str:
    """Return pairs as a text that `parse_pairs` reads."""
    return ", ".join("/".join(pair) for pair in pairs)


def mirrored_handles_by_name(
    handles: Iterable[Handle], pairs: SidePairs = PAIRS
) -> Mapping[int, int]:
    """Return the mirror partner of each handle by name, as handle ids in both directions."""
    names = {handle.name: handle.id for handle in handles}
    others = {
        identity: names.get(mirrored_name(name, pairs) or "") for name, identity in names.items()
    }
    return {identity: other for identity, other in others.items() if other is not None}


def mirrored_handles(
    handles: Iterable[Handle], axis: float, outline: Complexes, pairs: SidePairs = PAIRS
) -> Mapping[int, int]:
    """Return the mirror partner of each handle by name or else by position, as handle ids.

    A handle near the vertical axis is its own partner unless its name has a side. The tolerance
    depends on the size of the `outline`.
    """
    handles = tuple(handles)
    partners = dict(mirrored_handles_by_name(handles, pairs))
    alone = [handle for handle in handles if handle.id not in partners]
    places = np.array([handle.position for handle in alone])
    for handle in alone:
        away = np.abs(places - (2 * axis - handle.position.conjugate()))
        nearest = int(away.argmin())
        if away[nearest] < PAIR_DISTANCE * diameter(outline):
            partners[handle.id] = alone[nearest].id
    return partners
