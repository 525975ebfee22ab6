"""Lanes of the timeline: keys of every kind of channel, as a person changes them with the hand."""

import re
from dataclasses import replace

import numpy as np
import pytest
from documents import CENTRE, RADIUS, disc_document
from imgui_bundle import ImVec2
from messages import says
from projects import project_of

from app.document import (
    CAMERA,
    DEPTH,
    DRAW_ORDER,
    MARKER,
    OPACITY,
    PARENT,
    POSE,
    PRESETS,
    SWITCH,
    TRANSFORM,
    VISIBILITY,
    Attachment,
    Camera,
    Channel,
    DrawOrder,
    Keyframe,
    SwitchGroup,
    Transform,
    all_keys,
    channel_commands,
    cycle_commands,
    frames_in,
    handle_commands,
    keys_in,
    layer_commands,
    pose_channel,
    value_at,
)
from app.document.settings import FrameRange, Marker
from app.editor.actions import editing, playback
from app.editor.actions.editing import FIRST_KEY_STAYS
from app.editor.actions.timing import timeline_drag
from app.editor.layering.layer_selection import set_active_layer
from app.editor.poses.copying import copy_keys
from app.editor.poses.pasting import paste_copied
from app.ui.timeline import menus

EARLY, LATE, LAST = 6, 18, 24
FIRST, SECOND, AH, OH = range(4)  # ids of the layers
OWN = (
    Channel(TRANSFORM, FIRST),
    Channel(OPACITY, FIRST),
    Channel(DRAW_ORDER, FIRST),
    Channel(VISIBILITY, FIRST),
    Channel(DEPTH, FIRST, 0),
)
JOINTS, SHOTS, MOUTHS, MARKS = (
    Channel(PARENT, FIRST),
    Channel(CAMERA),
    Channel(SWITCH, part="mouths"),
    Channel(MARKER),
)
ALL = (*OWN, JOINTS, SHOTS, MOUTHS, MARKS)
VALUES = {
    TRANSFORM: (Transform(8 + 4j), Transform(-6 + 0j, 0.3)),
    OPACITY: (0.4, 1.0),
    DRAW_ORDER: (DrawOrder(SECOND), DrawOrder(None)),
    VISIBILITY: (False, True),
    DEPTH: (0.5, -0.5),
}
by_channel = pytest.mark.parametrize("channel", ALL, ids=lambda channel: channel.kind.name)


def document():
    """Four discs, of which the last two take turns; each channel has keys at two frames."""
    scene = handle_commands.add_handle(FIRST, CENTRE + RADIUS / 2)(disc_document())
    (layer,) = scene.layers
    pose = layer.keys[0].pose
    poses = tuple(Keyframe(frame=frame, pose=pose) for frame in (0, LAST))
    scene = scene.with_layer(replace(layer, name="first", keys=poses))
    for name, identity in (("second", SECOND), ("ah", AH), ("oh", OH)):
        scene = layer_commands.duplicate_layer(FIRST)(scene)
        scene = layer_commands.rename_layer(identity, name)(scene)
    channels = {
        channel.id: tuple(map(channel.kind.key, (EARLY, LATE), VALUES[channel.kind]))
        for channel in OWN
    }
    joints = (
        Attachment(frame=EARLY, parent=SECOND, parent_point=CENTRE),
        Attachment(frame=LATE, parent=None, keep_world_transform=True),
    )
    first = replace(scene.layer(FIRST), channels=channels, attachments=joints, anchor=CENTRE)
    turns = ((0, AH), (EARLY, OH), (LATE, AH))
    mouths = SwitchGroup(
        name="mouths",
        members=(AH, OH),
        keys=tuple(SWITCH.key(frame, layer) for frame, layer in turns),
    )
    return replace(
        scene.with_layer(first),
        frames=FrameRange(0, 60),
        camera=(CAMERA.key(EARLY, Camera(CENTRE)), CAMERA.key(LATE, Camera(CENTRE, 2.0, 0.5))),
        markers=(Marker(frame=EARLY, name="early"), Marker(frame=LATE, name="late")),
        switch_groups=(mouths,),
    )


