"""Numbers that are typed while the pointer drags."""

import numpy as np
import pytest
from bars import open_bar

from app.editor.actions import editing


@pytest.fixture
def bar(window):
    """A bar with a handle in its middle, which is selected."""
    return window.again(open_bar, 0.5)


def target(window, project):
    window.settle()
    return project.layer.keys[0].pose.targets[0]


def begin(robot, window, start, *places):
    robot.mouse_move_to_pos(window.point(start))
    robot.mouse_down(0)
    for place in places:
        robot.mouse_move_to_pos(window.point(place))


def test_forty_and_enter_move_a_handle_by_forty_pixels(window, bar):
    start = bar.layer.handles[0].position
    before = bar.document

    def play(robot):
        begin(robot, window, start, start + 9)
        # Neither digits nor letters are shortcuts now, and none of them is lost.
        robot.key_chars("40")
        robot.yield_(2)
        assert "type a number of pixels" in window.session.tools.hint.lower()
        robot.key_press(int(window.Key.enter))
        assert window.session.tools.active_tool is None
        robot.mouse_move_to_pos(window.point(start + 60j))
        robot.mouse_up(0)

    window.run(play)
    assert target(window, bar).position == pytest.approx(start + 40, abs=0.5)
    assert bar.viewport.view is None
    editing.undo(window.session)
    assert bar.document is before


def test_the_hint_of_drags_is_not_shown_for_a_click(window, bar):
    start, hints = bar.layer.handles[0].position, []

    def play(robot):
        begin(robot, window, start)
        for _ in range(4):
            hints.append(window.session.tools.hint)
            robot.yield_(1)
        robot.mouse_up(0)
        for _ in range(4):
            hints.append(window.session.tools.hint)
            robot.yield_(1)

    window.run(play)
    assert not [hint for hint in hints if "type a number" in hint.lower()]


def test_x_and_y_keep_a_drag_to_an_axis(window, bar):
    start = bar.layer.handles[0].position

    def play(robot, *, keys):
        begin(robot, window, start, start + 9, start + 20 + 30j)
        for key in keys:
            robot.key_press(int(key))
        robot.yield_(2)
        robot.mouse_up(0)

    for keys, way in (("x", 20), ("y", 30j), ("xx", 20 + 30j)):
        chords = [getattr(window.Key, key) for key in keys]
        window.run(lambda robot, chords=chords: play(robot, keys=chords))
        assert target(window, bar).position == pytest.approx(start + way, abs=2.0)
        editing.undo(window.session)
        window.settle()


def test_backspace_takes_a_digit_back_and_escape_everything(window, bar):
    start, before = bar.layer.handles[0].position, bar.document

    def play(robot, key):
        begin(robot, window, start, start + 9)
        robot.key_chars("-49")
        robot.key_press(int(window.Key.backspace))
        robot.key_chars("0")
        robot.key_press(int(key))
        robot.mouse_up(0)

    window.run(lambda robot: play(robot, window.Key.enter))
    assert target(window, bar).position == pytest.approx(start - 40, abs=0.5)
    editing.undo(window.session)
    window.settle()
    window.run(lambda robot: play(robot, window.Key.escape))
    window.settle()
    assert bar.document is before
    assert len(bar.layer.handles) == 1


def test_turning_by_steps_and_by_degrees(window, bar):
    centre = bar.layer.handles[0].position
    arm = window.ring(bar)

    def around(degrees):
        return centre + arm * np.exp(1j * np.radians(degrees))

    def snapped(robot):
        begin(robot, window, around(0), around(10), around(40))
        robot.key_down(int(window.Key.mod_ctrl))
        robot.yield_(2)
        robot.mouse_up(0)
        robot.key_up(int(window.Key.mod_ctrl))

    window.run(snapped)
    assert target(window, bar).rotation == pytest.approx(np.radians(45), abs=1e-9)
    editing.undo(window.session)
    window.settle()

    def entered(robot):
        begin(robot, window, around(0), around(10))
        robot.key_chars("-20")
        robot.key_press(int(window.Key.keypad_enter))
        robot.mouse_up(0)

    window.run(entered)
    assert target(window, bar).rotation == pytest.approx(np.radians(-20), abs=1e-9)
