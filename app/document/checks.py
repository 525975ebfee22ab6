"""Checks and limits that the values of a document share."""

from collections.abc import Iterable, Mapping
from types import MappingProxyType
from typing import Any

from app.errors import LissomError

MAX_PICTURE_SIDE = 65_535
# Pixels. Beyond this distance the squares of coordinates lose too many digits.
MAX_COORDINATE = 1e7
LAST_FRAME = 999_999
MAX_ID = 2**31 - 1  # largest id that the window accepts
# Fields of a project file that this version does not know. Saving writes them unchanged.
Unknown = Mapping[str, Any]
NOTHING: Unknown = MappingProxyType({})


def require(condition: bool, message: str) -> None:  # noqa: FBT001 - reads as a sentence
    if not condition:
        raise LissomError(message)


def require_distinct(values: Iterable[object], message: str) -> None:
    """Raise a `LissomError` if a value occurs twice; {!r} in the message stands for the value."""
    seen = set()
    for value in values:
        if value in seen:
            raise LissomError(message.format(value))
        seen.add(value)


def require_frame(frame: int, what: str) -> None:
    """Raise a `LissomError` unless the frame is from 0 to LAST_FRAME; `what` begins the message."""
    if not 0 <= frame <= LAST_FRAME:
        raise LissomError(f"{what} is at a frame from 0 to {LAST_FRAME:,}, not at {frame}.")


def require_id(identity: int, what: str) -> None:
    """Raise a `LissomError` unless the id is from 0 to MAX_ID."""
    require(0 <= identity <= MAX_ID, f"The id of {what} is 0 to {MAX_ID:,}, not {identity}.")


def require_point(place: complex, name: str) -> None:
    """Raise a `LissomError` unless both coordinates are within MAX_COORDINATE pixels."""
    require(
        abs(place.real) <= MAX_COORDINATE and abs(place.imag) <= MAX_COORDINATE,
        f"{name} must be within {MAX_COORDINATE:,.0f} pixels, not at {place:g}.",
    )


def require_size(size: tuple[int, int], what: str) -> None:
    """Raise a `LissomError` unless both sides are from 1 to MAX_PICTURE_SIDE pixels."""
    require(
        len(size) == 2 and all(1 <= pixels <= MAX_PICTURE_SIDE for pixels in size),
        f"The size of the {what} must be 1 to {MAX_PICTURE_SIDE:,} pixels each way, not {size}.",
    )
