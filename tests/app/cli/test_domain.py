import numpy as np
import pictures
import pytest
from layered import blob, openraster
from numpy.testing import assert_allclose, assert_array_equal
from PIL import Image, ImageDraw
from scipy import ndimage

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
    words = ["domain", drawing, "--out", out, "--triangles", "3000", "--holes", "fill"]
    assert main([str(word) for word in words]) == 0
    said = capsys.readouterr()
    assert "2 parts" in said.err
    assert "hole" in said.err
    assert "300 × 200" in said.out
    with np.load(out) as file:
        domain = dict(file)
    of_holes = {"outlines", "outline_sizes", "cages", "cage_sizes", "centres"}
    assert set(domain) == {
        *("outline", "cage", "vertices", "triangles", "uv", "image_size", "corner", "closed"),
        *(f"hole_{name}" for name in of_holes),
    }
    assert all(len(domain[f"hole_{name}"]) == 0 for name in of_holes)
    assert_array_equal(domain["image_size"], [300, 200])
    assert domain["corner"] == 0
    assert np.issubdtype(domain["image_size"].dtype, np.integer)
    outline, cage, vertices = domain["outline"], domain["cage"], domain["vertices"]
    assert_array_equal(domain["closed"], outline)
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
    words = ["domain", drawing, "--out", out, "--preview", preview]
    assert main([*map(str, words), "--triangles", "1000"]) == 0
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


@pytest.fixture
def photo(tmp_path):
    """A disc before a background of two colours: most of the border is none of them."""
    pixels = np.full((120, 160, 3), (40, 160, 70), np.uint8)
    pixels[:, 90:] = (90, 120, 210)
    y, x = np.mgrid[:120, :160]
    pixels[np.hypot(x - 50, y - 60) < 30] = (230, 200, 40)
    path = tmp_path / "photo.png"
    Image.fromarray(pixels).save(path)
    return path


def built(photo, tmp_path, *words):
    out = tmp_path / "d.npz"
    assert main(["domain", str(photo), "--out", str(out), "--triangles", "1000", *words]) == 0
    with np.load(out) as file:
        return file["outline"]


def test_a_background_is_reported_by_its_colour(photo, tmp_path, capsys):
    inside = np.array([50 + 60j, 20 + 20j, 130 + 60j])
    for words, expected, said in (
        ([], [True, True, True], "kept as a whole rectangle"),
        (["--background", "none"], [True, True, True], ""),
        (["--background", "#f0f"], [True, True, True], "no background of colour #ff00ff"),
        (["--background", "#28a046"], [True, False, True], "background removed"),
        (["--background", "#ff00ff"], [True, True, True], "no background of colour #ff00ff"),
        (["--background", "#28a046", "--tolerance", "145"], [True, False, False], "removed"),
    ):
        outline = built(photo, tmp_path, *words)
        assert polygon.contains(outline, inside).tolist() == expected, words
        assert said in capsys.readouterr().err


def test_a_mask_says_what_is_kept(photo, tmp_path, capsys):
    mask = np.zeros((120, 160), np.uint8)
    mask[30:90, 20:80] = 255
    path = tmp_path / "mask.png"
    Image.fromarray(mask).save(path)
    outline = built(photo, tmp_path, "--mask", str(path))
    assert_allclose(outline.real.min(), 20, rtol=0, atol=1.5)
    assert_allclose(outline.imag.max(), 90, rtol=0, atol=1.5)
    for bad, reason in (
        (mask[1:], "160 × 119 pixels, but the picture has 160 × 120"),
        (0 * mask, "removes the whole picture"),
    ):
        Image.fromarray(bad).save(path)
        words = ["domain", photo, "--out", tmp_path / "e.npz", "--mask", path]
        assert reason in error_of(words, capsys)
    missing = ["domain", photo, "--out", tmp_path / "e.npz", "--mask", tmp_path / "none.png"]
    assert "No such file" in error_of(missing, capsys)


def test_projects_and_exports_are_cut_out_likewise(photo, tmp_path, capsys):
    mask = np.zeros((120, 160), np.uint8)
    mask[30:90, 20:80] = 255
    Image.fromarray(mask).save(tmp_path / "mask.png")
    script = tmp_path / "script.json"
    script.write_text('{"schema": 1, "handles": {"a": [50, 60]}, "keys": [{"frame": 0}]}')
    for words, kept in (
        (["--mask", tmp_path / "mask.png"], mask > 0),
        (["--background", "none"], mask >= 0),
    ):
        project, frames = tmp_path / "posed.lissom", tmp_path / "frames"
        posing = ["pose", photo, script, "--out", project, "--triangles", 1000, *words]
        assert main([str(word) for word in posing]) == 0
        assert capsys.readouterr().out.endswith(f"{project}: 1 key, 1 handle\n")
        exporting = ["export", project, "--out", frames, "--framing", "canvas"]
        assert main([str(word) for word in exporting]) == 0
        (frame,) = frames.iterdir()
        alpha = np.asarray(Image.open(frame))[..., 3]
        assert (alpha[ndimage.binary_erosion(kept, iterations=3)] > 250).all()
        assert (alpha[~ndimage.binary_dilation(kept, iterations=2)] < 5).all()
        frame.unlink()


