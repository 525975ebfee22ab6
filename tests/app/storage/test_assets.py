import io

import pytest
from PIL import Image

from app.errors import REINSTALL, LissomError
from app.storage import assets


def test_the_checkout_has_its_shaders_and_pictures():
    assert "void main" in assets.shader_source("mesh.vert")
    assert (assets.sample_images() / "giraffe.png").is_file()
    with Image.open(io.BytesIO(assets.app_icon())) as icon:
        assert (icon.format, icon.mode, icon.size) == ("PNG", "RGBA", (512, 512))


def test_an_installed_package_uses_what_it_ships(tmp_path, monkeypatch):
    for name in ("app/shipped/shaders", "app/shipped/sample_images", "shaders"):
        (tmp_path / name).mkdir(parents=True)
    (tmp_path / "app/shipped/shaders/mesh.vert").write_text("shipped")
    (tmp_path / "shaders/mesh.vert").write_text("someone else's")
    monkeypatch.setattr(assets, "_APP", tmp_path / "app")
    assert assets.shader_source("mesh.vert") == "shipped"
    assert assets.sample_images() == tmp_path / "app/shipped/sample_images"


def test_a_damaged_installation_says_so(tmp_path, monkeypatch):
    with pytest.raises(LissomError, match=REINSTALL):
        assets.shader_source("none.frag")
    monkeypatch.setattr(assets, "_APP", tmp_path / "app")
    with pytest.raises(LissomError, match="'sample_images' of Lissom is missing"):
        assets.sample_images()
