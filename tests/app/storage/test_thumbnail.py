"""Pictures and projects are known by a small picture; what has none does no harm."""

import struct
import zlib

import numpy as np
import pytest
from documents import disc_document
from PIL import Image

from app.storage import decode_picture, draw_thumbnail, read_thumbnail, save_project
from app.storage.thumbnail import SIDE, shrink_picture

RGBA = np.zeros((900, 600, 4), np.uint8)
RGBA[:450] = (200, 30, 90, 255)


@pytest.mark.parametrize("suffix", [".lissom", ".png", ".jpg", ".LISSOM"])
def test_a_small_picture_shows_the_large_one(tmp_path, suffix):
    path = tmp_path / f"file{suffix}"
    if "lissom" in suffix.lower():
        save_project(path, disc_document(), thumbnail=draw_thumbnail(RGBA))
    else:
        image = Image.fromarray(RGBA)
        (image.convert("RGB") if suffix == ".jpg" else image).save(path)
    small = read_thumbnail(path)
    assert small.shape[0] == SIDE
    assert small.shape[1] == pytest.approx(SIDE * 2 / 3, abs=2)
    assert np.abs(small[SIDE // 4, 100, :3].astype(int) - (200, 30, 90)).max() <= 4
    assert (small[-SIDE // 4, :, :3] <= 4).all()


def test_small_pictures_stay_as_they_are(tmp_path):
    path = tmp_path / "a.png"
    Image.fromarray(RGBA[:20, :30]).save(path)
    assert (read_thumbnail(path) == RGBA[:20, :30]).all()


def test_large_photographs_are_read_at_a_fraction_and_turned_upright(tmp_path):
    exif = Image.Exif()
    exif[0x0112] = 6
    path = tmp_path / "a.jpg"
    Image.new("RGB", (4000, 3000), (200, 30, 90)).save(path, exif=exif)
    small = read_thumbnail(path)
    assert small.shape[:2] == (SIDE, SIDE * 3 // 4)
    assert np.abs(small[9, 9, :3].astype(int) - (200, 30, 90)).max() <= 4


@pytest.mark.parametrize("kind", ["PNG", "WEBP", "JPEG"])
@pytest.mark.parametrize(
    "notes", [b"\xe5]`\xed\xf7}\x9f\xe0", b"Exif\0\0nonsense", b"II*\0", b"MM"]
)
def test_a_camera_whose_notes_are_damaged_spoils_no_picture(tmp_path, kind, notes):
    path = tmp_path / "a"
    Image.fromarray(RGBA[:20, :30, :3]).save(path, kind, exif=notes, quality=95)
    shown = read_thumbnail(path)
    picture = decode_picture(path.read_bytes(), "it")
    assert shown.shape == picture.rgba.shape == (20, 30, 4)
    assert np.abs(shown[9, 9, :3].astype(int) - (200, 30, 90)).max() <= 4
    assert picture.notices in {(), ("its camera data is damaged and was ignored",)}


def test_what_has_no_picture_has_no_thumbnail(tmp_path):
    assert read_thumbnail(tmp_path / "missing.png") is None
    assert read_thumbnail(tmp_path / "missing.lissom") is None
    save_project(tmp_path / "none.lissom", disc_document())
    assert read_thumbnail(tmp_path / "none.lissom") is None
    save_project(tmp_path / "torn.lissom", disc_document(), thumbnail=draw_thumbnail(RGBA)[:90])
    assert read_thumbnail(tmp_path / "torn.lissom") is None
    # Pillow would run an interpreter for it.
    (tmp_path / "script.png").write_bytes(b"%!PS-Adobe-3.0 EPSF-3.0\n%%BoundingBox: 0 0 9 9\n")
    assert read_thumbnail(tmp_path / "script.png") is None


@pytest.mark.parametrize("side", [5_000, 12_000, 20_000])
def test_pictures_that_take_long_are_left_out(tmp_path, side):
    path = tmp_path / "large.png"
    Image.new("L", (8, 8)).save(path)
    content = bytearray(path.read_bytes())
    assert read_thumbnail(path) is not None
    content[16:24] = struct.pack(">II", side, side)  # of the header, and its checksum
    content[29:33] = struct.pack(">I", zlib.crc32(content[12:29]))
    path.write_bytes(content)
    assert read_thumbnail(path) is None


def test_what_is_drawn_is_made_small_without_what_is_around_it():
    picture = np.zeros((400, 600, 4), np.uint8)
    picture[100:150, 200:400] = (250, 10, 20, 255)
    small = shrink_picture(picture, 50)
    assert small.shape == (13, 50, 4)
    assert (small == (250, 10, 20, 255)).all()
    assert shrink_picture(np.zeros((30, 60, 4), np.uint8), 20).shape == (10, 20, 4)
    assert shrink_picture(picture[:120, :220], 96).shape == (20, 20, 4)
