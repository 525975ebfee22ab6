from dataclasses import replace

import numpy as np
import pytest
from documents import CENTRE, RADIUS, altered, disc_document
from hypothesis import given, strategies as st
from imgui_bundle import ImVec2, imgui
from projects import project_of

from app.document import (
    CAMERA,
    Camera,
    Channel,
    camera_at,
    channel_commands,
    export_frame_range,
    key_commands,
    pose_channel,
    shape_commands,
)
from app.document.channels.easing import HOLD, LINEAR, PRESETS
from app.document.channels.tangent_mode import TangentMode
from app.document.keyframe import Handle, Keyframe, Target
from app.document.settings import FrameRange
from app.editor.actions import editing, playback, viewing
from app.editor.actions.layer_setup import resolving
from app.editor.actions.timing import keys, timeline_drag
from app.editor.actions.timing.channel_keys import (
    key_camera,
    toggle_camera_view,
)
from app.editor.parts.timeline.time_range import TimeRangeView
from app.editor.parts.viewport_state import fit_view_around
from app.motion import BoundingBox
from app.ui.bars.status import describe_motion_limit
from app.ui.style.theme import PALETTES
from app.ui.timeline.rows import segments
from app.ui.viewport.marks import mark_all
from engine.maps import Bounds

FRAMES = (0, 12, 24, 48)
CAMERA_LANE = "lane camera None None"


def waving_document():
    """A disc that turns to and fro: four keys, two handles, of which one lags at frame 24."""
    (empty,) = disc_document().layers
    rest = empty.keys[0].pose
    handles = (
        Handle(id=0, name="left", position=CENTRE - RADIUS / 2),
        Handle(id=1, name="right", position=CENTRE + RADIUS / 2),
    )
    keys = []
    for frame, angle in zip(FRAMES, (0.0, 0.3, -0.3, 0.1), strict=True):
        turn = np.exp(1j * angle)
        targets = {h.id: Target(position=CENTRE + (h.position - CENTRE) * turn) for h in handles}
        if frame == 24:
            targets[1] = Target(position=CENTRE + RADIUS)
        phi = CENTRE + (empty.domain.cage - CENTRE) * turn
        keys.append(Keyframe(frame=frame, pose=replace(rest, targets=targets, phi=phi)))
    return altered(
        disc_document(), handles=handles, next_handle=2, keys=tuple(keys), frames=FrameRange(0, 60)
    )


@pytest.fixture
def project(window):
    return window.again(show_disc)


def show_disc(window):
    document = waving_document()
    pixels = np.full((200, 200, 4), 160, np.uint8)
    window.session.project = project_of(document, pixels, "disc")
    window.settle()


class Hand:
    """The robot's pointer, whose places are frames."""

    def __init__(self, robot, keys):
        self.robot = robot
        robot.set_ref("###Timeline")
        first, last = keys[0].frame, keys[-1].frame
        begin, end = self.place(f"key {first}"), self.place(f"key {last}")
        self._step, self._y = (end.x - begin.x) / (last - first), begin.y
        self._origin = begin.x - first * self._step

    def place(self, name):
        return self.robot.item_info(f"**/{name}").rect_full.get_center()

    def x(self, frame):
        return self._origin + frame * self._step

    def click(self, name, button=0):
        self.robot.item_click(f"**/{name}", button)

    def go_to(self, frame, y=None):
        self.robot.mouse_move_to_pos(ImVec2(self.x(frame), self._y if y is None else y))

    def press(self, name):
        self.robot.mouse_move(f"**/{name}")
        self.robot.mouse_down(0)

    def drag(self, name, *frames):
        """Take something, go to the frames in turn, and let go."""
        y = self.place(name).y
        self.press(name)
        for frame in frames:
            self.go_to(frame, y)
        self.robot.mouse_up(0)


@pytest.fixture
def play(window, project):
    """Let the robot play with the timeline."""

    def play(what):
        window.run(lambda robot: what(Hand(robot, project.layer.keys)))
        window.settle()
        return project.document

    return play


def frames_of(document):
    return tuple(key.frame for key in document.layers[0].keys)


