"""The box around several handles, by the window's own pointer and keys."""

import cmath
from dataclasses import replace

import numpy as np
import pytest
from bars import open_bar
from imgui_bundle import imgui

from app.editor.actions import editing
from app.editor.tools.tool import handle_places
from app.editor.tools.transform_tools.handle_box_tool import find_handle_box

CTRL, SHIFT = int(imgui.Key.mod_ctrl), int(imgui.Key.mod_shift)


@pytest.fixture(params=[1.0, 2.0])
def bar(window, request):
    """A bar with three selected handles, at two display scales."""
    window.resize((1280, 800), request.param)
    project = window.again(open_bar, 0.25, 0.5, 0.75)
    window.resize((1280, 800), request.param)
    editing.select_all(window.session)
    window.settle()
    yield project
    window.resize((1280, 800))


def box_of(window, project):
    scale = project.view_on(window.session.display.screen).scale
    em = window.ring(project) / 2.2
    assert scale > 0
    return find_handle_box(window.session, project, em), em


def drag(window, start, end, *, keys=0):
    """Drag between two places; return the hint before and during it."""
    hints = []

    def play(robot):
        robot.mouse_move_to_pos(window.point(start))
        robot.yield_(3)
        hints.append(window.session.tools.hint)
        robot.mouse_down(0)
        if keys:
            robot.key_down(keys)
        robot.mouse_move_to_pos(window.point((start + end) / 2))
        robot.mouse_move_to_pos(window.point(end))
        robot.yield_(2)
        hints.append(window.session.tools.hint)
        robot.mouse_up(0)
        if keys:
            robot.key_up(keys)

    window.run(play)
    window.settle()
    return hints


def angle_of(project, before):
    after = np.array(list(handle_places(project).values()))
    return cmath.phase((after[-1] - after[0]) / (before[-1] - before[0]))


def test_knob_turns_in_steps_with_shift_under_a_turned_camera(window, bar):
    view = bar.view_on(window.session.display.screen)
    bar.viewport.show(replace(view, turn=cmath.exp(0.5j)))
    window.frames(3)
    before = np.array(list(handle_places(bar).values()))
    box, em = box_of(window, bar)
    assert cmath.phase(box.axis) == pytest.approx(-0.5), "the box is upright on the screen"
    knob = box.knob_place(em)
    goal = box.pivot + cmath.exp(0.3j) * (knob - box.pivot)
    first, second = drag(window, knob, goal, keys=SHIFT)
    assert first == "Drag to turn around the pivot, Ctrl+← → turn"
    assert "type a number of degrees" in second
    assert angle_of(bar, before) == pytest.approx(np.radians(15), abs=2e-3)
    editing.undo(window.session)
    window.settle()
    assert angle_of(bar, before) == pytest.approx(0, abs=1e-6)


def test_pivot_is_dragged_and_put_back_and_keys_turn_around_it(window, bar):
    document, before = bar.document, np.array(list(handle_places(bar).values()))
    box, em = box_of(window, bar)
    # The handle in the middle is there, too: beside it the pivot is grabbed by its ring.
    grabbed = box.pivot + 0.95j * em
    first, _ = drag(window, grabbed, complex(before[0]))
    assert "move the pivot" in first
    assert bar.document is document
    assert bar.selection.pivot == pytest.approx(before[0])

    def turn(robot):
        for _ in range(2):
            robot.key_press(CTRL | SHIFT | int(imgui.Key.left_arrow))

    window.run(turn)
    window.settle()
    assert angle_of(bar, before) == pytest.approx(np.radians(20), abs=2e-3)
    assert next(iter(handle_places(bar).values())) == pytest.approx(before[0], abs=0.5)
