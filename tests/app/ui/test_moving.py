"""Moving the whole layer, by the window's own keys and pointer."""

import pytest
from bars import BENT, open_bar
from imgui_bundle import imgui

from app.editor.actions import editing, playback

CTRL, SHIFT = int(imgui.Key.mod_ctrl), int(imgui.Key.mod_shift)


def wanted(project, frame=BENT):
    return {i: each.position for i, each in project.layer.key(frame).pose.targets.items()}


def moved(project, before, way):
    return wanted(project) == pytest.approx({i: place + way for i, place in before.items()})


def press(window, *keys):
    def play(robot):
        for key in keys:
            robot.key_press(int(key))

    window.run(play)
    window.settle()


def drag(window, start, way, *, keys=0):
    """Drag from a place of the drawing's plane; return what the status bar said before."""
    hints = []

    def play(robot):
        robot.mouse_move_to_pos(window.point(start))
        if keys:
            robot.key_down(keys)
        robot.yield_(3)
        hints.append(window.session.tools.hint)
        robot.mouse_down(0)
        robot.mouse_move_to_pos(window.point(start + way / 2))
        robot.mouse_move_to_pos(window.point(start + way))
        robot.mouse_up(0)
        if keys:
            robot.key_up(keys)

    window.run(play)
    window.settle()
    return hints[0]


def test_v_and_a_drag_and_escape(window, loose):
    before, document, first = wanted(loose), loose.document, loose.layer.key(0)
    press(window, imgui.Key.v)
    hint = drag(window, loose.layer_runtime.shown.handle_positions[1], 40 - 25j)
    assert hint.startswith(f"Drag to move {loose.layer.name}")
    way = wanted(loose)[0] - before[0]
    assert abs(way - (40 - 25j)) < 2, "pixels of the screen are whole"
    assert moved(loose, before, way)
    assert loose.layer.key(0) is first
    press(window, imgui.Key.escape)
    assert window.session.tools.mode != "move"
    assert loose.selection.handles, "Escape puts one thing away at a time"
    editing.undo(window.session)
    assert loose.document is document


def test_ctrl_and_shift_from_beside(window, loose):
    before, width = wanted(loose), loose.document.canvas[0]
    assert "move the whole layer" in drag(window, width / 4 + 0j, 30j)
    assert moved(loose, before, 0), "without them it selects"
    drag(window, width / 4 + 0j, 30j, keys=CTRL | SHIFT)
    assert moved(loose, before, wanted(loose)[0] - before[0])
    assert abs(wanted(loose)[0] - before[0] - 30j) < 2


def test_arrows_move_all_of_it_only_with_the_tool(window, loose):
    before, session = wanted(loose), window.session
    loose.selection.handles = frozenset()
    press(window, imgui.Key.v, imgui.Key.up_arrow, SHIFT | int(imgui.Key.left_arrow))
    assert playback.current_frame(session, loose) == BENT
    assert moved(loose, before, 1j - 10)
    press(window, imgui.Key.escape, imgui.Key.down_arrow)
    assert playback.current_frame(session, loose) == 0


def test_it_is_one_tool_of_several(window, loose):
    session, chosen = window.session, loose.selection.handles
    press(window, imgui.Key.v, imgui.Key.x)
    assert session.tools.mode == "remove"
    press(window, imgui.Key.v)
    assert session.tools.mode == "move"
    press(window, imgui.Key.v)
    assert session.tools.mode != "move"
    assert loose.selection.handles == chosen
    press(window, imgui.Key.v)
    window.again(open_bar)
    assert session.tools.mode != "move", "another project begins with posing"