def undo_all(window):
    steps = 0
    while window.session.project.history.undo_label is not None:
        editing.undo(window.session)
        steps += 1
    return steps


def test_click_chooses_a_key_and_goes_there(window, project, play):
    play(lambda hand: hand.click("key 24"))
    assert project.selection.frames == {24}
    assert playback.current_frame(window.session, project) == 24

    def add(hand):
        hand.robot.key_down(int(window.Key.mod_shift))
        hand.click("key 48")
        hand.click("key 24")
        hand.click("key 0")
        hand.robot.key_up(int(window.Key.mod_shift))

    play(add)
    assert project.selection.frames == {0, 48}
    assert project.history.undo_label is None


def test_drag_moves_keys_by_whole_frames_in_one_step(window, project, play):
    first = project.document
    moved = play(lambda hand: hand.drag("key 24", 26.4, 29.7))
    assert frames_of(moved) == (0, 12, 30, 48)
    assert project.selection.frames == {30}
    assert moved.layers[0].keys[2].pose is first.layers[0].keys[2].pose
    editing.undo(window.session)
    assert project.document is first


def test_keys_are_seen_moving_while_they_are_dragged(project, play):
    seen = []

    def look(hand):
        hand.press("key 24")
        for frame in (30, 36):
            hand.go_to(frame)
            hand.robot.yield_(2)
            seen.append(frames_of(project.document))
            assert hand.place("key 24").x == pytest.approx(hand.x(frame), abs=1.0)
        hand.robot.mouse_up(0)

    play(look)
    assert seen == [(0, 12, 30, 48), (0, 12, 36, 48)]


def test_drag_back_leaves_nothing_to_undo(project, play):
    first = project.document
    assert play(lambda hand: hand.drag("key 24", 30, 24)) is first
    assert project.history.undo_label is None
    assert project.history.is_saved


def test_escape_takes_a_drag_back(window, project, play):
    first = project.document

    def escape(hand):
        hand.press("key 24")
        hand.go_to(30)
        hand.robot.key_press(int(window.Key.escape))
        hand.go_to(40)
        hand.robot.mouse_up(0)

    assert play(escape) is first
    assert project.selection.frames == {24}


def test_keys_stop_before_others_and_at_frame_0(play):
    assert frames_of(play(lambda hand: hand.drag("key 24", 20, 12))) == (0, 12, 13, 48)
    assert frames_of(play(lambda hand: hand.drag("key 13", -8))) == (0, 1, 12, 48)
    assert frames_of(play(lambda hand: hand.drag("key 12", 24, 50, 63))) == (0, 1, 48, 63)


def test_drag_past_the_end_makes_the_animation_longer(window, project, play):
    first = project.document
    longer = play(lambda hand: hand.drag("key 48", 61))
    assert frames_of(longer) == (0, 12, 24, 61)
    assert longer.frames == FrameRange(0, 61)
    assert undo_all(window) == 1
    assert project.document is first


def test_several_keys_move_together(window, project, play):
    def box(hand):
        hand.go_to(8, hand.place("ground").y + 15)
        hand.robot.mouse_down(0)
        hand.go_to(16)
        hand.go_to(30)
        hand.robot.mouse_up(0)

    play(box)
    assert project.selection.frames == {12, 24}
    assert frames_of(play(lambda hand: hand.drag("key 12", 17))) == (0, 17, 29, 48)
    assert project.selection.frames == {17, 29}

    def click_beside(hand):
        hand.go_to(55)
        hand.robot.mouse_click(0)

    play(click_beside)
    assert project.selection.frames == frozenset()
    assert undo_all(window) == 1


def test_ctrl_drag_copies_and_del_deletes(window, project, play):
    first = project.document

    def copy(hand):
        hand.robot.key_down(int(window.Key.mod_ctrl))
        hand.drag("key 12", 20, 36)
        hand.robot.key_up(int(window.Key.mod_ctrl))

    copied = play(copy)
    assert frames_of(copied) == (0, 12, 24, 36, 48)
    assert copied.layers[0].keys[3].pose is first.layers[0].keys[1].pose
    assert project.selection.frames == {36}
    deleted = play(lambda hand: hand.robot.key_press(int(window.Key.delete)))
    assert frames_of(deleted) == FRAMES
    assert undo_all(window) == 2
    assert project.document is first


