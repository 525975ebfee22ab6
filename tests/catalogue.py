"""The catalogue of texts: `python -m tests.catalogue` writes it anew, and updates the languages.

It prints what each language lacks, to be filled in there.
"""

import ast
import re
import sys
from collections.abc import Iterator, Mapping
from io import BytesIO
from pathlib import Path

from babel.messages.catalog import Catalog
from babel.messages.pofile import read_po, write_po

from app.texts import DOMAIN, LOCALE, parse_translations, read_translations

ROOT = Path(__file__).parents[1]
TEMPLATE = LOCALE / f"{DOMAIN}.pot"
# What takes a text as its first argument, and a text and its plural as the first two.
MARKS, PLURALS = {"_", "N_", "EngineError", "Message", "gettext"}, {"ngettext", "count_message"}


# Checks of the engine, whose messages have the name of a thing, and where they take it.
CHECKS = {
    "as_count": 1,
    "as_number": 1,
    "as_points": 1,
    "as_reals": 1,
    "as_tuple": 1,
    "require_inside": 2,
    "require_kind": 2,
    "require_simple": 1,
    "require_word": 2,
}


def source_files() -> list[Path]:
    """Return the modules of the program."""
    files = [path for room in ("app", "engine") for path in sorted((ROOT / room).rglob("*.py"))]
    examples = ROOT / "engine" / "examples"
    return [each for each in files if examples not in each.parents]


def marked_texts(source: str, name: str = "") -> Iterator[str | tuple[str, str]]:
    """Yield the marked texts of a module, none of which may be an f-string."""
    tree = ast.parse(source)
    constants = {
        target.id: node.value
        for node in ast.walk(tree)
        if isinstance(node, (ast.Assign, ast.AnnAssign)) and node.value is not None
        for target in (node.targets if isinstance(node, ast.Assign) else [node.target])
        if isinstance(target, ast.Name)
    }
    for node in ast.walk(tree):
        if not isinstance(node, ast.Call):
            continue
        function = node.func.attr if isinstance(node.func, ast.Attribute) else None
        function = node.func.id if isinstance(node.func, ast.Name) else function
        first = CHECKS.get(function or "", 0)
        if function not in MARKS | PLURALS | CHECKS.keys():
            continue
        count = 2 if function in PLURALS else 1
        texts = []
        for argument in node.args[first : first + count]:
            value = constants.get(argument.id) if isinstance(argument, ast.Name) else argument
            has_fields = isinstance(value, ast.JoinedStr) and function not in CHECKS
            assert not has_fields, f"{name}:{node.lineno}: has fields"
            if isinstance(value, ast.Constant) and isinstance(value.value, str):
                texts.append(value.value)
        if len(texts) == count:
            yield texts[0] if count == 1 else (texts[0], texts[1])


def make_catalogue() -> bytes:
    """Return the catalogue of all marked texts as a gettext template."""
    catalogue = Catalog(project="Lissom", fuzzy=False)
    for path in source_files():
        at = path.relative_to(ROOT).as_posix()
        for text in marked_texts(path.read_text(encoding="utf-8"), at):
            catalogue.add(text, locations=[(at, 0)])
    written = BytesIO()
    write_po(written, catalogue, omit_header=True, sort_output=True, include_lineno=False, width=98)
    return written.getvalue()


def translated_files() -> list[Path]:
    """Return the files of all languages beside English."""
    return sorted(LOCALE.glob("*.po"))


def template_texts() -> list[tuple[str, ...]]:
    """Return the catalogue's texts in its order, each with its plural if it has one."""
    with TEMPLATE.open("rb") as file:
        messages = [message for message in read_po(file) if message.id]
    return [message.id if message.pluralizable else (message.id,) for message in messages]


def quote(text: str) -> str:
    """Return a text as files of translations have it, on one line."""
    escaped = (
        text.replace("\\", "\\\\").replace('"', '\\"').replace("\n", "\\n").replace("\t", "\\t")
    )
    return f'"{escaped}"'


def read_merged(path: Path) -> dict[str, tuple[str, ...]]:
    """Return the translations of a file, or of both sides of a merge with conflicts in it."""
    text = re.sub(
        r"^(<{7}|={7}|>{7}).*\n", "", path.read_text(encoding="utf-8"), flags=re.MULTILINE
    )
    text = re.sub(r'^msgstr ""\n(?=msgstr ")', "", text, flags=re.MULTILINE)
    text = re.sub(r"^(msgstr .*\n)(msgstr .*\n)+", r"\1", text, flags=re.MULTILINE)
    return parse_translations(text)


def make_translations(known: Mapping[str, tuple[str, ...]]) -> str:
    """Return a file of the known translations: all of the catalogue's texts, and no others.

    Each text is on one line, without its place in the program, so that changes merge well.
    """
    (header,) = known[""]
    count = int(re.search(r"nplurals=(\d)", header)[1])
    entries = [
        'msgid ""\nmsgstr ""\n'
        + "".join(f"{quote(line)}\n" for line in header.splitlines(keepends=True))
    ]
    for text in template_texts():
        translated = known.get(text[0], ())
        if len(text) == 1:
            lines = [f"msgid {quote(text[0])}", f"msgstr {quote((*translated, '')[0])}"]
        else:
            forms = translated if len(translated) == count else ("",) * count
            lines = [f"msgid {quote(text[0])}", f"msgid_plural {quote(text[1])}"]
            lines += [f"msgstr[{i}] {quote(form)}" for i, form in enumerate(forms)]
        entries.append("\n".join(lines) + "\n")
    return "\n".join(entries)


def missing_texts(path: Path) -> list[str]:
    """Return the texts of the catalogue that a language lacks."""
    known = read_translations(path)
    return [text[0] for text in template_texts() if not all(known.get(text[0], ("",)))]


if __name__ == "__main__":
    TEMPLATE.parent.mkdir(exist_ok=True)
    TEMPLATE.write_bytes(make_catalogue())
    for path in translated_files():
        path.write_text(make_translations(read_merged(path)), encoding="utf-8")
        for text in missing_texts(path):
            sys.stdout.write(f"{path.name}: {text[:80]!r}\n")