def show(window):
    window.session.project = project_of(document(), np.full((200, 200, 4), 160, np.uint8), "discs")
    timeline_drag.toggle_lanes(window.session, FIRST)
    window.settle()


@pytest.fixture
def project(window):
    project = window.again(show)
    # Higher, the timeline shows all lanes at once.
    window.run(heighten_timeline)
    window.frames(2)
    yield project
    window.resize((1280, 800))


def heighten_timeline(robot):
    edge = ImVec2(640, robot.window_info("//###Timeline").window.pos.y - 1)
    robot.mouse_move_to_pos(edge)
    robot.mouse_down(0)
    robot.mouse_move_to_pos(ImVec2(edge.x, edge.y - 260))
    robot.mouse_up(0)


class Hand:
    """The robot's pointer on keys; its places are frames."""

    def __init__(self, robot):
        self.robot = robot
        robot.set_ref("###Timeline")
        begin, end = (self.place(pose_channel(FIRST), frame) for frame in (0, LAST))
        self._origin, self._step = begin.x, (end.x - begin.x) / LAST

    def name(self, channel, frame):
        """The name of the button of a key."""
        if channel == MARKS:
            return f"**/marker {frame}"
        if channel.kind is SWITCH:
            return f"**/choice {channel.part}/edge {frame}"
        if channel.kind is POSE:
            return f"**/row {channel.layer}/key {frame}"
        return f"**/lane {channel.kind.name} {channel.layer} {channel.part}/key {frame}"

    def place(self, channel, frame):
        return self.robot.item_info(self.name(channel, frame)).rect_full.get_center()

    def x(self, frame):
        return self._origin + frame * self._step

    def go_to(self, frame, y):
        self.robot.mouse_move_to_pos(ImVec2(self.x(frame), y))
        self.robot.yield_(2)

    def drag(self, channel, frame, to, key=None):
        if key is not None:
            self.robot.key_down(int(key))
        self.press_and_move(self.name(channel, frame), to - frame)
        self.robot.mouse_up(0)
        if key is not None:
            self.robot.key_up(int(key))

    def press_and_move(self, name, by):
        """Press a button, and move the pointer by some frames."""
        at = self.robot.item_info(name).rect_full.get_center()
        self.robot.mouse_move(name)
        self.robot.mouse_down(0)
        for each in (by - 1, by):
            self.robot.mouse_move_to_pos(ImVec2(at.x + each * self._step, at.y))
            self.robot.yield_(2)

    def box(self, frames, places):
        """Drag a box between two frames and two heights."""
        (begin, end), (top, bottom) = frames, places
        self.go_to(begin, top)
        self.robot.mouse_down(0)
        self.go_to(end - 1, bottom)
        self.go_to(end, bottom)
        self.robot.mouse_up(0)

    def click(self, channel, frame, button=0):
        self.robot.item_click(self.name(channel, frame), button)

    def press(self, *keys):
        chord = 0
        for key in keys:
            chord |= int(key)
        self.robot.key_press(chord)
        self.robot.yield_(2)


@pytest.fixture
def play(window, project):
    """Let the robot play with the timeline."""

    def play(what):
        window.run(lambda robot: what(Hand(robot)))
        window.settle()
        return project.document

    return play


def changed(before, after):
    """The channels whose keys differ."""
    return {each for each in all_keys(before) | all_keys(after) if differs(before, after, each)}


def differs(before, after, channel):
    return keys_in(before, channel) != keys_in(after, channel)


def start_of(channel):
    """The frames of keys before the first one that is moved here."""
    return {0} if channel.kind is SWITCH else set()


def value_of(document, channel, frame):
    """A key without its frame."""
    (key,) = (key for key in keys_in(document, channel) if key.frame == frame)
    return replace(key, frame=0)


