"""Pictures of layers: without empty pixels around them, and shared where they are the same."""

import numpy as np
import pytest
from layered import blob, openraster
from numpy.testing import assert_array_equal
from PIL import Image

from app.document import Meshing
from app.editor.actions.project_files import files
from app.storage import decode_picture, load_project, open_layered, save_project

SIZE = (400, 300)
STACK = (
    '<layer name="left" src="data/0.png" x="-20"/><layer name="right" src="data/0.png" x="40"/>'
    '<layer name="full" src="data/1.png" x="5" y="6"/>'
)


@pytest.fixture
def drawing(tmp_path):
    small = Image.new("RGBA", SIZE)
    small.paste(blob(60, 90), (130, 70))
    path = tmp_path / "walk.ora"
    path.write_bytes(openraster(SIZE, STACK, [small, blob(390, 290)]))
    return path


def test_what_is_empty_around_a_layer_is_cut_off(drawing):
    opened = open_layered(drawing, Meshing(triangles=4_000))
    full, right, left = opened.document.layers
    # But for one row and column each way, so that a plain box is none that stands still.
    assert right.picture.size == (62, 92)
    assert (left.corner, right.corner) == (109 + 139j, 169 + 139j)
    wanted = np.pad(np.asarray(blob(60, 90)), ((1, 1), (1, 1), (0, 0)))
    assert_array_equal(opened.pictures[left.id].rgba, wanted)
    assert_array_equal(decode_picture(left.picture.data, "").rgba, wanted)
    # Where it would save little, the file stays as it is.
    assert (full.picture.size, full.corner) == ((390, 290), 5 + 4j)
    middle = 110 + 30 + 1j * (140 + 45)
    assert abs(left.domain.outline.mean() - middle) < 1


def test_layers_that_share_a_picture_share_it_once_it_is_saved_too(drawing, tmp_path):
    opened = open_layered(drawing, Meshing(triangles=4_000))
    full, right, left = opened.document.layers
    assert left.picture is right.picture is not full.picture
    assert opened.pictures[left.id] is opened.pictures[right.id]
    save_project(tmp_path / "a.lissom", opened.document)
    again = load_project(tmp_path / "a.lissom")
    full, right, left = again.layers
    assert left.picture is right.picture is not full.picture
    shown = files.decode_project(again, "a")
    assert shown.layer_runtimes[left.id].picture is shown.layer_runtimes[right.id].picture


def test_a_box_on_an_empty_canvas_can_be_posed(tmp_path):
    box = Image.new("RGBA", SIZE)
    box.paste((200, 60, 30, 255), (150, 100, 220, 180))
    path = tmp_path / "box.ora"
    path.write_bytes(openraster(SIZE, '<layer name="box" src="data/0.png"/>', [box]))
    (layer,) = open_layered(path, Meshing(triangles=4_000)).document.layers
    assert (layer.still, layer.picture.size) == (False, (72, 82))