def test_the_preview_shows_picture_outline_cage_and_mesh(drawing, tmp_path):
    words = ["domain", drawing, "--out", tmp_path / "d.npz", "--triangles", 1000]
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


@pytest.fixture
def layered(tmp_path):
    """Return a drawing of 300 × 200 pixels with a layer of its own size and one 40 from its top."""
    path = tmp_path / "man.ora"
    stack = (
        '<layer name="arm" src="data/0.png" x="120" y="40"/><layer name="wall" src="data/1.png"/>'
    )
    wall = Image.new("RGBA", (300, 200), (220, 230, 220, 255))
    path.write_bytes(openraster((300, 200), stack, [blob(100, 60), wall]))
    return path


def test_a_layer_is_where_its_canvas_has_it(layered, tmp_path, capsys):
    out, preview = tmp_path / "arm.npz", tmp_path / "arm.png"
    words = ["domain", layered, "--layer", "arm", "--out", out, "--preview", preview]
    assert main([*map(str, words), "--triangles", "1000"]) == 0
    assert "100 × 60 pixels" in capsys.readouterr().out
    assert preview.exists()
    with np.load(out) as file:
        domain = dict(file)
    assert domain["corner"] == 120 + 100j
    assert_array_equal(domain["image_size"], [100, 60])
    middle = (domain["outline"].real.min() + domain["outline"].real.max()) / 2
    assert abs(middle - 170) < 2
    assert polygon.contains(domain["cage"], domain["outline"]).all()
    assert polygon.contains(domain["outline"], np.array([170 + 130j])).all()
    places = polygon.as_xy(domain["vertices"] - domain["corner"])
    assert_allclose(domain["uv"] * [100, 60], places, rtol=0, atol=1e-9)
    # One that is opaque all over is a rectangle, as it is in a scene.
    words[3] = "wall"
    assert main([*map(str, words), "--triangles", "1000"]) == 0
    with np.load(out) as file:
        area = polygon.signed_area(file["outline"])
    assert abs(area / (300 * 200) - 1) < 0.05


def test_which_layer_is_asked_for_where_there_are_several(layered, drawing, tmp_path, capsys):
    out = tmp_path / "d.npz"
    error = error_of(["domain", layered, "--out", out], capsys)
    assert error.endswith("has 2 layers; name one with --layer, from the front: 'arm', 'wall'")
    error = error_of(["domain", layered, "--layer", "leg", "--out", out], capsys)
    assert error.endswith("no layer 'leg'; its layers are, from the front: 'arm', 'wall'")
    error = error_of(["domain", drawing, "--layer", "arm", "--out", out], capsys)
    assert error.endswith("has no layers; leave out --layer")
    assert not out.exists()
    alone = tmp_path / "alone.ora"
    alone.write_bytes(openraster((90, 70), '<layer name="blob" src="data/0.png"/>', [blob(90, 70)]))
    words = ["domain", alone, "--out", out, "--triangles", "1000"]
    assert main(list(map(str, words))) == 0


def test_a_knife_parts_along_a_line_in_pixels_from_the_upper_left_corner(tmp_path, capsys):
    mask = np.zeros((300, 200), dtype=np.bool_)
    mask[20:-20, 20:-20] = True
    Image.fromarray(pictures.painted(mask)).save(tmp_path / "block.png")
    out = tmp_path / "block.npz"
    words = ["domain", tmp_path / "block.png", "--out", out, "--triangles", "1000"]
    # From below, up to 100 pixels under the upper edge.
    assert main([*map(str, words), "--knife", "100,300,100,200,100,100"]) == 0
    with np.load(out) as file:
        domain = dict(file)
    inside = polygon.contains(domain["outline"], np.array([100 + 50j, 100 + 180j, 100 + 210j]))
    assert inside.tolist() == [False, False, True]
    moved = np.abs(domain["closed"] - domain["outline"])
    assert 0 < moved.max() < 0.0025 * np.hypot(260, 160)
    for line, message in (
        ("100,300,100,0", "The knife cuts off"),
        ("250,300,250,0", "does not touch"),
        ("100,300,100", "at least two points"),
        ("100,300,100,nan", "at least two points"),
        ("100,300", "at least two points"),
    ):
        assert message in error_of([*words, "--knife", line], capsys)
