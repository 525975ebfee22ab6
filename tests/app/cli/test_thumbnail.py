"""The small picture of a project, as file managers ask for it."""

import re

import numpy as np
import pytest
from documents import disc_document
from messages import says
from PIL import Image
from refusals import refusal

from app.cli.commands.thumbnail import NO_SMALL_PICTURE
from app.cli.main import main
from app.storage import draw_thumbnail, sample_images, save_project
from app.storage.thumbnail import SIDE

RGBA = np.full((600, 900, 4), (200, 30, 90, 255), np.uint8)


@pytest.mark.parametrize(("size", "longer"), [(128, 128), (7, 7), (1000, SIDE), (None, 256)])
def test_the_stored_picture_is_written_as_small_as_asked_and_never_enlarged(tmp_path, size, longer):
    project, out = tmp_path / "a.lissom", tmp_path / "out"
    save_project(project, disc_document(), thumbnail=draw_thumbnail(RGBA))
    asked = () if size is None else ("--size", str(size))
    assert main(["thumbnail", str(project), "--out", str(out), *asked]) == 0
    with Image.open(out) as image:
        assert image.format == "PNG"
        assert image.width == longer
        assert image.height == pytest.approx(longer * 2 / 3, abs=1)
        assert image.convert("RGBA").getpixel((1, 1)) == pytest.approx((200, 30, 90, 255), abs=2)


def test_the_samples_have_small_pictures(tmp_path):
    sample = sample_images() / "giraffe.lissom"
    assert main(["thumbnail", str(sample), "--out", str(tmp_path / "out.png")]) == 0


def test_what_cannot_be_done_is_said(tmp_path, capsys):
    project, out = tmp_path / "bare.lissom", tmp_path / "out.png"
    save_project(project, disc_document())
    assert re.search(says(NO_SMALL_PICTURE), refusal(capsys, "thumbnail", project, "--out", out))
    assert "is a folder" in refusal(capsys, "thumbnail", project, "--out", tmp_path)
    project.write_bytes(b"PK")
    assert re.search(says(NO_SMALL_PICTURE), refusal(capsys, "thumbnail", project, "--out", out))
    assert "at least 1, not 'large'" in refusal(
        capsys, "thumbnail", project, "--out", out, "--size", "large"
    )
    assert not out.exists()
