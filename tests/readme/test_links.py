"""What the READMEs and the changelog link to is there."""

import re
from itertools import chain
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
ROOMS = ("app", "engine", "tests")
PAGES = [*ROOT.glob("*.md"), *chain.from_iterable((ROOT / room).rglob("*.md") for room in ROOMS)]
MOST_LINES = 120  # of the first page, which is read in two minutes


def anchors(page):
    """Return what the headings of a page are called in links."""
    headings = re.findall(r"^#+ (.+)$", page.read_text(encoding="utf-8"), flags=re.MULTILINE)
    return {re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-") for heading in headings}


def names(page):
    return str(page.relative_to(ROOT))


@pytest.mark.parametrize("page", PAGES, ids=names)
def test_every_link_leads_somewhere(page):
    for link in re.findall(r"\]\(([^)\s]+)\)", page.read_text(encoding="utf-8")):
        if "://" in link:
            continue
        path, _, anchor = link.partition("#")
        target = page.parent / path if path else page
        assert target.exists(), f"{link} leads nowhere"
        assert not anchor or anchor in anchors(target), f"{link} has no such heading"


@pytest.mark.parametrize("page", PAGES, ids=names)
def test_every_named_file_is_there(page):
    named = re.findall(r"`((?:app|engine|tests|shaders)/[\w/]+(?:\.py)?)`", page.read_text("utf-8"))
    assert [each for each in named if not (ROOT / each).exists()] == []


def test_the_readmes_lead_to_each_other():
    first = (ROOT / "README.md").read_text(encoding="utf-8")
    for page in PAGES:
        if page.name == "README.md" and page.parent.parent == ROOT:
            assert f"]({names(page)})" in first
    assert {names(page) for page in PAGES} >= {"app/README.md", "engine/README.md"}


def test_the_first_page_is_short():
    first = (ROOT / "README.md").read_text(encoding="utf-8")
    assert len(first.splitlines()) <= MOST_LINES


def test_the_index_of_support_names_every_module():
    page = (ROOT / "tests" / "README.md").read_text(encoding="utf-8")
    index = page.partition("\n## Shared modules\n")[2].partition("\n## ")[0]
    named = re.findall(r"^\| `(\w+)` \| \S", index, flags=re.MULTILINE)
    there = {path.stem for path in (ROOT / "tests" / "support").glob("*.py")}
    assert sorted(named) == sorted(there)
