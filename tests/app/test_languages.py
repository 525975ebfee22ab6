"""Languages beside English: complete, with all fields, and chosen as the person wants."""

import json
import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

from app import texts
from app.texts import ENGLISH, LOCALE, list_languages, read_system_languages, read_translations
from app.ui.shortcuts.table import ACTIONS, MENUS
from tests.catalogue import (
    make_translations,
    missing_texts,
    read_merged,
    template_texts,
    translated_files,
)

SUPPORT = Path(__file__).parents[1] / "support"
FIELD = re.compile(r"\{\w+[^{}]*\}|%\(\w+\)\w|%[srd%]")
VARIABLES = ("LISSOM_LANGUAGE", "LC_ALL", "LC_MESSAGES", "LANG", "LANGUAGE")
READ = """
from pseudo_language import Reader
reader = Reader()
from harness import Harness
window = Harness()
window.frames(3)
print("\\n".join(reader.read))
"""


@pytest.fixture(params=translated_files(), ids=lambda path: path.stem)
def language(request):
    return request.param


@pytest.fixture
def nowhere(monkeypatch, tmp_path):
    """A system that says nothing of its language, and a person without preferences."""
    for name in VARIABLES:
        monkeypatch.delenv(name, raising=False)
    monkeypatch.setattr(texts, "preferences_file", lambda: tmp_path / "preferences.json")
    return tmp_path


def test_languages_are_complete(language):
    assert missing_texts(language) == [], "python -m tests.catalogue prints them"
    written = language.read_text(encoding="utf-8")
    assert "fuzzy" not in written
    assert written == make_translations(read_translations(language)), "python -m tests.catalogue"


def test_translations_have_the_fields_and_the_ends_of_the_english_texts(language):
    known, wrong = read_translations(language), []
    for english in template_texts():
        for form in known.get(english[0], ()):
            # The form for one may name the number by a word.
            fields = [set(FIELD.findall(each)) for each in (english[0], english[-1])]
            has_fields = set(FIELD.findall(form)) in fields
            if not has_fields or end_of(form) != end_of(english[0]):
                wrong.append((english[0], form))
    assert wrong == []


def end_of(text):
    """Return spaces around a text, how it closes, and whether it has an id of ImGui's."""
    closing = next((sign for sign in ".…?:" if text.endswith(sign)), "")
    return text[:1].isspace(), text[-1:].isspace(), closing, "##" in text


def test_labels_of_actions_and_menus_stay_apart(language):
    """Labels find actions, and are ids in menus."""
    known = read_translations(language)
    for names in (list(ACTIONS), list(MENUS)):
        translated = [known[name][0] for name in names]
        assert len(set(translated)) == len(names), sorted(translated)


def test_a_third_language_is_one_file(nowhere, monkeypatch):
    rule = "nplurals=3; plural=(n==1 ? 0 : n<5 ? 1 : 2);"
    (nowhere / "xx.po").write_text(
        'msgid ""\nmsgstr ""\n"X-Language-Name: Xanadu\\n"\n'
        f'"Plural-Forms: {rule}\\n"\n\n'
        'msgid "Undo"\nmsgstr ""\n"Back"\n"wards"\n\n'
        'msgid "{count} key"\nmsgid_plural "{count} keys"\n'
        'msgstr[0] "one \\"key\\""\nmsgstr[1] "few\\n"\nmsgstr[2] "many"\n\n'
        'msgid "Redo"\nmsgstr ""'
    )
    monkeypatch.setattr(texts, "LOCALE", nowhere)
    monkeypatch.setenv("LC_ALL", "xx_YY.UTF-8@dialect")
    spoken = texts._translations()
    assert (spoken.gettext("Undo"), spoken.gettext("Redo")) == ("Backwards", "Redo")
    counted = [spoken.ngettext("{count} key", "{count} keys", count) for count in (1, 3, 7)]
    assert counted == ['one "key"', "few\n", "many"]
    assert spoken.ngettext("{count} pose", "{count} poses", 2) == "{count} poses"
    assert spoken.source_of("Backwards") == "Undo"
    list_languages.cache_clear()
    assert list_languages() == {ENGLISH: "English", "xx": "Xanadu"}
    list_languages.cache_clear()


