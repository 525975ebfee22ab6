"""What is copied and selected is what the person sees: in the drawing, or in the timeline."""

import numpy as np
import pytest
from imgui_bundle import ImVec2, imgui

from app.document import HOLD, channel_commands, pose_channel
from app.editor.actions import editing, playback
from app.editor.actions.posing.inserting import insert_key_at
from app.editor.layering.layer_list import duplicate_layer
from app.editor.layering.layer_selection import set_active_layer
from app.editor.layering.pictures import make_still
from app.editor.poses.copying import KEYS_COPIED
from app.ui.shortcuts.table import ACTIONS

CTRL = int(imgui.Key.mod_ctrl)
ALL, COPY, PASTE = (CTRL | int(key) for key in (imgui.Key.a, imgui.Key.c, imgui.Key.v))
ESCAPE = int(imgui.Key.escape)


class Hand:
    """The robot, over the drawing or the timeline."""

    def __init__(self, window, robot):
        self._window = window
        self.robot = robot

    def to_drawing(self):
        project = self._window.session.project
        # Beside the shape.
        self.robot.mouse_move_to_pos(self._window.point(complex(*project.document.canvas) * 0.02))

    def to_timeline(self, frame=18, item="ground"):
        box = self.robot.item_info(f"###Timeline/**/{item}").rect_full
        self.robot.mouse_move_to_pos(ImVec2(self.x(frame), (box.min.y + box.max.y) / 2))

    def x(self, frame):
        first, last = (
            self.robot.item_info(f"###Timeline/**/key {at}").rect_full.get_center().x
            for at in (0, 24)
        )
        return first + frame * (last - first) / 24

    def click_key(self, frame, button=0):
        self.robot.item_click(f"###Timeline/**/key {frame}", button)

    def press(self, *keys):
        for key in keys:
            self.robot.key_press(key)
            self.robot.yield_(2)


@pytest.fixture
def play(window, loose):
    assert loose is window.session.project

    def play(what):
        window.session.notices.toasts = []
        window.run(lambda robot: what(Hand(window, robot)))
        window.settle()
        return [toast.text for toast in window.session.notices.toasts]

    return play


def poses_of(project):
    return {key.frame: key.pose for key in project.layer.keys}


@pytest.mark.parametrize("frame", [0, 12])
def test_over_the_drawing_the_pose_at_the_playhead_is_copied(window, loose, play, frame):
    def copy(hand):
        hand.click_key(24)
        playback.scrub(window.session, frame)
        hand.to_drawing()
        hand.press(COPY)

    message = play(copy)
    assert loose.selection.frames == {24}
    assert message == [f"Pose at frame {frame} copied."]
    (copied,) = window.session.clipboard.poses
    (key,) = copied.keys
    f = loose.layer.map_of(key.pose)
    places = np.array([handle.position for handle in loose.layer.handles])
    np.testing.assert_allclose(
        f(places), loose.layer_runtime.shown.handle_positions, rtol=0, atol=0.5
    )
    if frame == 0:
        assert key.pose is loose.layer.key(0).pose


def test_a_pose_that_is_copied_as_the_playhead_leaves_another_is_the_one_that_it_comes_to(
    window, loose, play
):
    def copy(hand):
        hand.to_drawing()
        # Both in one frame: what is shown is still the pose before.
        playback.scrub(window.session, 0)
        window.session.display.is_timeline_focused = False
        hand.press(COPY)

    play(copy)
    assert window.session.clipboard.poses[0].keys[0].pose is loose.layer.key(0).pose


def test_in_the_timeline_the_chosen_keys_are_copied(window, loose, play):
    def copy(hand):
        hand.to_timeline()
        hand.press(ALL)
        playback.scrub(window.session, 12)
        hand.press(COPY)

    assert play(copy) == [KEYS_COPIED.format(count=2)]
    assert loose.selection.frames == {0, 24}
    (copied,) = window.session.clipboard.poses
    assert copied.keys == loose.layer.keys

    def one(hand):
        hand.click_key(0)
        playback.scrub(window.session, 12)
        hand.press(COPY)

    assert play(one) == ["Pose at frame 0 copied."]
    assert window.session.clipboard.poses[0].keys == (loose.layer.key(0),)


def test_where_the_pointer_is_in_neither_the_focus_tells(window, play):
    window.show_tab("Handle")
    window.frames(2)

    def over_a_tab(hand):
        hand.robot.mouse_move("###Handle")

    for begin, message in (
        (lambda hand: hand.click_key(24), "Pose at frame 24 copied."),
        (Hand.to_drawing, "Pose at frame 12 copied."),
    ):

        def copy(hand, begin=begin):
            hand.click_key(24)
            playback.scrub(window.session, 12)
            begin(hand)
            if begin == Hand.to_drawing:
                hand.robot.mouse_click(0)
                editing.select_keys(window.session, frozenset({24}))
            else:
                playback.scrub(window.session, 12)
            over_a_tab(hand)
            hand.press(COPY)

        assert play(copy)[-1] == message


