"""Commands while a hand holds a handle: the pose goes on, or the rest of the drag is void."""

from dataclasses import replace

import pytest
from bars import BENT, check_at_rest, drag_bar
from invariants import check_invariants

from app.document import channel_commands, pose_channel
from app.document.keyframe import Target
from app.editor.action import do
from app.editor.actions import editing, playback, viewing
from app.editor.actions.posing.handles import add_handle, suggest_handles
from app.editor.actions.posing.pose_drag import (
    drag_handles,
    move_pose,
    nudge_handles,
    release_drag,
    set_targets,
)
from app.editor.actions.posing.pose_solver import POSING
from app.editor.actions.project_files import saving
from app.editor.actions.timing import timeline_drag
from app.editor.layering.layer_list import duplicate_layer
from app.editor.layering.layer_selection import set_active_layer
from app.editor.parts.timeline.gestures import KeyDrag
from app.editor.parts.timeline.time_range import TimeRangeView
from app.editor.poses import copying
from app.errors import LissomError
from app.solving import DragSolver
from app.storage import load_project
from engine.deform import BoundedPull
from engine.errors import EngineError

INBETWEEN = 12  # a frame between the keys
NEAR = 1.0  # pixels


class Hand:
    """A hand that holds the right handle of the bar."""

    def __init__(self, window, project, frame=BENT):
        playback.scrub(window.session, frame)
        window.settle()
        self.window, self.project, self.start = window, project, place_of(project, 1)

    def move(self, way):
        def moved(start, targets):
            return {1: replace(targets[1], position=start.places[1] + way)}

        pull = BoundedPull(frozenset({1}))
        drag_handles(self.window.session, moved, gesture=self, hand=pull)

    def let_go(self):
        self.window.settle()
        release_drag(self.window.session)
        self.window.settle()
        playback.stop_playback(self.window.session)
        playback.scrub(self.window.session, BENT)
        self.window.settle()

    @property
    def way(self):
        """The handle's way since the press, at the key."""
        return place_of(self.project, 1) - self.start


def place_of(project, handle):
    shown = project.layer_runtime.shown
    assert shown is not None
    return complex(shown.handle_positions[[h.id for h in project.layer.handles].index(handle)])


def hold(window, project, frame=BENT):
    hand = Hand(window, project, frame)
    hand.move(-60j)
    window.settle()
    return hand


LEAVING = {
    "copy": copying.copy_pose_or_keys,
    "scrub": lambda session: playback.scrub(session, 5),
    "play": playback.toggle_play,
}


@pytest.mark.parametrize("name", LEAVING)
def test_drag_that_a_command_ended_moves_no_further(window, loose, name):
    hand = hold(window, loose)
    LEAVING[name](window.session)
    hand.move(-70j)
    hand.let_go()
    assert abs(hand.way + 60j) < NEAR
    assert loose.layer.key_frames == {0, BENT}


def test_drag_moves_no_handle_of_another_layer(window, loose):
    duplicate_layer(window.session, 0)
    window.settle()
    (other,) = loose.runtimes.layers.keys() - {0}
    set_active_layer(window.session, 0)
    hand, before = hold(window, loose), loose.document.layer(other)
    set_active_layer(window.session, other)
    hand.move(-70j)
    hand.let_go()
    assert loose.document.layer(other) is before
    set_active_layer(window.session, 0)
    window.settle()
    assert abs(hand.way + 60j) < NEAR


def test_drag_goes_on_after_a_nudge(window, loose):
    hand, goal = hold(window, loose), place_of(loose, 0) + 1
    loose.selection.handles = frozenset({0})
    nudge_handles(window.session, 1 + 0j)
    window.settle()
    assert loose.history.is_held
    hand.move(-70j)
    hand.let_go()
    assert abs(hand.way + 70j) < NEAR
    assert abs(place_of(loose, 0) - goal) < NEAR


def test_drag_goes_on_after_redo_that_has_nothing(window, loose):
    set_targets(window.session, {0: Target(position=place_of(loose, 0) + 20j)})
    window.settle()
    editing.undo(window.session)
    hand = hold(window, loose)
    assert "nothing to redo" in editing.redo.disabled_reason(window.session)
    editing.redo(window.session)
    hand.move(-70j)
    hand.let_go()
    assert abs(hand.way + 70j) < NEAR


def test_undo_ends_each_gesture_of_a_drag(window, loose):
    hand, before = Hand(window, loose, INBETWEEN), loose.document
    loose.selection.handles = frozenset({1})
    with window.session.jobs.held(POSING):
        nudge_handles(window.session, 1 + 0j)
        hand.move(-30j)
        assert len(loose.drag.target_changes) == 2
        editing.undo(window.session)
        hand.move(-40j)
    window.settle()
    assert loose.drag is None
    assert loose.document is before