@by_channel
def test_a_key_is_dragged(window, project, play, channel):
    before = project.document
    after = play(lambda hand: hand.drag(channel, EARLY, 10))
    assert frames_in(after, channel) == {*start_of(channel), 10, LATE}
    assert value_of(after, channel, 10) == value_of(before, channel, EARLY)
    assert changed(before, after) == {channel}
    assert project.selection.keys == {channel: {10}}
    assert project.history.undo_label == "Move keys"
    # A key stops before the next one.
    after = play(lambda hand: hand.drag(channel, 10, LATE))
    assert frames_in(after, channel) == {*start_of(channel), LATE - 1, LATE}
    for _ in range(2):
        window.act(editing.undo)
    assert project.document is before


@pytest.mark.parametrize(
    "channel", [OWN[0], SHOTS, MOUTHS, MARKS], ids=lambda channel: channel.kind.name
)
def test_escape_cancels_the_drag_of_a_key(window, project, play, channel):
    before = project.document

    def give_up(hand):
        hand.press_and_move(hand.name(channel, EARLY), 4)
        assert 10 in frames_in(project.document, channel)
        hand.press(window.Key.escape)
        hand.robot.mouse_up(0)

    assert play(give_up) is before
    assert project.history.undo_label is None


def test_drag_is_one_undo_step_when_its_lane_vanishes(window, project, play):
    window.act(editing.edit_document, channel_commands.delete_keys({JOINTS: {LATE}}))
    before = project.document

    def drag(hand):
        y = hand.place(JOINTS, EARLY).y
        hand.robot.mouse_move(hand.name(JOINTS, EARLY))
        hand.robot.mouse_down(0)
        # A single parent from the first frame on has no lane.
        for frame in (3, 0, 5, 8):
            hand.go_to(frame, y)
        hand.robot.mouse_up(0)

    assert frames_in(play(drag), JOINTS) == {8}
    window.act(editing.undo)
    assert project.document is before


@by_channel
def test_a_click_on_a_key_selects_it_and_shows_its_frame(window, project, play, channel):
    before = project.document
    play(lambda hand: hand.click(channel, LATE))
    assert project.selection.keys == {channel: {LATE}}
    assert project.channel == channel
    assert playback.current_frame(window.session, project) == LATE
    assert project.document is before


@by_channel
def test_ctrl_drag_copies_a_key(window, project, play, channel):
    before = project.document
    after = play(lambda hand: hand.drag(channel, LATE, 30, window.Key.mod_ctrl))
    assert frames_in(after, channel) == {*start_of(channel), EARLY, LATE, 30}
    assert value_of(after, channel, 30) == value_of(before, channel, LATE)
    assert project.selection.keys == {channel: {30}}
    window.act(editing.undo)
    assert project.document is before


@by_channel
def test_the_menu_of_a_key_deletes_it(window, project, play, channel):
    before = project.document

    def delete(hand):
        hand.click(channel, LATE, 1)
        hand.robot.item_click(f"//$FOCUSED/{'Delete' if channel == MARKS else '###Delete'}")

    after = play(delete)
    assert frames_in(after, channel) == {*start_of(channel), EARLY}
    assert changed(before, after) == {channel}
    window.act(editing.undo)
    assert project.document is before


@by_channel
def test_a_copied_key_is_pasted_at_the_playhead(window, project, play, channel):
    before = project.document

    def copy(hand):
        hand.click(channel, EARLY)
        hand.press(window.Key.mod_ctrl, window.Key.c)

    play(copy)
    playback.seek(window.session, 30)
    after = play(lambda hand: hand.press(window.Key.mod_ctrl, window.Key.v))
    assert frames_in(after, channel) == {*start_of(channel), EARLY, LATE, 30}
    assert value_of(after, channel, 30) == value_of(before, channel, EARLY)
    assert changed(before, after) == {channel}
    assert project.selection.keys == {channel: {30}}
    window.act(editing.undo)
    assert project.document is before


