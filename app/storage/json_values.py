"""Reading decoded JSON by kind; the errors name the field, what it must be and what it is."""

import json
import math
from collections import Counter
from typing import Any

from app.errors import LissomError, shown_name


class JsonObject(dict[str, Any]):
    """An object of a JSON text; asking for a field that it lacks is a `LissomError`."""

    def __init__(self, content: dict[str, Any], where: str) -> None:
        super().__init__(content)
        self.where = where

    def __missing__(self, name: str) -> Any:
        raise LissomError(f"{self.where} lacks the field {name!r}")


def as_object(content: object, where: str) -> JsonObject:
    """Return an object."""
    if not isinstance(content, dict):
        raise LissomError(f"{where} must be an object {{...}}, not {shown(content)}")
    return JsonObject(content, where)


def as_list(content: object, where: str) -> list[Any]:
    """Return a list."""
    if not isinstance(content, list):
        raise LissomError(f"{where} must be a list [...], not {shown(content)}")
    return content


def as_text(content: object, where: str) -> str:
    """Return a text."""
    if not isinstance(content, str):
        raise LissomError(f"{where} must be a text, not {shown(content)}")
    return shown_name(content)


def as_flag(content: object, where: str) -> bool:
    """Return true or false."""
    if not isinstance(content, bool):
        raise LissomError(f"{where} must be true or false, not {shown(content)}")
    return content


def as_whole(content: object, where: str) -> int:
    """Return a whole number."""
    if not isinstance(content, int) or isinstance(content, bool):
        raise LissomError(f"{where} must be a whole number, not {shown(content)}")
    return content


def as_number(content: object, where: str) -> float:
    """Return a finite number."""
    if isinstance(content, bool) or not isinstance(content, (int, float)):
        raise LissomError(f"{where} must be a number, not {shown(content)}")
    try:
        number = float(content)
    except OverflowError:
        number = math.inf
    if not math.isfinite(number):
        raise LissomError(f"{where} must be finite, not {shown(content)}")
    return number


def as_point(content: object, where: str) -> complex:
    """Return a point x + iy, written [x, y]."""
    if not isinstance(content, list) or len(content) != 2:
        raise LissomError(f"{where} must be a point [x, y], not {shown(content)}")
    return complex(as_number(content[0], f"{where}[0]"), as_number(content[1], f"{where}[1]"))


def shown(content: object) -> str:
    """Return JSON for an error message, shortened where it is long."""
    text = json.dumps(content)
    return text if len(text) <= 60 else f"{text[:57]}..."


def without_repeats(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    """Refuse repeated fields; the `object_pairs_hook` of `json.loads`."""
    content = dict(pairs)
    if len(content) < len(pairs):
        (repeated, _), *_ = Counter(name for name, _ in pairs).most_common(1)
        raise LissomError(f"the field {repeated!r} is given twice in one object")
    return content
