"""The map from the paper's equations to the code, as `help(engine)` shows it, is true."""

import importlib
import re
from pathlib import Path

import pytest

import engine

ENTRIES = re.findall(r"^ {4}(.+?)  +.+?  +(engine\.\S+)$", engine.__doc__, flags=re.MULTILINE)


def test_the_map_covers_the_paper():
    equations = " ".join(equation for equation, _ in ENTRIES)
    for number in ("(1)", "(2)", "(3)", "(4)", "(5)", "(6)", "(7)", "(8)", "(13)", "(14)", "(15)"):
        assert number in equations
    assert len(ENTRIES) == engine.__doc__.count(" engine.") >= 24


def test_the_readme_shows_the_same_map():
    readme = (Path(__file__).parents[2] / "README.md").read_text(encoding="utf-8")
    shown = re.findall(r"^\| (.+?) \| .+? \| `(engine\.\S+)` \|$", readme, flags=re.MULTILINE)
    assert [entry for entry in shown if entry[1].count(".") > 1] == ENTRIES


@pytest.mark.parametrize(("equation", "path"), ENTRIES)
def test_every_entry_names_something_documented(equation, path):
    module, _, name = path.rpartition(".")
    assert getattr(importlib.import_module(module), name).__doc__, equation
