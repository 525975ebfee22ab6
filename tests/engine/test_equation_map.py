"""The map from the paper's equations to the code, as `help(engine)` shows it, is true."""

import ast
import importlib
import inspect
import re
from pathlib import Path

import pytest

import engine

README = Path(__file__).parents[2] / "engine" / "README.md"
ENTRIES = re.findall(
    r"^ {4}(.+?)  +(.+?)  +((?:engine|app)\.\S+)$", engine.__doc__, flags=re.MULTILINE
)
HEAD = "| equation | what | where |\n| --- | --- | --- |\n"


def test_every_line_of_the_map_is_read():
    assert len(ENTRIES) == len(re.findall(r"  (?:engine|app)\.", engine.__doc__)) >= 24


@pytest.mark.parametrize("number", range(1, 19))
def test_each_equation_stands_literally_where_the_map_says(number):
    paths = [path for equation, _, path in ENTRIES if f"({number})" in equation.split(", ")]
    assert paths, "the map does not have it"
    for module in ("engine.reference", *(path.rpartition(".")[0] for path in paths)):
        source = inspect.getsource(importlib.import_module(module))
        body = source[len(ast.get_docstring(ast.parse(source), clean=False)) :]
        assert re.search(rf"\bEquation \({number}\)", body), module


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
