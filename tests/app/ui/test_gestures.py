"""Drags of every kind under one rule: a preview, and one undo step at the end."""

from dataclasses import dataclass, field

import pytest
from bars import BENT, check_at_rest, drag_bar
from documents import differences
from imgui_bundle import imgui

from app.document import OPACITY, Channel, pose_channel, scene_commands
from app.editor import pending_changes
from app.editor.actions import editing, playback
from app.editor.actions.posing.pose_solver import POSING, finish_drag
from app.editor.actions.project_files import saving
from app.editor.actions.timing import channel_keys, timeline_drag, tracks
from app.editor.actions.tracking.track_dragging import drag_track_handle
from app.editor.layering.layer_list import duplicate_layer
from app.editor.layering.layer_selection import set_active_layer
from app.editor.parts.timeline import EdgeDrag, KeyDrag, TimeRangeView
from app.editor.poses import flipping
from app.editor.tools.tool_pointer import note_widget_in_use
from app.storage import load_project
from app.ui.window import action_queue

VIEW = TimeRangeView(0.0, 48.0)
WIDGET = 7


@dataclass(eq=False)
class Hand:
    """A hand that changes the bar in one of several ways, by amounts from 1 on."""

    window: object
    project: object
    drag: object = field(default_factory=object)

    @property
    def session(self):
        return self.window.session

    def press(self):
        """Begin."""

    def move(self, amount):
        raise NotImplementedError

    def let_go(self):
        self.project.history.release(self.drag)


class KeyHand(Hand):
    def press(self):
        keys = {pose_channel(0): frozenset({BENT})}
        options = {"pressed": BENT, "mark": keys, "copies": False}
        drag = KeyDrag(start=BENT, keys=keys, channel=pose_channel(0), **options)
        timeline_drag.begin_timeline_drag(self.session, drag, VIEW)

    def move(self, amount):
        timeline_drag.move_timeline_drag(self.session, BENT + amount, pose_channel(0))

    def let_go(self):
        timeline_drag.end_timeline_drag(self.session)


class EndHand(KeyHand):
    def press(self):
        drag = EdgeDrag(start=48.0, edge="animation end")
        timeline_drag.begin_timeline_drag(self.session, drag, VIEW)

    def move(self, amount):
        timeline_drag.move_timeline_drag(self.session, 60 + amount, pose_channel(0))


class SliderHand(Hand):
    def press(self):
        note_widget_in_use(self.session, WIDGET, is_pressed=True)

    def move(self, amount):
        channel_keys.set_channel_value(self.session, Channel(OPACITY, 0), 1 / (1 + amount))

    def let_go(self):
        note_widget_in_use(self.session, 0, is_pressed=False)


class TrackHand(Hand):
    def press(self):
        self.place = complex(self.project.layer_runtime.shown.handle_positions[1])

    def move(self, amount):
        drag_track_handle(self.session, 1, self.place + 20j * amount, gesture=self.drag)
        self.window.until(lambda: not self.project.track_drags)


class AxisHand(Hand):
    def move(self, amount):
        flipping.move_mirror_axis(self.session, 100.0 + amount, self.drag)


HANDS = {
    "keys": KeyHand,
    "end": EndHand,
    "slider": SliderHand,
    "track": TrackHand,
    "axis": AxisHand,
}


@pytest.fixture(params=HANDS)
def hand(request, window, loose):
    """A hand that has begun, and moved by 2."""
    session = window.session
    playback.scrub(session, BENT)
    window.settle()
    if request.param == "track":
        tracks.key_handles_at_playhead(session, (1,))
        window.settle()
        loose.selection.select_track(loose.layer, 1)
        window.settle()
    hand = HANDS[request.param](window, loose)
    hand.before = loose.document
    hand.press()
    hand.move(1)
    hand.move(2)
    assert loose.document is not hand.before
    return hand


@pytest.fixture
def is_down(monkeypatch):
    """The button of the mouse is down on a widget."""
    monkeypatch.setattr(imgui, "is_mouse_down", lambda _: True)
    monkeypatch.setattr(imgui.internal, "get_active_id", lambda: WIDGET)


def test_undo_cancels_a_drag_under_the_hand(window, loose, hand):
    editing.undo(window.session)
    assert loose.document is hand.before
    hand.move(3)
    hand.let_go()
    window.frames(2)
    assert loose.document is hand.before
    assert loose.history.redo_label is None


@pytest.mark.usefixtures("is_down")
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


@pytest.mark.usefixtures("is_down")
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
    again = type(hand)(window, loose)
    again.press()
    again.move(1)
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