@pytest.mark.parametrize("channel", [OWN[1], OWN[3]], ids=lambda channel: channel.kind.name)
def test_copied_key_is_pasted_into_all_repeats(window, project, channel):
    window.act(editing.edit_document, cycle_commands.set_cycle(FIRST, 0, LAST))
    editing.select_channel_keys(window.session, {channel: frozenset({EARLY})})
    copy_keys(window.session)
    playback.seek(window.session, LAST + 12)
    window.act(paste_copied)
    assert frames_in(project.document, channel) == {EARLY, 12, LATE}
    assert project.selection.keys == {channel: {12}}


@pytest.mark.parametrize("kind", [TRANSFORM, OPACITY], ids=lambda kind: kind.name)
def test_a_copied_key_is_pasted_onto_another_layer(window, project, play, kind):
    before = project.document

    def copy(hand):
        hand.click(Channel(kind, FIRST), EARLY)
        hand.press(window.Key.mod_ctrl, window.Key.c)
        hand.robot.item_click(f"**/name {SECOND}")

    play(copy)
    playback.seek(window.session, 12)
    after = play(lambda hand: hand.press(window.Key.mod_ctrl, window.Key.v))
    assert after.layer(SECOND).keys_of(kind) == (kind.key(12, VALUES[kind][0]),)
    assert changed(before, after) == {Channel(kind, SECOND)}
    window.act(editing.undo)
    assert project.document is before


@by_channel
def test_f9_eases_a_key_of_an_interpolated_channel(window, project, play, channel):
    before = project.document

    def ease(hand):
        hand.click(channel, EARLY)
        hand.press(window.Key.f9)

    after = play(ease)
    if channel.kind.is_held:
        assert after is before
        return
    assert keys_in(after, channel)[0].easing == PRESETS["in-out"]
    assert changed(before, after) == {channel}
    window.act(editing.undo)
    assert project.document is before


@by_channel
def test_delete_without_selected_keys_deletes_the_selected_channel(window, project, play, channel):
    before = project.document
    play(lambda hand: hand.click(channel, EARLY))
    window.act(editing.deselect_keys)
    after = play(lambda hand: hand.press(window.Key.delete))
    assert not frames_in(after, channel)
    window.act(editing.undo)
    assert project.document is before


def test_a_box_over_lanes_of_several_kinds_selects_keys_that_move_together(window, project, play):
    before = project.document

    def box(hand):
        lowest = max(hand.place(each, LATE).y for each in (*OWN, JOINTS))
        hand.box((9, 20), (lowest + 3, hand.place(MARKS, LATE).y))

    play(box)
    assert project.selection.keys == {each: {LATE} for each in project.selection.keys}
    inside = set(project.selection.keys)
    assert {*OWN, JOINTS, SHOTS, MARKS} <= inside
    after = play(lambda hand: hand.drag(Channel(OPACITY, FIRST), LATE, 22))
    for channel in ALL:
        late = 22 if channel in inside else LATE
        assert frames_in(after, channel) == {*start_of(channel), EARLY, late}
    assert frames_in(after, pose_channel(FIRST)) == {0, LAST}
    assert changed(before, after) == inside
    window.act(editing.undo)
    assert project.document is before


def test_all_keys_are_deleted_but_the_first_pose_key_of_each_layer(window, project, play):
    before = project.document

    def delete(hand):
        hand.robot.mouse_move("**/ruler")
        hand.press(window.Key.mod_ctrl, window.Key.a)
        assert project.selection.keys == all_keys(before)
        hand.press(window.Key.delete)

    after = play(delete)
    assert all_keys(after) == {pose_channel(layer.id): {0} for layer in before.layers}
    (notice,) = (toast.text for toast in window.session.notices.toasts)
    names = ", ".join(repr(layer.name) for layer in before.layers)
    assert re.fullmatch(says(FIRST_KEY_STAYS, layers=names), notice)
    window.act(editing.undo)
    assert project.document is before


