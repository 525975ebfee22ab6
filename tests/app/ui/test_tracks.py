"""Tracks in the timeline and in the panel of handles, as a person makes and changes them."""

import numpy as np
import pytest
from imgui_bundle import ImVec2, imgui

from app.document import (
    MARKER,
    TRACK,
    Channel,
    all_keys,
    channel_commands,
    clip_of,
    frames_in,
    handle_commands,
    pose_channel,
    scene_commands,
    shape_commands,
    track_at,
    track_commands,
)
from app.document.channels.easing import PRESETS
from app.document.channels.springs import Spring
from app.document.channels.tangent_mode import TangentMode
from app.document.channels.tracks import Track, TrackKey
from app.document.keyframe import Handle
from app.editor.actions import editing, playback
from app.editor.actions.timing import keys, springs, timeline_drag, tracks
from app.motion import Animation
from app.ui.style.theme import PALETTES
from app.ui.timeline.rows.track_residuals import describe_residual, find_residuals
from app.ui.viewport.marks import find_auto_pinned, find_off_target, mark_all

LEFT, RIGHT = 0, 1  # ids of the bar's handles
WAVE = ((0, 0), (8, 12 + 6j), (16, 0))
FAR = 1500  # pixels: farther than the bar, held at its other end, can be stretched


def with_track(window, project, keys=WAVE, handle=RIGHT, **settings):
    """Give a handle a track, show its row, and choose it."""
    own = tuple(TrackKey(frame=frame, place=complex(place)) for frame, place in keys)
    track = Track(handles=(handle,), keys=own, **settings)
    editing.edit_document(window.session, track_commands.put_track(project.selection.active, track))
    timeline_drag.toggle_lanes(window.session, project.selection.active)
    project.selection.select_track(project.layer, handle)
    window.settle()
    return project.layer.track_of(handle)


def row(project, handle=RIGHT):
    return Channel(TRACK, project.selection.active, handle)


def frames_of(project, handle=RIGHT):
    return tuple(sorted(frames_in(project.document, row(project, handle))))


def place_of(project, handle, frame):
    """Where a handle is at a frame, exactly."""
    (place,) = places_of(project, handle, [frame])
    return place


def places_of(project, handle, frames):
    """Where a handle is at some frames, exactly."""
    clip = clip_of(project.document, project.selection.active)
    animation = Animation(clip, points=np.array([project.layer.handle(handle).position]))
    return [complex(animation.positions(frame)[0]) for frame in frames]


class Rows:
    """The robot's pointer among the rows of the timeline."""

    def __init__(self, robot, project):
        self.robot, self.project = robot, project
        robot.set_ref("###Timeline")
        first, last = project.layer.keys[0].frame, project.layer.keys[-1].frame
        begin, end = (
            self.place(f"row {project.selection.active}", f"key {f}") for f in (first, last)
        )
        self._step = (end.x - begin.x) / (last - first)
        self._origin = begin.x - first * self._step
        self.pose_y = begin.y

    def name(self, place, item):
        return f"**/{place}/{item}"

    def place(self, place, item):
        return self.robot.item_info(self.name(place, item)).rect_full.get_center()

    def of(self, item, handle=RIGHT):
        return self.name(f"lane track {self.project.selection.active} {handle}", item)

    def y(self, handle=RIGHT):
        return self.robot.item_info(self.of("name", handle)).rect_full.get_center().y

    def x(self, frame):
        return self._origin + frame * self._step

    def go_to(self, frame, y):
        self.robot.mouse_move_to_pos(ImVec2(self.x(frame), y))

    def drag(self, item, *frames, key=None):
        self.robot.mouse_move(self.of(item))
        if key is not None:
            self.robot.key_down(int(key))
        self.robot.mouse_down(0)
        for frame in frames:
            self.go_to(frame, self.y())
        self.robot.mouse_up(0)
        if key is not None:
            self.robot.key_up(int(key))