def test_menu_of_a_key_begins_with_delete(window, play):
    def delete(hand):
        hand.click("key 24", 1)
        hand.robot.item_click("//$FOCUSED/###Delete")

    assert frames_of(play(delete)) == (0, 12, 48)
    assert undo_all(window) == 1


def test_double_click_inserts_a_key(window, project, play):
    def insert(hand):
        hand.go_to(55)
        hand.robot.mouse_double_click(0)

    first = project.document
    assert frames_of(play(insert)) == (*FRAMES, 55)
    assert undo_all(window) == 1
    playback.seek(window.session, 6)
    inserted = play(lambda hand: hand.robot.key_press(int(window.Key.i)))
    assert frames_of(inserted) == (0, 6, 12, 24, 48)
    assert undo_all(window) == 1
    assert project.document is first


def test_easing_is_chosen_and_drawn_by_hand(window, project, play):
    first = project.document
    seen = []

    def choose(hand):
        hand.click("interval 12")
        hand.robot.item_click("//$FOCUSED/in-out")
        seen.append([key.easing for key in project.layer.keys])
        hand.robot.item_drag_with_delta("//$FOCUSED/control 1", ImVec2(30, -400))

    curve = play(choose).layers[0].keys[1].easing.curve
    assert seen == [[LINEAR, PRESETS["in-out"], LINEAR, LINEAR]]
    assert curve[0] == pytest.approx(0.42 + 30 / 150, abs=0.05)
    assert curve[1:] == (1.0, *PRESETS["in-out"].curve[2:])
    assert undo_all(window) == 2
    assert project.document is first


def test_easing_of_all_chosen_keys_is_changed_together(window, play):
    editing.select_keys(window.session, frozenset({0, 24}))

    def choose(hand):
        hand.click("interval 24")
        hand.robot.item_click("//$FOCUSED/hold")

    easings = [key.easing for key in play(choose).layers[0].keys]
    assert easings == [HOLD, LINEAR, HOLD, LINEAR]
    assert undo_all(window) == 1


def test_how_keys_are_passed_is_chosen_in_their_menu_and_by_a_key(window, project, play):
    editing.select_keys(window.session, frozenset({12, 24}))

    def choose(hand):
        hand.click("key 12", 1)
        hand.robot.item_click("//$FOCUSED/Tangent")
        hand.robot.item_click("//**/###stop")

    passings = [key.shown_tangent_mode for key in play(choose).layers[0].keys]
    assert passings == ["through", "stop", "stop", "through"]
    for expected in ("hold", "through", "corner"):
        window.run(lambda robot: robot.key_press(int(window.Key.t)))
        window.settle()
        passings = [key.shown_tangent_mode for key in project.layer.keys]
        assert passings == ["through", expected, expected, "through"]
    assert undo_all(window) == 4


def test_the_paths_of_selected_handles_are_shown_and_follow_the_keys(window, project):
    # The motion from key to key: one handle that stays would hide it.
    project.history.do(shape_commands.set_auto_pins(0, enabled=False))
    window.run(lambda robot: robot.key_press(int(window.Key.j)))
    window.settle()
    assert project.measured.paths.value is None  # nothing is selected
    project.selection.handles = frozenset({1})
    window.settle()
    paths = project.measured.paths.value
    assert project.measured.paths.follows(project.clip)
    assert paths.positions.shape == (61, 2)
    places = CENTRE + RADIUS / 2 * np.exp(1j * np.array([0.0, 0.3, -0.3, 0.1]))
    np.testing.assert_allclose(paths.positions[list(FRAMES), 1], places, atol=1e-6)
    shown = project.layer_runtime.shown
    with_path, _ = mark_all(window.session, project, shown, PALETTES["dark"])
    project.selection.handles = frozenset()
    without, _ = mark_all(window.session, project, shown, PALETTES["dark"])
    assert len(with_path) > len(without)
    # In a corner at frame 12 the path is another one.
    editing.edit_document(
        window.session,
        channel_commands.set_tangent_mode({pose_channel(0): frozenset({12})}, TangentMode.CORNER),
    )
    project.selection.handles = frozenset({1})
    window.settle()
    assert np.abs(project.measured.paths.value.positions - paths.positions)[6:20].max() > 0.1
    window.session.display.overlays = replace(window.session.display.overlays, paths=False)


