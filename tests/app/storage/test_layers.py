import zipfile
from dataclasses import replace

import numpy as np
import pytest
from documents import clocked_document
from layered import blob, openraster, png
from messages import says
from PIL import Image
from psd_tools import PSDImage

from app.cut_out import CutOut
from app.document.channels.kinds import DEPTH
from app.document.settings import Meshing
from app.errors import LissomError
from app.storage.pictures.openraster import MERGED_ALONE, NO_KRITA, NOT_MERGED
from app.storage.project_file import load_project, save_project
from app.storage.scenes.drawings import (
    NO_SHAPE,
    open_layered,
    open_merged,
    open_picture,
    open_pictures,
)
from app.storage.scenes.flattening import LARGEST_FLAT
from app.storage.scenes.layers import make_still_layer
from engine.domain import require_domain

MESHING = Meshing(triangles=9_000)
COARSE = Meshing(triangles=1_000, detail="coarse")
STACK = (
    '<layer name="head" src="data/0.png" x="60" y="10" opacity="0.5"/>'
    '<layer name="body" src="data/1.png" x="20" y="60" visibility="hidden"/>'
    '<layer name="sky" src="data/2.png"/>'
)


@pytest.fixture
def drawing(tmp_path):
    path = tmp_path / "walk.ora"
    sky = Image.new("RGBA", (200, 220), (120, 180, 250, 255))
    path.write_bytes(openraster((200, 220), STACK, [blob(70, 50), blob(150, 140), sky]))
    return path


def test_every_layer_is_a_layer_where_it_is_on_the_canvas(drawing):
    opened = open_layered(drawing, MESHING)
    document = opened.document
    _, body, head = document.layers
    assert [layer.name for layer in document.layers] == ["sky", "body", "head"]
    assert document.canvas == (200, 220)
    assert head.corner == 60 + 160j
    outline = head.domain.outline
    assert abs(outline.mean() - (60 + 35 + 1j * (160 + 25))) < 2
    assert body.corner == 20 + 20j
    assert (body.hidden, head.hidden, head.opacity) == (True, False, 0.5)
    for layer in document.layers:
        require_domain(layer.domain)
        rest = layer.domain.mesh.vertices
        (key,) = layer.keys
        np.testing.assert_allclose(layer.map_of(key.pose)(rest), rest, rtol=0, atol=1e-9)
        assert opened.pictures[layer.id].size == layer.picture.size


def test_a_layer_that_is_opaque_all_over_stands_still(drawing):
    opened = open_layered(drawing, MESHING)
    assert [layer.still for layer in opened.document.layers] == [True, False, False]
    assert (
        "sky: the picture is opaque everywhere, so there is no shape to pose"
        in opened.document.import_log.notes
    )


def test_layers_share_the_triangles(drawing):
    layers = open_layered(drawing, MESHING).document.layers
    assert [len(layer.domain.mesh.triangles) for layer in layers[:1]] == [2]
    for layer in layers[1:]:
        assert layer.meshing.triangles == 4_000
        assert abs(len(layer.domain.mesh.triangles) - 4_000) < 400


def test_a_scene_of_layers_comes_back_from_its_file(drawing, tmp_path):
    document = open_layered(drawing, MESHING).document
    save_project(tmp_path / "a.lissom", document)
    again = load_project(tmp_path / "a.lissom")
    assert again.canvas == document.canvas
    for one, other in zip(document.layers, again.layers, strict=True):
        assert (one.name, one.corner, one.still, one.hidden, one.opacity) == (
            other.name,
            other.corner,
            other.still,
            other.hidden,
            other.opacity,
        )