@pytest.fixture
def play(window, bent):
    def play(what):
        window.run(lambda robot: what(Rows(robot, bent)))
        window.settle()
        return bent.document

    return play


@pytest.fixture
def press(window):
    """A function that clicks on something in the tab of handles."""

    def press(name):
        window.show_tab("Handle")
        window.run(lambda robot: (robot.set_ref("//Handle"), robot.item_click(f"**/{name}")))
        window.settle()

    return press


def test_a_handle_is_keyed_alone_by_one_click(window, bent, press):
    before, there = bent.document, place_of(bent, RIGHT, 12)
    window.act(playback.seek, 12)
    window.act(editing.select_handles, frozenset({RIGHT}))
    press("###Key this handle only")
    track = bent.layer.track_of(RIGHT)
    assert [(key.frame, key.place) for key in track.keys] == [(12, 0)]
    assert bent.selected_track == RIGHT
    assert bent.layer.keys == before.layers[0].keys
    assert abs(place_of(bent, RIGHT, 12) - there) < 1e-6, "nothing moves"
    # Once more at the same frame there is nothing to do, and at another one there is.
    press("###Key this handle only")
    window.act(playback.seek, 18)
    window.run(lambda robot: robot.key_press(int(window.Key.mod_shift) | int(window.Key.i)))
    assert frames_of(bent) == (12, 18)
    window.act(editing.undo)
    window.act(editing.undo)
    assert bent.document is before
    assert bent.selected_track is None
    window.act(editing.redo)
    assert bent.selected_track == RIGHT


def test_a_key_between_two_others_keeps_what_the_track_does(window, bent, play):
    track = with_track(window, bent, delay=2)
    wanted = track_at(track, bent.clip, 7).place

    def double_click(rows):
        rows.go_to(7, rows.y())
        rows.robot.mouse_double_click(0)

    play(double_click)
    assert playback.current_frame(window.session, bent) == 7
    assert frames_of(bent) == (0, 5, 8, 16)
    (key,) = (key for key in bent.layer.track_of(RIGHT).keys if key.frame == 5)
    assert key.place == wanted


def test_handles_of_a_selection_are_keyed_together_and_others_on_their_own(window, bent):
    window.act(playback.seek, 6)
    window.act(editing.select_handles, frozenset({LEFT, RIGHT}))
    window.act(tracks.key_selected_handles)
    assert [track.handles for track in bent.layer.tracks] == [(LEFT, RIGHT)]
    window.act(editing.undo)
    with_track(window, bent)
    before = bent.document
    window.act(editing.select_handles, frozenset({LEFT, RIGHT}))
    window.act(tracks.key_selected_handles)
    assert frames_of(bent, LEFT) == (6,)
    assert frames_of(bent, RIGHT) == (0, 6, 8, 16)
    window.act(editing.undo)
    assert bent.document is before, "that was one step"


def test_rows_of_tracks_are_folded_away_until_somebody_asks(window, bent, play):
    own = (TrackKey(frame=3, place=2j),)
    editing.edit_document(
        window.session,
        track_commands.put_track(bent.selection.active, Track(handles=(RIGHT,), keys=own)),
    )
    window.settle()
    is_there = []

    def look(rows):
        is_there.append(rows.robot.item_exists(rows.of("key 3")))
        rows.robot.item_click(f"**/fold {bent.selection.active}")
        is_there.append(rows.robot.item_exists(rows.of("key 3")))

    play(look)
    assert is_there == [False, True]
    assert bent.timeline.expanded_layers == {bent.selection.active}