@pytest.mark.usefixtures("everything")
def test_keys_that_the_limits_slow_down_come_with_a_remedy(window, project):
    assert describe_motion_limit(window.session) == ""
    tight = Bounds(k=0.01, sigma_a=1.001, sigma_b=0.999)
    command = shape_commands.set_limits(0, tight)
    project.history.do(shape_commands.set_variant(0, "nu"))
    squeezed = project.layer.key(12).pose
    squeezed = replace(squeezed, psi=0.3 * (project.layer.domain.cage - CENTRE).conj())
    project.history.do(key_commands.replace_key_pose(0, 12, squeezed))
    project.history.do(command)
    window.settle()
    assert describe_motion_limit(window.session) == ("At its limit · the motion stops at frame 12")
    resolving.relax_motion_limits(window.session)
    window.settle()
    assert project.layer.bounds != tight
    assert project.layer.key(12).pose is squeezed


def test_playhead_is_dragged_and_stops_at_the_ends(window, project, play):
    play(lambda hand: hand.drag("playhead", 7.2))
    assert playback.current_frame(window.session, project) == 7
    play(lambda hand: hand.drag("playhead", 63))
    assert playback.current_frame(window.session, project) == 60
    play(lambda hand: hand.drag("playhead", -3))
    assert playback.current_frame(window.session, project) == 0

    def press(hand):
        hand.go_to(33, hand.place("ruler").y)
        hand.robot.mouse_down(0)
        hand.robot.mouse_up(0)

    play(press)
    assert playback.current_frame(window.session, project) == 33
    assert project.history.undo_label is None


def test_preview_range_and_end_are_dragged(window, project, play):
    first = project.document
    assert play(lambda hand: hand.drag("preview start", 5, 10)).preview == FrameRange(10, 60)
    assert play(lambda hand: hand.drag("preview end", 5, 40)).preview == FrameRange(10, 40)
    assert play(lambda hand: hand.drag("preview range", 90)).preview == FrameRange(30, 60)
    assert play(lambda hand: hand.drag("animation end", 40, 54)).frames == FrameRange(0, 54)
    assert project.document.preview == FrameRange(30, 54)
    assert play(lambda hand: hand.drag("animation end", 10)).frames == FrameRange(0, 48)
    play(lambda hand: hand.robot.item_double_click("**/preview start"))
    assert project.document.preview is None
    assert undo_all(window) == 6
    assert project.document is first


def test_dragged_end_stops_at_the_last_camera_key(window, play):
    shot = CAMERA.key(52, Camera(CENTRE))
    window.act(editing.edit_document, channel_commands.insert_keys({Channel(CAMERA): [shot]}))
    assert play(lambda hand: hand.drag("animation end", 10)).frames == FrameRange(0, 52)


def test_menu_reverses_and_scales(window, project, play):
    first = project.document
    poses = [key.pose for key in first.layers[0].keys]

    def choose(path):
        def through(hand):
            hand.click("###more")
            hand.robot.set_ref("//$FOCUSED")
            hand.robot.menu_click(path)

        return play(through)

    backwards = choose("###Reverse")
    assert frames_of(backwards) == (0, 24, 36, 48)
    assert [key.pose for key in backwards.layers[0].keys] == poses[::-1]
    assert choose("Copy first pose to last key").layers[0].keys[-1].pose is poses[-1]
    assert frames_of(choose("###Scale time/Half as long")) == (0, 12, 18, 24)
    editing.select_keys(window.session, frozenset({18, 24}))
    assert frames_of(choose("###Scale time/Twice as long")) == (0, 12, 18, 30)
    assert project.selection.frames == {18, 30}
    undo_all(window)
    assert project.document is first


