"""Sounds of a pose script are files beside it."""

import json

import pytest
from animations import bar_document
from sound_files import sine, wav

from app.errors import LissomError
from app.solving import load_pose_script, pose_document

SCRIPT = {"schema": 1, "handles": {}, "keys": [{"frame": 0}]}


@pytest.fixture
def folder(tmp_path):
    (tmp_path / "talk.wav").write_bytes(wav(sine(1.0)))
    (tmp_path / "diary.wav").write_text("Dear diary, " * 100)
    return tmp_path


def posed(folder, *sounds):
    path = folder / "script.json"
    path.write_text(json.dumps({**SCRIPT, "sounds": sounds}))
    document, _ = pose_document(bar_document(), load_pose_script(path), lambda _: None)
    return document


def test_script_takes_its_sounds_from_its_folder(folder):
    volume = [{"frame": 0, "volume": 0}, {"frame": 12, "volume": 1, "easing": "in"}]
    whole, part = posed(
        folder,
        {"file": "talk.wav"},
        {"file": "talk.wav", "name": "part", "at": 7.5, "from": 0.25, "to": 9, "volume": volume},
    ).sounds
    assert (whole.name, whole.start, whole.skip, whole.length) == ("talk", 0, 0, 1)
    assert whole.file.data == (folder / "talk.wav").read_bytes()
    assert (part.name, part.start, part.skip, part.length) == ("part", 7.5, 0.25, 0.75)
    assert [(key.frame, key.value) for key in part.keys] == [(0, 0), (12, 1)]


def test_number_is_the_volume_of_all_frames(folder):
    (talk,) = posed(folder, {"file": "talk.wav", "volume": 0.5, "muted": True}).sounds
    assert (talk.volume, talk.keys, talk.muted) == (0.5, (), True)


@pytest.mark.parametrize(
    ("sound", "words"),
    [
        ({"file": "none.wav"}, r"sounds\[0\]: cannot read .*none.wav"),
        ({"file": "diary.wav"}, r"sounds\[0\]: diary.wav is not a sound"),
        ({"file": "talk.wav", "volume": 2}, r"sounds\[0\].volume: A volume must be from 0 to 1"),
        ({"file": "talk.wav", "volume": []}, r"sounds\[0\].volume must be a list of at least one"),
        ({"file": "talk.wav", "from": 2}, r"sounds\[0\]: talk.wav lasts 1 s"),
        ({"file": "talk.wav", "from": 0.5, "to": 0.5}, r'sounds\[0\]: "from" and "to"'),
        ({"file": "talk.wav", "frame": 2}, "unknown field 'frame'"),
        ({"at": 2}, "file"),
    ],
)
def test_wrong_sounds_are_refused_in_one_sentence(folder, sound, words):
    with pytest.raises(LissomError, match=words):
        posed(folder, sound)
