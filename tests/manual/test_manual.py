"""The manual is what its sources say, leads to what is there, and shows what there is."""

import ast
import json
import re
from html.parser import HTMLParser
from pathlib import Path

import pytest
from chromium import PROGRAM, chromium

from app.cli.main import main
from app.errors import LissomError
from app.solving.script.pose_script import parse_pose_script
from app.storage import manual_page
from app.storage.project import document_json
from app.ui.shortcuts.table import MENUS
from app.ui.shortcuts.window_actions import PAGES, open_manual_page
from tests.manual import build, motion, names, window
from tests.readme.shown import shown_now

HINT = "build it anew with `python -m tests.manual --pages`, and look at it"
BYTES = 8_000_000  # of all that is shipped
TASKS = 12  # pages at least


class Leads(HTMLParser):
    """What a page leads to and shows, and the places in it that are led to."""

    def __init__(self, text):
        super().__init__()
        self.links, self.sources, self.places = [], [], set()
        self.feed(text)

    def handle_starttag(self, tag, attrs):
        of = dict(attrs)
        self.links += [of["href"]] if tag in {"a", "link"} else []
        self.sources += [of["src"]] if "src" in of else []
        self.places |= {of["id"]} if "id" in of else set()


@pytest.fixture(scope="module")
def built():
    return build.build()


@pytest.fixture(scope="module")
def leads(built):
    return {name: Leads(text) for name, text in built.items() if name.endswith(".html")}


def test_the_pages_are_those_of_their_sources(built):
    kept = {path.name for path in build.SITE.glob("*.html")} | {build.INDEX}
    assert kept == set(built), HINT
    for name, text in built.items():
        assert (build.SITE / name).read_text(encoding="utf-8") == text, f"{name} is old: {HINT}"


def test_every_link_leads_somewhere_and_nothing_comes_from_outside(leads):
    for name, page in leads.items():
        for link in page.links:
            path, _, place = link.partition("#")
            assert (build.SITE / path).is_file() or not path, f"{name}: {link} leads nowhere"
            if place:
                assert place in leads[path or name].places, f"{name}: {link} has no such heading"
        for source in page.sources:
            assert (build.SITE / source).is_file(), f"{name}: {source} is missing"
    for path in build.SITE.glob("*.[cj]s*"):
        assert "//" not in re.sub(r"(?m)(^|\s)//.*$", "", path.read_text()), f"{path} loads more"


def test_every_picture_is_drawn_by_the_command_and_shown_on_a_page(leads):
    shown = {source.partition("/")[2] for page in leads.values() for source in page.sources}
    kept = {path.name for path in build.PICTURES.iterdir()}
    assert kept == shown - {""}
    assert {name.partition(".")[0] for name in kept} == {*motion.DRAWN, *window.DRAWN}


def test_the_pictures_show_the_window_as_it_is():
    drawn, digest = json.loads(window.DRAWN_OF.read_text()), window.window_digest()
    old = sorted(name for name, of in drawn.items() if of != digest)
    assert set(drawn) == set(window.DRAWN)
    assert not old, f"of a window that is no more ({shown_now()['menus']}): {old}; draw them anew"


def test_the_whole_is_small_and_has_a_page_for_each_task():
    files = [path for path in build.SITE.rglob("*") if path.is_file()]
    assert sum(path.stat().st_size for path in files) < BYTES
    chapters = build.chapters_of(build.PAGES / "index.md")
    assert sum(len(pages) for name, pages in chapters.items() if name != "To look up") >= TASKS


def test_every_task_has_steps_and_a_picture():
    chapters = build.chapters_of(build.PAGES / "index.md")
    for chapter in ("First steps", "Motion", "Shape", "Layers and camera"):
        for name in chapters[chapter]:
            text = (build.PAGES / f"{name}.md").read_text(encoding="utf-8")
            assert re.search(r"^1\. ", text, flags=re.MULTILINE), f"{name} has no steps"
            assert "](../site/pictures/" in text, f"{name} has no picture"


@pytest.mark.parametrize(
    "text",
    [
        "*File › Exprot…*",
        "*Handel*",
        "*Export › Formt*",
        "*File ›\nNew…*",
        "{key:exprot}",
        "{press:Escpe}",
        "Press Ctrl+E.",
        "Press F9.",
        "`--fromat`",
        "`lissom exprot x`",
        "```sh\nlissom export x --fromat gif\n```",
        "[there](nowhere.md)[outside](style.css)",
        "![a cow](../site/pictures/cow.png)",
        "{exprot}",
    ],
)
def test_what_the_program_does_not_have_is_refused(tmp_path, text):
    path = tmp_path / "page.md"
    path.write_text(f"# Page\n\nIt is short.\n\n{text}\n", encoding="utf-8")
    with pytest.raises(build.PageError, match=r"page\.md"):
        build.read_page(path)