def test_a_drag_goes_to_where_the_button_is_let_go(window, project, play):
    places = {}
    play(lambda hand: places.update(key=hand.place("key 24"), x=hand.x(30)))
    io = imgui.get_io()
    io.add_mouse_pos_event(*places["key"])
    window.frames(3)
    io.add_mouse_button_event(0, down=True)
    window.frames(2)
    # All of the way, and the end of it, before the next frame.
    io.add_mouse_pos_event(places["x"], places["key"].y)
    io.add_mouse_button_event(0, down=False)
    window.frames(4)
    assert frames_of(project.document) == (0, 12, 30, 48)
    assert project.history.undo_label == "Move keys"


def test_a_strip_that_is_scrolled_by_a_drag_stays_so(window, project, play):
    timeline_drag.set_time_range(window.session, TimeRangeView(0.0, 1.5))
    window.frames(2)

    def drag_beyond_the_edge(hand):
        hand.press("key 0")
        edge = hand.robot.item_info("**/key 0").rect_full.get_center()
        hand.robot.mouse_move_to_pos(ImVec2(1275, edge.y))
        for _ in range(10):
            hand.robot.yield_()
        assert project.timeline.gesture_time_range.start > 0
        hand.robot.mouse_up(0)

    play(drag_beyond_the_edge)
    assert project.timeline.time_range.start > 0


def test_wheel_zooms_at_the_pointer_and_scrolls(window, project, play):
    def zoom(hand):
        hand.go_to(24)
        hand.robot.key_down(int(window.Key.mod_ctrl))
        for _ in range(6):
            hand.robot.mouse_wheel_y(1.0)
        hand.robot.key_up(int(window.Key.mod_ctrl))
        assert hand.place("key 24").x == pytest.approx(hand.x(24), abs=3.0)

    play(zoom)
    zoomed = project.timeline.time_range
    assert zoomed is not None
    window.run(lambda robot: robot.mouse_wheel_y(-1.0))
    assert project.timeline.time_range.start > zoomed.start
    assert project.timeline.time_range.scale == zoomed.scale
    timeline_drag.fit_timeline(window.session)
    assert project.timeline.time_range is None


def test_timeline_follows_the_playhead_while_playing(window, project):
    timeline_drag.set_time_range(window.session, TimeRangeView(0.0, 4.0))
    window.frames(2)
    assert project.timeline.time_range.start == 0.0
    playback.toggle_play(window.session)
    playback.set_playback_speed(window.session, 2.0)
    window.frames(45)
    frame = playback.current_frame(window.session, project)
    assert frame > 30
    assert project.timeline.time_range.start > 10
    playback.stop_playback(window.session)


def test_speed_is_changed_while_playing(window, project):
    playback.toggle_play(window.session)
    window.frames(30)
    before = playback.current_frame(window.session, project)
    keys.set_fps(window.session, 60.0)
    assert playback.current_frame(window.session, project) == before
    playback.stop_playback(window.session)


@given(
    st.sets(st.integers(0, 30), min_size=1, max_size=8),
    st.integers(0, 255),
    st.integers(-40, 40),
    st.booleans(),
)
def test_keys_go_to_the_nearest_place_that_is_free(frames, subset, wanted, copies):
    document = disc_document()
    poses = [replace(document.layers[0].keys[0], frame=frame) for frame in sorted(frames)]
    document = altered(document, keys=tuple(poses), frames=FrameRange(0, 100))
    dragged = frozenset(f for i, f in enumerate(sorted(frames)) if subset >> i & 1) or frozenset(
        {min(frames)}
    )

    def is_possible(by):
        there = {frame + by for frame in dragged}
        return by == 0 or (min(there) >= 0 and not there & (frames if copies else frames - dragged))

    by = timeline_drag.drag_offset(
        document, {pose_channel(document.layers[0].id): dragged}, wanted, copies=copies
    )
    assert is_possible(by)
    nearest = max(wanted, -min(dragged))
    assert not any(is_possible(o) for o in range(-40, 120) if abs(o - nearest) < abs(by - nearest))


def test_keys_that_fall_short_are_known(project):
    lags = [project.timeline.target_errors.value[key.pose] for key in project.layer.keys]
    assert [set(lag) for lag in lags] == [set(), set(), {1}, set()]


