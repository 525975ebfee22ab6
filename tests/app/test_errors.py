import pytest

from app.errors import (
    MAX_LISTED,
    MAX_MESSAGE_LENGTH,
    MAX_TEXT_LENGTH,
    NoticeCollector,
    display_message,
    few_notices,
    join_names,
    printable,
    shortened,
)


@pytest.mark.parametrize(
    ("text", "shown"),
    [
        ("\x1b[31mred\x07", r"\x1b[31mred\x07"),
        ("a\r\nb\tc", r"a\r\nb\tc"),
        ("a\u202eb\u2028c\x9b", r"a\u202eb\u2028c\x9b"),
        ("Zoë 走 \N{WOMAN}\u200d\N{ROCKET}\u00a0x", "Zoë 走 \N{WOMAN}\u200d\N{ROCKET}\u00a0x"),
        ("a\udcff", "a\N{REPLACEMENT CHARACTER}"),
    ],
)
def test_control_characters_are_shown_as_escapes(text, shown):
    assert printable(text) == shown


def test_texts_of_others_are_cut_where_they_are_long():
    assert shortened("x" * MAX_TEXT_LENGTH) == "x" * MAX_TEXT_LENGTH
    for long in ("x" * 121, "\x1b" * 100):
        assert len(shortened(long)) == MAX_TEXT_LENGTH
        assert shortened(long).endswith("…")


def test_a_message_is_one_line_whose_long_parts_are_cut():
    shown = display_message(f"the layer {'x' * 900!r} is\nin two choices; the user's layer's name")
    assert shown == f"the layer '{'x' * 119}…' is in two choices; the user's layer's name"
    assert len(display_message("word " * 5000)) == MAX_MESSAGE_LENGTH + 1


def test_many_names_and_notices_are_counted():
    names = [f"n{number}" for number in range(2_000)]
    assert join_names(names[:MAX_LISTED]) == ", ".join(names[:MAX_LISTED])
    assert join_names(names).endswith("n9 and 1,990 more")
    assert few_notices(names) == [*names[:MAX_LISTED], "and 1,990 more"]
    collector = NoticeCollector()
    for name in ("a\x1b", *names):
        collector.add_warning(name, "is lost")
    assert collector.import_log.warnings == (
        rf"a\x1b, {', '.join(names[:9])} and 1,991 more: is lost",
    )
