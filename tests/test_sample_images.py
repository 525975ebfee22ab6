"""The shipped sample pictures: sound subjects, and what the script in `tests/drawings` draws."""

from __future__ import annotations

import importlib.util
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest
from PIL import Image
from scipy import ndimage

from app.storage.pictures.openraster import read_openraster

SAMPLES = Path(__file__).parents[1] / "sample_images"
DRAWINGS = Path(__file__).parent / "drawings"
NAMES = ("bar", "character", "dragon", "giraffe", "octopus", "ring", "s")
VISIBLE = 8  # alpha from which the mask of a picture with a soft rim counts a pixel


@pytest.fixture
def draw(monkeypatch: pytest.MonkeyPatch) -> ModuleType:
    """The script that draws the samples."""
    return load("draw", monkeypatch)


def load(name: str, monkeypatch: pytest.MonkeyPatch) -> ModuleType:
    """Load a drawing script as `python tests/drawings/NAME.py` finds it."""
    monkeypatch.syspath_prepend(str(DRAWINGS))
    spec = importlib.util.spec_from_file_location(name, DRAWINGS / f"{name}.py")
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.fixture(params=NAMES)
def picture(request: pytest.FixtureRequest) -> Image.Image:
    """Each shipped picture in turn."""
    with Image.open(SAMPLES / f"{request.param}.png") as image:
        image.load()
        image.info["name"] = request.param
        return image


def test_picture_has_alpha_and_the_promised_size(picture: Image.Image) -> None:
    assert picture.mode == "RGBA"
    assert 900 <= max(picture.size) <= 1100
    assert (SAMPLES / f"{picture.info['name']}.png").stat().st_size < 400_000


def test_subject_keeps_off_the_border(picture: Image.Image) -> None:
    rows, columns = np.nonzero(np.asarray(picture)[..., 3])
    clear = 0.03 * max(picture.size)
    assert min(rows.min(), columns.min()) > clear
    assert picture.height - 1 - rows.max() > clear
    assert picture.width - 1 - columns.max() > clear


def test_transparent_pixels_carry_no_colour(picture: Image.Image) -> None:
    pixels = np.asarray(picture)
    assert not pixels[pixels[..., 3] == 0].any()


def test_subject_is_one_part_and_only_the_ring_has_a_hole(picture: Image.Image) -> None:
    mask = np.asarray(picture)[..., 3] >= VISIBLE
    _, parts = ndimage.label(mask)
    _, outside = ndimage.label(~mask, structure=np.ones((3, 3)))
    assert parts == 1
    assert outside - 1 == (1 if picture.info["name"] == "ring" else 0)


def test_script_draws_every_shipped_picture(draw: ModuleType) -> None:
    assert set(draw.PICTURES) == {path.stem for path in SAMPLES.glob("*.png")} == set(NAMES)


def test_script_draws_the_shipped_bar(draw: ModuleType, tmp_path: Path) -> None:
    draw.main(["bar", "--out", str(tmp_path)])
    with Image.open(tmp_path / "bar.png") as drawn, Image.open(SAMPLES / "bar.png") as shipped:
        assert differ_at_most(drawn, shipped) <= 1


def test_script_draws_the_shipped_layers(draw: ModuleType) -> None:
    assert set(draw.LAYERED) == {path.stem for path in SAMPLES.glob("*.ora")}
    shipped = read_openraster((SAMPLES / "friend.ora").read_bytes()).layers
    layers = draw.friend.LAYERS
    assert [name for name, _ in layers] == [layer.name for layer in shipped]
    smile = next(index for index, (name, _) in enumerate(layers) if name == "smile")
    canvas = draw.friend.Canvas(*draw.friend.SIZE)
    layers[smile][1](canvas)
    whole = canvas.layer()
    # What is empty around it is not kept.
    layer = shipped[smile]
    with Image.new("RGBA", whole.size) as placed, Image.fromarray(layer.picture.rgba) as drawn:
        top = whole.height - layer.corner.imag - drawn.height
        placed.paste(drawn, (round(layer.corner.real), round(top)))
        assert differ_at_most(whole, placed) <= 1


def test_script_draws_the_shipped_icon(monkeypatch: pytest.MonkeyPatch) -> None:
    module = load("icon", monkeypatch)
    with Image.open(SAMPLES.parent / "app" / "icon" / "lissom.png") as shipped:
        assert differ_at_most(module.icon().image(), shipped) <= 1


def differ_at_most(drawn: Image.Image, shipped: Image.Image) -> int:
    difference = np.asarray(drawn, dtype=int) - np.asarray(shipped, dtype=int)
    return int(np.abs(difference).max())