KEY_COMMANDS = {
    "delete": (channel_commands.delete_keys, {0, BENT}),
    "move": (lambda keys: channel_commands.move_keys(keys, 3), {0, INBETWEEN + 3, BENT}),
}


@pytest.mark.parametrize("name", KEY_COMMANDS)
def test_command_has_the_key_that_a_drag_displays(window, loose, name):
    command, frames = KEY_COMMANDS[name]
    hold(window, loose, INBETWEEN)
    release_drag(window.session)
    assert loose.drag is not None
    editing.edit_document(window.session, command({pose_channel(0): {INBETWEEN}}))
    assert loose.drag is None
    assert loose.layer.key_frames == frames


def test_key_moves_with_the_pose_at_rest_of_a_drag(window, loose):
    goal = drag_bar(window, loose)
    drag, keys = loose.drag, {pose_channel(0): frozenset({BENT})}
    window.until(lambda: drag.preview is not None)
    assert not drag.is_at_rest
    held = KeyDrag(
        start=BENT,
        keys=keys,
        channel=pose_channel(0),
        pressed=BENT,
        mark=keys,
        copies=False,
    )
    timeline_drag.begin_timeline_drag(window.session, held, TimeRangeView(0.0, 48.0))
    for frame in (BENT + 2, BENT + 4):
        timeline_drag.move_timeline_drag(window.session, frame, pose_channel(0))
    timeline_drag.end_timeline_drag(window.session)
    assert loose.layer.key_frames == {0, BENT + 4}
    check_at_rest(loose.document, goal, frame=BENT + 4)


def test_saved_key_has_the_pose_at_rest_without_auto_key(window, loose, tmp_path):
    path = tmp_path / "a.lissom"
    saving.write_project(window.session, path, None)
    viewing.toggle_auto_key(window.session)
    window.settle()
    goal = drag_bar(window, loose)
    drag = loose.drag
    window.until(lambda: drag.preview is not None)
    assert not drag.is_at_rest
    saving.key_and_save(window.session, do(saving.discard_project))
    window.until(lambda: window.session.project is None)
    check_at_rest(load_project(path), goal)


@pytest.fixture
def fails(window, monkeypatch):
    """Return a function after which the solver fails; nobody reads the report of it."""

    def failing(*_arguments, **_options):
        raise EngineError("no pose")

    yield lambda: monkeypatch.setattr(DragSolver, "step_towards", failing)
    assert POSING.complaint in window.session.notices.toasts[-1].text
    window.session.notices.toasts.clear()


def test_key_of_a_drag_that_fails_is_selected_no_more(window, loose, fails):
    hand = hold(window, loose, INBETWEEN)
    editing.select_keys(window.session, frozenset({INBETWEEN}))
    fails()
    hand.move(-70j)
    window.settle()
    assert loose.drag is None
    check_invariants(window.session)
    assert not loose.selection.keys


def test_undo_of_a_drag_that_fails_takes_back_no_other_step(window, loose, fails):
    before = loose.document
    hand = hold(window, loose)
    with window.session.jobs.held(POSING):
        hand.move(-70j)
        release_drag(window.session)
        fails()
        editing.undo(window.session)
    assert loose.drag is None
    assert loose.document is before


FAR = 1e9  # pixels: beyond all targets


@pytest.mark.parametrize("is_moved", [False, True])
def test_drag_keeps_its_targets_when_one_is_refused(window, loose, is_moved):
    def move(way):
        if is_moved:
            move_pose(window.session, way, gesture=hand)
        else:
            hand.move(way)

    hand = Hand(window, loose)
    move(-60j)
    window.settle()
    with pytest.raises(LissomError, match="within 10,000,000 pixels"):
        move(FAR + 0j)
    hand.let_go()
    assert abs(hand.way + 60j) < NEAR


def test_suggestions_go_though_one_is_dragged(window, loose):
    before = loose.layer.handles
    suggest_handles(window.session)
    window.frames(2)
    added = loose.layer.handles[-1].id
    take_back = window.session.notices.toasts[-1].action
    set_targets(window.session, {added: Target(position=place_of(loose, added) + 9j)})
    take_back.apply(window.session)
    window.settle()
    assert loose.layer.handles == before


def test_escape_ends_the_drag_of_a_handle_that_goes_with_it(window, loose):
    before, gesture = loose.document, object()
    playback.scrub(window.session, BENT)
    window.settle()
    place = complex(loose.layer_runtime.shown.positions.mean())
    add_handle(window.session, place, gesture=gesture)
    (added,) = loose.selection.handles
    drag_handles(window.session, {added: Target(position=place + 20j)}, gesture=gesture)
    set_targets(window.session, {1: Target(position=place_of(loose, 1) + 9j)})
    window.frames(2)
    editing.revert_gesture(window.session, gesture)
    window.settle()
    assert loose.document is before
    assert loose.drag is None