def test_several_pictures_become_layers_in_the_middle_of_the_largest(tmp_path):
    for folder, size in (("a", (160, 120)), ("b", (60, 40))):
        (tmp_path / folder).mkdir()
        (tmp_path / folder / "layer.png").write_bytes(png(blob(*size)))
    paths = [tmp_path / "a" / "layer.png", tmp_path / "b" / "layer.png"]
    document = open_pictures(paths, MESHING).document
    assert document.canvas == (160, 120)
    assert [layer.name for layer in document.layers] == ["layer", "layer 2"]
    assert [layer.corner for layer in document.layers] == [0, 50 + 40j]


def test_bad_drawings_are_reported_in_words(tmp_path):
    for name, content in (("a.ora", b"?"), ("a.psd", b"?")):
        (tmp_path / name).write_bytes(content)
        with pytest.raises(LissomError, match=f"cannot open .*{name}: it is not a"):
            open_layered(tmp_path / name, MESHING)
    dot = Image.new("RGBA", (3, 2), (1, 2, 3, 255))
    stack = '<layer name="dot" src="data/0.png"/>'
    (tmp_path / "dot.ora").write_bytes(openraster((30, 20), stack, [dot]))
    with pytest.raises(LissomError, match=says(NO_SHAPE)):
        open_layered(tmp_path / "dot.ora", MESHING)
    with pytest.raises(LissomError, match="cannot read"):
        open_layered(tmp_path / "none.ora", MESHING)


def disc_on_paper(size=(160, 120), paper=(255, 255, 255, 255)):
    flat = Image.new("RGBA", size, paper)
    flat.alpha_composite(blob(80, 60), (40, 30))
    return flat


@pytest.mark.parametrize("background", ["auto", "none"])
def test_flat_drawing_opens_as_a_picture_of_it_does(tmp_path, background):
    cut_out, flat = CutOut(background=background), disc_on_paper()
    (tmp_path / "flat.png").write_bytes(png(flat))
    stack = '<layer name="paper" src="data/0.png"/>'
    (tmp_path / "flat.ora").write_bytes(openraster(flat.size, stack, [flat]))
    PSDImage.frompil(flat.convert("RGB")).save(tmp_path / "flat.psd")
    with zipfile.ZipFile(tmp_path / "flat.kra", "w") as archive:
        archive.writestr("mimetype", "application/x-krita")
        archive.writestr("mergedimage.png", png(flat))
    wanted = open_picture(tmp_path / "flat.png", COARSE, cut_out).document.layers[0]
    for name in ("flat.ora", "flat.psd", "flat.kra"):
        for opening in (open_layered, open_merged):
            (layer,) = opening(tmp_path / name, COARSE, cut_out).document.layers
            assert not layer.still
            assert layer.cut_out == cut_out
            np.testing.assert_array_equal(layer.domain.outline, wanted.domain.outline)


def test_layers_that_are_all_opaque_lose_their_plain_backgrounds(tmp_path):
    stack = '<layer name="front" src="data/0.png"/><layer name="paper" src="data/1.png"/>'
    paper = Image.new("RGBA", (160, 120), (9, 99, 9, 255))
    path = tmp_path / "opaque.ora"
    path.write_bytes(openraster((160, 120), stack, [disc_on_paper(), paper]))
    document = open_layered(path, COARSE).document
    assert [layer.still for layer in document.layers] == [False, False]
    assert abs(document.layers[1].domain.outline - (80 + 60j)).max() < 45
    # Merged, the picture is the front layer at its own size.
    opened = open_merged(path, COARSE)
    assert opened.pictures[opened.document.layers[0].id].size == (160, 120)


def test_merged_drawing_keeps_its_size(tmp_path):
    size = 2 * LARGEST_FLAT, 32
    stack = '<layer name="a" src="data/0.png" x="-9" y="-3"/><layer name="b" src="data/1.png"/>'
    stack += '<layer name="far" src="data/0.png" x="-99"/>'
    path = tmp_path / "wide.ora"
    path.write_bytes(openraster(size, stack, [blob(40, 30), blob(*size, (0, 0, 255))]))
    opened = open_merged(path, COARSE)
    rgba = opened.pictures[opened.document.layers[0].id].rgba
    assert rgba.shape == (32, size[0], 4)
    assert tuple(rgba[10, 10]) == (200, 60, 30, 255)
    assert tuple(rgba[16, LARGEST_FLAT]) == (0, 0, 255, 255)


