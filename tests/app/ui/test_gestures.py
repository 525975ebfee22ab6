"""Drags of every kind under one rule: a preview, and one undo step at the end."""

import pytest
from bars import BENT, check_at_rest, drag_bar
from documents import differences
from hands import HANDS, WIDGET
from imgui_bundle import imgui

from app.document import cycle_commands, scene_commands
from app.editor import pending_changes
from app.editor.actions import editing, playback
from app.editor.actions.posing.pose_solver import POSING, finish_drag
from app.editor.actions.project_files import saving
from app.editor.actions.timing import tracks
from app.editor.layering.layer_list import duplicate_layer
from app.editor.layering.layer_selection import set_active_layer
from app.editor.tools.tool_pointer import note_widget_in_use
from app.storage import load_project
from app.ui.window import action_queue

# Those whose change is final at once. Poses are in test_held_drags.
FINAL = ("keys", "end", "cycle", "slider", "camera", "track", "turn", "axis")


@pytest.fixture
def is_down(monkeypatch):
    """The button of the mouse is down on a widget."""
    monkeypatch.setattr(imgui, "is_mouse_down", lambda _: True)
    monkeypatch.setattr(imgui.internal, "get_active_id", lambda: WIDGET)


@pytest.fixture(params=FINAL)
def hand(request, window, loose, is_down):  # noqa: ARG001 - the button is down meanwhile
    """A hand that has begun, and moved by 2."""
    session = window.session
    playback.scrub(session, BENT)
    window.settle()
    if request.param in {"track", "turn"}:
        tracks.key_handles_at_playhead(session, (1,))
        window.settle()
        loose.selection.select_track(loose.layer, 1)
        window.settle()
    if request.param == "cycle":
        loose.history.do(cycle_commands.set_cycle(0, 0, BENT + 6))
    hand = HANDS[request.param](session)
    hand.before = loose.document
    hand.press()
    hand.move(1)
    hand.move(2)
    window.until(lambda: loose.document is not hand.before and not loose.pending_track_keys)
    return hand


def test_undo_cancels_a_drag_under_the_hand(window, loose, hand):
    editing.undo(window.session)
    assert loose.document is hand.before
    hand.move(3)
    hand.let_go()
    window.frames(2)
    assert loose.document is hand.before
    assert loose.history.redo_label is None


def test_escape_cancels_a_drag_under_the_hand(window, loose, hand):
    window.frames(2)
    assert loose.document is not hand.before
    for is_pressed in (True, False):
        imgui.get_io().add_key_event(imgui.Key.escape, is_pressed)
        window.frames(2)
    hand.move(3)
    hand.let_go()
    window.frames(2)
    assert loose.document is hand.before


def test_released_drag_is_a_single_undo_step(window, loose, hand):
    dragged = loose.document
    hand.let_go()
    assert not loose.history.is_unfinished
    editing.undo(window.session)
    assert loose.document is hand.before
    editing.redo(window.session)
    assert loose.document is dragged


def test_command_commits_the_drag_before_it(window, loose, hand):
    dragged = loose.document
    loose.history.do(scene_commands.set_fps(50))
    hand.move(3)
    hand.let_go()
    window.frames(2)
    editing.undo(window.session)
    assert loose.document is dragged
    editing.undo(window.session)
    assert loose.document is hand.before


def test_typing_in_a_field_is_undone_and_holds_nothing(window, loose):
    before = loose.document
    note_widget_in_use(window.session, WIDGET, is_pressed=True)
    note_widget_in_use(window.session, WIDGET, is_pressed=False)
    for fps in (50, 60):
        editing.edit_document(window.session, scene_commands.set_fps(fps))
    typed = loose.document
    assert not loose.history.is_held
    editing.undo(window.session)
    assert loose.document is before
    editing.redo(window.session)
    assert loose.document is typed


def test_save_waits_for_the_end_of_the_drag(window, loose, hand, tmp_path):
    path = tmp_path / "a.lissom"
    saving.write_project(window.session, path, None)
    window.settle()
    assert not path.exists()
    assert loose.history.undo_label in pending_changes.deferred_label(loose)
    hand.move(3)
    hand.let_go()
    window.until(path.exists)
    window.settle()
    assert not differences(load_project(path), loose.document)
    assert loose.history.is_saved


def test_hand_changes_nothing_of_another_layer(window, loose, hand):
    hand.let_go()
    duplicate_layer(window.session, 0)
    window.settle()
    set_active_layer(window.session, 0)
    again = type(hand)(window.session)
    again.press()
    again.move(1)
    window.until(lambda: not loose.pending_track_keys)
    dragged = loose.document
    (other,) = loose.runtimes.layers.keys() - {0}
    set_active_layer(window.session, other)
    again.move(2)
    again.let_go()
    window.frames(2)
    assert loose.document is dragged


@pytest.fixture
def unfinished(window, loose, monkeypatch):
    """A drag that was let go, with a command that waits for it, and the solver held."""
    monkeypatch.setattr(action_queue, "PATIENCE", 0.0)
    before, goal = loose.document, drag_bar(window, loose)
    drag = loose.drag
    window.until(lambda: drag.preview is not None)
    with window.session.jobs.held(POSING):
        window.act(editing.edit_document, scene_commands.set_fps(50))
        window.act(editing.edit_document, scene_commands.set_fps(60))
        window.frames(3)
        assert loose.drag is drag
        assert loose.document.fps == before.fps
        yield before, goal, drag


def test_commands_wait_in_order_until_the_pose_rests(window, loose, unfinished):
    before, goal, _drag = unfinished
    assert "Esc" in pending_changes.deferred_label(loose)
    # The worker goes on.
    finish_drag(window.session, loose)
    window.frames(2)
    assert loose.document.fps == 60
    check_at_rest(loose.document, goal)
    steps = []
    for _ in range(3):
        steps.append(loose.document.fps)
        editing.undo(window.session)
    assert steps == [60, 50, before.fps]
    assert loose.document is before


def test_escape_stops_a_pose_where_it_is_for_a_command(window, loose, unfinished):
    _before, _goal, drag = unfinished
    seen = drag.newest
    assert not drag.is_at_rest
    for is_pressed in (True, False):
        imgui.get_io().add_key_event(imgui.Key.escape, is_pressed)
        window.frames(2)
    assert loose.drag is None
    assert loose.layer.key(BENT).pose is seen
    assert loose.document.fps == 60


def test_drag_ends_where_the_playhead_leaves_its_frame(window, loose, hand):
    dragged = loose.document
    playback.scrub(window.session, 5)
    window.frames(1)
    hand.move(3)
    hand.let_go()
    window.settle()
    assert loose.document is dragged