def test_keys_of_a_track_are_moved_copied_and_deleted(window, bent, play):
    with_track(window, bent, delay=3)
    before = bent.document
    play(lambda rows: rows.drag("key 8", 12, 13))
    assert frames_of(bent) == (0, 10, 16)
    assert bent.selection.keys == {row(bent): {10}}
    assert bent.selected_track == RIGHT
    play(lambda rows: rows.drag("key 10", 15, 17, key=window.Key.mod_ctrl))
    assert frames_of(bent) == (0, 10, 14, 16)
    window.run(lambda robot: robot.key_press(int(window.Key.delete)))
    assert frames_of(bent) == (0, 10, 16)
    for _ in range(3):
        window.act(editing.undo)
    assert bent.document is before
    # A click goes to where the key is seen.
    play(lambda rows: rows.robot.item_click(rows.of("key 8")))
    assert playback.current_frame(window.session, bent) == 11


def test_chosen_keys_of_poses_and_of_a_track_are_scaled_and_reversed_together(window, bent):
    with_track(window, bent, keys=((2, 0), (12, 5j), (22, 0)), delay=6)
    everything = all_keys(bent.document)
    editing.edit_document(window.session, scene_commands.add_marker(30))
    before = bent.document
    editing.select_channel_keys(
        window.session,
        {
            pose_channel(bent.selection.active): frozenset({0, 24}),
            row(bent): frozenset({2, 12, 22}),
        },
    )
    window.act(keys.scale_selected_keys, 0.5)
    assert bent.layer.key_frames == {0, 12}
    # Around the first of all, each in its own time: the track is as late as it was.
    assert frames_of(bent) == (1, 6, 11)
    assert bent.layer.track_of(RIGHT).delay == 6
    window.act(keys.reverse_selected_keys)
    assert frames_of(bent) == (1, 6, 11)
    assert [key.place for key in bent.layer.track_of(RIGHT).keys] == [0, 5j, 0]
    window.act(editing.undo)
    window.act(editing.undo)
    assert bent.document is before
    # All keys together are the animation: its end and the delay are scaled, too.
    window.act(editing.select_channel_keys, {**everything, Channel(MARKER): frozenset({30})})
    window.act(keys.scale_selected_keys, 0.5)
    assert bent.document.frames.last == before.frames.last // 2
    assert bent.layer.track_of(RIGHT).delay == 3
    window.act(editing.undo)
    assert bent.document is before
    # Those of poses alone leave the track, which has its own time, and the other way round.
    editing.select_channel_keys(
        window.session, {pose_channel(bent.selection.active): frozenset({0, 24})}
    )
    window.act(keys.scale_selected_keys, 0.5)
    assert frames_of(bent) == (2, 12, 22)
    assert bent.layer.key_frames == {0, 12}


def test_a_drag_of_a_track_key_is_given_up_with_esc(window, bent, play):
    with_track(window, bent)
    before = bent.document

    def give_up(rows):
        rows.robot.mouse_move(rows.of("key 8"))
        rows.robot.mouse_down(0)
        rows.go_to(11, rows.y())
        rows.go_to(12, rows.y())
        rows.robot.key_press(int(window.Key.escape))
        rows.robot.mouse_up(0)

    play(give_up)
    assert bent.document is before
    assert bent.selection.keys == {row(bent): {8}}


def test_a_track_that_goes_in_the_middle_of_a_drag_ends_it(window, bent, play):
    with_track(window, bent)

    def lose(rows):
        rows.robot.mouse_move(rows.of("key 8"))
        rows.robot.mouse_down(0)
        y = rows.y()
        rows.go_to(11, y)
        editing.edit_document(
            window.session, track_commands.remove_tracks(bent.selection.active, (RIGHT,))
        )
        rows.go_to(13, y)
        rows.go_to(14, y)
        rows.robot.mouse_up(0)

    play(lose)
    assert not bent.layer.tracks
    assert bent.selected_track is None
    assert not bent.selection.keys


