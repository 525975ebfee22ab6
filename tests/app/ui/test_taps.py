"""Presses that come in the same moment as the pointer, and keys within one picture.

As pens, tablets and their express keys send them, and hands where pictures are slow: there, several
come between two pictures.
"""

import shutil
from itertools import pairwise

import numpy as np
import pytest
from bars import BENT
from imgui_bundle import ImVec2, imgui

from app.editor.actions import editing, playback
from tests.campaigns.taps import tapped

LEFT = 0
CTRL = (imgui.Key.mod_ctrl, imgui.Key.left_ctrl)


def place_of(window, name, window_name="###Timeline"):
    """Return the box of an item."""
    found = []

    def look(robot):
        robot.set_ref(window_name)
        found.append(robot.item_info(f"**/{name}").rect_full)

    window.run(look)
    return found[0]


def tap(place, times=1):
    """Move the pointer, press and let go, before anything is drawn."""
    io = imgui.get_io()
    io.add_mouse_pos_event(place.x, place.y)
    for _ in range(times):
        io.add_mouse_button_event(LEFT, True)  # noqa: FBT003 - ImGui's own
        io.add_mouse_button_event(LEFT, False)  # noqa: FBT003


def turn(*several, down):
    for key in several:
        imgui.get_io().add_key_event(key, down)


def until_all_is_taken(window):
    """Draw pictures until no input waits any more, and return each frame that was shown."""
    session, shown = window.session, []
    queue = imgui.get_current_context().input_events_queue
    while queue.size():
        window.frames(1)
        shown.append(playback.current_frame(session, session.project))
    window.frames(2)
    return shown


@pytest.fixture
def ruler(window, bent):
    """Where each frame is on the ruler; the pointer is elsewhere."""
    first, last = (place_of(window, f"key {key.frame}").get_center() for key in bent.layer.keys)
    middle = place_of(window, "ruler").get_center().y
    imgui.get_io().add_mouse_pos_event(first.x, first.y - 300)
    window.frames(3)
    return [ImVec2(first.x + (last.x - first.x) * frame / BENT, middle) for frame in range(49)]


def test_the_playhead_goes_to_each_tap_on_the_ruler(window, ruler):
    frames = np.random.default_rng(1).permutation(len(ruler))[:30].tolist()
    for frame in frames:
        tap(ruler[frame])
    shown = until_all_is_taken(window)
    assert [now for last, now in pairwise([BENT, *shown]) if now != last] == frames


def test_taps_on_one_place_count_too(window, ruler):
    """The playhead comes under the pointer, between a press and the next one."""
    for frame in (30, 10, 20):
        tap(ruler[frame], times=2)
        assert until_all_is_taken(window)[-1] == frame


@pytest.mark.usefixtures("bar")
def test_tabs_take_a_tap(window):
    names = ("Layers", "Export", "Handle", "Shape")
    panels = {name: f"###{name}" for name in names}
    window.frames(2)
    for name, panel in panels.items():
        node = imgui.internal.find_window_by_name(panel)
        assert node is not None, name
        box = node.dc.dock_tab_item_rect
        tap(box.get_center())
        until_all_is_taken(window)
        assert node.dock_node.selected_tab_id == node.tab_id, name


def test_a_chord_whose_modifier_is_let_go_first_counts(window, bar):
    steps = bar.history.position
    turn(*CTRL, down=True)
    window.frames(1)
    turn(imgui.Key.z, down=True)
    turn(*CTRL, down=False)
    turn(imgui.Key.z, down=False)
    until_all_is_taken(window)
    assert bar.history.position == steps - 1


def test_keys_and_taps_come_in_turn(window, bent, ruler):
    """A mark on each frame that is tapped, and every second one undone, all within a picture."""
    frames = [40, 8, 32, 16, 48, 2]
    for frame in frames:
        tap(ruler[frame])
        for down in (True, False):
            turn(imgui.Key.m, down=down)
        if frame > BENT:
            turn(*CTRL, imgui.Key.z, down=True)
            turn(*CTRL, imgui.Key.z, down=False)
    until_all_is_taken(window)
    assert [marker.frame for marker in bent.document.markers] == [2, 8, 16]


@pytest.mark.skipif(
    not (shutil.which("Xvfb") and shutil.which("xdotool")), reason="bash .ci/setup test"
)
def test_a_real_window_takes_all_of_them():
    assert tapped(np.random.default_rng(0), 4)["taps"] == 4


class Keyboard:
    """A keyboard that counts taps as the real window does."""

    def __init__(self, window):
        self.taps = window.program.shell.taps

    def tap(self, key, times=1):
        for down in (True, False) * times:
            waiting = imgui.get_current_context().input_events_queue.size()
            if not self.taps.drops(key, is_down=down, waiting=waiting):
                turn(key, down=down)


def test_taps_of_a_stepping_key_within_a_picture_are_one_move(window, bent):
    """A held key that a remote desktop sends as taps goes on no longer than the hand holds it."""
    keyboard = Keyboard(window)
    playback.scrub(window.session, 0)
    window.frames(2)
    keyboard.tap(imgui.Key.page_down, 9)
    assert until_all_is_taken(window) == [9, 9]
    keyboard.tap(imgui.Key.page_down, 4)
    keyboard.tap(imgui.Key.page_up, 2)
    keyboard.tap(imgui.Key.page_down)
    shown = until_all_is_taken(window)
    assert [now for last, now in pairwise([9, *shown]) if now != last] == [13, 11, 12]
    window.frames(2)
    # A tap that comes while the last release waits is another one.
    keyboard.tap(imgui.Key.page_down)
    window.frames(1)
    keyboard.tap(imgui.Key.page_down, 3)
    until_all_is_taken(window)
    assert playback.current_frame(window.session, bent) == 16


def test_arrows_nudge_as_far_as_they_are_tapped(window, bent):
    keyboard, (handle, *_) = Keyboard(window), bent.layer.handles
    window.act(editing.select_handles, frozenset({handle.id}))
    window.frames(2)
    start = bent.layer.keys[-1].pose.targets[handle.id].position
    steps = bent.history.position
    keyboard.tap(imgui.Key.up_arrow, 5)
    until_all_is_taken(window)
    window.settle()
    assert bent.layer.keys[-1].pose.targets[handle.id].position == pytest.approx(start + 5j)
    assert bent.history.position == steps + 1


def test_no_tap_is_counted_while_a_field_has_the_keys(window, bent):
    del bent
    window.program.shell.taps.is_on = False
    keyboard = Keyboard(window)
    keyboard.tap(imgui.Key.left_arrow, 3)
    assert imgui.get_current_context().input_events_queue.size() == 6
    until_all_is_taken(window)
