"""The manual's pages: Markdown and the program's own tables in, static HTML out.

In a page, *italics* are names of the program (`*File › Export…*`, `*Handle*`), and what stands in
braces is written by it: `{key:Export…}` the keys of a named action, `{press:Escape}` a single key,
`{ctrl:drag}` what the pointer does with a key held. A line `{keys}`, `{commands}` or
`{script:giraffe}` is a table, or a file of the samples. A name that is not the program's is an
error.
"""

import html
import json
import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from string import Template

from markdown_it import MarkdownIt
from markdown_it.token import Token
from PIL import Image

from app.cli.main import COMMANDS
from tests.manual import names

ROOT = Path(__file__).parents[2]
PAGES = ROOT / "app" / "manual" / "pages"
SITE = ROOT / "app" / "manual" / "site"
PICTURES = SITE / "pictures"
FROM_PAGES = "../site/"  # how a page names what lies in the site
START = "index"
INDEX = "search-index.js"  # as the frame of a page loads it
MARKED = re.compile(r"\{(key|press|alt|ctrl|shift|ctrl\+shift):([^}\n]+)\}")
LINE = re.compile(r"^\{(\w+)(?::(\w+))?\}$", re.MULTILINE)
RAW_KEY = re.compile(r"\b(?:Ctrl|Shift|Alt)\+|(?<![\w.])F\d\d?\b")
FRAME = Template(Path(__file__).with_name("page.html").read_text(encoding="utf-8"))
LARGE = re.compile(r'(<img src="([^"]+\.png)"[^>]*>)')  # is seen whole by a click
CHAPTER = 2  # the level of headings that parts of a page have


class PageError(ValueError):
    """Something in a page that cannot be built."""


@dataclass(frozen=True, slots=True)
class Page:
    """A page of the manual, built."""

    name: str
    title: str
    lead: str  # its first paragraph, as a text
    body: str  # HTML
    parts: tuple[tuple[str, str, str], ...]  # of the search: identity, heading, text
    pictures: frozenset[str]
    links: frozenset[str]  # of other pages and their parts: "cut-out.html#by-hand"


def build() -> dict[str, str]:
    """Return the contents of all files that are made from the sources, by name."""
    pages = {path.stem: read_page(path) for path in sorted(PAGES.glob("*.md"))}
    chapters = chapters_of(PAGES / f"{START}.md")
    order = [START, *(name for names_ in chapters.values() for name in names_)]
    if sorted(order) != sorted(pages):
        raise PageError(f"{START}.md leads to {sorted(order)}, there are {sorted(pages)}")
    built = {}
    for place, name in enumerate(order):
        before = pages[order[place - 1]] if place else None
        after = pages[order[place + 1]] if place + 1 < len(order) else None
        built[f"{name}.html"] = _whole(pages[name], pages, chapters, before, after)
    entries = [
        [page.title, f"{page.name}.html" + (f"#{identity}" if identity else ""), heading, text]
        for page in map(pages.__getitem__, order)
        for identity, heading, text in page.parts
    ]
    lines = ",\n".join(json.dumps(entry, ensure_ascii=False) for entry in entries)
    built[INDEX] = f"// Made from the pages, as they are.\nconst PARTS = [\n{lines}\n];\n"
    return built


def write() -> None:
    """Build the manual, and take away pages that it has no longer."""
    built = build()
    for path in SITE.glob("*.html"):
        if path.name not in built:
            path.unlink()
    for name, text in built.items():
        (SITE / name).write_text(text, encoding="utf-8")


def chapters_of(start: Path) -> dict[str, list[str]]:
    """Return the pages that the start page leads to, by its headings."""
    chapters: dict[str, list[str]] = {}
    for line in start.read_text(encoding="utf-8").splitlines():
        if line.startswith("## "):
            chapters[line[3:]] = []
        elif found := re.match(r"- \[[^\]]+\]\(([\w-]+)\.md\)", line):
            chapters[list(chapters)[-1]].append(found[1])
    return chapters


def read_page(path: Path) -> Page:
    """Return one page, with all that it names checked."""
    try:
        return _Reader(path).page()
    except (PageError, names.UnknownNameError) as error:
        raise PageError(f"{path.name}: {error}") from error