def test_a_box_takes_keys_of_poses_and_of_tracks_which_move_together(window, bent, play):
    with_track(window, bent, delay=4)
    before = bent.document

    def box(rows):
        rows.go_to(10, rows.pose_y)
        rows.robot.mouse_down(0)
        rows.go_to(20, rows.y() - 2)
        rows.go_to(25, rows.y())
        rows.robot.mouse_up(0)

    play(box)
    assert bent.selection.keys == {pose_channel(bent.selection.active): {24}, row(bent): {8, 16}}
    play(lambda rows: rows.drag("key 8", 14, 15))
    assert frames_of(bent) == (0, 11, 19)
    assert [key.frame for key in bent.layer.keys] == [0, 27]
    window.act(editing.undo)
    assert bent.document is before


def test_keys_of_a_track_are_eased_and_passed_by_their_menu(window, bent, play):
    with_track(window, bent)

    def ease(rows):
        rows.robot.item_click(rows.of("key 8"), 1)
        rows.robot.set_ref("//$FOCUSED")
        rows.robot.menu_click("Easing/In-out")

    play(ease)
    key = bent.layer.track_of(RIGHT).keys[1]
    assert key.easing == PRESETS["in-out"]
    window.act(keys.use_next_tangent_mode)
    assert bent.layer.track_of(RIGHT).keys[1].tangent_mode is TangentMode.CORNER
    # Without a chosen key, that of the chosen row at the playhead or before it is meant.
    window.act(editing.deselect_keys)
    window.act(playback.seek, 20)
    window.act(keys.ease_selected_keys, PRESETS["out"])
    assert bent.layer.track_of(RIGHT).keys[2].easing == PRESETS["out"]
    assert all(key.easing != PRESETS["out"] for key in bent.layer.keys)


def test_a_key_in_the_pose_ends_a_track_without_a_jump(window, bent, play):
    with_track(window, bent, keys=((4, 10j), (12, 6)))

    def insert(rows):
        rows.go_to(18, rows.y())
        rows.robot.mouse_click(1)
        rows.robot.set_ref("//$FOCUSED")
        rows.robot.item_click("**/###Insert in pose")

    play(insert)
    key = bent.layer.track_of(RIGHT).keys[-1]
    assert (key.frame, key.place) == (18, 0)


def test_what_is_chosen_is_where_keys_come_and_go(window, bent, play):
    with_track(window, bent, delay=1)
    poses = bent.layer.keys
    window.act(playback.seek, 5)
    window.run(lambda robot: robot.key_press(int(window.Key.i)))
    window.settle()
    assert frames_of(bent) == (0, 4, 8, 16)
    assert bent.layer.keys is poses
    seen = []
    for _ in range(3):
        window.act(playback.go_to_key, 1)
        seen.append(playback.current_frame(window.session, bent))
    assert seen == [9, 17, 17]
    window.session.display.is_timeline_focused = True
    window.act(editing.select_all)
    assert bent.selection.keys == {
        pose_channel(bent.selection.active): {0, 24},
        row(bent): {0, 4, 8, 16},
    }
    # The row of the poses takes it back.
    play(lambda rows: rows.robot.item_click(f"**/name {bent.selection.active}"))
    assert bent.selected_track is None
    window.act(keys.insert_key_in_row_at, 12)
    window.settle()
    assert [key.frame for key in bent.layer.keys] == [0, 12, 24]


def test_a_chosen_track_is_deleted_in_the_timeline_and_its_handle_stays(window, bent, play):
    with_track(window, bent)
    before = bent.document

    def delete(rows):
        rows.robot.item_click(rows.of("name"))
        rows.robot.key_press(int(window.Key.delete))

    play(delete)
    assert not bent.layer.tracks
    assert len(bent.layer.handles) == 2
    window.act(editing.undo)
    assert bent.document is before
    # Folded away, it is not what is meant any more.
    bent.selection.select_track(bent.layer, RIGHT)
    play(lambda rows: rows.robot.item_click(f"**/fold {bent.selection.active}"))
    assert bent.selected_track is None


