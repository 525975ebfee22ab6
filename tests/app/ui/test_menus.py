"""The menus of the drawing, tooltips, and a panel that stays where it is between keys."""

from dataclasses import replace
from itertools import chain

import pytest
from bars import BENT
from harness import FRAME
from imgui_bundle import ImVec2, hello_imgui, imgui

from app.document import DEPTH, Channel, channel_commands
from app.document.commands import handle_commands
from app.document.commands.command import Command
from app.editor.actions import editing, playback
from app.editor.tools import move_tool
from app.storage.assets import sample_images
from app.ui import panel
from app.ui.style.widgets import draw_tooltip
from app.ui.viewport.viewport import CANVAS

RIGHT = 1


def open_menu(robot, point):
    robot.mouse_move_to_pos(point)
    robot.mouse_click(RIGHT)
    robot.yield_(2)


def on_handle(window, loose, *items):
    place = window.point(loose.layer_runtime.shown.handle_positions[0])

    def play(robot):
        open_menu(robot, place)
        robot.menu_click(f"//$FOCUSED/{'/'.join(items)}")

    window.run(play)
    window.settle()


def test_a_handle_is_pinned_by_its_menu(window, loose):
    assert loose.selection.handles == {1}
    place = complex(loose.layer_runtime.shown.handle_positions[0])
    on_handle(window, loose, "Pin here")
    assert loose.selection.handles == {0}, "what the menu is of is selected"
    assert loose.layer.key(BENT).pose.targets[0].position == pytest.approx(place, abs=0.1)


def test_menu_of_a_handle_closes_when_the_layer_changes(window, loose):
    """Until a mesh of the new outline is there, the old layer is shown with its handles."""
    place = window.point(loose.layer_runtime.shown.handle_positions[1])
    window.run(lambda robot: open_menu(robot, place))
    with window.session.jobs.held():
        fewer = handle_commands.remove_handles(loose.selection.active, {1})(loose.document)
        (layer,) = fewer.layers
        other = replace(fewer, layers=(replace(layer, domain=replace(layer.domain)),))
        editing.edit_document(window.session, Command("Change the outline", lambda _: other))
        window.frames(2)
        assert len(loose.layer_runtime.shown.clip.layer.handles) > len(loose.layer.handles)
    assert not [part for part in window.program.shell.parts.values() if part.failure]


def test_how_firmly_a_handle_holds_is_in_its_menu(window, loose):
    editing.select_handles(window.session, frozenset({0, 1}))
    on_handle(window, loose, "Hold", "Firm")
    assert [handle.weight for handle in loose.layer.handles] == [10.0, 10.0]


def test_the_depth_of_a_handle_is_in_its_menu(window, loose):
    on_handle(window, loose, "Depth", "Behind")
    assert [handle.depth for handle in loose.layer.handles] == [-1.0, 0.0]
    channel = Channel(DEPTH, loose.selection.active, 0)
    window.act(editing.edit_document, channel_commands.set_key(channel, BENT, 0.0))
    on_handle(window, loose, "Depth", "In front")
    assert loose.layer.keys_of(DEPTH, 0) == (DEPTH.key(BENT, 1.0),)
    assert loose.layer.handle(0).depth == -1.0


def test_a_handle_is_locked_by_its_menu(window, loose):
    on_handle(window, loose, "Lock")
    assert [handle.locked for handle in loose.layer.handles] == [True, False]


def test_the_canvas_has_a_menu(window, loose):
    width, height = loose.document.canvas
    beside = window.point(complex(width / 4, -height / 3))
    found = []

    def play(robot):
        open_menu(robot, beside)
        for spec in chain(*CANVAS):
            label = spec.label
            if any(robot.item_exists(f"//$FOCUSED/{before}{label}") for before in ("", "###")):
                found.append(spec)
        robot.item_click(f"//$FOCUSED/{move_tool.toggle_move_tool.label}")

    window.run(play)
    assert found == list(chain(*CANVAS))
    assert window.session.tools.mode == "move"


def test_a_right_click_in_a_drag_still_takes_it_back(window, loose):
    document, place = loose.document, window.point(loose.layer_runtime.shown.handle_positions[1])

    def play(robot):
        robot.mouse_move_to_pos(place)
        robot.mouse_down(0)
        robot.mouse_move_to_pos(place + ImVec2(20, 10))
        robot.mouse_down(RIGHT)
        robot.mouse_up(RIGHT)
        robot.mouse_up(0)

    window.run(play)
    window.settle()
    assert loose.document is document
    assert not imgui.get_current_context().open_popup_stack.size()


@pytest.mark.usefixtures("loose")
def test_the_panel_stays_between_keys(window):
    """All that is below the target of a handle is where it was."""
    window.show_tab("Handle")
    heights, names = [], ("##target x", "##turns", "##depth")

    def look(robot):
        heights.append([robot.item_info(f"Handle/{name}").rect_full.min.y for name in names])

    for frame in (BENT, BENT // 2, 0):
        playback.seek(window.session, frame)
        window.settle()
        window.run(look)
    assert heights[0] == heights[1] == heights[2]


def test_a_number_between_keys_makes_a_key_as_a_drag_does(window, loose):
    window.show_tab("Handle")
    playback.seek(window.session, BENT // 2)
    window.settle()

    def play(robot):
        robot.item_input_value("**/##target x", 321.0)

    window.run(play)
    window.settle()
    assert loose.layer.key(BENT // 2).pose.targets[1].position.real == pytest.approx(321.0)


def tooltip_at(window, place, seconds=0.5):
    """Return the box of the tooltip that there is half a second after the pointer came."""
    imgui.get_io().add_mouse_pos_event(place.x, place.y)
    window.frames(round(seconds / FRAME))
    windows = imgui.get_current_context().windows
    found = [each for each in windows if each.name.startswith("##Tooltip") and each.active]
    return found[0].rect() if found else None


def test_a_tab_that_is_an_icon_has_its_name_in_a_tooltip(window):
    window.open(sample_images() / "bar.png")
    # Half of so small a window has no room for six words.
    window.resize((1024, 700), 2.0)
    assert tooltip_at(window, ImVec2(200, 200)) is None
    window.show_tab("Measure")
    window.frames(6)
    tab = imgui.internal.find_window_by_name("###Export").dc.dock_tab_item_rect
    assert tooltip_at(window, tab.get_center()) is not None
    window.resize((1280, 800))


def test_a_long_tooltip_wraps(window):
    window.open(sample_images() / "bar.png")
    places = []
    width = 30 * window.text_height()

    def draw():
        imgui.set_next_window_pos(ImVec2(100, 100))
        imgui.begin("probe")
        imgui.button("long", ImVec2(200, 100))
        draw_tooltip("What a click does here takes a sentence or two to say. " * 3, "Ctrl+Shift+S")
        imgui.end()

    calls = hello_imgui.get_runner_params().callbacks
    usual = calls.show_gui
    calls.show_gui = hello_imgui.sequence_functions(usual, draw)
    try:
        window.frames(3)
        places.append(tooltip_at(window, ImVec2(200, 200)))
    finally:
        calls.show_gui = usual
    (box,) = places
    assert box is not None
    assert box.get_width() < width


def test_a_tab_shows_its_title_translated_and_keeps_its_id(monkeypatch):
    monkeypatch.setattr(panel, "_", str.upper)
    mesh = panel.Panel("Mesh", "i", lambda *_: [])
    assert mesh.labels == ("i  MESH###Mesh", "MESH###Mesh", "i###Mesh")
