"""Repeated fields are found without comparing each with each: a file may hold millions of them."""

import json

import pytest

from app.errors import LissomError
from app.storage.json_values import as_text, check_repeated_fields


def test_a_repeated_field_among_many_is_found_at_little_cost():
    compared = 0

    class Name(str):
        __slots__ = ()
        __hash__ = str.__hash__

        def __eq__(self, other):
            nonlocal compared
            compared += 1
            return str.__eq__(self, other)

    count = 400
    names = [Name(number) for number in range(count)] + [Name(count - 1)]
    with pytest.raises(LissomError, match=f"the field '{count - 1}' twice"):
        check_repeated_fields([(name, None) for name in names])
    assert compared < 5 * count


def test_no_text_has_parts_that_no_window_can_show():
    assert (
        as_text(json.loads(r'"caf\udce9 \ud83d\udc12"'), "name")
        == "caf\N{REPLACEMENT CHARACTER} 🐒"
    )