class _Reader:
    """Goes through the tokens of one page."""

    def __init__(self, path: Path) -> None:
        self.name = path.stem
        source = path.read_text(encoding="utf-8")
        if wild := RAW_KEY.search(re.sub(r"```.*?```", "", source, flags=re.DOTALL)):
            raise PageError(f"{wild[0]!r} is written by hand: name the action, as in {{key:Save}}")
        source = MARKED.sub(lambda found: _keys_in_html(found[1], found[2]), source)
        self.source = LINE.sub(lambda found: _table(found[1], found[2] or ""), source)
        self.markdown = MarkdownIt("commonmark", {"html": True}).enable("table")
        self.pictures: set[str] = set()
        self.links: set[str] = set()
        self.parts: list[tuple[str, str, list[str]]] = []

    def page(self) -> Page:
        tokens = self.markdown.parse(self.source)
        if len(tokens) < 2 or tokens[0].tag != "h1":
            raise PageError("it does not begin with its title")
        title = _plain(tokens[1])
        self.parts.append(("", title, []))
        for number, token in enumerate(tokens[3:], 3):
            self._meet(token, tokens[number + 1] if number + 1 < len(tokens) else None)
        lead = next((text for text in self.parts[0][2] if text), "")
        body = self.markdown.renderer.render(tokens[3:], self.markdown.options, {})
        body = body.replace("<table>", '<div class="wide"><table>')
        body = body.replace("</table>", "</table></div>")
        body = LARGE.sub(r'<a class="large" href="\2">\1</a>', body)
        parts = tuple((where, head, " ".join(texts)) for where, head, texts in self.parts)
        pictures, links = frozenset(self.pictures), frozenset(self.links)
        return Page(self.name, title, lead, body, parts, pictures, links)

    def _meet(self, token: Token, following: Token | None) -> None:
        if token.type == "heading_open" and following is not None:
            heading = _plain(following)
            token.attrSet("id", slug(heading))
            if int(token.tag[1]) == CHAPTER:
                self.parts.append((slug(heading), heading, []))
        elif token.type == "inline":
            self._inline(token)
            self.parts[-1][2].append(_plain(token))
        elif token.type == "html_block":
            text = html.unescape(re.sub(r"<[^>]+>", " ", token.content))
            self.parts[-1][2].append(re.sub(r"\s+", " ", text).strip())
        elif token.type == "fence" and token.info == "sh":
            for line in token.content.splitlines():
                names.check_command(line)

    def _inline(self, token: Token) -> None:
        children = token.children or []
        for number, child in enumerate(children):
            if child.type in {"em_open", "em_close"}:
                child.tag = "span"
                if child.type == "em_open":
                    child.attrSet("class", "name")
                    names.check_name(_inside(children[number + 1 :]))
            elif child.type == "code_inline":
                _check_code(child.content)
            elif child.type == "image":
                self._picture(child)
            elif child.type == "link_open":
                child.attrSet("href", self._link(str(child.attrGet("href"))))

    def _link(self, target: str) -> str:
        if "://" in target:
            return target
        path, _, part = target.partition("#")
        found = re.fullmatch(r"([\w-]+)\.md", path) if path else None
        if path and found is None:
            raise PageError(f"{target} is no page of the manual")
        link = f"{found[1] if found else self.name}.html" + (f"#{part}" if part else "")
        self.links.add(link)
        return link if path else f"#{part}"

    def _picture(self, token: Token) -> None:
        source = str(token.attrGet("src"))
        file = PAGES / source
        if not source.startswith(f"{FROM_PAGES}pictures/") or not file.is_file():
            raise PageError(f"the picture {source} is missing")
        if not token.content:
            raise PageError(f"the picture {source} is not described")
        self.pictures.add(file.name)
        with Image.open(file) as picture:
            width, height = picture.size
        token.attrs = {
            "src": source.removeprefix(FROM_PAGES),
            "alt": "",
            "width": width,
            "height": height,
            "loading": "lazy",
        }


def _inside(children: Sequence[Token]) -> str:
    """Return the text up to where an emphasis ends; it may go on on the next line."""
    parts = []
    for child in children:
        if child.type == "em_close":
            break
        parts.append(" " if child.type == "softbreak" else child.content)
    return "".join(parts)


