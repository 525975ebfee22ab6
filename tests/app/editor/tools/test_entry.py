"""Numbers that are typed during a drag, and axes that it keeps to."""

import pytest

from app.editor.tools.numeric_entry import ERASE, NumericEntry


@pytest.mark.parametrize(
    ("typed", "value"),
    [
        ("40", 40.0),
        ("4,5", 4.5),
        ("4.5.6", 4.56),
        ("-12", -12.0),
        ("12-", -12.0),
        ("1--2", 12.0),
        (f"41{ERASE}0", 40.0),
        (f"4{ERASE}", None),
        ("-", None),
        (".", None),
        (".5", 0.5),
        ("a4é0", 40.0),
        ("1" * 40, 111_111_111_111.0),
    ],
)
def test_what_is_typed_makes_a_number(typed, value):
    entry = NumericEntry()
    for character in typed:
        entry.type(character)
    assert entry.value == value


@pytest.mark.parametrize(
    ("typed", "offset", "way"),
    [
        ("", 3 + 4j, 3 + 4j),
        ("x", 3 + 4j, 3),
        ("y", 3 + 4j, 4j),
        ("xy", 3 + 4j, 4j),
        ("xx", 3 + 4j, 3 + 4j),
        ("40", 3 + 4j, 24 + 32j),
        ("40", 0j, 40),
        ("x40", 3 + 4j, 40),
        # As people count pixels, y goes down.
        ("y40", 3 + 4j, -40j),
        ("y-40", 3 + 4j, 40j),
    ],
)
def test_a_way_is_as_long_as_was_typed_and_keeps_to_the_axis(typed, offset, way):
    entry = NumericEntry()
    entry.type(typed)
    assert entry.constrain_offset(offset) == pytest.approx(way)
