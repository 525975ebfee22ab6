"""The README has the pictures that `python -m tests.readme` draws, and they show what there is."""

import json
import re
from pathlib import Path

import pytest

from tests.readme import motion, window
from tests.readme.shown import shown_now

ROOT = Path(__file__).parents[2]
SHOWN = ROOT / "sample_images" / "shown"
README = (ROOT / "README.md").read_text(encoding="utf-8")
HINT = "draw it anew with `python -m tests.readme`, and look at it"


@pytest.fixture(scope="module")
def present():
    return shown_now()


@pytest.mark.parametrize("name", window.PICTURES)
def test_a_picture_of_the_window_shows_it_as_it_is(name, present):
    assert all(present.values())
    shown = json.loads((SHOWN / f"{name}.json").read_text(encoding="utf-8"))
    assert shown == present, f"{name}.png shows a window that is no more: {HINT}"


def test_the_readme_has_the_pictures_that_the_command_draws():
    drawn = {*motion.PICTURES, *window.PICTURES}
    in_readme = [Path(path) for path in re.findall(r"\]\((sample_images/shown/.+?)\)", README)]
    assert {path.stem for path in in_readme} == drawn
    lists = {f"{name}.json" for name in window.PICTURES}
    assert {path.name for path in SHOWN.iterdir()} == {path.name for path in in_readme} | lists


def test_the_readme_tells_of_every_tab(present):
    paragraph = README.split("## The window\n")[1].split("\n## ")[0]
    for title in present["tabs"]:
        assert f"*{title}*" in paragraph


def test_a_picture_is_small_enough_for_a_page():
    for path in SHOWN.iterdir():
        assert path.stat().st_size < 700_000, path
