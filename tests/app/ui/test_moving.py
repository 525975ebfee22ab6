"""Moving the whole figure, by the window's own keys and pointer."""

import pytest
from bars import BENT, open_bar
from imgui_bundle import imgui

from app.editor.actions import editing, playback

CTRL, SHIFT = int(imgui.Key.mod_ctrl), int(imgui.Key.mod_shift)


@pytest.fixture
def bent(loose):
    """What the motion is like in between is not asked here."""
    return loose


def wanted(project, frame=BENT):
    return {i: each.position for i, each in project.figure.key(frame).pose.targets.items()}


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
    told = []

    def play(robot):
        robot.mouse_move_to_pos(window.point(start))
        if keys:
            robot.key_down(keys)
        robot.yield_(3)
        told.append(window.session.hint)
        robot.mouse_down(0)
        robot.mouse_move_to_pos(window.point(start + way / 2))
        robot.mouse_move_to_pos(window.point(start + way))
        robot.mouse_up(0)
        if keys:
            robot.key_up(keys)

    window.run(play)
    window.settle()
    return told[0]


def test_v_and_a_drag_and_escape(window, bent):
    before, document, first = wanted(bent), bent.document, bent.figure.key(0)
    press(window, imgui.Key.v)
    hint = drag(window, bent.puppet.shown.handle_places[1], 40 - 25j)
    assert hint.startswith(f"Drag to move all of {bent.figure.name}")
    way = wanted(bent)[0] - before[0]
    assert abs(way - (40 - 25j)) < 2, "pixels of the screen are whole"
    assert moved(bent, before, way)
    assert bent.figure.key(0) is first
    press(window, imgui.Key.escape)
    assert not window.session.moves
    assert bent.selected, "Escape puts one thing away at a time"
    editing.undo(window.session)
    assert bent.document is document


def test_ctrl_and_shift_from_beside(window, bent):
    before, width = wanted(bent), bent.document.canvas[0]
    assert "move all of it" in drag(window, width / 4 + 0j, 30j)
    assert moved(bent, before, 0), "without them it selects"
    drag(window, width / 4 + 0j, 30j, keys=CTRL | SHIFT)
    assert moved(bent, before, wanted(bent)[0] - before[0])
    assert abs(wanted(bent)[0] - before[0] - 30j) < 2


def test_arrows_move_all_of_it_only_with_the_tool(window, bent):
    before, session = wanted(bent), window.session
    bent.selected = frozenset()
    press(window, imgui.Key.v, imgui.Key.up_arrow, SHIFT | int(imgui.Key.left_arrow))
    assert playback.current_frame(session, bent) == BENT
    assert moved(bent, before, 1j - 10)
    press(window, imgui.Key.escape, imgui.Key.down_arrow)
    assert playback.current_frame(session, bent) == 0


def test_it_is_one_tool_of_several(window, bent):
    session, chosen = window.session, bent.selected
    press(window, imgui.Key.v, imgui.Key.x)
    assert session.cutting == "remove"
    press(window, imgui.Key.v)
    assert (session.cutting, session.moves) == (None, True)
    press(window, imgui.Key.v)
    assert not session.moves
    assert bent.selected == chosen
    press(window, imgui.Key.v)
    window.again(open_bar)
    assert not session.moves, "another project begins with posing"