def test_a_folded_layer_shows_all_of_its_keys_by_marks(window, project, play):
    before = project.document
    play(lambda hand: hand.robot.item_click(f"**/fold {FIRST}"))
    mark = f"**/row {FIRST}/keys {EARLY}"
    play(lambda hand: hand.robot.item_click(mark))
    assert project.selection.keys == dict.fromkeys((*OWN, JOINTS), frozenset({EARLY}))
    assert playback.current_frame(window.session, project) == EARLY

    def drag(hand):
        assert not hand.robot.item_exists(hand.name(OWN[0], EARLY))
        hand.press_and_move(mark, 4)
        hand.robot.mouse_up(0)

    after = play(drag)
    assert changed(before, after) == {*OWN, JOINTS}
    assert project.selection.keys == {each: {10} for each in (*OWN, JOINTS)}
    window.act(editing.undo)
    assert project.document is before

    def delete(hand):
        hand.robot.item_click(mark, 1)
        hand.robot.item_click("//$FOCUSED/###Delete")

    after = play(delete)
    for each in (*OWN, JOINTS):
        assert frames_in(after, each) == {LATE}
    play(lambda hand: hand.robot.item_click(f"**/fold {FIRST}"))
    play(lambda hand: hand.place(OWN[0], LATE))


@pytest.mark.parametrize("channel", [*OWN, SHOTS], ids=lambda channel: channel.kind.name)
def test_a_double_click_in_a_lane_inserts_a_key_with_the_value_there(
    window, project, play, channel
):
    before = project.document

    def insert(hand):
        hand.go_to(12, hand.place(channel, EARLY).y)
        hand.robot.mouse_double_click(0)

    after = play(insert)
    assert frames_in(after, channel) == {EARLY, 12, LATE}
    assert changed(before, after) == {channel}
    assert playback.current_frame(window.session, project) == 12
    assert value_at(after, channel, 12) == value_at(before, channel, 12)


# The buttons of keys in the panels.


@pytest.fixture
def click_diamond(window, project):
    def click(channel):
        tab = "Handle" if channel.kind is DEPTH else "Layers"
        if channel.kind is DEPTH:
            window.act(editing.select_handles, frozenset({channel.part}))
        window.show_tab(tab)

        def press(robot):
            robot.set_ref(f"//{tab}")
            robot.item_click(f"**/key {channel.kind.name}")

        window.run(press)
        window.settle()
        return project.document

    return click


by_property = pytest.mark.parametrize("channel", OWN, ids=lambda channel: channel.kind.name)


@by_property
def test_a_diamond_sets_and_deletes_a_key(window, project, click_diamond, channel):
    before = project.document
    playback.seek(window.session, 12)
    after = click_diamond(channel)
    assert frames_in(after, channel) == {EARLY, 12, LATE}
    assert changed(before, after) == {channel}
    assert value_at(after, channel, 12) == value_at(before, channel, 12)
    after = click_diamond(channel)
    assert frames_in(after, channel) == {EARLY, LATE}
    for _ in range(2):
        window.act(editing.undo)
    assert project.document is before


@by_property
def test_a_diamond_begins_and_ends_a_channel(window, project, click_diamond, channel):
    other = replace(channel, layer=SECOND)
    set_active_layer(window.session, SECOND)
    playback.seek(window.session, 12)
    before = project.document
    value = value_at(before, other, 12)
    after = click_diamond(other)
    assert changed(before, after) == {other}
    assert keys_in(after, other) == (channel.kind.key(12, value),)
    assert not keys_in(click_diamond(other), other)


@by_property
def test_a_diamond_in_a_repeat_changes_the_key_that_repeats(
    window, project, click_diamond, channel
):
    project.history.do(cycle_commands.set_cycle(FIRST, 0, LAST))
    playback.seek(window.session, LAST + 12)
    after = click_diamond(channel)
    assert frames_in(after, channel) == {EARLY, 12, LATE}
    playback.seek(window.session, LAST + EARLY)
    after = click_diamond(channel)
    assert frames_in(after, channel) == {12, LATE}