def test_rows_are_scrolled_to_a_track_that_is_chosen(window, bent):
    for number in range(12):
        handle = Handle(id=0, name=f"joint {number}", position=150 + 60 * number + 117j)
        command = handle_commands.add_handles(bent.selection.active, [handle])
        editing.edit_document(window.session, command)
    own = (TrackKey(frame=3, place=0j), TrackKey(frame=9, place=0j))
    for handle in bent.layer.handles:
        track = Track(handles=(handle.id,), keys=own)
        editing.edit_document(
            window.session, track_commands.put_track(bent.selection.active, track)
        )
    timeline_drag.toggle_lanes(window.session, bent.selection.active)
    window.settle()
    assert bent.timeline.scrolled == 0, "the row of the poses is to be seen"
    bent.selection.select_track(bent.layer, bent.layer.handles[-1].id)
    window.frames(3)
    assert bent.timeline.scrolled > 0
    bent.selection.select_channel(None)
    window.frames(3)
    assert bent.timeline.scrolled == 0


def test_a_row_switches_its_track_off(window, bent, play):
    with_track(window, bent)
    play(lambda rows: rows.robot.item_click(rows.of("switch")))
    assert not bent.layer.track_of(RIGHT).enabled
    assert bent.layer.track_of(RIGHT).keys


def test_keys_of_a_track_are_copied_and_pasted(window, bent):
    with_track(window, bent, delay=2)
    before = bent.document
    window.act(editing.select_channel_keys, {row(bent): frozenset({8, 16})})
    window.run(lambda robot: robot.mouse_move("//###Timeline"))
    copy, paste = (int(window.Key.mod_ctrl) | int(key) for key in (window.Key.c, window.Key.v))
    window.session.display.is_timeline_focused = True
    window.run(lambda robot: robot.key_press(copy))
    window.act(playback.seek, 30)
    window.run(lambda robot: robot.key_press(paste))
    window.settle()
    assert frames_of(bent) == (0, 8, 16, 28, 36)
    assert bent.selection.keys == {row(bent): {28, 36}}
    window.act(editing.undo)
    assert bent.document is before
    # Where the track is gone, it comes again with them.
    window.act(editing.edit_document, track_commands.remove_tracks(bent.selection.active, (RIGHT,)))
    window.run(lambda robot: robot.key_press(paste))
    window.settle()
    assert frames_of(bent) == (30, 38)


def test_planting_moves_nothing_at_the_keys_and_leads_back(window, bent, press):
    track = with_track(window, bent, delay=1)
    window.act(editing.select_handles, frozenset({RIGHT}))
    before = places_of(bent, RIGHT, [key.frame + 1 for key in track.keys])
    press("kind/###picture")
    planted = bent.layer.track_of(RIGHT)
    assert planted.is_scene_space
    places = [key.place for key in planted.keys]
    np.testing.assert_allclose(places, before, rtol=0, atol=0.1)
    press("kind/###pose")
    again = bent.layer.track_of(RIGHT)
    assert not again.is_scene_space
    wanted = [key.place for key in track.keys]
    np.testing.assert_allclose([key.place for key in again.keys], wanted, rtol=0, atol=1e-6)
    window.act(editing.undo)
    window.act(editing.undo)
    assert bent.layer.track_of(RIGHT) == track


def test_planting_keeps_the_motion_around_keys_that_have_velocities(window, bent, press):
    keys = tuple(
        TrackKey(frame=frame, place=place, velocity=velocity)
        for frame, place, velocity in ((4, 0, 0j), (10, 20j, 3 + 1j), (16, 9, None))
    )
    with_track(window, bent)
    window.act(
        editing.edit_document,
        track_commands.put_track(bent.selection.active, Track(handles=(RIGHT,), keys=keys)),
    )
    window.act(editing.select_handles, frozenset({RIGHT}))
    window.settle()

    def passing():
        before, after = places_of(bent, RIGHT, (9.99, 10.01))
        return (after - before) / 0.02

    beside = passing()
    press("kind/###picture")
    planted = bent.layer.track_of(RIGHT)
    assert planted.keys[2].velocity is None
    np.testing.assert_allclose(planted.keys[1].velocity, beside, rtol=0, atol=0.1)
    np.testing.assert_allclose(passing(), beside, rtol=0, atol=0.1)
    assert abs(beside - (3 + 1j)) > 1, "the base moves, too"
    press("kind/###pose")
    again = bent.layer.track_of(RIGHT)
    velocities = [key.velocity for key in again.keys[:2]]
    np.testing.assert_allclose(velocities, [0, 3 + 1j], rtol=0, atol=0.01)