def test_what_the_program_has_is_written_as_it_writes_it(tmp_path):
    path = tmp_path / "page.md"
    path.write_text(
        "# Page\n\n*File › Export…*, *Show from frame 7 on*, *Export › Format*, "
        "{key:Save as…}, {ctrl+shift:drag}\n",
        encoding="utf-8",
    )
    body = build.read_page(path).body
    assert '<kbd data-mac="⇧⌘S">Ctrl+Shift+S</kbd>' in body
    assert "Ctrl+Shift+drag" in body
    assert '<span class="name">File › Export…</span>' in body


def test_the_search_knows_every_page(built):
    text = built[build.INDEX]
    entries = json.loads(text[text.index("[") : text.rindex("]") + 1])
    assert {url.partition("#")[0] for _, url, _, _ in entries} == set(built) - {build.INDEX}


@pytest.mark.skipif(PROGRAM is None, reason="no Chromium is installed")
def test_the_search_works_on_files_and_leads_to_what_is_looked_for(tmp_path):
    with chromium(tmp_path) as page:
        page.open(build.SITE / "handles.html", (1280, 800))
        found = page.run(
            "field.value = 'wag tail'; field.dispatchEvent(new Event('input'));"
            "[...list.querySelectorAll('a')].map((link) => link.getAttribute('href'))"
        )
        assert found[0].startswith("tail-wag.html")
        page.run("field.value = 'xyzzy'; field.dispatchEvent(new Event('input'))")
        assert page.run("list.textContent") == "Nothing was found."


def test_scripts_on_the_pages_are_read_as_such():
    text = (build.PAGES / "pose-scripts.md").read_text(encoding="utf-8")
    (script,) = re.findall(r"```json\n(.*?)```", text, flags=re.DOTALL)
    assert len(parse_pose_script(json.loads(script)).layers[0].keys) == 3


def test_the_fields_of_project_files_are_told():
    text = (build.PAGES / "project-files.md").read_text(encoding="utf-8")
    told = {
        name
        for row in re.findall(r"^\| (`[^|]+) \|", text.split("## project.json")[1], re.MULTILINE)
        for name in re.findall(r"`(\w+)`", row)
    }
    source = Path(document_json.__file__).read_text(encoding="utf-8")
    records = {
        ast.unparse(node.targets[0]): getattr(node.value, "args", getattr(node.value, "elts", []))
        for node in ast.parse(source).body
        if isinstance(node, ast.Assign)
    }
    fields = [each for name in ("DOCUMENT", "LAYER", "LAYER_FIELDS") for each in records[name]]
    assert told == {each.args[0].value for each in fields if isinstance(each, ast.Call)}


def test_each_tab_has_its_page():
    # The tab of sounds is there once there is a sound.
    assert set(PAGES) == {*shown_now()["tabs"], "Measure"}
    for page in PAGES.values():
        assert (build.PAGES / f"{page}.md").is_file()
    assert MENUS["Help"][0][0] is open_manual_page
    assert names.key("Manual") == ("F1", "F1")
    assert open_manual_page.label == "Manual"


def test_the_command_copies_it_whole(tmp_path, capsys):
    out = tmp_path / "deep" / "manual"
    assert main(["manual", "--out", str(out)]) == 0
    assert str(out / "index.html") in capsys.readouterr().out
    copied = {path.relative_to(out): path.read_bytes() for path in out.rglob("*") if path.is_file()}
    kept = {
        path.relative_to(build.SITE): path.read_bytes()
        for path in build.SITE.rglob("*")
        if path.is_file()
    }
    assert copied == kept


def test_the_command_does_not_copy_it_onto_itself(capsys):
    with pytest.raises(SystemExit) as left:
        main(["manual", "--out", str(build.SITE)])
    assert left.value.code == 2
    assert "the file that it is made from" in capsys.readouterr().err


def test_a_page_that_is_missing_is_told(monkeypatch, tmp_path):
    monkeypatch.setattr("app.storage.assets._APP", tmp_path)
    with pytest.raises(LissomError, match="install Lissom again"):
        manual_page()
