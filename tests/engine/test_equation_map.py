"""The map from the paper's equations to the code, as `help(engine)` shows it, is true."""

import importlib
import re
from pathlib import Path

import pytest

import engine

README = Path(__file__).parents[2] / "engine" / "README.md"
ENTRIES = re.findall(r"^ {4}(.+?)  +(.+?)  +(engine\.\S+)$", engine.__doc__, flags=re.MULTILINE)
HEAD = "| equation | what | where |\n| --- | --- | --- |\n"


def test_the_map_covers_the_paper():
    equations = " ".join(equation for equation, _, _ in ENTRIES)
    for number in ("(1)", "(2)", "(3)", "(4)", "(5)", "(6)", "(7)", "(8)", "(13)", "(14)", "(15)"):
        assert number in equations
    assert len(ENTRIES) == engine.__doc__.count(" engine.") >= 24


def test_the_readme_shows_the_same_map(request):
    before, shown = README.read_text(encoding="utf-8").split(HEAD)
    rows = "".join(f"| {equation} | {what} | `{path}` |\n" for equation, what, path in ENTRIES)
    if request.config.getoption("--regenerate"):
        README.write_text(before + HEAD + rows, encoding="utf-8")
    else:
        assert shown == rows, "write it anew with --regenerate"


@pytest.mark.parametrize(("equation", "what", "path"), ENTRIES)
def test_every_entry_names_something_documented(equation, what, path):
    module, _, name = path.rpartition(".")
    assert getattr(importlib.import_module(module), name).__doc__, f"{equation}, {what}"
