"""Texts from the catalogue, and the engine's messages shown by it."""

from app import texts
from app.texts import message_of
from engine.errors import EngineError, Message, count_message


def test_message_has_one_form_for_one_and_another_for_many():
    said = [
        count_message("{count} hole", "{count} holes of {share:.0%}", n, share=0.5) for n in (1, 2)
    ]
    assert [*map(str, said)] == [*map(message_of, said)] == ["1 hole", "2 holes of 50%"]


def test_messages_of_the_engine_are_translated_with_their_values(monkeypatch):
    monkeypatch.setattr(texts, "_", str.upper)
    monkeypatch.setattr(
        texts, "ngettext", lambda one, many, count: (one if count == 1 else many).upper()
    )
    error = EngineError("the {0} crosses")
    assert message_of(error) == "THE {0} CROSSES"
    assert message_of(Message("closed")) == "CLOSED"
    assert message_of(count_message("one", "many", 3)) == "MANY"
    assert message_of(LookupError("as it is")) == "as it is"
