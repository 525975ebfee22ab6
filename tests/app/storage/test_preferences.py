"""Preferences survive being written, and whatever stands in their file does no harm."""

import json
import os
from dataclasses import replace
from pathlib import Path

import pytest

from app.errors import LissomError
from app.folders import home_folder, settings_folder
from app.storage import preferences
from app.storage.preferences import (
    MOST_RECENT,
    Preferences,
    load_preferences,
    save_preferences,
)

CHOSEN = Preferences(
    theme="light",
    scale=1.75,
    auto_key=False,
    backdrop="#12ab9f",
    language="de",
    ghosts_before=0,
    ghosts_after=6,
    ghost_step=24,
    recent=(Path("/drawings/cow.png"), Path("/walk – Ä.lissom"), Path(os.fsdecode(b"/caf\xe9"))),
    folder=Path("/drawings"),
)


def test_what_was_chosen_comes_back(tmp_path):
    folder = tmp_path / "not there yet"
    save_preferences(folder, CHOSEN)
    assert load_preferences(folder) == CHOSEN
    save_preferences(folder, Preferences())
    assert load_preferences(folder) == Preferences()
    assert [path.name for path in folder.iterdir()] == ["preferences.json"]


@pytest.mark.parametrize(
    "content",
    [b"", b"{", b"\xff\xfe\x00", b"null", b"[1]", b"[" * 100_000, b'{"theme": "light"'],
    ids=["empty", "torn", "no text", "null", "list", "deep", "cut"],
)
def test_a_damaged_file_is_as_none(tmp_path, content):
    (tmp_path / "preferences.json").write_bytes(content)
    assert load_preferences(tmp_path) == Preferences()


@pytest.mark.parametrize(
    ("name", "values"),
    [
        ("theme", ["purple", 3, None, ["dark"]]),
        ("scale", [True, 0, 0.7499, 3.01, 1e300, -1, "1", None, float("nan"), float("inf"), [1]]),
        ("auto_key", [None, 0, "no", {}]),
        ("backdrop", ["#12345", "#1234567", "#GGGGGG", "red", 7, None]),
        ("language", ["tlh", "../de", 7, None, ["de"]]),
        ("ghosts_before", [True, -1, 7, "2", None, float("nan")]),
        ("ghosts_after", [-1, 7, {}]),
        ("ghost_step", [0, 25, []]),
        ("recent", ["/a.png", 3, None, {}]),
        ("folder", [3, None, ["/a"]]),
    ],
)
def test_an_entry_that_makes_no_sense_is_as_it_is_at_first(tmp_path, name, values):
    save_preferences(tmp_path, CHOSEN)
    file = tmp_path / "preferences.json"
    content = json.loads(file.read_text(encoding="utf-8"))
    for value in values:
        file.write_text(json.dumps(content | {name: value}), encoding="utf-8")
        first = {name: getattr(Preferences(), name)}
        assert load_preferences(tmp_path) == replace(CHOSEN, **first), value


def test_keys_of_actions_survive_a_change_of_the_language(tmp_path, monkeypatch):
    german = {"Undo": "Rückgängig"}
    monkeypatch.setattr(preferences, "_", lambda text: german.get(text, text))
    monkeypatch.setattr(preferences, "source_text", {german[text]: text for text in german}.get)
    save_preferences(tmp_path, Preferences(keys={"Rückgängig": "Ctrl+J"}, language="de"))
    assert load_preferences(tmp_path).keys == {"Rückgängig": "Ctrl+J"}
    monkeypatch.undo()
    assert load_preferences(tmp_path) == Preferences(keys={"Undo": "Ctrl+J"}, language="de")


def test_a_later_version_may_know_more(tmp_path):
    save_preferences(tmp_path, CHOSEN)
    file = tmp_path / "preferences.json"
    content = json.loads(file.read_text(encoding="utf-8"))
    content["recent"] += [None, 5]
    file.write_text(json.dumps(content | {"dialect": "tlh"}), encoding="utf-8")
    assert load_preferences(tmp_path) == CHOSEN


def test_a_folder_that_cannot_be_written_is_reported_and_does_no_harm(tmp_path):
    folder = tmp_path / "file"
    folder.write_bytes(b"")
    with pytest.raises(LissomError, match=r"the folder .*file cannot be made: File exists"):
        save_preferences(folder, CHOSEN)
    assert load_preferences(folder) == Preferences()


def test_whoever_has_no_folder_of_their_own_has_the_topmost_one(monkeypatch):
    def nobody(_):
        raise RuntimeError("Could not determine home directory.")

    monkeypatch.setattr(Path, "home", classmethod(nobody))
    monkeypatch.delenv("XDG_CONFIG_HOME", raising=False)
    assert home_folder() == Path(Path.cwd().anchor)
    assert settings_folder().is_relative_to(home_folder())


def test_recent_files_are_the_newest_ones_once_each():
    preferences = Preferences(theme="light")
    paths = [Path(f"/{number}/drawing.png") for number in range(MOST_RECENT + 3)]
    for path in (*paths, paths[-2]):
        preferences = preferences.with_recent(path)
    newest = [paths[-2], paths[-1], *paths[-3 : -MOST_RECENT - 1 : -1]]
    assert list(preferences.recent) == newest
    assert preferences.folder == paths[-2].parent
    assert preferences.theme == "light"
    fewer = preferences.without_recent(paths[-1])
    assert list(fewer.recent) == [newest[0], *newest[2:]]
    assert fewer.without_recent(Path("/other.png")) == fewer


def test_the_folder_follows_the_system(monkeypatch, tmp_path):
    monkeypatch.setattr("app.folders.sys.platform", "linux")
    monkeypatch.setenv("HOME", str(tmp_path))
    monkeypatch.setenv("XDG_CONFIG_HOME", "/etc/mine")
    assert settings_folder() == Path("/etc/mine/lissom")
    for nowhere in ("", "relative"):
        monkeypatch.setenv("XDG_CONFIG_HOME", nowhere)
        assert settings_folder() == tmp_path / ".config" / "lissom"
    monkeypatch.delenv("XDG_CONFIG_HOME")
    assert settings_folder() == tmp_path / ".config" / "lissom"
    monkeypatch.setenv("XDG_CONFIG_HOME", "/etc/mine")
    monkeypatch.setattr("app.folders.sys.platform", "darwin")
    assert settings_folder() == tmp_path / "Library" / "Application Support" / "Lissom"
    monkeypatch.setattr("app.folders.sys.platform", "win32")
    monkeypatch.setenv("APPDATA", "/mine/Roaming")
    assert settings_folder() == Path("/mine/Roaming/Lissom")
    monkeypatch.setenv("APPDATA", "")
    assert settings_folder() == tmp_path / "AppData" / "Roaming" / "Lissom"
    monkeypatch.delenv("APPDATA")
    assert settings_folder() == tmp_path / "AppData" / "Roaming" / "Lissom"
