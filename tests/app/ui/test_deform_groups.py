"""Ink, shadow and colour in the window: bent as one, selected, dragged, parted."""

import numpy as np
import pytest
from harness import Harness
from layered import openraster
from PIL import Image, ImageDraw

from app.document.keyframe import Target
from app.editor.actions import editing, playback
from app.editor.actions.posing.handles import add_handle
from app.editor.actions.posing.pose_drag import set_targets
from app.editor.layering.deform_groups import bend_layers_as_one, part_group
from app.editor.layering.deletion import delete_layers
from app.editor.layering.layer_list import duplicate_layer, layer_at, toggle_layers_hidden
from app.editor.layering.layer_selection import set_active_layer, solo_layers
from app.editor.layering.parenting import attach_layer

SIZE = (240, 200)
BODY = [(40, 100), (80, 60), (170, 60), (200, 100), (170, 140), (80, 140)]
PARTS = ("ink", "shade", "colour")


def drawn(paint):
    image = Image.new("RGBA", SIZE)
    paint(ImageDraw.Draw(image))
    return image


@pytest.fixture(scope="module")
def drawing(tmp_path_factory):
    pictures = {
        "ink": drawn(lambda draw: draw.line([*BODY, BODY[0]], fill=(20, 10, 30, 255), width=6)),
        "hat": drawn(lambda draw: draw.rectangle((90, 20, 140, 70), fill=(20, 120, 60, 255))),
        "shade": drawn(lambda draw: draw.rectangle((80, 105, 170, 135), fill=(60, 20, 120, 130))),
        "colour": drawn(lambda draw: draw.polygon(BODY, fill=(240, 150, 60, 255))),
    }
    stack = "".join(
        f'<layer name="{name}" src="data/{index}.png" x="0" y="0"/>'
        for index, name in enumerate(pictures)
    )
    path = tmp_path_factory.mktemp("bent") / "fish.ora"
    path.write_bytes(openraster(SIZE, stack, [*pictures.values()]))
    return path


@pytest.fixture
def scene(window, drawing):
    project = window.again(Harness.open, drawing)
    window.show_tab("Layers")
    window.settle()
    return project


def ids(scene, *names):
    known = {layer.name: layer.id for layer in scene.document.layers}
    return [known[name] for name in names]


def row_of(key):
    return f"**/###row {key}"


@pytest.fixture
def group(window, scene):
    window.act(bend_layers_as_one, *ids(scene, *PARTS))
    window.settle()
    return scene.selection.active


def shown(scene, name):
    (identity,) = ids(scene, name)
    return scene.runtimes.layers[identity].shown


def test_menu_bends_the_selected_layers_as_one_in_one_step(window, scene):
    before, chosen = scene.document, ids(scene, *PARTS)

    def play(robot):
        robot.set_ref("Layers")
        robot.item_click(row_of(chosen[0]))
        robot.key_down(int(window.Key.mod_ctrl))
        for each in chosen[1:]:
            robot.item_click(row_of(each))
        robot.key_up(int(window.Key.mod_ctrl))
        robot.item_click(row_of(chosen[1]), 1)
        robot.item_click("//$FOCUSED/Bend as one")

    window.run(play)
    window.settle()
    document = scene.document
    assert [each.name for each in document.deform_members(scene.selection.active)] == [
        *reversed(PARTS)
    ]
    window.act(editing.undo)
    window.settle()
    assert scene.document is before


def test_every_member_shows_and_drags_the_shared_handles(window, scene, group):
    window.act(add_handle, 60 + 100j)
    window.act(add_handle, 180 + 100j)
    window.settle()
    for name in PARTS:
        window.act(set_active_layer, *ids(scene, name))
        window.settle()
        assert scene.selection.active == group
        assert scene.listed_layer.name == name
        assert len(scene.layer.handles) == 2
    rest = {name: shown(scene, name).positions for name in PARTS}
    window.act(playback.seek, 12)
    window.settle()
    window.act(set_targets, {scene.layer.handles[1].id: Target(position=185 + 140j)})
    window.settle()
    assert [key.frame for key in scene.document.layer(group).keys] == [0, 12]
    for name in PARTS:
        assert shown(scene, name).vertices is shown(scene, "ink").vertices
        assert np.abs(shown(scene, name).positions - rest[name]).max() > 20
    assert scene.listed_layer.name == "colour"
    # A click on the drawing means the group, not its members.
    assert layer_at(scene, 100 + 100j) == group


def test_group_is_hidden_soloed_and_copied_with_its_members(window, scene, group):
    window.act(toggle_layers_hidden, group)
    window.settle()
    assert [*scene.runtimes.displayed.visible_layers] == ids(scene, "hat")
    window.act(editing.undo)
    window.act(solo_layers, group)
    window.settle()
    assert scene.layer_list.solo == {group, *ids(scene, *PARTS)}
    window.act(solo_layers, group)
    assert not scene.layer_list.solo
    window.act(duplicate_layer, group)
    window.settle()
    copy = scene.selection.active
    assert copy != group
    assert len(scene.document.deform_members(copy)) == 3
    window.act(delete_layers, copy)
    window.settle()
    assert len(scene.document.layers) == 5
    window.act(delete_layers, *ids(scene, *PARTS))
    window.settle()
    assert [layer.name for layer in scene.document.layers] == ["hat"]


def test_layers_are_attached_to_the_group_of_a_member(window, scene, group):
    (hat,), (ink,) = ids(scene, "hat"), ids(scene, "ink")
    window.act(attach_layer, hat, ink)
    window.settle()
    assert scene.document.layer(hat).attachments[0].parent == group
    window.act(part_group, group)
    window.settle()
    assert scene.document.layer(hat).attachments[0].parent in ids(scene, *PARTS)
    assert [layer.name for layer in scene.document.layers] == ["colour", "shade", "hat", "ink"]
    assert scene.layer.name == "ink"
    window.act(editing.undo)
    window.settle()
    assert scene.document.is_deform_group(group)


def test_drawing_that_lies_on_itself_is_offered_to_bend_as_one(window, scene):
    window.frames(2)
    window.run(lambda robot: robot.item_click("Layers/**/Bend as one"))
    window.settle()
    assert len(scene.document.deform_members(scene.selection.active)) == 3
    window.frames(2)
    window.act(editing.undo)
    window.settle()
    window.run(lambda robot: robot.item_click("Layers/**/No"))
    assert not scene.layer_list.bending_suggestions
