"""The project's language: no private words, no files that take long to read."""

import io
import re
import tokenize
from pathlib import Path

ROOT = Path(__file__).parents[1]
# Words with a usual term of the field in their place, which `words` of the README's glossary gives.
PRIVATE = re.compile(
    r"wish(es|ed)?|insist(s|ed|ing)?|hang(s|ing)?|hung|carriers?|sights?|film(s|ed|ing)|placings?"
    r"|puppets?|twins?|promis(es?|ed)|upkeep|errands?|shortfalls?|passages?|transits?|courses"
    r"|likeness(es)?|renewals?|stillness|told"
)
LONGEST = 300  # lines of a module

# Names in files of earlier versions, and the tool of another program.
READ = {
    "app/storage/autosave.py": {"told"},
    "app/storage/project/document_json.py": {"stillness", "told"},
    "app/storage/project/earlier_schemas.py": {"placings"},
    "app/manual/pages/after-effects.md": {"puppet"},
}
REPLACED_LONG = {
    "app/document/layer.py",
    "app/document/model.py",
}
# Tables are looked things up in, and read by nobody from end to end.
TABLES = {
    "app/document/__init__.py",
    "app/export_formats.py",
    "app/storage/project/document_json.py",
}


def modules() -> list[Path]:
    return [path for root in ("app", "engine") for path in sorted((ROOT / root).rglob("*.py"))]


def private_words(text: str) -> set[str]:
    """Return the private words in a text or an identifier."""
    words = re.findall(r"[A-Z]?[a-z]+|[A-Z]+(?![a-z])", text)
    return {word.lower() for word in words if PRIVATE.fullmatch(word.lower())}


def test_modules_have_no_private_words():
    found = {}
    for path in modules():
        name = path.relative_to(ROOT).as_posix()
        words = private_words(path.stem)
        for token in tokenize.generate_tokens(io.StringIO(path.read_text("utf-8")).readline):
            if token.type in {tokenize.NAME, tokenize.STRING, tokenize.COMMENT}:
                words |= private_words(token.string)
        if words:
            found[name] = words
    assert found == {name: words for name, words in READ.items() if name.endswith(".py")}


def test_pages_have_no_private_words():
    pages = [*(ROOT / "app" / "manual" / "pages").glob("*.md"), *ROOT.glob("*.md")]
    pages += [ROOT / room / "README.md" for room in ("app", "engine", "tests")]
    found = {
        page.relative_to(ROOT).as_posix(): words
        for page in pages
        if (words := private_words(page.read_text("utf-8")))
    }
    assert found == {name: words for name, words in READ.items() if name.endswith(".md")}


def test_modules_are_short():
    lengths = {
        path.relative_to(ROOT).as_posix(): len(path.read_text("utf-8").splitlines())
        for path in modules()
    }
    long = {name for name, lines in lengths.items() if lines > LONGEST}
    assert long - TABLES - REPLACED_LONG == set()
    # What has become short needs no exemption.
    assert (TABLES | REPLACED_LONG) - long == set()
