"""Footage of every kind: read in any order, kept by projects, and refused in words."""

import sys
from dataclasses import replace

import numpy as np
import pytest
from footage_files import (
    SIZE,
    number_of,
    numbered_colour,
    numbered_picture,
    write_numbered,
    write_video,
)
from PIL import Image

from app.document import FOOTAGE_TIME, FootageTime
from app.errors import LissomError
from app.storage import (
    inspect_footage,
    load_project,
    open_footage,
    open_footage_scene,
    save_project,
)

COUNT = 20


def shuffled(count):
    return [int(each) for each in np.random.default_rng(1).permutation(count)]


@pytest.mark.parametrize(
    ("name", "codec"),
    [("a.mp4", "libx264"), ("a.webm", "libvpx-vp9"), ("a.mov", "prores_ks")],
)
def test_video_gives_each_picture_in_any_order(tmp_path, name, codec):
    path = write_video(tmp_path / name, COUNT, codec=codec)
    footage = inspect_footage(path, 30.0).footage
    assert (footage.size, footage.fps, footage.picture_count) == (SIZE, 24.0, COUNT)
    with open_footage(footage) as reader:
        for number in shuffled(COUNT):
            pixels = reader.read(number)
            assert number_of(pixels) == number
            assert pixels[0, 0, 3] == (255 if name == "a.mp4" else 0)


def animation(path, **options):
    first, *others = [numbered_picture(number) for number in range(COUNT)]
    first.save(path, save_all=True, append_images=others, **options)
    return path


@pytest.mark.parametrize(
    ("name", "options", "fps", "holds"),
    [
        ("a.gif", {"duration": [100] * (COUNT - 1) + [500]}, 10.0, (1,) * (COUNT - 1) + (5,)),
        ("a.gif", {"duration": 0}, 10.0, ()),
        ("a.webp", {"duration": 40, "lossless": True}, 25.0, ()),
        ("a.png", {"duration": 50}, 20.0, ()),
        ("a.tiff", {}, 30.0, ()),
    ],
)
def test_animated_picture_gives_each_picture_in_any_order(tmp_path, name, options, fps, holds):
    footage = inspect_footage(animation(tmp_path / name, **options), 30.0).footage
    assert (footage.fps, footage.holds, footage.picture_count) == (fps, holds, COUNT)
    with open_footage(footage) as reader:
        for number in shuffled(COUNT):
            assert number_of(reader.read(number)) == number


def test_numbered_pictures_have_gaps_and_others_are_left_out(tmp_path):
    write_numbered(tmp_path, [1, 2, 3, 7, 8])
    for other in ("run_004.png", "walk_005.txt", "walk_006.png.bak", "walk_9_mask.png"):
        (tmp_path / other).write_bytes(b"")
    opened = inspect_footage(tmp_path / "walk_003.png", 12.0)
    assert opened.footage.files == tuple(f"walk_{n:03}.png" for n in (1, 2, 3, 7, 8))
    assert opened.footage.holds == (1, 1, 4, 1, 1)
    assert opened.notices == ("pictures 4–6 are missing; the picture before each gap holds",)


def test_numbers_of_different_lengths_are_in_numeric_order(tmp_path):
    for number in (8, 9, 10, 11):
        numbered_picture(number).save(tmp_path / f"f{number}.png")
    assert inspect_footage(tmp_path / "f9.png", 12.0).footage.files == (
        "f8.png",
        "f9.png",
        "f10.png",
        "f11.png",
    )


def test_a_folder_stands_for_its_numbered_pictures(tmp_path):
    first = write_numbered(tmp_path / "shot", range(3))
    assert inspect_footage(first.parent, 12.0).footage.picture_count == 3


@pytest.mark.parametrize(
    ("name", "content", "reason"),
    [
        ("a.mp4", b"no video", "not a video that can be read"),
        ("a.gif", b"", "is empty"),
        ("a.gif", b"GIF89a", "is damaged"),
        ("a.txt", b"text", "not a picture"),
    ],
)
def test_file_without_footage_is_refused(tmp_path, name, content, reason):
    path = tmp_path / name
    path.write_bytes(content)
    with pytest.raises(LissomError, match=reason):
        inspect_footage(path, 24.0)