@pytest.mark.usefixtures("nowhere")
@pytest.mark.parametrize(
    ("variables", "codes"),
    [
        ({"LANG": "de_AT.UTF-8"}, ["de_AT"]),
        ({"LANG": "de_DE.UTF-8", "LC_MESSAGES": "fr_FR"}, ["fr_FR"]),
        ({"LANG": "de_DE.UTF-8", "LC_ALL": "C.UTF-8", "LANGUAGE": "de"}, []),
        ({"LANG": "en_GB.UTF-8", "LANGUAGE": "de_CH:fr"}, ["de_CH", "fr", "en_GB"]),
        ({"LANG": "pt-BR"}, ["pt_BR"]),
    ],
)
def test_language_of_the_system(monkeypatch, variables, codes):
    for name, value in variables.items():
        monkeypatch.setenv(name, value)
    assert read_system_languages() == codes


@pytest.mark.parametrize(
    "content", [b"\xff\xfe", b'msgid ""\nmsgstr ""\n"plural=(n;\\n"\n', b"", b"msgid"]
)
def test_a_damaged_file_leaves_the_texts_english(nowhere, monkeypatch, content):
    (nowhere / "xx.po").write_bytes(content)
    monkeypatch.setattr(texts, "LOCALE", nowhere)
    monkeypatch.setenv("LISSOM_LANGUAGE", "xx")
    assert texts._translations().ngettext("{count} key", "{count} keys", 2) == "{count} keys"
    list_languages.cache_clear()
    assert list_languages()["xx"] == "xx"
    list_languages.cache_clear()


def test_preferences_come_before_the_system_and_a_variable_before_both(nowhere, monkeypatch):
    def is_english():
        return texts._translations().gettext("Undo") == "Undo"

    monkeypatch.setenv("LANG", "de_DE.UTF-8")
    assert not is_english()
    file = nowhere / "preferences.json"
    for content in ('{"language": "en"}', '{"language": "EN'):
        file.write_text(content, encoding="utf-8")
        assert is_english() == content.endswith("}")
    for other in ("", "tlh", "../de", 7, None, ["en"]):
        file.write_text(json.dumps({"language": other}), encoding="utf-8")
        # Of a language without a file the texts stay English.
        assert is_english() == (other in ("tlh", "../de")), other
    monkeypatch.setenv("LISSOM_LANGUAGE", "de")
    assert not is_english()


def test_merges_with_conflicts_keep_the_translations_of_both_sides(tmp_path):
    path = tmp_path / "de.po"
    path.write_text(
        'msgid "a"\n<<<<<<< HEAD\nmsgstr ""\n=======\nmsgstr "A"\n>>>>>>> mine\n\n'
        '<<<<<<< HEAD\nmsgid "b"\nmsgstr "B"\n\n=======\nmsgid "b"\nmsgstr ""\n\n>>>>>>> mine\n'
    )
    assert read_merged(path) == {"a": ("A",), "b": ("B",)}


def test_window_and_terminal_speak_german_on_a_german_system(tmp_path):
    environment = {name: value for name, value in os.environ.items() if name not in VARIABLES}
    environment |= {
        "LANG": "de_DE.UTF-8",
        "HOME": str(tmp_path),
        "APPDATA": str(tmp_path),
        "XDG_CONFIG_HOME": str(tmp_path),
        "PYTHONPATH": os.pathsep.join([*sys.path, str(SUPPORT)]),
    }

    def said(*words):
        command = [sys.executable, *words]
        return subprocess.run(
            command, env=environment, capture_output=True, encoding="utf-8", check=True
        ).stdout

    assert said("-X", "utf8", "-m", "app", "--help").startswith("Aufruf: lissom")
    drawn = {text.partition("##")[0] for text in said("-X", "utf8", "-c", READ).splitlines()}
    german = read_translations(LOCALE / "de.po")
    del german[""]
    assert {"Datei", "Bearbeiten", "Eines davon ausprobieren"} <= drawn
    spoken = {form for forms in german.values() for form in forms}
    assert {text for text in drawn if text in german} <= spoken


@pytest.mark.long
def test_buttons_show_their_whole_german_text():
    command = [sys.executable, "-m", "pytest", "-n", "0", "tests/app/ui/test_button_texts.py"]
    environment = {**os.environ, "LISSOM_LANGUAGE": "de"}
    ended = subprocess.run(
        command,
        cwd=SUPPORT.parents[1],
        env=environment,
        capture_output=True,
        text=True,
        check=False,
    )
    assert ended.returncode == 0, ended.stdout
