"""Standard JSON, which every reader accepts."""

import json

from app.errors import LissomError
from app.texts import N_, _

NOT_FINITE = N_("it contains a number that is not finite, which JSON does not allow")


def strict_json(content: object, *, indent: int | None = None) -> str:
    """Return a value as JSON, on one line or with this indent.

    Raises `LissomError` if a number is infinite or NaN: Python would write invalid JSON.
    """
    separators = (",", ":") if indent is None else None
    try:
        return json.dumps(content, indent=indent, separators=separators, allow_nan=False)
    except ValueError as error:
        raise LissomError(_(NOT_FINITE)) from error
