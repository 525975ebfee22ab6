"""Codecs of decoded JSON. Errors name the field, the required kind and the actual content."""

import json
import math
from collections import Counter
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from operator import attrgetter
from pathlib import Path
from types import MappingProxyType
from typing import Any, TypeVar

from app.errors import LissomError, display_name
from app.storage.files.reading import read_file
from app.texts import N_, _, message_of

Parsed = TypeVar("Parsed")

MISSING: Any = object()  # marks an absent value
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


@dataclass(frozen=True, slots=True)
class Codec:
    """Conversion between the values of one kind and JSON.

    Parameters
    ----------
    read : callable
        Receives the decoded JSON and its place in the file, for errors.
    known_fields : mapping
        Known field names of an object, nested. Unknown fields are stored in the parent object.
        Empty if the value stores its own unknown fields.
    """

    write: Callable[[Any], Any]
    read: Callable[[object, str], Any]
    known_fields: Mapping[str, Any] = field(default_factory=dict)


def verbatim(value: Any, _where: str = "") -> Any:
    """Return a value unchanged: it is its own JSON."""
    return value


ANYTHING = Codec(verbatim, verbatim)
FLAG = Codec(verbatim, as_flag)
WHOLE = Codec(verbatim, as_whole)
NUMBER = Codec(verbatim, as_number)
TEXT = Codec(verbatim, as_text)
POINT = Codec(lambda point: [point.real, point.imag], as_point)


def optional(codec: Codec) -> Codec:
    """Return a codec whose values may be None."""
    return Codec(
        lambda value: None if value is None else codec.write(value),
        lambda content, where: None if content is None else codec.read(content, where),
        codec.known_fields,
    )


def list_of(codec: Codec) -> Codec:
    """Return a codec of tuples of any length."""
    return Codec(
        lambda values: [codec.write(value) for value in values],
        lambda content, where: tuple(
            codec.read(each, f"{where}[{i}]") for i, each in enumerate(as_list(content, where))
        ),
    )


def pair(
    first: Codec,
    second: Codec,
    what: str,
    *,
    make: Callable[[Any, Any], Any] = lambda one, other: (one, other),
    of: Callable[[Any], tuple[Any, Any]] = verbatim,
) -> Codec:
    """Return a codec of a value made of two parts; `what`, a marked text, stands in errors."""

    def write(value: Any) -> list[Any]:
        one, other = of(value)
        return [first.write(one), second.write(other)]

    def read(content: object, where: str) -> Any:
        values = as_list(content, where)
        if len(values) != 2:
            raise LissomError(
                _("{where} must be {what}, not {content}").format(
                    where=where, what=_(what), content=repr_for_error(values)
                )
            )
        return make(first.read(values[0], where), second.read(values[1], where))

    return Codec(write, read)


@dataclass(frozen=True, slots=True)
class Field:
    """A field of an object.

    Parameters
    ----------
    get : callable, optional
        Returns the field's value of an object; by default the attribute `name`.
    default : object, optional
        Default value. A field equal to its default is not written.
    legacy_default : object, optional
        Value in earlier files, which lack the field. The field is always written.
    legacy_name : str, optional
        Name in earlier files, which is read as well.
    """

    name: str
    codec: Codec
    get: Callable[[Any], Any] | None = None
    default: Any = MISSING
    legacy_default: Any = MISSING
    legacy_name: str = ""

    def value_of(self, value: Any) -> Any:
        return getattr(value, self.name) if self.get is None else self.get(value)

    def read(self, content: JsonObject, where: str) -> Any:
        absent = self.legacy_default if self.default is MISSING else self.default
        name = (
            self.legacy_name
            if self.name not in content and self.legacy_name in content
            else self.name
        )
        if name not in content and absent is not MISSING:
            return absent
        return self.codec.read(content[name], f"{where}.{name}" if where else name)


def record(
    make: Callable[..., Any],
    *fields: Field,
    unknown: Callable[[Any], Mapping[str, Any]] | None = attrgetter("unknown"),
) -> Codec:
    """Return a codec of objects.

    `make` receives the fields by their names, and the unknown fields as `unknown`. The function
    `unknown` returns the unknown fields of an object.
    """
    known = {field.name: field.codec.known_fields for field in fields}
    known |= {field.legacy_name: field.codec.known_fields for field in fields if field.legacy_name}

    def write(value: Any) -> dict[str, Any]:
        values = ((field, field.value_of(value)) for field in fields)
        written = {field.name: field.codec.write(of) for field, of in values if of != field.default}
        return with_unknown_fields(written, unknown(value) if unknown else {}, known)

    def read(content: object, where: str) -> Any:
        content = as_object(content, where or "project.json")
        values = {field.name: field.read(content, where) for field in fields}
        return make(
            **values, **({"unknown": find_unknown_fields(content, known)} if unknown else {})
        )

    return Codec(write, read, {} if unknown else known)


def nested_record(make: Callable[..., Any], *fields: Field) -> Codec:
    """Return a codec of objects whose parent object stores their unknown fields."""
    return record(make, *fields, unknown=None)


def find_unknown_fields(content: Mapping[str, Any], known: Mapping[str, Any]) -> Mapping[str, Any]:
    """Return the unknown fields, also those of inner objects."""
    unknown = {}
    for name, value in content.items():
        if name not in known:
            unknown[name] = value
        elif known[name] and isinstance(value, dict):
            inner = find_unknown_fields(value, known[name])
            if inner:
                unknown[name] = inner
    return MappingProxyType(unknown)


def with_unknown_fields(
    written: dict[str, Any], unknown: Mapping[str, Any], known: Mapping[str, Any]
) -> dict[str, Any]:
    """Return an object with the unknown fields added. A known field always wins."""
    for name, value in unknown.items():
        if name not in known:
            written[name] = value
        elif isinstance(written.get(name), dict):
            written[name] = with_unknown_fields(written[name], value, known[name])
    return written
