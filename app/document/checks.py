"""Conditions of the document's values, and numbers that they share."""

import math
from collections.abc import Mapping
from types import MappingProxyType
from typing import Any

from app.errors import LissomError

WIDEST = 65_535
# Fields of a project file that this version does not know and hands on.
Unknown = Mapping[str, Any]
NOTHING: Unknown = MappingProxyType({})


def require(condition: bool, message: str) -> None:  # noqa: FBT001 - reads as a sentence
    """Raise a `LissomError` with the message unless the condition holds."""
    if not condition:
        raise LissomError(message)


def require_finite(value: complex, name: str) -> None:
    """Raise a `LissomError` unless the number is finite."""
    require(
        math.isfinite(value.real) and math.isfinite(value.imag), f"{name} must be finite: {value}."
    )


def require_size(size: tuple[int, int], what: str) -> None:
    """Raise a `LissomError` unless both sides are whole numbers that a picture can have."""
    require(
        len(size) == 2 and all(1 <= pixels <= WIDEST for pixels in size),
        f"The size of the {what} must be 1 to {WIDEST:,} pixels each way, not {size}.",
    )
