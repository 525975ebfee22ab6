"""The sound of a video is the source, sample by sample, from the first exported frame on."""

from dataclasses import replace
from pathlib import Path

import av
import numpy as np
import pytest
from animations import moving_document
from documents import altered
from exports import draw, plan_for, run
from full_disk import FullDisk
from sound_files import clicks, lag, noise, sound, wav

from app.cli.main import main
from app.document import Document, ExportSettings
from app.errors import LissomError
from app.sound import Soundtrack, find_soundtrack, list_sound_notices
from app.storage.project_file import save_project

FPS = 24.0
SOURCE = noise(3.0, channels=2, seed=5)


def levels(signal: np.ndarray) -> np.ndarray:
    return (np.rint(signal * 32_767) / 32_768).astype(np.float32)


def spoken(rate: int = 48_000, **changes) -> Document:
    talk = sound(wav(noise(3.0, rate, channels=2, seed=5), rate), **changes)
    return replace(altered(moving_document(48), fps=FPS), sounds=(talk,))


def exported(path: Path, document: Document, first: int, count: int, fps: float = FPS) -> Path:
    track = Soundtrack(document=document, first=first, seconds=count / fps)
    times = tuple(float(first + number) for number in range(count))
    plan = plan_for(
        path, path.suffix[1:], times=times, background=(9, 9, 9), fps=fps, soundtrack=track
    )
    run(plan, lambda time: draw(time % 7))
    return path


def heard(path: Path) -> tuple[np.ndarray, int]:
    """The samples of a video (n, 2), as a player plays them, and their rate."""
    with av.open(path) as video:
        stream = video.streams.audio[0]
        resampler = av.AudioResampler(format="fltp", layout="stereo", rate=stream.rate)
        frames = list(video.decode(stream))
        # What comes before time zero primes the decoder, and is not played.
        start = round(frames[0].pts * frames[0].time_base * stream.rate)
        parts = [each.to_ndarray() for frame in frames for each in resampler.resample(frame)]
        samples = np.concatenate(parts, axis=1).T
        return samples[max(-start, 0) :], stream.rate


def test_prores_carries_the_source_sample_by_sample(tmp_path):
    found, rate = heard(exported(tmp_path / "a.mov", spoken(start=-6), 12, 24))
    assert rate == 48_000
    begin = (12 + 6) * 2_000
    assert np.array_equal(found, levels(SOURCE)[begin : begin + 48_000])


@pytest.mark.parametrize("suffix", ["mp4", "webm"])
def test_packed_formats_begin_at_the_same_sample(tmp_path, suffix):
    found, rate = heard(exported(tmp_path / f"a.{suffix}", spoken(), 12, 24))
    assert rate == 48_000
    expected = SOURCE[24_000:72_000]
    assert lag(found[:, 0], expected[:, 0]) == 0
    assert 48_000 <= len(found) < 48_000 + 1_024
    kept = found[2_000:46_000]
    error = np.sqrt(np.mean((kept - expected[2_000:46_000]) ** 2) / np.mean(kept**2))
    assert error < 0.2  # noise is hard to pack