def test_a_new_key_on_a_way_with_velocities_leaves_the_way_as_it_is(window, bent):
    keys = tuple(
        TrackKey(frame=frame, place=place, velocity=5 - 3j)
        for frame, place in ((4, 0), (20, 20j), (28, 0))
    )
    with_track(window, bent)
    track = Track(handles=(RIGHT,), keys=keys)
    window.act(editing.edit_document, track_commands.put_track(bent.selection.active, track))
    for frame, insert in ((7, tracks.key_handles_at_playhead), (15, tracks.set_handle_value)):
        playback.scrub(window.session, frame)
        at = track_at(track, bent.clip, frame).place
        insert(
            window.session,
            *(((RIGHT,),) if insert is tracks.key_handles_at_playhead else (RIGHT, at)),
        )
    window.settle()
    more = bent.layer.track_of(RIGHT)
    assert len(more.keys) == 5
    ways = [
        [track_at(t, bent.clip, f).place for f in np.arange(4, 28.1, 0.5)] for t in (track, more)
    ]
    np.testing.assert_allclose(*ways, rtol=0, atol=1e-9)


def test_a_new_key_of_a_planted_track_is_where_the_handle_is(window, bent):
    with_track(window, bent, keys=((4, 300 + 100j), (8, 310 + 100j)), is_scene_space=True)
    window.act(playback.seek, 16)
    there = place_of(bent, RIGHT, 16)
    window.act(tracks.key_handles_at_playhead, (RIGHT,))
    window.settle()
    key = bent.layer.track_of(RIGHT).keys[-1]
    assert key.frame == 16
    assert abs(key.place - there) < 1e-6


def test_the_panel_sets_what_a_track_has(window, bent, press):
    with_track(window, bent)
    window.act(editing.select_handles, frozenset({RIGHT}))
    press("on##track")
    assert not bent.layer.track_of(RIGHT).enabled
    press("Key rotation")
    assert bent.layer.track_of(RIGHT).keys_rotation

    def enter(name, value):
        window.run(
            lambda robot: (
                robot.set_ref("//Handle"),
                robot.item_input_value(f"**/##{name}", value),
            )
        )
        window.settle()

    window.act(playback.seek, 12)
    enter("track x", 9.0)
    enter("track y", 4.0)
    (key,) = (key for key in bent.layer.track_of(RIGHT).keys if key.frame == 12)
    assert key.place == 9 - 4j, "y goes down for people"
    enter("track turn", 90.0)
    (key,) = (key for key in bent.layer.track_of(RIGHT).keys if key.frame == 12)
    assert abs(key.turn - np.pi / 2) < 1e-6
    enter("delay", 5.0)
    enter("reach", 0.4)
    track = bent.layer.track_of(RIGHT)
    assert (track.delay, track.reach) == (5, 0.4)
    press("delete track")
    assert bent.layer.track_of(RIGHT) is None