def test_the_menu_says_what_would_be_copied_and_selected(window, play):
    entries = []

    def look(hand):
        hand.robot.set_ref("##MainMenuBar")
        hand.robot.menu_action(imgui.test_engine.TestAction.open, "Edit")
        for name in ("Copy", "Select all"):
            assert hand.robot.item_exists(f"//$FOCUSED/###{name}")
            binding = next(each for each in ACTIONS.values() if each.label == name)
            entries.append(binding.menu_title(window.session).split("###")[0])
        hand.robot.popup_close_all()

    # On the way to the menu the pointer crosses the drawing; the focus is the timeline's.
    play(lambda hand: (hand.click_key(24), hand.to_timeline(), hand.press(ALL), look(hand)))
    assert entries == ["Copy 2 keys", "Select all keys"]
    entries.clear()
    play(lambda hand: (hand.to_drawing(), hand.robot.mouse_click(0), look(hand)))
    assert entries == ["Copy pose", "Select all handles"]


def test_all_keys_of_all_layers_that_are_posed_are_chosen(window, loose, play):
    duplicate_layer(window.session, 0)
    duplicate_layer(window.session, 0)
    window.settle()
    still = loose.selection.active
    make_still(window.session, still)
    window.settle()
    set_active_layer(window.session, 0)
    posed = {layer.id for layer in loose.document.layers} - {still}
    assert play(lambda hand: (hand.to_timeline(), hand.press(ALL, COPY))) == [
        KEYS_COPIED.format(count=4)
    ]
    assert loose.selection.keys == {pose_channel(each): {0, 24} for each in posed}


@pytest.mark.parametrize("item", ["ruler", "ground"])
def test_a_click_on_the_ruler_or_the_empty_timeline_clears_the_choice_of_keys(
    window, loose, play, item
):
    editing.select_handles(window.session, frozenset({1}))
    loose.selection.keys = {pose_channel(loose.selection.active): frozenset({0, 24})}

    def scrub(hand):
        hand.to_timeline(6, "ruler")
        hand.robot.mouse_down(0)
        hand.to_timeline(14, "ruler")
        hand.robot.mouse_up(0)

    play(scrub)
    assert loose.selection.frames == {0, 24}, "to look at another frame lets go of nothing"

    def click(hand):
        # Beyond the last key there is nothing but the ground.
        hand.to_timeline(30, item)
        hand.robot.mouse_click(0)

    play(click)
    assert not loose.selection.keys
    if item == "ruler":
        assert loose.selection.handles == {1}
        assert loose.timeline.playhead.frame == 30


def test_the_menu_of_a_key_copies_and_pastes_there(window, loose, play):
    editing.edit_document(
        window.session,
        channel_commands.set_easing({pose_channel(loose.selection.active): {24}}, HOLD),
    )
    before = loose.document

    def use(frame, *path):
        def use(hand):
            hand.click_key(frame, 1)
            hand.robot.item_click(f"//$FOCUSED/{'/'.join(path)}")

        return play(use)

    assert use(24, "###Copy") == ["Pose at frame 24 copied."]
    use(0, "Paste")
    poses = poses_of(loose)
    assert poses[0].phi is poses[24].phi
    assert loose.timeline.playhead.frame == 0
    editing.undo(window.session)
    assert loose.document is before
    use(0, "Paste flipped")
    assert poses_of(loose)[0].phi is not poses[0].phi
    editing.undo(window.session)
    assert loose.document is before


@pytest.mark.parametrize("item", ["ground", "interval 0"])
def test_the_menu_of_a_place_between_keys_pastes_there(window, loose, play, item):
    insert_key_at(window.session, 0, 24)
    frame = 12 if item == "interval 0" else 36

    def paste(hand):
        hand.to_drawing()
        hand.press(COPY)
        hand.to_timeline(frame, item)
        hand.robot.mouse_click(1)
        hand.robot.item_click("//$FOCUSED/Paste")

    play(paste)
    poses = poses_of(loose)
    assert poses.keys() == {0, frame, 24}
    assert poses[frame].phi is poses[24].phi
    assert loose.timeline.playhead.frame == frame


def test_escape_deselects_after_it_has_ended_what_is_under_way(window, loose, play):
    editing.select_handles(window.session, frozenset({0, 1}))
    before = loose.document

    def drag(hand):
        place = window.point(complex(loose.layer_runtime.shown.handle_positions[1]))
        hand.robot.mouse_move_to_pos(place)
        hand.robot.mouse_down(0)
        hand.robot.mouse_move_to_pos(place + ImVec2(30, 30))
        hand.press(ESCAPE)
        assert loose.selection.handles == {0, 1}
        hand.robot.mouse_up(0)

    play(drag)
    assert loose.document is before
    assert loose.selection.handles == {0, 1}
    # A menu that is open is closed first.
    play(lambda hand: (hand.click_key(24, 1), hand.press(ESCAPE)))
    assert loose.selection.frames == {24}
    play(lambda hand: hand.press(ESCAPE))
    assert not loose.selection.keys
    editing.select_handles(window.session, frozenset({0, 1}))
    play(lambda hand: (hand.to_drawing(), hand.press(ESCAPE)))
    assert not loose.selection.handles
    assert loose.document is before
