"""What repeats in the window: made of chosen keys, edited in one place, ended by its handle."""

import pytest
from bars import bend_bar
from imgui_bundle import ImVec2
from messages import says

from app.document import (
    LINEAR,
    OPACITY,
    PRESETS,
    Channel,
    FrameRange,
    channel_commands,
    cycle_commands,
    key_commands,
    layer_commands,
    opacity_at,
    pose_channel,
    scene_commands,
    track_commands,
)
from app.document.channels.cycles import Cycle
from app.document.channels.tracks import Track, TrackKey
from app.document.commands.keys.cycle_commands import TWO_POSES_SHOWN
from app.editor.actions import editing, playback
from app.editor.actions.timing import cycles, keys
from app.editor.layering.layer_selection import select_layers
from app.editor.layering.pictures import make_still
from app.errors import LissomError

RIGHT = 1  # the id of the bar's right handle
MENU = "//$FOCUSED/###"


@pytest.fixture
def swinging(window):
    """The bar that swings to and fro: keys at 0 and 24, and at 48 as at 0, in 150 frames."""
    return window.again(swing)


@pytest.fixture
def cycling(window):
    return window.again(repeat_swings)


def swing(window):
    bent = window.again(bend_bar, None, "loose")
    editing.edit_document(
        window.session, channel_commands.copy_keys({pose_channel(bent.selection.active): {0}}, 48)
    )
    editing.edit_document(window.session, scene_commands.set_frames(FrameRange(0, 150)))
    editing.select_keys(window.session, frozenset({0, 24, 48}))
    window.settle()


def repeat_swings(window):
    swing(window)
    window.act(cycles.create_cycle)
    window.settle()


def frames_of(project):
    return [key.frame for key in project.layer.keys]


class Row:
    """The robot's pointer on the row of the bar."""

    def __init__(self, robot, bent=24):
        self.robot = robot
        robot.set_ref("###Timeline")
        self.begin = self.place("key 0")
        self.scale = (self.place(f"key {bent}").x - self.begin.x) / bent

    def place(self, name):
        return self.robot.item_info(f"**/{name}").rect_full.get_center()

    def drag(self, name, *frames):
        self.robot.mouse_move(f"**/{name}")
        self.robot.mouse_down(0)
        for frame in frames:
            self.robot.mouse_move_to_pos(ImVec2(self.begin.x + frame * self.scale, self.begin.y))
        self.robot.mouse_up(0)


def drag_end_of_bar(window, project, by):
    """Drag the right handle, where it is shown now."""
    start = complex(project.layer_runtime.shown.handle_positions[RIGHT])

    def drag(robot):
        robot.mouse_move_to_pos(window.point(start))
        robot.mouse_down(0)
        for share in (0.5, 1.0):
            robot.mouse_move_to_pos(window.point(start + share * by))
        robot.mouse_up(0)

    window.run(drag)
    window.settle()


def test_key_that_repeats_is_eased_in_its_repeats(window, cycling):
    editing.deselect_keys(window.session)
    playback.seek(window.session, 52)  # of the segment from frame 0 to 24
    window.act(keys.ease_selected_keys, PRESETS["in"])
    assert [key.easing for key in cycling.layer.keys] == [PRESETS["in"], LINEAR]


def test_the_menu_of_chosen_keys_lets_them_repeat(window, swinging):
    def repeat(robot):
        robot.set_ref("###Timeline")
        robot.item_click("**/key 24", 1)
        robot.item_click(f"{MENU}Repeat")

    first = swinging.document
    window.run(repeat)
    window.settle()
    assert swinging.layer.cycles == (Cycle(first=0, last=48),)
    assert frames_of(swinging) == [0, 24]
    editing.undo(window.session)
    assert swinging.document is first


def test_the_end_of_the_repeats_is_dragged(window, cycling):
    first = cycling.document
    # It snaps to where a key is shown.
    window.run(lambda robot: Row(robot).drag("repeats of 0", 120, 101))
    window.settle()
    assert cycling.layer.cycles == (Cycle(first=0, last=48, until=96),)
    editing.undo(window.session)
    assert cycling.document is first


def test_the_end_of_the_stretch_is_dragged_and_it_repeats_as_often(window, cycling):
    window.run(lambda robot: Row(robot).drag("repeats of 0", 120, 95))
    window.run(lambda robot: Row(robot).drag("stretch of 0", 44, 40))
    window.settle()
    assert cycling.layer.cycles == (Cycle(first=0, last=40, until=80),)
    # Its keys stay in it.
    window.run(lambda robot: Row(robot).drag("stretch of 0", 30, 10))
    window.settle()
    assert cycling.layer.cycles == (Cycle(first=0, last=25, until=50),)


def test_a_drag_in_a_repeat_poses_the_key_that_is_shown_there(window, cycling):
    before = cycling.layer.key(24).pose
    playback.seek(window.session, 72)
    window.settle()
    shown = complex(cycling.layer_runtime.shown.handle_positions[RIGHT])
    drag_end_of_bar(window, cycling, 10 - 40j)
    assert playback.current_frame(window.session, cycling) == 72
    assert frames_of(cycling) == [0, 24]
    after = cycling.layer.key(24).pose
    assert after is not before
    there = complex(cycling.layer_runtime.shown.handle_positions[RIGHT])
    assert abs(there - shown - (10 - 40j)) < 3
    playback.seek(window.session, 24)
    window.settle()
    assert cycling.layer_runtime.shown.pose is after
    editing.undo(window.session)
    assert cycling.layer.key(24).pose is before