def test_a_value_entered_in_a_repeat_changes_the_key_that_repeats(window, project):
    project.history.do(cycle_commands.set_cycle(FIRST, 0, LAST))
    playback.seek(window.session, LAST + EARLY)
    window.show_tab("Layers")
    window.run(lambda robot: robot.item_input_value("//Layers/**/##opacity", 70.0))
    window.settle()
    first, last = project.document.layer(FIRST).keys_of(OPACITY)
    assert (first.frame, first.value) == (EARLY, pytest.approx(0.7))
    assert last == OPACITY.key(LATE, VALUES[OPACITY][1])


def select_all_keys(hand, window):
    hand.robot.mouse_move("**/ruler")
    hand.press(window.Key.mod_ctrl, window.Key.a)


def test_all_keys_move_together(window, project, play):
    before = project.document

    def drag(hand):
        select_all_keys(hand, window)
        hand.press_and_move(hand.name(MARKS, EARLY), 3)
        hand.robot.mouse_up(0)

    after = play(drag)
    assert all_keys(after) == {
        channel: {frame + 3 for frame in frames} for channel, frames in all_keys(before).items()
    }
    assert project.selection.keys == all_keys(after)
    window.act(editing.undo)
    assert project.document is before


def test_all_keys_are_pasted_in_one_step(window, project, play):
    before = project.document

    def copy(hand):
        select_all_keys(hand, window)
        hand.press(window.Key.mod_ctrl, window.Key.c)

    play(copy)
    playback.seek(window.session, 30)
    after = play(lambda hand: hand.press(window.Key.mod_ctrl, window.Key.v))
    assert all_keys(after) == {
        channel: frames | {frame + 30 for frame in frames}
        for channel, frames in all_keys(before).items()
    }
    window.act(editing.undo)
    assert project.document is before


def test_the_menu_of_a_key_has_a_field_for_its_number(window, project, play):
    def enter(hand):
        hand.click(Channel(OPACITY, FIRST), EARLY, 1)
        hand.robot.item_input_value("//$FOCUSED/##opacity opacity", 70.0)
        hand.press(window.Key.escape)

    first, _ = play(enter).layer(FIRST).keys_of(OPACITY)
    assert first.value == pytest.approx(0.7)
    assert playback.current_frame(window.session, project) == 0


@pytest.mark.parametrize("item", ["###Reverse", "###Scale time/Half as long"])
def test_selected_keys_of_all_kinds_are_reversed_and_scaled(window, project, play, item):
    before = project.document
    chosen = dict.fromkeys((*OWN, JOINTS, SHOTS, MARKS), frozenset({EARLY, LATE}))
    window.act(editing.select_channel_keys, chosen)

    def choose(hand):
        hand.click(OWN[0], LATE, 1)
        hand.robot.set_ref("//$FOCUSED")
        hand.robot.menu_click(item)

    after = play(choose)
    if item == "###Reverse":
        for channel in (OWN[0], OWN[1], SHOTS):
            assert value_at(after, channel, EARLY) == value_at(before, channel, LATE)
        assert all_keys(after) == all_keys(before)
    else:
        assert project.selection.keys == dict.fromkeys(chosen, frozenset({EARLY, 12}))
    window.act(editing.undo)
    assert project.document is before


def test_a_mark_at_the_frame_of_a_pose_key_has_a_menu_of_its_own(
    window, project, play, monkeypatch
):
    drawn, draw = [], menus.draw_value_fields

    def count(*given):
        drawn.append(given[1])
        return draw(*given)

    monkeypatch.setattr(menus, "draw_value_fields", count)
    project.history.do(channel_commands.move_keys({OWN[1]: frozenset({LATE})}, LAST - LATE))
    play(lambda hand: hand.robot.item_click(f"**/fold {FIRST}"))
    play(lambda hand: hand.robot.item_click(f"**/row {FIRST}/key {LAST}", 1))
    window.frames(1)
    assert not drawn
    play(lambda hand: hand.press(window.Key.escape))
    play(lambda hand: hand.robot.item_click(f"**/row {FIRST}/keys {LAST}", 1))
    assert set(drawn) == {OWN[1]}