def test_last_frame_and_speed_are_typed(window, project, play):
    def type_last(hand):
        hand.robot.item_click("more")
        hand.robot.item_input_value("//$FOCUSED/###last", 90)
        hand.robot.popup_close_all()

    play(type_last)
    assert project.document.frames == FrameRange(0, 90)
    play(lambda hand: hand.robot.item_input_value("##fps", 12))
    assert project.document.fps == 12
    assert undo_all(window) == 2


@pytest.mark.parametrize("field", ["frame", "fps"])
def test_one_click_on_a_number_takes_what_is_typed(window, project, field):
    """The keys 1, b and n would zoom and set the preview range."""
    before, camera = project.document, project.viewport.view

    def type_into(robot):
        robot.set_ref("Timeline")
        robot.mouse_move_to_pos(robot.item_info(f"**/##{field}").rect_full.get_center())
        robot.mouse_click(0)
        robot.yield_(2)
        assert imgui.get_io().want_text_input
        robot.key_chars_replace_enter("12")

    window.run(type_into)
    window.settle()
    assert project.viewport.view is camera
    assert project.document.preview == before.preview
    values = {
        "frame": playback.current_frame(window.session, project),
        "fps": project.document.fps,
    }
    assert values[field] == 12


def marks_of(project):
    return [(marker.frame, marker.name) for marker in project.document.markers]


def test_markers_are_made_named_dragged_and_deleted(window, project, play):
    first = project.document
    playback.scrub(window.session, 20)
    play(lambda hand: hand.robot.key_press(int(window.Key.m)))
    assert marks_of(project) == [(20, "Marker 1")]
    # Another one on the same frame is explained.
    play(lambda hand: hand.robot.key_press(int(window.Key.m)))
    assert "already has a marker" in window.session.notices.toasts[-1].text
    window.session.notices.toasts = []

    def name(hand):
        hand.robot.item_double_click("**/marker 20")
        hand.robot.key_chars_replace_enter("beat")

    play(name)
    assert marks_of(project) == [(20, "beat")]

    def drag(hand, frame, *frames):
        # A marker is taken by its name, too, which is right of its frame.
        beside = (hand.place(f"marker {frame}").x - hand.x(frame)) / (hand.x(1) - hand.x(0))
        hand.drag(f"marker {frame}", *(beside + to for to in frames))

    play(lambda hand: drag(hand, 20, 50, 33))
    assert marks_of(project) == [(33, "beat")]

    def drag_and_cancel(hand):
        hand.press("marker 33")
        hand.go_to(50, hand.place("marker 33").y)
        hand.robot.key_press(int(window.Key.escape))
        hand.robot.mouse_up(0)

    play(drag_and_cancel)
    assert marks_of(project) == [(33, "beat")]

    def add_beside(hand):
        hand.go_to(55)
        hand.robot.mouse_click(1)
        hand.robot.item_click("//$FOCUSED/###Add marker")

    play(add_beside)
    assert marks_of(project) == [(33, "beat"), (55, "Marker 2")]
    # One marker is never dropped on another.
    play(lambda hand: drag(hand, 55, 34, 33))
    assert marks_of(project) == [(33, "beat"), (34, "Marker 2")]

    def delete(hand):
        hand.click("marker 33", 1)
        hand.robot.item_click("//$FOCUSED/Delete")

    play(delete)
    assert marks_of(project) == [(34, "Marker 2")]
    assert undo_all(window) == 6
    assert project.document is first


def test_markers_are_jumped_to(window, project, play):
    for frame in (9, 40):
        keys.add_marker(window.session, frame)
    window.frames(2)

    def here():
        return playback.current_frame(window.session, project)

    seen = []

    def jump(hand):
        for chord in 3 * (int(window.Key.mod_shift | window.Key.page_down),):
            hand.robot.key_press(chord)
            seen.append(here())
        hand.robot.key_press(int(window.Key.mod_shift | window.Key.page_up))
        seen.append(here())

    play(jump)
    assert seen == [9, 40, 40, 9]
    play(lambda hand: hand.click("marker 40"))
    assert here() == 40


