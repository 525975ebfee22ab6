import pytest

from app.export.destination import folder_within, replaced, suited


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
        ("walk frames", "mp4", "walk frames.mp4"),
    ],
)
def test_only_the_endings_of_formats_give_way_to_each_other(tmp_path, name, format_, wanted):
    assert suited(tmp_path / name, format_) == tmp_path / wanted


def test_a_folder_that_is_there_keeps_its_name(tmp_path):
    (tmp_path / "walk.gif").mkdir()
    assert suited(tmp_path / "walk.gif", "png") == tmp_path / "walk.gif"


def test_frames_do_not_lie_among_other_files(tmp_path):
    assert folder_within(tmp_path, "walk frames") == tmp_path  # it is empty
    (tmp_path / "frame_0001.png").write_bytes(b"")
    (tmp_path / ".DS_Store").write_bytes(b"")
    assert folder_within(tmp_path, "walk frames") == tmp_path  # it holds frames alone
    (tmp_path / "letter.txt").write_bytes(b"")
    inner = tmp_path / "walk frames"
    assert folder_within(tmp_path, "walk frames") == inner
    inner.mkdir()
    (inner / "notes.txt").write_bytes(b"")
    assert folder_within(inner, "walk frames") == inner  # it has the name


def test_what_an_export_takes_the_place_of_is_known_before(tmp_path):
    frames = ["frame_0000.png", "frame_0001.png"]
    assert replaced(tmp_path / "none", "png", frames) == []
    (tmp_path / "frame_0001.png").write_bytes(b"")
    (tmp_path / "frame_0002.png").write_bytes(b"")
    assert replaced(tmp_path, "png", frames) == ["frame_0001.png"]
    assert replaced(tmp_path / "walk.gif", "gif", frames) == []
    (tmp_path / "walk.gif").write_bytes(b"")
    assert replaced(tmp_path / "walk.gif", "gif", frames) == ["walk.gif"]