def test_merged_drawing_of_one_layer_shows_its_canvas(tmp_path):
    stack = '<layer name="a" src="data/0.png" x="60" y="10" opacity="0.5"/>'
    path = tmp_path / "one.ora"
    path.write_bytes(openraster((200, 220), stack, [blob(70, 50)]))
    opened = open_merged(path, COARSE)
    rgba = opened.pictures[0].rgba
    assert rgba.shape == (220, 200, 4)
    assert tuple(rgba[10 + 25, 60 + 35]) == (200, 60, 30, 128)


def test_merged_picture_of_a_file_is_preferred_if_it_shows_something(tmp_path):
    stack = '<layer name="a" src="data/0.png" composite-op="krita:vivid_light"/>' + STACK
    layers = [blob(70, 50), blob(150, 140), blob(200, 220)]
    path, shown = tmp_path / "walk.ora", blob(200, 220, (1, 2, 3))

    def opened(merged):
        path.write_bytes(openraster((200, 220), stack, layers, merged=merged))
        document, pictures, _notices = open_merged(path, COARSE)
        return pictures[document.layers[0].id].rgba, document.import_log

    rgba, import_log = opened(shown)
    np.testing.assert_array_equal(rgba, np.asarray(shown))
    # What it shows is no loss.
    assert not import_log
    own, import_log = opened(None)
    assert import_log.warnings
    for useless in (Image.new("RGBA", (200, 220), (255, 255, 255, 255)), blob(9, 9)):
        np.testing.assert_array_equal(opened(useless)[0], own)


def test_large_photoshop_files_open(tmp_path):
    drawing = PSDImage.new("RGB", (60, 50))
    drawing._record.header.version = 2
    drawing.create_pixel_layer(blob(40, 30), name="arm", top=5, left=9)
    drawing.save(tmp_path / "large.psb")
    (layer,) = open_layered(tmp_path / "large.psb", COARSE).document.layers
    assert (layer.name, layer.picture.size, layer.corner) == ("arm", (40, 30), 9 + 15j)


def test_krita_file_is_read_as_its_merged_picture_with_advice(tmp_path):
    path = tmp_path / "a.kra"

    def write(**members):
        with zipfile.ZipFile(path, "w") as archive:
            for name, content in members.items():
                archive.writestr(name.replace("_", "."), content)

    write(mimetype="application/x-krita", mergedimage_png=png(blob(60, 50)))
    document = open_layered(path, COARSE).document
    assert [layer.picture.size for layer in document.layers] == [(60, 50)]
    assert document.import_log.warnings == (f"picture: {MERGED_ALONE}",)
    write(mimetype="application/x-krita")
    with pytest.raises(LissomError, match=says(NOT_MERGED)):
        open_layered(path, COARSE)
    write(mimetype="image/openraster", mergedimage_png=png(blob(60, 50)))
    with pytest.raises(LissomError, match=says(NO_KRITA)):
        open_layered(path, COARSE)


def test_a_layer_that_becomes_still_keeps_all_but_its_handles_and_poses():
    (layer, _parent) = clocked_document().layers
    layer = replace(layer, unread_channels=("later",)).with_keys_of(DEPTH, [DEPTH.key(3, 0.5)], 4)
    still = make_still_layer(layer)
    assert still.still
    for name in ("handles", "tracks", "springs", "bones", "library"):
        assert getattr(still, name) == ()
    assert still.stiffness is None
    assert {**still.channels, (DEPTH.name, 4): layer.keys_of(DEPTH, 4)} == layer.channels
    for name in ("name", "opacity", "blend", "group", "attachments", "unread_channels", "unknown"):
        assert getattr(still, name) == getattr(layer, name)