def test_a_drag_between_keys_of_a_repeat_makes_one_where_it_repeats(window, cycling):
    playback.seek(window.session, 60)
    window.settle()
    goal = complex(cycling.layer_runtime.shown.handle_positions[RIGHT]) + 5 - 30j
    drag_end_of_bar(window, cycling, 5 - 30j)
    assert frames_of(cycling) == [0, 12, 24]
    assert abs(complex(cycling.layer_runtime.shown.handle_positions[RIGHT]) - goal) < 3
    window.act(editing.undo)
    window.settle()
    assert frames_of(cycling) == [0, 24]
    window.act(keys.insert_key_in_row)
    window.settle()
    assert frames_of(cycling) == [0, 12, 24]
    assert abs(complex(cycling.layer_runtime.shown.handle_positions[RIGHT]) - goal + 5 - 30j) < 3


def test_repeats_are_made_into_keys_or_stop(window, cycling):
    first = cycling.document
    playback.seek(window.session, 100)
    window.act(cycles.bake_cycle)
    assert frames_of(cycling) == [0, 24, 48, 72, 96, 120]
    assert cycling.layer.cycles == (Cycle(first=96, last=144),)
    window.act(editing.undo)
    assert cycling.document is first
    window.act(cycles.end_cycle)
    assert frames_of(cycling) == [0, 24, 48]
    assert not cycling.layer.cycles


def test_keys_wait_before_what_repeats(window, cycling):
    editing.select_keys(window.session, frozenset())
    window.run(lambda robot: Row(robot).drag("key 24", 40, 44, 70, 90))
    window.settle()
    assert frames_of(cycling) == [0, 44]
    assert not window.session.notices.toasts
    # All of its keys together take the cycle with them.
    editing.select_keys(window.session, frozenset({0, 44}))
    window.run(lambda robot: Row(robot, 44).drag("key 44", 50, 54))
    window.settle()
    assert frames_of(cycling) == [10, 54]
    assert cycling.layer.cycles == (Cycle(first=10, last=58),)


def test_chosen_layers_repeat_together_in_one_step(window, cycling):
    arm, body = cycling.selection.active, cycling.selection.active + 1
    editing.edit_document(window.session, layer_commands.duplicate_layer(arm))
    editing.edit_document(window.session, cycle_commands.delete_cycle(arm, 0))
    for layer in cycling.document.layers:
        editing.edit_document(
            window.session, channel_commands.move_keys({pose_channel(layer.id): {24}}, layer.id)
        )
    editing.edit_document(window.session, cycle_commands.delete_cycle(body, 0))
    window.settle()
    select_layers(window.session, arm, body)
    editing.select_channel_keys(window.session, {})
    before = cycling.document
    window.act(cycles.create_cycle)
    cycle = (Cycle(first=0, last=48),)
    assert [layer.cycles for layer in cycling.document.layers] == [cycle, cycle]
    editing.undo(window.session)
    assert cycling.document is before
    # What one of them refuses, none does.
    other = key_commands.insert_pose(body, 48, cycling.document.layer(body).key(25).pose, LINEAR)
    editing.edit_document(window.session, other)
    before = cycling.document
    with pytest.raises(LissomError, match="bar copy: " + says(TWO_POSES_SHOWN, first=0, last=48)):
        cycles.create_cycle(window.session)
    assert cycling.document is before


def test_a_still_picture_repeats_with_others_what_it_does_beside_its_pose(window, swinging):
    bar, copy = swinging.selection.active, swinging.selection.active + 1
    editing.edit_document(window.session, layer_commands.duplicate_layer(bar))
    window.settle()
    make_still(window.session, copy)
    window.settle()
    select_layers(window.session, bar, copy)
    editing.select_channel_keys(window.session, {})
    window.act(cycles.create_cycle)
    assert [each.cycles for each in swinging.document.layers] == [(Cycle(first=0, last=48),), ()]
    editing.undo(window.session)
    for frame, opacity in ((0, 1.0), (10, 0.2)):
        editing.edit_document(
            window.session, channel_commands.set_key(Channel(OPACITY, copy), frame, opacity)
        )
    window.act(cycles.create_cycle)
    cycle = (Cycle(first=0, last=48),)
    assert [each.cycles for each in swinging.document.layers] == [cycle, cycle]
    faded = opacity_at(swinging.document, swinging.document.layer(copy), 58)
    assert abs(faded - 0.2) < 1e-9


def test_a_drag_on_a_track_in_a_repeat_keys_it_where_it_repeats(window, cycling):
    own = tuple(TrackKey(frame=f, place=p) for f, p in ((0, 0j), (8, 12 + 6j), (16, 0j)))
    command = track_commands.put_track(cycling.selection.active, Track(handles=(RIGHT,), keys=own))
    editing.edit_document(window.session, command)
    cycling.selection.select_track(cycling.layer, RIGHT)
    playback.seek(window.session, 56)
    window.settle()
    shown = complex(cycling.layer_runtime.shown.handle_positions[RIGHT])
    drag_end_of_bar(window, cycling, 4 - 10j)
    track = cycling.layer.track_of(RIGHT)
    assert [key.frame for key in track.keys] == [0, 8, 16]
    assert track.keys[1].place != 12 + 6j
    assert abs(complex(cycling.layer_runtime.shown.handle_positions[RIGHT]) - shown - (4 - 10j)) < 3
    playback.seek(window.session, 60)
    window.settle()
    drag_end_of_bar(window, cycling, 2 - 5j)
    track = cycling.layer.track_of(RIGHT)
    assert [key.frame for key in track.keys] == [0, 8, 12, 16]
    assert frames_of(cycling) == [0, 24]
