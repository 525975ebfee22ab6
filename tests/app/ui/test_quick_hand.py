"""Presses and moves within one frame, as on a slow machine or a touch screen."""

import numpy as np
import pytest
from bars import open_bar
from imgui_bundle import imgui

from app.editor.actions import editing
from app.editor.actions.posing.handles import add_handle


@pytest.fixture
def project(window):
    """A bar with a handle near its left end, under the pointer."""
    project = window.again(open_bar, 0.1)
    point(window, project, 0.1)
    window.frames(3)
    assert window.session.tools.hovered == 0
    return project


def place_of(project, share):
    width, height = project.document.canvas
    return complex(share * width, height / 2)


def point(window, project, share):
    imgui.get_io().add_mouse_pos_event(*window.point(place_of(project, share)))


def hold(*, is_down):
    imgui.get_io().add_mouse_button_event(0, is_down)


def press(window, project, share):
    """Move the pointer and press the button before the next frame."""
    point(window, project, share)
    hold(is_down=True)
    hold(is_down=False)
    window.frames(4)


def test_it_leaves_a_handle_for_the_canvas(window, project):
    press(window, project, 0.9)
    assert len(project.layer.handles) == 2


def test_it_leaves_the_canvas_for_a_handle(window, project):
    press(window, project, 0.9)
    point(window, project, 0.5)
    window.frames(3)
    press(window, project, 0.1)
    assert project.selection.handles == {0}
    assert len(project.layer.handles) == 2


def test_it_takes_the_upper_one_of_two_handles(window, project):
    press(window, project, 0.9)
    add_handle(window.session, place_of(project, 0.901))
    window.frames(3)
    press(window, project, 0.9)
    assert project.selection.handles == {2}


def test_two_drags_in_adjacent_frames_are_two_steps(window, project):
    """The button is let go in one frame, and pressed again in the next."""
    before = project.document
    for share in (0.15, 0.12):
        hold(is_down=True)
        window.frames(1)
        point(window, project, share)
        window.settle()
        hold(is_down=False)
        window.frames(1)
    window.settle()
    places = []
    while project.document is not before:
        places.append(project.layer.keys[0].pose.targets[0].position)
        editing.undo(window.session)
        window.settle()
    np.testing.assert_allclose(places, [place_of(project, at) for at in (0.12, 0.15)], atol=2)


def test_a_drag_goes_to_where_the_button_is_let_go(window, project):
    press(window, project, 0.9)
    hold(is_down=True)
    window.frames(2)
    # All of the way, and the end of it, before the next frame.
    for share in (0.88, 0.86, 0.85):
        point(window, project, share)
    hold(is_down=False)
    window.settle()
    target = project.layer.keys[0].pose.targets[1]
    assert abs(target.position - place_of(project, 0.85)) < 2
