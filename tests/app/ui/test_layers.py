"""A scene of several layers in the window: chosen, ordered, hidden, joined and painted in front."""

import numpy as np
import pytest
from layered import openraster
from PIL import Image, ImageDraw

from app.document import figure_commands
from app.document.keyframe import Target
from app.editor import layering
from app.editor.actions import editing, playback, posing

WIDTH, HEIGHT = 240, 200


def painted(box, colour):
    image = Image.new("RGBA", (WIDTH, HEIGHT))
    ImageDraw.Draw(image).rounded_rectangle(box, 12, fill=colour)
    return image


@pytest.fixture(scope="module")
def drawing(tmp_path_factory):
    path = tmp_path_factory.mktemp("layers") / "man.ora"
    names = ("arm", "body", "wall")
    stack = "".join(f'<layer name="{n}" src="data/{i}.png"/>' for i, n in enumerate(names))
    pictures = [
        painted((85, 70, 200, 95), (200, 40, 40, 255)),
        painted((60, 25, 110, 180), (40, 40, 200, 255)),
        Image.new("RGBA", (WIDTH, HEIGHT), (220, 230, 220, 255)),
    ]
    path.write_bytes(openraster((WIDTH, HEIGHT), stack, pictures))
    return path


@pytest.fixture
def scene(window, drawing):
    project = window.open(drawing)
    window.show_tab("Layers")
    return project


def identity(project, name):
    return next(figure.id for figure in project.document.figures if figure.name == name)


def test_a_click_chooses_the_layer_that_is_seen(window, scene):
    assert scene.figure.name == "arm"

    def click(place, key=None):
        def run(robot):
            robot.mouse_move_to_pos(window.point(scene.puppet.shown.placement.back(place)))
            if key is not None:
                robot.key_down(int(key))
            robot.mouse_click(0)
            if key is not None:
                robot.key_up(int(key))

        window.run(run)
        window.settle()

    click(80 + 60j)
    assert scene.figure.name == "body"
    assert not scene.figure.handles
    # The arm lies over the body here.
    click(100 + 118j)
    assert scene.figure.name == "arm"
    click(100 + 118j, window.Key.mod_alt)
    assert scene.figure.name == "body"
    # On the layer that is chosen a click adds a handle.
    click(80 + 60j)
    assert len(scene.figure.handles) == 1


def test_the_list_of_layers(window, scene):
    arm, body = identity(scene, "arm"), identity(scene, "body")

    def names():
        return [figure.name for figure in scene.document.figures]

    def click(*items):
        for item in items:
            window.run(lambda robot, item=item: robot.item_click(f"Layers/###{item}"))
            window.settle()

    click(f"row {body}")
    assert scene.active == body
    click("raise")
    assert names() == ["wall", "arm", "body"]
    click("lower", "copy layer")
    assert names() == ["wall", "body", "body copy", "arm"]
    assert scene.figure.name == "body copy"
    click("delete layer")
    assert names() == ["wall", "body", "arm"]
    click(f"eye {arm}", f"lock {body}")
    assert scene.document.figure(arm).hidden
    assert scene.document.figure(body).locked
    # What is hidden or locked is passed through.
    assert layering.figure_at(scene, 100 + 118j) is None
    for _ in range(6):
        window.act(editing.undo)
    window.settle()
    assert names() == ["wall", "body", "arm"]
    assert not scene.document.figure(arm).hidden


def test_a_layer_that_hangs_follows_live_and_is_posed_around_its_joint(window, scene):
    arm, body = identity(scene, "arm"), identity(scene, "body")
    window.act(editing.edit_figure, figure_commands.set_anchor, 95 + 118j)
    window.act(layering.hang, arm, body)
    window.settle()
    window.act(layering.choose, body)
    for place in (85 + 40j, 85 + 160j):
        window.act(posing.add_handle, place)
        window.settle()
    window.act(playback.seek, 24)
    top = scene.figure.handles[1].id
    window.act(posing.wish, {top: Target(position=110 + 155j)})
    window.settle()
    hung, carrier = scene.puppets[arm].shown, scene.puppets[body].shown
    joint = scene.document.figure(arm).attachment
    at = carrier.hinge(joint.at)
    place = hung.placement.on(np.array([hung.hinge(95 + 118j).place]))[0]
    assert abs(place - at.place) < 1e-6 * WIDTH
    assert abs(hung.placement.factor - at.turn) < 0.02
    assert hung.placement.factor.imag < -0.05
    window.act(layering.choose, arm)
    window.act(posing.add_handle, 190 + 118j)
    window.settle()
    hand = scene.figure.handles[0].id
    window.act(posing.wish, {hand: Target(position=170 + 170j)})
    window.settle()
    after = scene.puppets[arm].shown
    held = after.placement.on(np.array([after.hinge(95 + 118j).place]))[0]
    assert abs(held - at.place) < 1e-3 * WIDTH
    before = after.placement.on(after.positions)
    window.act(layering.let_hang, arm)
    window.settle()
    loose = scene.puppets[arm].shown
    assert np.abs(loose.placement.on(loose.positions) - before).max() < 1e-3


def test_layers_take_turns(window, scene):
    arm = identity(scene, "arm")
    window.act(playback.seek, 12)
    window.settle()
    window.act(layering.switch_here, arm)
    window.settle()
    with_arm = np.asarray(window.picture()).astype(int)
    window.act(playback.seek, 11)
    window.settle()
    assert np.abs(np.asarray(window.picture()).astype(int) - with_arm).max() > 100
    assert [s.visible for s in scene.document.figure(arm).switches] == [True, False]


def test_depth_is_set_at_a_handle_and_shown_as_a_tint(window, scene):
    window.act(posing.add_handle, 190 + 118j)
    window.settle()
    window.show_tab("Handle")
    tinted = []

    def point(robot):
        for item in ("##depth", "##name"):
            robot.mouse_move(f"Handle/{item}")
            robot.yield_(3)
            tinted.append(window.session.tints_depth)

    window.run(point)
    assert tinted == [True, False]
    window.run(lambda robot: robot.item_input_value("Handle/##depth", 0.5))
    window.settle()
    assert scene.figure.handles[0].front == 0.5
