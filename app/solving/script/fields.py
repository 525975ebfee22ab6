"""What keys of poses and of tracks have alike in a pose script."""

from collections.abc import Callable, Collection, Mapping, Sequence
from itertools import pairwise
from typing import Any, TypeVar

from app.document import HOLD, LAST_FRAME, LINEAR, Easing, Passing
from app.errors import LissomError, listed
from app.storage import JsonObject, as_object, shown

Made = TypeVar("Made")
NOT_A_FRAME = "{where}.{name} must be a whole number from 0 to {last}, not {content}"
OUT_OF_ORDER = "{what} out of order: frame {after} after {before}"


def fields_in(content: object, where: str, fields: tuple[str, ...]) -> JsonObject:
    """Return an object that has none but these fields."""
    read = as_object(content, where)
    for name in read:
        if name not in fields:
            raise LissomError(
                f"{where} has an unknown field {name!r}; it may have {', '.join(fields)}"
            )
    return read


def frame_of(key: Mapping[str, object], where: str, name: str = "frame") -> int:
    """Return the frame that a key, or another object, has under a name."""
    frame = key.get(name)
    if not isinstance(frame, int) or isinstance(frame, bool) or not 0 <= frame <= LAST_FRAME:
        raise LissomError(
            NOT_A_FRAME.format(where=where, name=name, last=LAST_FRAME, content=shown(frame))
        )
    return frame


def passage_of(key: JsonObject, where: str) -> tuple[Easing, Passing]:
    """Return how time runs after a key, and how the motion passes it.

    By default it passes through, or with an easing of its own in a corner.
    """
    ease = Easing.parse(key["ease"]) if "ease" in key else LINEAR
    default = Passing.CORNER if "ease" in key else Passing.THROUGH
    word = key.get("passing", default)
    if word not in list(Passing):
        raise LissomError(f"{where}.passing must be one of {', '.join(Passing)}, not {shown(word)}")
    if word != Passing.HOLD:
        return ease, Passing(word)
    if "ease" in key and ease != HOLD:
        raise LissomError(f"{where} holds its pose, so that it has nothing to ease; leave out ease")
    return HOLD, default


def require_order(frames: Sequence[int], what: str) -> None:
    """Refuse frames of which one does not come after the one before."""
    for before, after in pairwise(frames):
        if after <= before:
            raise LissomError(OUT_OF_ORDER.format(what=what, after=after, before=before))


def require_handle(name: str, handles: Collection[str], where: str) -> None:
    """Refuse the name of a handle that the script does not have."""
    if name not in handles:
        raise LissomError(
            f"{where} names the handle {name!r}, but the handles are {listed([*handles]) or 'none'}"
        )


def made_of(kind: Callable[..., Made], where: str, **fields: Any) -> Made:
    """Return a value of these fields; what it refuses is told with the place in the script."""
    try:
        return kind(**fields)
    except LissomError as error:
        raise LissomError(f"{where}: {error}") from error