@cache
def _all_options() -> frozenset[str]:
    return frozenset(word for words in names.options().values() for word in words)


def _check_code(text: str) -> None:
    """Refuse a command or an option that does not exist."""
    names.check_command(text)
    if text.startswith("--") and re.split("[ =]", text)[0] not in _all_options():
        raise PageError(f"no command has the option {text}")


def slug(heading: str) -> str:
    """Return what a heading is called in links, as it is on GitHub."""
    return re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-")


def _plain(token: Token) -> str:
    """Return the text of a line, without what marks it."""
    parts = []
    for child in token.children or []:
        if child.type in {"text", "code_inline", "image"}:
            parts.append(child.content)
        elif child.type in {"softbreak", "hardbreak"}:
            parts.append(" ")
    return "".join(parts).strip()


def _kbd(keys: tuple[str, str]) -> str:
    plain, mac = map(html.escape, keys)
    there = "" if mac == plain else f' data-mac="{mac}"'
    return f"<kbd{there}>{plain}</kbd>"


def _keys_in_html(kind: str, what: str) -> str:
    if kind == "key":
        return _kbd(names.key(what))
    return _kbd(names.press(what) if kind == "press" else names.hold(kind, what))


def _table(kind: str, what: str) -> str:
    match kind:
        case "keys":
            return _keys()
        case "commands":
            return "\n".join(map(_help, COMMANDS))
        case "script":
            path = ROOT / "sample_images" / f"{what}.json"
            return _folded(path.name, path.read_text(encoding="utf-8"))
    raise PageError(f"{{{kind}}} stands for nothing")


def _keys() -> str:
    """Return all keys and gestures as tables, by menus."""
    out = []
    for menu, rows in names.key_groups().items():
        cells = (
            f"<tr><td>{html.escape(what)}</td><td>{_kbd(keys)}</td></tr>" for what, keys in rows
        )
        out.append(f"## {menu}\n\n<table>{''.join(cells)}</table>\n")
    cells = (
        f"<tr><td>{html.escape(what)}</td><td>{html.escape(how)}</td></tr>"
        for what, how in names.gestures()
    )
    out.append(f"## Pointer\n\n<table>{''.join(cells)}</table>\n")
    return "\n".join(out)


def _help(command: str) -> str:
    heading = f"## lissom {command}\n\n{COMMANDS[command]}\n\n"
    return heading + _folded(f"lissom {command} --help", names.help_of(command))


def _folded(title: str, text: str) -> str:
    """Return a text that is shown on demand; as one block of HTML, without empty lines."""
    inner = html.escape(text.rstrip()).replace("\n", "&#10;")
    return f"<details><summary>{html.escape(title)}</summary><pre>{inner}</pre></details>\n"


def _whole(
    page: Page,
    pages: Mapping[str, Page],
    chapters: Mapping[str, list[str]],
    before: Page | None,
    after: Page | None,
) -> str:
    """Return a page as it is written."""
    values = {
        "title": "Lissom, the manual" if page.name == START else f"{page.title} – Lissom",
        "lead": page.lead,
        "heading": page.title,
    }
    return FRAME.substitute(
        {name: html.escape(value) for name, value in values.items()},
        navigation="\n".join(_navigation(page, pages, chapters)),
        body=page.body.rstrip(),
        ways="\n".join(_ways(before, after)),
    )


def _navigation(
    page: Page, pages: Mapping[str, Page], chapters: Mapping[str, list[str]]
) -> Iterator[str]:
    yield '<details open class="menu"><summary>All pages</summary>'
    for chapter, inside in chapters.items():
        yield f"<h2>{html.escape(chapter)}</h2>"
        yield "<ul>"
        for name in inside:
            here = ' aria-current="page"' if name == page.name else ""
            yield f'<li><a href="{name}.html"{here}>{html.escape(pages[name].title)}</a></li>'
        yield "</ul>"
    yield "</details>"


def _ways(before: Page | None, after: Page | None) -> Iterator[str]:
    for page, what in ((before, "before"), (after, "after")):
        if page is not None:
            word = "Page before" if what == "before" else "Next page"
            title = html.escape(page.title)
            yield f'<a class="{what}" href="{page.name}.html"><small>{word}</small>{title}</a>'