def test_a_handle_follows_like_a_tail(window, bent, press):
    before = bent.document
    window.act(editing.select_handles, frozenset({RIGHT}))
    press("preset/###tail")
    assert bent.layer.spring_of(RIGHT) == Spring(handle=RIGHT, frequency=1.6, damping=0.18)
    press("preset/###jelly")
    assert bent.layer.spring_of(RIGHT) == Spring(handle=RIGHT, frequency=4.5, damping=0.12)
    press("on##spring")
    assert not bent.layer.spring_of(RIGHT).enabled
    window.run(
        lambda robot: (
            robot.set_ref("//Handle"),
            robot.combo_click(f"##root/###about {LEFT}"),
        )
    )
    assert bent.layer.spring_of(RIGHT).root == LEFT
    window.run(
        lambda robot: (
            robot.set_ref("//Handle"),
            robot.item_input_value("**/##stretch", 0.5),
        )
    )
    assert bent.layer.spring_of(RIGHT).stretch == 0.5
    press("delete spring")
    assert bent.layer.spring_of(RIGHT) is None
    for _ in range(6):
        window.act(editing.undo)
    assert bent.document is before


def test_a_spring_becomes_keys_that_swing_as_it_did(window, bent, press):
    spring = Spring(handle=RIGHT, frequency=2.0, damping=0.3)
    editing.edit_document(window.session, track_commands.put_spring(bent.selection.active, spring))
    window.act(editing.select_handles, frozenset({RIGHT}))
    window.settle()
    before, frames = bent.document, range(0, 49, 4)
    swung = np.array(places_of(bent, RIGHT, frames))
    press("Bake to keys")
    track = bent.layer.track_of(RIGHT)
    assert bent.layer.spring_of(RIGHT) is None
    assert bent.selected_track == RIGHT
    assert len(track.keys) < 20
    keyed = np.array(places_of(bent, RIGHT, frames))
    assert np.abs(keyed - swung).max() < 1, "half a pixel, and what is solved"
    window.act(editing.undo)
    assert bent.document is before


def test_a_spring_that_nothing_moves_stays_a_spring(window, bent):
    editing.edit_document(
        window.session, shape_commands.set_auto_pins(bent.selection.active, enabled=False)
    )
    editing.edit_document(
        window.session, channel_commands.delete_keys({pose_channel(bent.selection.active): {24}})
    )
    spring = Spring(handle=RIGHT, frequency=2.0, damping=0.3)
    editing.edit_document(window.session, track_commands.put_spring(bent.selection.active, spring))
    window.settle()
    before = bent.document
    window.act(springs.bake_spring, RIGHT)
    window.settle()
    assert bent.document is before
    assert "does not swing" in window.session.notices.toasts[-1].text


@pytest.mark.usefixtures("everything")
def test_target_error_of_a_track_appears_in_pixels(window, bent):
    hold = Track(handles=(LEFT,), keys=tuple(TrackKey(frame=f, place=0j) for f in (4, 16)))
    editing.edit_document(window.session, track_commands.put_track(bent.selection.active, hold))
    track = with_track(window, bent, keys=((4, 0), (10, FAR), (16, 0)))
    misses = find_residuals(bent, bent.layer, track)
    assert 10 in misses
    assert not {4, 16, 20} & misses.keys()
    text = describe_residual(bent, bent.layer, track, 10)
    assert f"{misses[10]:.0f} px" in text
    assert "stretch" in text
    assert describe_residual(bent, bent.layer, track, 4) == ""
    # In the viewport a dashed line leads from where it is to where it is wanted.
    window.act(playback.seek, 10)
    window.settle()
    shown = bent.layer_runtime.shown
    target = shown.correction.targets[RIGHT]
    assert abs(abs(shown.handle_positions[RIGHT] - target) - misses[10]) < 1
    palette = PALETTES[window.session.settings.preferences.theme]
    ends = [line.points[0] for line in mark_all(window.session, bent, shown, palette)[0]]
    assert target in ends
    # Switched off, it misses nothing.
    window.act(
        editing.edit_document,
        track_commands.enable_track(bent.selection.active, RIGHT, enabled=False),
    )
    window.settle()
    assert not find_residuals(bent, bent.layer, bent.layer.track_of(RIGHT))


