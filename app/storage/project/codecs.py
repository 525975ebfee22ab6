"""Codecs between values and decoded JSON, which keep the fields of later versions."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from operator import attrgetter
from types import MappingProxyType
from typing import Any, TypeVar

from app.errors import LissomError
from app.storage.json_values import (
    JsonObject,
    as_flag,
    as_list,
    as_number,
    as_object,
    as_point,
    as_text,
    as_whole,
    repr_for_error,
)
from app.texts import _

MISSING: Any = object()  # marks an absent value
Made = TypeVar("Made")


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


def located(where: str, make: Callable[..., Made], *values: Any, **fields: Any) -> Made:
    """Return a value made of others; an error gets its place in the file, if there is one."""
    try:
        return make(*values, **fields)
    except LissomError as error:
        raise LissomError(f"{where}: {error}" if where else str(error)) from error


def verbatim(value: Any, _where: str = "") -> Any:
    """Return a value unchanged: it is its own JSON."""
    return value


ANYTHING = Codec(verbatim, verbatim)
FLAG = Codec(verbatim, as_flag)
WHOLE = Codec(verbatim, as_whole)
NUMBER = Codec(verbatim, as_number)
TEXT = Codec(verbatim, as_text)
WHOLE_OR_TEXT = Codec(
    verbatim,
    lambda content, where: (as_text if isinstance(content, str) else as_whole)(content, where),
)
POINT = Codec(lambda point: [point.real, point.imag], as_point)

VALUE = Codec(
    lambda value: [value.real, value.imag] if value.imag else value.real,
    lambda content, where: (
        as_point(content, where)
        if isinstance(content, list)
        else complex(as_number(content, where))
    ),
)  # of a slider: one number, or two of a pad


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
        more = {"unknown": find_unknown_fields(content, known)} if unknown else {}
        return located(where, make, **values, **more)

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