def test_the_preview_range_is_cleared_in_one_click_and_never_exported(window, project, play):
    keys.start_preview_at_playhead(window.session)
    playback.scrub(window.session, 40)
    keys.end_preview_at_playhead(window.session)
    window.frames(2)
    assert project.document.preview == project.document.played_frames == FrameRange(0, 40)
    assert export_frame_range(project.document) == FrameRange(0, 60)
    play(lambda hand: hand.click("clear preview"))
    assert project.document.preview is None
    editing.undo(window.session)
    window.frames(2)
    play(lambda hand: hand.robot.key_press(int(window.Key.mod_alt | window.Key.p)))
    assert project.document.preview is None


def test_chosen_keys_are_eased_at_once(window, project, play):
    def easings():
        return [key.easing.name for key in project.layer.keys]

    editing.select_keys(window.session, frozenset({0, 12, 24}))
    play(lambda hand: hand.robot.key_press(int(window.Key.f9)))
    assert easings() == ["in-out", "in-out", "in-out", "linear"]
    assert undo_all(window) == 1

    def by_popup(hand):
        hand.click("interval 12")
        hand.robot.item_click("//$FOCUSED/hold")
        hand.robot.key_press(int(window.Key.escape))

    editing.select_keys(window.session, frozenset({0, 12}))
    play(by_popup)
    assert easings() == ["hold", "hold", "linear", "linear"]
    # Without a choice it is the way at the playhead.
    editing.select_keys(window.session, frozenset())
    playback.scrub(window.session, 30)
    play(lambda hand: hand.robot.key_press(int(window.Key.mod_shift | window.Key.f9)))
    assert easings() == ["hold", "hold", "in", "linear"]


def test_new_keys_get_the_easing_that_was_chosen_for_them(window, project, play):
    def choose(hand):
        hand.click("interval 24")
        hand.robot.item_click("//$FOCUSED/Use for new keys")
        hand.robot.key_press(int(window.Key.escape))

    keys.set_easing(window.session, {pose_channel(0): frozenset({24})}, PRESETS["out"])
    window.frames(2)
    play(choose)
    keys.insert_key_in_row_at(window.session, 60)
    window.settle()
    assert [key.easing.name for key in project.layer.keys][2:] == ["out", "out", "out"]
    # A key that divides a way keeps how time runs there.
    keys.insert_key_in_row_at(window.session, 6)
    window.settle()
    assert project.layer.key(6).easing == LINEAR


def test_undo_and_redo_name_their_step_and_show_where_it_was(window, project):
    session = window.session

    def here():
        return playback.current_frame(session, project)

    keys.set_easing(session, {pose_channel(0): frozenset({24})}, HOLD)
    editing.edit_document(session, channel_commands.move_keys({pose_channel(0): {12}}, -2))
    keys.set_fps(session, 12.0)
    playback.scrub(session, 60)
    for text, frame in (
        ("Undone: Set frames per second", 60),
        # From 10 back to 12, which is nearer.
        ("Undone: Move keys", 12),
        ("Undone: Set easing", 24),
    ):
        editing.undo(session)
        assert [toast.text for toast in session.notices.toasts] == [text]
        assert here() == frame
    playback.scrub(session, 30)
    editing.redo(session)
    # The way from 24 to 48 has changed, and the playhead is on it.
    assert here() == 30
    assert [toast.text for toast in session.notices.toasts] == ["Redone: Set easing"]
    editing.redo(session)
    assert here() == 12
    window.frames(2)


def labels(window, monkeypatch):
    """What the bars between keys say."""
    names = []

    def label(_, name, *__):
        names.append(name)

    with monkeypatch.context() as patched:
        patched.setattr(segments, "_label", label)
        window.frames(1)
    return names


@pytest.mark.usefixtures("project")
def test_only_what_goes_straight_is_called_linear(window, monkeypatch):
    assert labels(window, monkeypatch) == ["smooth"] * 3
    window.act(
        editing.edit_document,
        channel_commands.set_tangent_mode({pose_channel(0): {24}}, TangentMode.CORNER),
    )
    window.settle()
    assert labels(window, monkeypatch) == ["smooth", "smooth", "linear"]
    window.act(
        editing.edit_document,
        channel_commands.set_tangent_mode({pose_channel(0): {12}}, TangentMode.STOP),
    )
    window.act(keys.set_easing, {pose_channel(0): {24}}, HOLD)
    window.settle()
    assert labels(window, monkeypatch) == ["smooth", "smooth", "hold"]