@pytest.mark.usefixtures("everything")
def test_a_red_stretch_of_a_row_tells_by_how_much_it_is_missed(window, bent, play):
    hold = Track(handles=(LEFT,), keys=tuple(TrackKey(frame=f, place=0j) for f in (4, 16)))
    editing.edit_document(window.session, track_commands.put_track(bent.selection.active, hold))
    with_track(window, bent, keys=((4, 0), (10, FAR), (16, 0)))
    at = []
    play(lambda rows: at.extend([ImVec2(rows.x(20), rows.y()), ImVec2(rows.x(9), rows.y())]))
    assert tooltip_at(window, at[0]) is None
    assert tooltip_at(window, at[1]) is not None


@pytest.mark.usefixtures("everything")
def test_a_tracked_handle_at_a_key_of_poses_is_not_short_of_that(window, bent):
    with_track(window, bent, keys=((20, 0), (24, 60j), (30, 0)))
    window.act(playback.seek, 24)
    window.settle()
    shown = bent.layer_runtime.shown
    target = shown.pose.targets[RIGHT].position
    assert abs(shown.handle_positions[RIGHT] - target) > 50
    assert not find_off_target(bent, shown)


def tooltip_at(window, place):
    """Return the tooltip that there is some time after the pointer came to a place, if any."""
    imgui.get_io().add_mouse_pos_event(place.x, place.y)
    window.frames(40)
    windows = imgui.get_current_context().windows
    return next((w for w in windows if w.name.startswith("##Tooltip") and w.active), None)


def test_handles_that_stay_have_a_mark_and_can_be_freed(window, bent, press):
    window.act(playback.seek, 12)
    window.settle()
    assert find_auto_pinned(bent.layer_runtime.shown) == {LEFT}

    def lines():
        shown = bent.layer_runtime.shown
        return mark_all(
            window.session, bent, shown, PALETTES[window.session.settings.preferences.theme]
        )[0]

    marked = lines()
    window.act(editing.select_handles, frozenset({LEFT}))
    press("Free between keys")
    assert bent.layer.handle(LEFT).is_unpinned
    assert not find_auto_pinned(bent.layer_runtime.shown)
    assert len(lines()) < len(marked)
    press("Free between keys")
    assert find_auto_pinned(bent.layer_runtime.shown) == {LEFT}
    # With a track of its own it goes where that leads.
    with_track(window, bent, handle=LEFT)
    assert not find_auto_pinned(bent.layer_runtime.shown)


def test_handles_stay_or_not_as_the_menu_of_interpolation_says(window, bent):
    before = bent.document
    window.act(playback.seek, 12)
    window.settle()

    def switch():
        def act(robot):
            robot.menu_click("//##MainMenuBar/View/Measure/In-betweens/Auto-pin handles")

        window.run(act)
        window.settle()
        playback.seek(window.session, 12)
        window.settle()
        return np.array(bent.layer_runtime.shown.handle_positions)

    target = bent.layer.key(24).pose.targets[LEFT].position
    still = np.array(bent.layer_runtime.shown.handle_positions)
    assert abs(still[LEFT] - target) < 0.3
    free = switch()
    assert not bent.layer.has_auto_pins
    assert not find_auto_pinned(bent.layer_runtime.shown)
    assert np.abs(free - still).max() > 0.5
    np.testing.assert_allclose(switch(), still, rtol=0, atol=1e-6)
    assert bent.layer.has_auto_pins
    window.act(editing.undo)
    window.act(editing.undo)
    assert bent.document is before


def test_a_track_of_several_handles_is_set_with_all_of_them_selected(window, bent, press):
    with_track(window, bent)
    track = Track(handles=(LEFT, RIGHT), keys=(TrackKey(frame=4, place=0j),))
    window.act(editing.edit_document, track_commands.put_track(bent.selection.active, track))
    for chosen in ({LEFT, RIGHT}, {RIGHT}):
        window.act(editing.select_handles, frozenset(chosen))
        window.settle()
        was = bent.layer.track_of(LEFT).keys_rotation
        press("Key rotation")
        assert bent.layer.track_of(LEFT).keys_rotation != was
