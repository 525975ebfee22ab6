"""Values of decoded JSON. Errors name the field, the required kind and the actual content."""

import json
import math
from collections import Counter
from collections.abc import Callable
from pathlib import Path
from typing import Any, TypeVar

from app.errors import LissomError, display_name
from app.storage.files.reading import read_file
from app.texts import N_, _, message_of

Parsed = TypeVar("Parsed")

NOT_TRUE_OR_FALSE = N_("{where} must be true or false, not {content}")
NOT_WHOLE = N_("{where} must be a whole number, not {content}")
NOT_NUMBER = N_("{where} must be a number, not {content}")
NOT_LIST = N_("{where} must be a list [...], not {content}")
NOT_OBJECT = N_("{where} must be an object {{...}}, not {content}")
NOT_TEXT = N_("{where} must be a text, not {content}")
NOT_POINT = N_("{where} must be a point [x, y], not {content}")
NOT_FINITE = N_("{where} must be finite, not {content}")
NOT_JSON = N_("{path} is not JSON: {reason} in line {line}, column {column}")
TOO_NESTED = N_("{path} is nested too deeply")
LACKS_FIELD = N_("{where} needs the field {name!r}")


class JsonObject(dict[str, Any]):
    """A JSON object. A missing field raises `LissomError`."""

    def __init__(self, content: dict[str, Any], where: str) -> None:
        super().__init__(content)
        self.where = where

    def __missing__(self, name: str) -> Any:
        raise LissomError(_(LACKS_FIELD).format(where=self.where, name=name))


def as_object(content: object, where: str) -> JsonObject:
    if not isinstance(content, dict):
        raise LissomError(_(NOT_OBJECT).format(where=where, content=repr_for_error(content)))
    return JsonObject(content, where)


def as_list(content: object, where: str) -> list[Any]:
    if not isinstance(content, list):
        raise LissomError(_(NOT_LIST).format(where=where, content=repr_for_error(content)))
    return content


def as_text(content: object, where: str) -> str:
    if not isinstance(content, str):
        raise LissomError(_(NOT_TEXT).format(where=where, content=repr_for_error(content)))
    return display_name(content)


def as_flag(content: object, where: str) -> bool:
    if not isinstance(content, bool):
        raise LissomError(_(NOT_TRUE_OR_FALSE).format(where=where, content=repr_for_error(content)))
    return content


def as_whole(content: object, where: str) -> int:
    if not isinstance(content, int) or isinstance(content, bool):
        raise LissomError(_(NOT_WHOLE).format(where=where, content=repr_for_error(content)))
    return content


def as_number(content: object, where: str) -> float:
    """Return a finite float."""
    if isinstance(content, bool) or not isinstance(content, (int, float)):
        raise LissomError(_(NOT_NUMBER).format(where=where, content=repr_for_error(content)))
    try:
        number = float(content)
    except OverflowError:
        number = math.inf
    if not math.isfinite(number):
        raise LissomError(_(NOT_FINITE).format(where=where, content=repr_for_error(content)))
    return number


def as_point(content: object, where: str) -> complex:
    """Return a point x + iy, written [x, y]."""
    if not isinstance(content, list) or len(content) != 2:
        raise LissomError(_(NOT_POINT).format(where=where, content=repr_for_error(content)))
    return complex(as_number(content[0], f"{where}[0]"), as_number(content[1], f"{where}[1]"))


def repr_for_error(content: object) -> str:
    """Return the content as JSON of at most 60 characters."""
    text = json.dumps(content)
    return text if len(text) <= 60 else f"{text[:57]}..."


def load_json(path: Path, parse: Callable[[object], Parsed], *, largest: int) -> Parsed:
    """Read a JSON file that a person wrote, and parse its decoded content.

    Raises `LissomError` if the file is missing, too large, not text, not JSON, or cannot be parsed.
    The message names the file.
    """
    try:
        text = read_file(path, largest=largest).decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise LissomError(_("{path} is not a text file in UTF-8").format(path=path)) from error
    try:
        return parse(json.loads(text, object_pairs_hook=check_repeated_fields))
    except json.JSONDecodeError as error:
        raise LissomError(
            _(NOT_JSON).format(path=path, reason=error.msg, line=error.lineno, column=error.colno)
        ) from error
    except RecursionError as error:
        raise LissomError(_(TOO_NESTED).format(path=path)) from error
    except (LissomError, ValueError) as error:
        raise LissomError(f"{path}: {message_of(error)}") from error


def check_repeated_fields(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    """Refuse repeated fields; the `object_pairs_hook` of `json.loads`."""
    content = dict(pairs)
    if len(content) < len(pairs):
        ((repeated, _count),) = Counter(name for name, _value in pairs).most_common(1)
        raise LissomError(
            _("one object has the field {name!r} twice; keep one of them").format(name=repeated)
        )
    return content
