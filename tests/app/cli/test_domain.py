import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal
from PIL import Image, ImageDraw

from app.cli.main import main
from engine.geometry import polygon


@pytest.fixture
def drawing(tmp_path):
    """Return a 300 × 200 picture: a disc in its upper left, with a hole, and a detached dot."""
    image = Image.new("RGBA", (300, 200))
    pen = ImageDraw.Draw(image)
    pen.ellipse((20, 10, 140, 130), fill=(200, 60, 30, 255))
    pen.ellipse((70, 60, 90, 80), fill=(0, 0, 0, 0))
    pen.ellipse((160, 20, 190, 50), fill=(30, 60, 200, 255))
    path = tmp_path / "drawing whose name tells no format"
    image.save(path, "PNG")
    return path


def error_of(words, capsys):
    with pytest.raises(SystemExit) as leaving:
        main([str(word) for word in words])
    assert leaving.value.code == 2
    lines = [
        line for line in capsys.readouterr().err.splitlines() if line.startswith("lissom: error:")
    ]
    assert len(lines) == 1
    return lines[0]


def test_the_file_is_as_documented(drawing, tmp_path, capsys):
    out = tmp_path / "result without suffix"
    assert main(["domain", str(drawing), "--out", str(out), "--triangles", "3000"]) == 0
    said = capsys.readouterr()
    assert "2 parts" in said.err
    assert "hole" in said.err
    assert "300 × 200" in said.out
    with np.load(out) as file:
        domain = dict(file)
    of_holes = {"outlines", "outline_sizes", "cages", "cage_sizes", "centres"}
    assert set(domain) == {
        *("outline", "cage", "vertices", "triangles", "uv", "image_size"),
        *(f"hole_{name}" for name in of_holes),
    }
    assert all(len(domain[f"hole_{name}"]) == 0 for name in of_holes)
    assert_array_equal(domain["image_size"], [300, 200])
    assert np.issubdtype(domain["image_size"].dtype, np.integer)
    outline, cage, vertices = domain["outline"], domain["cage"], domain["vertices"]
    assert outline.dtype == cage.dtype == vertices.dtype == np.complex128
    assert domain["triangles"].dtype == np.int32
    assert domain["uv"].dtype == np.float64
    polygon.require_simple(outline, "outline")
    polygon.require_simple(cage, "cage")
    assert polygon.contains(cage, outline).all()
    # y points up: the disc is in the upper left, 70 pixels below the top edge.
    assert polygon.contains(outline, np.array([80 + 130j, 175 + 165j])).all()
    assert not polygon.contains(outline, np.array([80 + 30j])).any()
    assert_allclose(domain["uv"] * [300, 200], polygon.as_xy(vertices), rtol=0, atol=1e-9)
    corners = vertices[domain["triangles"]]
    areas = ((corners[:, 1] - corners[:, 0]).conj() * (corners[:, 2] - corners[:, 0])).imag / 2
    assert areas.min() > 0
    assert_allclose(areas.sum(), polygon.signed_area(outline), rtol=1e-9, atol=0)
    assert abs(len(areas) - 3000) <= 150


def test_holes_are_kept_where_they_are_wanted(drawing, tmp_path, capsys):
    out, preview = tmp_path / "d.npz", tmp_path / "p.png"
    words = ["domain", drawing, "--out", out, "--holes", "keep", "--preview", preview]
    assert main([*map(str, words), "--triangles", "3000"]) == 0
    said = capsys.readouterr()
    assert "hole" not in said.err
    assert "1 hole, " in said.out
    with np.load(out) as file:
        domain = dict(file)
    (size,), (cage_size,), (centre,) = (
        domain[f"hole_{name}"] for name in ("outline_sizes", "cage_sizes", "centres")
    )
    hole, cage = domain["hole_outlines"], domain["hole_cages"]
    assert (len(hole), len(cage)) == (size, cage_size)
    polygon.require_holes([hole], domain["outline"])
    polygon.require_simple(cage, "cage", clockwise=True)
    assert polygon.lies_within(cage, hole)
    assert polygon.contains(cage, np.array([centre])).all()
    assert abs(centre - (80 + 130j)) < 1.5
    corners = domain["vertices"][domain["triangles"]]
    areas = ((corners[:, 1] - corners[:, 0]).conj() * (corners[:, 2] - corners[:, 0])).imag / 2
    assert areas.min() > 0
    whole = polygon.signed_area(domain["outline"]) + polygon.signed_area(hole)
    assert_allclose(areas.sum(), whole, rtol=1e-9, atol=0)
    assert preview.stat().st_size > 0


def test_the_preview_shows_picture_outline_cage_and_mesh(drawing, tmp_path):
    words = ["domain", drawing, "--out", tmp_path / "d.npz", "--triangles", 2000]
    assert main([str(w) for w in (*words, "--preview", tmp_path / "p.png")]) == 0
    pixels = np.asarray(Image.open(tmp_path / "p.png")).reshape(-1, 3).astype(int)
    for colour in ((0, 120, 215), (235, 94, 40), (200, 60, 30), (250, 249, 246)):
        assert (np.abs(pixels - colour).max(axis=1) < 12).sum() > 50, colour


@pytest.mark.parametrize("count", ["999", "2000001", "-5", "many"])
def test_counts_out_of_range_are_refused(drawing, tmp_path, capsys, count):
    out = tmp_path / "d.npz"
    line = error_of(["domain", drawing, "--out", out, f"--triangles={count}"], capsys)
    assert count.lstrip("-") in line.replace(",", "")
    assert not out.exists()


def test_bad_pictures_write_nothing(tmp_path, capsys):
    empty = tmp_path / "empty.png"
    Image.new("RGBA", (50, 50)).save(empty)
    text = tmp_path / "text.png"
    text.write_text("no picture")
    out, preview = tmp_path / "d.npz", tmp_path / "p.png"
    for picture, reason in (
        (empty, "transparent"),
        (text, "not a picture"),
        (tmp_path / "missing.png", "No such file"),
    ):
        assert reason in error_of(["domain", picture, "--out", out, "--preview", preview], capsys)
    assert "is a folder" in error_of(["domain", empty, "--out", tmp_path], capsys)
    assert sorted(tmp_path.iterdir()) == [empty, text]