def camera_of(project):
    return [(key.frame, round(key.value.zoom, 6)) for key in project.document.camera]


def test_the_camera_is_keyed_from_the_viewport_dragged_and_deleted(window, project, play):
    first, canvas = project.document, project.document.canvas
    # What fits the canvas is the canvas.
    key_camera(window.session)
    shot = camera_at(project.document, 0)
    assert shot.centre == complex(*canvas) / 2
    assert shot.zoom == pytest.approx(1, rel=1e-12)
    playback.scrub(window.session, 30)
    view = project.view_on(window.session.display.screen)
    viewing.set_view(window.session, replace(view, centre=60 + 70j, scale=2 * view.scale))
    key_camera(window.session)
    window.settle()
    assert camera_of(project) == [(0, 1), (30, 2)]
    assert camera_at(project.document, 30).centre == 60 + 70j
    window.frames(10)  # the lane of the camera takes room from the drawing
    screen = window.session.display.screen
    whole = fit_view_around(BoundingBox(0j, complex(*canvas)), screen)
    looked = replace(project.view_on(screen), scale=2 * whole.scale)
    viewing.set_view(window.session, None)
    toggle_camera_view(window.session)
    again = project.view_on(window.session.display.screen)
    assert (again.centre, again.scale) == (looked.centre, pytest.approx(looked.scale))
    playback.scrub(window.session, 0)
    window.settle()
    assert project.view_on(window.session.display.screen).centre == complex(*canvas) / 2
    # A key from there, turned, is what it was; looking elsewhere ends it.
    turned = replace(project.document.camera[0].value, turn=7.0)
    editing.edit_document(window.session, channel_commands.set_key(Channel(CAMERA), 0, turned))
    window.settle()
    key_camera(window.session)
    assert project.document.camera[0].value.turn == pytest.approx(7.0)
    editing.undo(window.session)
    viewing.set_view(window.session, None)
    assert not project.viewport.is_camera_view
    window.settle()

    play(lambda hand: hand.drag(f"{CAMERA_LANE}/key 30", 50, 44))
    assert camera_of(project) == [(0, 1), (44, 2)]
    # One key is never dropped on another, and a click goes there.
    play(lambda hand: hand.drag(f"{CAMERA_LANE}/key 44", 10, 0))
    assert camera_of(project)[0] == (0, 1)
    moved = camera_of(project)[1][0]
    play(lambda hand: hand.click(f"{CAMERA_LANE}/key {moved}"))
    assert playback.current_frame(window.session, project) == moved

    def turn(hand):
        hand.click(f"{CAMERA_LANE}/key {moved}", 1)
        hand.robot.item_input_value("//$FOCUSED/##camera turn", 90.0)
        hand.robot.key_press(int(window.Key.escape))

    play(turn)
    assert project.document.camera[1].value.turn == pytest.approx(np.pi / 2)

    def delete(hand):
        hand.click(f"{CAMERA_LANE}/key 0", 1)
        hand.robot.item_click("//$FOCUSED/###Delete")

    play(delete)
    assert camera_of(project) == [(moved, 2)]
    undo_all(window)
    assert project.document is first


def test_what_the_camera_leaves_out_is_dimmed_in_the_viewport(window, project):
    inside, outside = CENTRE, CENTRE + 0.8 * RADIUS
    window.session.display.overlays = replace(window.session.display.overlays, handles=False)

    def brightness(place):
        point = window.point(place)
        return np.mean(window.picture().convert("RGB").getpixel((int(point.x), int(point.y))))

    before = brightness(inside), brightness(outside)
    key_camera(window.session)
    near = replace(project.document.camera[0].value, zoom=2.0)
    editing.edit_document(window.session, channel_commands.set_key(Channel(CAMERA), 0, near))
    window.settle()
    # The lane of the camera takes room: the place is on another pixel.
    assert abs(brightness(inside) - before[0]) < 6
    assert abs(brightness(outside) - before[1]) > 20
