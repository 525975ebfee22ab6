"""Projects keep the bytes of their sounds; autosave writes them once."""

import os
import zipfile
from dataclasses import replace

import pytest
from documents import differences, disc_document
from full_disk import FullDisk
from sound_files import sine, sound, wav

from app.document import VOLUME, Cue, Mouths, SoundFile, sound_commands
from app.errors import LissomError
from app.storage.autosave import (
    UNKNOWN_SOURCE,
    Autosave,
    load_recoverable_file,
    remove_recoverable_file,
)
from app.storage.project_file import load_project, save_project

TALK = wav(sine(0.3))
MOUTHS = Mouths(switch="mouth", cues=(Cue(seconds=0.1, name="A"),), drawings=(("A", 1),))


def spoken():
    talk = sound(TALK, start=3.5)
    keys = (VOLUME.key(0, 0.5), VOLUME.key(9, 1.0))
    return replace(
        disc_document(),
        sounds=(talk, replace(talk, name="again", keys=keys, muted=True, mouths=MOUTHS)),
    )


def test_project_keeps_its_sounds_and_their_bytes_once(tmp_path):
    document, path = spoken(), tmp_path / "a.lissom"
    save_project(path, document)
    loaded = load_project(path)
    assert differences(loaded, document) == []
    assert [each.file.data for each in loaded.sounds] == [TALK, TALK]
    with zipfile.ZipFile(path) as members:
        names = [name for name in members.namelist() if name.startswith("sounds/")]
        assert [members.read(name) for name in names] == [TALK]


@pytest.mark.parametrize("damage", ["lacks it", "has another"])
def test_project_opens_without_the_bytes_of_a_sound(tmp_path, damage):
    whole, path = tmp_path / "a.lissom", tmp_path / "b.lissom"
    save_project(whole, spoken())
    with zipfile.ZipFile(whole) as old, zipfile.ZipFile(path, "w") as new:
        for member in old.infolist():
            content = old.read(member)
            if member.filename.startswith("sounds/"):
                if damage == "lacks it":
                    continue
                content = bytes(len(content))
            new.writestr(member, content)
    loaded = load_project(path)
    assert [each.file.data for each in loaded.sounds] == [None, None]
    file = sound(TALK).file
    assert loaded.sounds[0].file.sha256 == file.sha256
    found = sound_commands.replace_sound_file("talk", file)(loaded)
    assert [each.file.data for each in found.sounds] == [TALK, TALK]
    save_project(path, found)
    assert load_project(path).sounds[0].file.data == TALK


def test_autosave_writes_the_bytes_of_a_sound_once(tmp_path):
    own, document = Autosave(tmp_path), spoken()
    own.write(document, UNKNOWN_SOURCE)
    (kept,) = tmp_path.glob("*.sound")
    os.utime(kept, (1, 1))
    own.write(sound_commands.mute_sound("talk", muted=True)(document), UNKNOWN_SOURCE)
    assert kept.stat().st_mtime == 1
    (path,) = tmp_path.glob("*.lissom")
    with zipfile.ZipFile(path) as members:
        assert not [name for name in members.namelist() if name.startswith("sounds/")]
    loaded, _ = load_recoverable_file(path)
    assert [each.file.data for each in loaded.sounds] == [TALK, TALK]
    own.remove()
    assert list(tmp_path.iterdir()) == []


def test_recovered_work_takes_its_sounds_along(tmp_path):
    Autosave(tmp_path).write(spoken(), UNKNOWN_SOURCE)
    (path,) = tmp_path.glob("*.lissom")
    (kept,) = tmp_path.glob("*.sound")
    kept.write_bytes(b"damaged")
    assert load_recoverable_file(path)[0].sounds[0].file.data is None
    remove_recoverable_file(path)
    assert not list(tmp_path.glob("*.sound"))


def test_replacing_a_file_by_a_shorter_one_cuts_the_sound():
    document = spoken()
    shorter: SoundFile = sound(wav(sine(0.2)), "other.wav").file
    talk, again = sound_commands.replace_sound_file("talk", shorter)(document).sounds
    assert (talk.file.name, talk.length) == ("other.wav", 0.2)
    assert again is document.sounds[1]


def test_full_disk_keeps_the_autosave_of_before(tmp_path, monkeypatch):
    own, document = Autosave(tmp_path), spoken()
    own.write(replace(document, sounds=()), UNKNOWN_SOURCE)
    (path,) = tmp_path.glob("*.lissom")
    with monkeypatch.context() as full:
        full.setattr("app.storage.files.atomic.os.fdopen", FullDisk)
        FullDisk.room = len(TALK) - 1
        with pytest.raises(LissomError, match="No space left on device"):
            own.write(document, UNKNOWN_SOURCE)
    assert not list(tmp_path.glob("*.sound"))
    assert load_recoverable_file(path)[0].sounds == ()
    own.write(document, UNKNOWN_SOURCE)
    assert load_recoverable_file(path)[0].sounds[0].file.data == TALK
    own.remove()
