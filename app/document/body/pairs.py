"""Which handles are each other's mirror image, as their names tell, or else their places."""

import re
from collections.abc import Iterable, Mapping

import numpy as np

from app.document.keyframe import Handle
from engine.arrays import Complexes
from engine.geometry import box_diagonal

# Of the shape's diagonal: handles that mirror each other this nearly are pairs without names.
NEAR = 0.03
OTHER_SIDE = {"l": "r", "r": "l", "left": "right", "right": "left"}
# "left" and "right" where a word begins and ends, be it in the middle of "handLeftUpper", but not
# in "bright" or "cleft".
_WORD = re.compile(
    r"(?<![A-Za-z])(?:left|right|Left|Right|LEFT|RIGHT)(?![a-z])|(?<=[a-z])(?:Left|Right)(?![a-z])"
)
# A letter of its own: ".L", "_r", "L arm", "arm.l.001".
_LETTER = re.compile(r"(?<![A-Za-z0-9])[lrLR](?![A-Za-z0-9])")


def mirrored_name(name: str) -> str | None:
    """Return a handle's name on the other side; None where the name tells of no side.

    Of several words or letters that tell of a side the last one counts, as in "right tail.L", and
    its case is kept.
    """
    found = [*_WORD.finditer(name), *_LETTER.finditer(name)]
    if not found:
        return None
    last = max(found, key=lambda match: match.start())
    side = last.group()
    other = OTHER_SIDE[side.lower()]
    if side.isupper():
        other = other.upper()
    elif side[0].isupper():
        other = other.capitalize()
    return name[: last.start()] + other + name[last.end() :]


def pairs_by_name(handles: Iterable[Handle]) -> Mapping[int, int]:
    """Return the partner of each handle that has one by name; both by their ids, both ways."""
    names = {handle.name: handle.id for handle in handles}
    pairs = {identity: names.get(mirrored_name(name) or "") for name, identity in names.items()}
    return {identity: other for identity, other in pairs.items() if other is not None}


def partners_of(handles: Iterable[Handle], axis: float, outline: Complexes) -> Mapping[int, int]:
    """Return the partner of each handle that has one, by name or else by place, by their ids.

    A handle next to the axis is its own partner, unless its name tells of another.

    Parameters
    ----------
    handles : iterable of Handle
    axis : float
        The upright line at which they mirror each other, in pixels from the left.
    outline : complex128, shape (n,)
        Of their figure.
    """
    handles = tuple(handles)
    partners = dict(pairs_by_name(handles))
    alone = [handle for handle in handles if handle.id not in partners]
    places = np.array([handle.position for handle in alone])
    for handle in alone:
        away = np.abs(places - (2 * axis - handle.position.conjugate()))
        nearest = int(away.argmin())
        if away[nearest] < NEAR * box_diagonal(outline):
            partners[handle.id] = alone[nearest].id
    return partners
