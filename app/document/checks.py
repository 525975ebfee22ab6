"""Checks and limits that the values of a document share."""

from collections.abc import Iterable, Mapping
from types import MappingProxyType
from typing import Any

from app.errors import LissomError
from app.texts import N_, _

MAX_PICTURE_SIDE = 65_535
# Pixels. Beyond this distance the squares of coordinates lose too many digits.
MAX_COORDINATE = 1e7
LAST_FRAME = 999_999
MAX_ID = 2**31 - 1  # largest id that the window accepts
# Fields of a project file that this version does not know. Saving writes them unchanged.
Unknown = Mapping[str, Any]
NOTHING: Unknown = MappingProxyType({})


def require(condition: bool, message: str, /, **values: object) -> None:  # noqa: FBT001 - reads as a sentence
    """Raise a `LissomError` with a marked message, and the values of its fields, if it is false."""
    if not condition:
        raise LissomError(_(message).format(**values))


def require_distinct(values: Iterable[object], message: str) -> None:
    """Raise a `LissomError` if a value occurs twice; `value` is a field of the message."""
    seen = set()
    for value in values:
        if value in seen:
            raise LissomError(_(message).format(value=value))
        seen.add(value)


def require_frame(frame: int, what: str) -> None:
    """Raise a `LissomError` unless the frame is from 0 to LAST_FRAME; `what` begins the message."""
    if not 0 <= frame <= LAST_FRAME:
        raise LissomError(
            _("{what} must be at a frame from 0 to {largest:,}, not at {frame}.").format(
                what=what, largest=LAST_FRAME, frame=frame
            )
        )


def require_id(identity: int, what: str) -> None:
    """Raise a `LissomError` unless the id is from 0 to MAX_ID."""
    require(
        0 <= identity <= MAX_ID,
        N_("{what} must have an id from 0 to {largest:,}, not {identity}."),
        what=what,
        largest=MAX_ID,
        identity=identity,
    )


def require_point(place: complex, what: str) -> None:
    """Raise a `LissomError` unless both coordinates are within MAX_COORDINATE pixels."""
    require(
        abs(place.real) <= MAX_COORDINATE and abs(place.imag) <= MAX_COORDINATE,
        N_("{what} must be within {largest:,.0f} pixels, not at ({x:g}, {y:g})."),
        what=what,
        largest=MAX_COORDINATE,
        x=place.real,
        y=place.imag,
    )


def require_size(size: tuple[int, int], what: str) -> None:
    """Raise a `LissomError` unless both sides are from 1 to MAX_PICTURE_SIDE pixels."""
    require(
        len(size) == 2 and all(1 <= pixels <= MAX_PICTURE_SIDE for pixels in size),
        N_("{what} must have 1 to {largest:,} pixels each way, not {size}."),
        what=what,
        largest=MAX_PICTURE_SIDE,
        size=" × ".join(map(str, size)),
    )
