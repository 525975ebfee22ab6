"""The texts for the person: all in one catalogue, none of them English in another language."""

import ast
import os
import re
import subprocess
import sys
from pathlib import Path

from app import texts
from app.texts import message_of
from engine.errors import EngineError, Message, count_message
from tests.catalogue import TEMPLATE, make_catalogue, source_files

SUPPORT = Path(__file__).parents[1] / "support"


def test_catalogue_has_all_texts(request):
    if request.config.getoption("--regenerate"):
        TEMPLATE.write_bytes(make_catalogue())
    assert TEMPLATE.read_bytes() == make_catalogue(), "python -m tests.catalogue"


def test_refusals_and_undo_steps_have_no_text_beside_the_catalogue():
    """The window shows few of them in any one run."""
    said = {"LissomError", "command", "layer_command", "require", "notices.show", "JobKind"}
    beside = []
    for path in source_files():
        for node in ast.walk(ast.parse(path.read_text("utf-8"))):
            if not isinstance(node, ast.Call) or not node.args:
                continue
            called = ast.unparse(node.func).split(".")
            name = ".".join(called[-2:] if called[-1] == "show" else called[-1:])
            text = node.args[name == "require" and len(node.args) > 1]
            parts = text.values if isinstance(text, ast.JoinedStr) else [text]
            literal = " ".join(str(each.value) for each in parts if isinstance(each, ast.Constant))
            if name in said and re.search("[a-z]{2,}", literal):
                beside.append((path.name, node.lineno, literal))
    assert beside == []


def test_window_and_help_show_no_english_in_another_language():
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join([*sys.path, str(SUPPORT)])}
    command = [sys.executable, str(SUPPORT / "pseudo_language.py")]
    ended = subprocess.run(command, env=environment, capture_output=True, text=True, check=False)
    assert (ended.returncode, ended.stdout.splitlines()) == (0, []), ended.stderr


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
