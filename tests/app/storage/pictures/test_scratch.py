"""Pixels in a file without a name."""

import numpy as np
import pytest

from app.storage.pictures.mmap_pixels import move_to_disk, release_pages
from app.storage.pictures.picture import Picture


@pytest.fixture
def picture():
    pixels = np.arange(4 * 300 * 200, dtype=np.uint32).astype(np.uint8).reshape(200, 300, 4)
    return Picture(rgba=pixels, suffix=".webp", notices=("read",))


def test_pixels_on_disk_are_the_same_and_come_back(picture):
    kept = move_to_disk(picture)
    assert (kept.suffix, kept.notices, kept.size) == (".webp", ("read",), (300, 200))
    assert not kept.rgba.flags.writeable
    for _ in range(2):
        assert np.array_equal(kept.rgba, picture.rgba)
        release_pages(kept.rgba)
        release_pages(kept.rgba[5:, ::2])


def test_where_nothing_fits_on_the_disk_pixels_stay_in_memory(picture, monkeypatch):
    def full(*_, **__):
        raise OSError("no space left")

    monkeypatch.setattr("tempfile.TemporaryFile", full)
    assert move_to_disk(picture) is picture
    release_pages(picture.rgba)
    assert picture.rgba.any()
