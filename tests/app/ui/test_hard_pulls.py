"""A handle that is dragged beyond its reach, by the pointer, and the notice about it."""

import numpy as np
import pytest
from bars import open_bar

from app.document import NATURAL, RUBBERY
from app.editor.actions import editing
from app.editor.actions.posing.reach_limit import STOPPED_AT_LIMIT

HAND, OUT = 0, 500 + 40j  # pixels of the picture


@pytest.fixture
def bar(window):
    """The bar, held at its left end and in its middle; its right end is the hand."""
    project = window.again(open_bar, 0.9, 0.5, 0.1)
    editing.select_handles(window.session, frozenset())
    window.settle()
    assert project.layer.bounds == NATURAL.bounds
    return project


def places(bar):
    return np.array(bar.layer_runtime.shown.handle_positions)


def texts(window):
    return [toast.text for toast in window.session.notices.toasts if "stopped" in toast.text]


def drag(window, bar, way, *, key=None):
    start = complex(places(bar)[HAND])

    def play(robot):
        robot.mouse_move_to_pos(window.point(start))
        robot.mouse_down(0)
        robot.mouse_move_to_pos(window.point(start + way / 2))
        robot.mouse_move_to_pos(window.point(start + way))
        robot.yield_(2)
        assert "to keep the target where the pointer is" in window.session.tools.hint
        if key is not None:
            robot.key_down(int(key))
        robot.mouse_up(0)
        if key is not None:
            robot.key_up(int(key))

    window.run(play)
    window.settle()
    return start + way


def test_the_rest_stays_and_loosen_lets_it_come_nearer(window, bar):
    start = places(bar)
    asked = drag(window, bar, OUT)
    reached = places(bar)
    assert np.abs(reached[1:] - start[1:]).max() < 3
    short = abs(asked - reached[HAND])
    assert short > 50
    wanted = bar.layer.keys[0].pose.targets[HAND].position
    assert abs(wanted - reached[HAND]) < 2
    (text,) = texts(window)
    assert text == STOPPED_AT_LIMIT.format(handle=bar.layer.handles[HAND].name)
    window.run(lambda robot: robot.item_click("**/Loosen"))
    window.settle()
    assert bar.layer.bounds == RUBBERY.bounds
    assert abs(asked - places(bar)[HAND]) < 0.7 * short
    # Looser limits and what comes of them are one step, and so was the drag.
    editing.undo(window.session)
    window.settle()
    assert np.abs(places(bar) - reached).max() < 1e-6
    editing.undo(window.session)
    window.settle()
    assert np.abs(places(bar) - start).max() < 1e-6


def test_alt_while_releasing_keeps_the_target(window, bar):
    start = places(bar)
    asked = drag(window, bar, OUT, key=window.Key.mod_alt)
    assert bar.layer.keys[0].pose.targets[HAND].position == pytest.approx(asked, abs=3)
    assert np.abs(places(bar)[1:] - start[1:]).max() > 3
    assert not texts(window)