@pytest.mark.parametrize("rate", [8_000, 44_100, 192_000])
def test_sounds_of_any_rate_keep_their_place(tmp_path, rate):
    document = spoken(rate)
    found, own = heard(exported(tmp_path / "a.mov", document, 24, 12))
    assert (own, len(found)) == (rate, rate // 2)
    source = levels(noise(3.0, rate, channels=2, seed=5))
    assert np.array_equal(found, source[rate : rate + rate // 2])


@pytest.mark.parametrize("fps", [23.976, 29.97, 12.5])
def test_sound_is_as_long_as_the_pictures(tmp_path, fps):
    document = replace(spoken(), fps=fps)
    path = exported(tmp_path / "a.mov", document, 7, 20, fps)
    found, rate = heard(path)
    begin = round(7 / fps * rate)
    assert np.array_equal(found, levels(SOURCE)[begin : begin + round(20 / fps * rate)])
    with av.open(path) as video:
        pictures = video.streams.video[0]
        assert pictures.frames == 20


def test_click_is_at_its_frame(tmp_path):
    talk = sound(wav(clicks(2.0, at=(1.5,))), start=12)
    document = replace(spoken(), sounds=(talk,))
    found, rate = heard(exported(tmp_path / "a.mov", document, 24, 36))
    assert np.flatnonzero(found[:, 0]).tolist() == [rate]


@pytest.fixture(scope="module")
def project(tmp_path_factory) -> Path:
    path = tmp_path_factory.mktemp("sounds") / "talk.lissom"
    document = replace(spoken(), export=ExportSettings(size=(64, 48), background="#ffffff"))
    save_project(path, document)
    return path


def test_command_exports_the_sound_of_its_range(project, tmp_path, capsys):
    out = tmp_path / "a.mov"
    assert main(["export", str(project), "--out", str(out), "--frames", "12:23"]) == 0
    assert "sound" not in capsys.readouterr().err
    assert np.array_equal(heard(out)[0], levels(SOURCE)[24_000:48_000])


def test_another_rate_of_pictures_leaves_the_sound_as_it_is(project, tmp_path):
    out = tmp_path / "a.mov"
    words = ["--out", str(out), "--frames", "12:23", "--fps", "12"]
    assert main(["export", str(project), *words]) == 0
    assert np.array_equal(heard(out)[0], levels(SOURCE)[24_000:48_000])


def test_sound_none_leaves_it_out(project, tmp_path, capsys):
    for name in ("a.mp4", "a.gif"):
        out = tmp_path / name
        words = ["--out", str(out), "--frames", "0:2", "--sound", "none"]
        assert main(["export", str(project), *words]) == 0
        assert "sound" not in capsys.readouterr().err
    with av.open(tmp_path / "a.mp4") as video:
        assert not video.streams.audio


def test_formats_without_sound_say_so(project, tmp_path, capsys):
    words = ["--out", str(tmp_path / "a.gif"), "--frames", "0:2"]
    assert main(["export", str(project), *words]) == 0
    line = "the format gif has no sound; mp4, webm, mov, html carry the sounds"
    assert line in capsys.readouterr().err


def test_page_carries_the_sound_and_says_its_size(project, tmp_path, capsys):
    out = tmp_path / "a.html"
    assert main(["export", str(project), "--out", str(out), "--frames", "12:24"]) == 0
    assert "0.5 s of sound take 128 KB of the file" in capsys.readouterr().err
    text = out.read_text(encoding="utf-8")
    assert text.count("data:audio/wav;base64,") == 1
    assert main(["export", str(project), "--out", str(out), "--sound", "none"]) == 0
    assert "data:audio" not in out.read_text(encoding="utf-8")


def test_missing_file_is_named(tmp_path, capsys):
    document = spoken()
    talk = document.sounds[0]
    missing = replace(talk, file=replace(talk.file, data=None))
    path = tmp_path / "a.lissom"
    own = ExportSettings(size=(64, 48), background="#ffffff")
    save_project(path, replace(document, sounds=(missing,), export=own))
    assert main(["export", str(path), "--out", str(tmp_path / "a.mov"), "--frames", "0:2"]) == 0
    assert "the file talk.wav of the sound 'talk' is missing" in capsys.readouterr().err
    assert not heard(tmp_path / "a.mov")[0].any()


@pytest.mark.parametrize("suffix", ["mp4", "webm", "mov"])
@pytest.mark.parametrize("room", [0, 20_000, 120_000])
def test_full_disk_leaves_no_file_and_one_sentence(tmp_path, monkeypatch, capfd, suffix, room):
    document = spoken()
    monkeypatch.setattr("app.storage.files.atomic.os.fdopen", FullDisk)
    # ProRes is the largest by far; the others pack a second into fewer bytes.
    FullDisk.room = room if suffix == "mov" else min(room, 20_000)
    with pytest.raises(LissomError, match=r"No space left on device\. The file needs"):
        exported(tmp_path / f"a.{suffix}", document, 0, 48)
    assert list(tmp_path.iterdir()) == []
    assert capfd.readouterr().err == ""


def test_the_sound_repeats_with_the_frames():
    document = spoken()
    once = Soundtrack(document=document, first=12, seconds=7 / FPS)
    thrice = Soundtrack(document=document, first=12, seconds=3 * 7 / FPS, passes=3)
    whole = np.concatenate(list(once.blocks(48_000, 1_000)))
    repeated = list(thrice.blocks(48_000, 1_000))
    assert {len(block) for block in repeated[:-1]} == {1_000}
    assert np.array_equal(np.concatenate(repeated), np.concatenate([whole] * 3))
    # No sample is lost or doubled where a pass is no whole number of samples.
    uneven = Soundtrack(document=document, first=0, seconds=1.00001, passes=7)
    assert sum(map(len, uneven.blocks(44_100, 333))) == uneven.count(44_100)
    settings = replace(document.export, format="mov", speed=0.5)
    assert find_soundtrack(document, settings, 0, 1.0) is None
    assert "another speed" in list_sound_notices(document, settings, None)[0]
