"""Pixels in a file without a name."""

import tempfile
from dataclasses import replace

import numpy as np
import pytest

from app.storage.pictures.mmap_pixels import move_to_disk, release_pages
from app.storage.pictures.picture import Picture


@pytest.fixture
def picture():
    pixels = np.arange(4 * 300 * 200, dtype=np.uint32).astype(np.uint8).reshape(200, 300, 4)
    return Picture(rgba=pixels, suffix=".webp", notices=("read",))


def test_pixels_on_disk_are_the_same_and_come_back(picture):
    (kept,) = move_to_disk([picture])
    assert (kept.suffix, kept.notices, kept.size) == (".webp", ("read",), (300, 200))
    assert not kept.rgba.flags.writeable
    for _ in range(2):
        assert np.array_equal(kept.rgba, picture.rgba)
        release_pages(kept.rgba)
        release_pages(kept.rgba[5:, ::2])


def test_pictures_on_disk_share_an_open_file(picture, monkeypatch):
    opened, open_one = [], tempfile.TemporaryFile

    def counted():
        opened.append(True)
        return open_one()

    monkeypatch.setattr("tempfile.TemporaryFile", counted)
    pictures = [replace(picture, rgba=picture.rgba[: n + 1] + np.uint8(n)) for n in range(50)]
    kept = move_to_disk(pictures)
    assert opened == [True]
    release_pages(kept[7].rgba)
    for one, other in zip(kept, pictures, strict=True):
        assert np.array_equal(one.rgba, other.rgba)


def test_where_nothing_fits_on_the_disk_pixels_stay_in_memory(picture, monkeypatch):
    def full(*_, **__):
        raise OSError("no space left")

    monkeypatch.setattr("tempfile.TemporaryFile", full)
    (kept,) = move_to_disk([picture])
    assert kept is picture
    release_pages(picture.rgba)
    assert picture.rgba.any()
