"""Whoever quits while something goes on is asked, and nothing is lost by the answer."""

from contextlib import ExitStack

import pytest
from imgui_bundle import hello_imgui

from app.document.keyframe import Target
from app.editor.actions.posing.handles import add_handle
from app.editor.actions.posing.pose_drag import set_targets
from app.editor.actions.project_files import saving
from app.editor.parts.dialogs import Question
from app.storage import NO_FOLDER
from app.storage.project_file import load_project


@pytest.fixture
def saved(window, bar, tmp_path):
    """The bar, saved in a file."""
    path = tmp_path / "a.lissom"
    saving.write_project(window.session, path, None)
    window.settle()
    assert bar.history.is_saved
    yield path
    # It is the window of the other tests, too.
    hello_imgui.get_runner_params().app_shall_exit = False


@pytest.fixture
def gate(window):
    """Saves wait until it is closed."""
    with ExitStack() as gate:
        gate.enter_context(window.session.jobs.held(saving.SAVING))
        yield gate


def quit_lissom(window):
    """Ask the window to close, as its button does."""
    window.act(saving.request_quit)


def question(window):
    dialog = window.session.dialogs.current
    return dialog.title if isinstance(dialog, Question) else None


def answer(window, text):
    window.run(lambda robot: robot.item_click(f"//###dialog/{text}"))


def target_of(document):
    return document.layers[0].key(0).pose.targets[1].position


def test_a_pose_that_the_solver_still_looks_for_is_not_lost(window, bar, saved):
    place = target_of(bar.document)
    set_targets(window.session, {1: Target(position=place + 5j)})
    assert bar.history.is_saved  # nothing of it has come yet
    saving.request_quit(window.session)
    assert not window.session.is_quitting
    window.until(lambda: question(window) == "Unsaved changes")
    answer(window, "Save")
    window.settle()
    assert window.session.is_quitting
    assert target_of(load_project(saved)) == place + 5j


def test_two_saves_at_a_time_are_one_after_the_other_and_nobody_elses(window, bar, saved, gate):
    for step in (3j, 6j):
        add_handle(window.session, complex(50, 50) + step)
        window.frames(2)
        window.act(saving.save)
    gate.close()
    window.settle()
    assert question(window) is None
    assert bar.history.is_saved
    assert len(load_project(saved).layers[0].handles) == len(bar.layer.handles)


def test_quitting_waits_for_a_running_save_unless_asked_twice(window, bar, saved, gate):
    add_handle(window.session, complex(50, 50))
    window.act(saving.save)
    for title in (None, saving.UNSAVED):
        quit_lissom(window)
        assert question(window) == title
        assert not window.session.is_quitting
    answer(window, "Cancel")
    quit_lissom(window)
    assert question(window) is None
    gate.close()
    window.settle()
    assert window.session.is_quitting
    assert len(load_project(saved).layers[0].handles) == len(bar.layer.handles)


@pytest.mark.usefixtures("bar")
def test_a_save_that_fails_ends_nothing(window, saved):
    add_handle(window.session, complex(50, 50))
    window.frames(2)
    for path in saved.parent.iterdir():
        path.unlink()
    saved.parent.rmdir()
    quit_lissom(window)
    answer(window, "Save")
    window.settle()
    assert not window.session.is_quitting
    assert any(
        NO_FOLDER.format(folder=saved.parent) in toast.text
        for toast in window.session.notices.toasts
    )
    quit_lissom(window)
    assert question(window) == saving.UNSAVED


def test_a_drag_that_goes_on_while_the_window_is_to_close_is_kept(window, bar, saved):
    start = complex(bar.layer_runtime.shown.handle_positions[1])

    def play(robot):
        robot.mouse_move_to_pos(window.point(start))
        robot.mouse_down(0)
        robot.mouse_move_to_pos(window.point(start - 20j))
        saving.request_quit(window.session)
        robot.yield_(2)
        robot.mouse_move_to_pos(window.point(start - 25j))
        robot.mouse_up(0)
        robot.yield_(2)

    window.run(play)
    assert window.session.tools.active_tool is None
    saving.request_quit(window.session)  # once more
    answer(window, "Save")
    window.settle()
    assert window.session.is_quitting
    kept = load_project(saved)
    assert abs(target_of(kept) - start) > 10
    assert target_of(kept) == target_of(bar.document)
