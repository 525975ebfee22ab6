from pathlib import Path
from types import SimpleNamespace

import pytest
from messages import says

from app.errors import LissomError
from app.export.destination import (
    TOO_LITTLE_ROOM,
    FrameNames,
    check_destination,
    check_room,
    choose_frame_folder,
    find_overwritten_files,
    with_suffix_for,
)

NAMES = FrameNames(pattern="frame_####", project="walk")


@pytest.mark.parametrize(
    ("name", "format_", "wanted"),
    [
        ("shot.010", "png", "shot.010"),
        ("shot.010", "gif", "shot.010.gif"),
        ("shot.010.gif", "webp", "shot.010.webp"),
        ("walk", "png", "walk"),
        ("walk.gif", "png", "walk frames"),
        ("walk.GIF", "gif", "walk.GIF"),
        ("walk.png", "apng", "walk.png"),
        ("walk.apng", "spritesheet", "walk.png"),
        ("walk frames", "mp4", "walk.mp4"),
        ("walk frames.mp4", "png", "walk frames"),
        ("walk frames", "png", "walk frames"),
        (" frames", "gif", " frames.gif"),
    ],
)
def test_only_the_endings_of_formats_give_way_to_each_other(tmp_path, name, format_, wanted):
    assert with_suffix_for(tmp_path / name, format_) == tmp_path / wanted


def test_a_folder_that_is_there_keeps_its_name(tmp_path):
    (tmp_path / "walk.gif").mkdir()
    assert with_suffix_for(tmp_path / "walk.gif", "png") == tmp_path / "walk.gif"


def test_frames_do_not_lie_among_other_files(tmp_path):
    assert choose_frame_folder(tmp_path, "walk frames", NAMES.fits) == tmp_path  # it is empty
    (tmp_path / "frame_0001.png").write_bytes(b"")
    (tmp_path / ".DS_Store").write_bytes(b"")
    assert (
        choose_frame_folder(tmp_path, "walk frames", NAMES.fits) == tmp_path
    )  # it holds frames alone
    (tmp_path / "letter.txt").write_bytes(b"")
    inner = tmp_path / "walk frames"
    assert choose_frame_folder(tmp_path, "walk frames", NAMES.fits) == inner
    inner.mkdir()
    (inner / "notes.txt").write_bytes(b"")
    assert choose_frame_folder(inner, "walk frames", NAMES.fits) == inner  # it has the name


def test_what_an_export_takes_the_place_of_is_known_before(tmp_path):
    frames = ["frame_0000.png", "frame_0001.png"]
    assert find_overwritten_files(tmp_path / "none", "png", frames) == []
    (tmp_path / "frame_0001.png").write_bytes(b"")
    (tmp_path / "frame_0002.png").write_bytes(b"")
    assert find_overwritten_files(tmp_path, "png", frames) == ["frame_0001.png"]
    assert find_overwritten_files(tmp_path / "walk.gif", "gif", frames) == []
    (tmp_path / "walk.gif").write_bytes(b"")
    assert find_overwritten_files(tmp_path / "walk.gif", "gif", frames) == ["walk.gif"]


def test_names_of_frames_are_found_again():
    names = FrameNames(pattern="{name}.##_a", project="the walk")
    assert names.of(8, 3) == [f"the walk.{n}_a.png" for n in ("08", "09", "10")]
    assert names.of(99, 2) == ["the walk.099_a.png", "the walk.100_a.png"]
    assert all(names.fits(name) for name in names.of(95, 10))
    for other in (
        "the walk.8_a.png",
        "the walk.08_b.png",
        "the walkx08_a.png",
        "the walk.08_a.gif",
    ):
        assert not names.fits(other)


def test_what_does_not_fit_on_the_disk_is_refused(tmp_path):
    check_room(tmp_path / "a.gif", 1000)
    with pytest.raises(LissomError, match=says(TOO_LITTLE_ROOM)):
        check_room(tmp_path / "a.gif", 10**18)


def test_disk_has_room_for_exactly_what_is_free(tmp_path, monkeypatch):
    monkeypatch.setattr("shutil.disk_usage", lambda _: SimpleNamespace(free=1000))
    check_room(tmp_path / "a.gif", 1000)
    with pytest.raises(LissomError, match=says(TOO_LITTLE_ROOM)):
        check_room(tmp_path / "a.gif", 1001)


def test_a_folder_that_may_not_be_written_to_is_refused(tmp_path, monkeypatch):
    check_destination(tmp_path / "a.gif", "gif")
    monkeypatch.setattr("os.access", lambda path, _: Path(path) != tmp_path)
    for out, format_ in ((tmp_path / "a.gif", "gif"), (tmp_path / "frames", "png")):
        with pytest.raises(LissomError, match="no permission to write to"):
            check_destination(out, format_)


def test_the_data_of_a_sheet_are_asked_about_too(tmp_path):
    (tmp_path / "walk.json").write_bytes(b"precious")
    assert find_overwritten_files(tmp_path / "walk.png", "spritesheet", []) == ["walk.json"]
    assert find_overwritten_files(tmp_path / "walk.png", "apng", []) == []
    (tmp_path / "run.json").mkdir()
    with pytest.raises(LissomError, match="is a folder"):
        check_destination(tmp_path / "run.png", "spritesheet")
