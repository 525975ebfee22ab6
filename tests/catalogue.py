"""The catalogue of texts: `python -m tests.catalogue` writes it anew."""

import ast
from collections.abc import Iterator
from io import BytesIO
from pathlib import Path

from babel.messages.catalog import Catalog
from babel.messages.pofile import write_po

from app.texts import DOMAIN, LOCALE

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


if __name__ == "__main__":
    TEMPLATE.parent.mkdir(exist_ok=True)
    TEMPLATE.write_bytes(make_catalogue())