def test_a_single_picture_is_refused(tmp_path):
    numbered_picture(0).save(tmp_path / "cat.png")
    with pytest.raises(LissomError, match="single picture"):
        inspect_footage(tmp_path / "cat.png", 24.0)


def test_numbered_pictures_of_several_sizes_are_refused_by_name(tmp_path):
    first = write_numbered(tmp_path, range(3))
    numbered_picture(1, (5, 5)).save(tmp_path / "walk_001.png")
    with pytest.raises(LissomError, match=r"walk_001\.png differ"):
        inspect_footage(first, 24.0)


def test_a_damaged_picture_among_numbered_ones_is_named(tmp_path):
    first = write_numbered(tmp_path, range(3))
    footage = inspect_footage(first, 24.0).footage
    (tmp_path / "walk_001.png").write_bytes(first.read_bytes()[:40])
    with open_footage(footage) as reader, pytest.raises(LissomError, match=r"walk_001\.png"):
        reader.read(1)
    # The others are still there.
    with open_footage(footage) as reader:
        assert number_of(reader.read(2)) == 2


def test_a_video_that_is_cut_short_gives_its_first_pictures(tmp_path):
    path = write_video(tmp_path / "a.webm", COUNT, codec="libvpx-vp9")
    footage = inspect_footage(path, 24.0).footage
    content = path.read_bytes()
    path.write_bytes(content[: len(content) // 2])
    with pytest.raises(LissomError, match="changed"):
        open_footage(footage)


def test_without_its_library_a_video_says_how_to_install_it(tmp_path, monkeypatch):
    path = write_video(tmp_path / "a.mp4", 3)
    monkeypatch.setattr("app.storage.footage.opening.install_hint", lambda _: "pip install av")
    monkeypatch.delitem(sys.modules, "app.storage.footage.video", raising=False)
    with pytest.raises(LissomError, match=r"install PyAV \(pip install av\); numbered pictures"):
        inspect_footage(path, 24.0)


def test_project_keeps_footage_and_its_keys(tmp_path):
    scene = open_footage_scene(inspect_footage(write_numbered(tmp_path, range(4)), 12.0))
    (layer,) = scene.document.layers
    key = FOOTAGE_TIME.key(2, FootageTime(start=1.5, speed=-0.5, loops=True))
    layer = layer.with_keys_of(FOOTAGE_TIME, [key])
    save_project(tmp_path / "a.lissom", replace(scene.document, layers=(layer,)))
    (read,) = load_project(tmp_path / "a.lissom").layers
    assert read.footage == layer.footage
    assert read.keys_of(FOOTAGE_TIME) == (key,)


def test_project_moved_with_its_footage_finds_it(tmp_path):
    home = tmp_path / "home"
    home.mkdir()
    first = write_numbered(home / "pictures", range(4))
    scene = open_footage_scene(inspect_footage(first, 12.0))
    (home / "projects").mkdir()
    save_project(home / "projects" / "a.lissom", scene.document)
    moved = home.rename(tmp_path / "elsewhere")
    (layer,) = load_project(moved / "projects" / "a.lissom").layers
    with open_footage(layer.footage) as reader:
        assert number_of(reader.read(3)) == 3
    # Without its footage the project opens too, and says what is missing.
    first = moved / "pictures" / "walk_002.png"
    first.unlink()
    (layer,) = load_project(moved / "projects" / "a.lissom").layers
    with pytest.raises(LissomError, match=r"walk_000\.png is missing: walk_002\.png cannot be"):
        open_footage(layer.footage)


def test_a_picture_keeps_its_transparency(tmp_path):
    for number in range(2):
        pixels = np.asarray(numbered_picture(number)).copy()
        pixels[:5, :, 3] = 100
        Image.fromarray(pixels).save(tmp_path / f"a{number}.png")
    with open_footage(inspect_footage(tmp_path / "a0.png", 24.0).footage) as reader:
        assert tuple(reader.read(1)[0, 0]) == (*numbered_colour(1)[:3], 100)
