"""The main job, through the window's own widgets: from a sample to exported frames."""

import numpy as np
import pytest
from PIL import Image

from app.document import scene_commands, shape_commands
from app.document.commands.shape_commands import set_anchor
from app.document.keyframe import Target
from app.document.settings import ExportSettings, Meshing
from app.editor.action import do
from app.editor.actions import editing, playback, viewing
from app.editor.actions.posing.handles import add_handle, remove_handles
from app.editor.actions.posing.inserting import insert_key
from app.editor.actions.posing.pose_drag import drag_handles, release_drag, set_targets
from app.editor.actions.project_files import exporting, saving
from app.editor.layering.anchors import toggle_anchor_at_handle
from app.render.view import View
from app.storage.assets import sample_images
from app.ui.viewport import marks
from app.ui.viewport.interaction import hints
from engine.deform import Status

BAR = sample_images() / "bar.png"


def drag(robot, window, start, end, *, key=None, steps=4):
    """Press at a place of the plane, move to another in steps, and let go there."""
    robot.mouse_move_to_pos(window.point(start))
    if key is not None:
        robot.key_down(int(key))
    robot.mouse_down(0)
    for step in range(1, steps + 1):
        robot.mouse_move_to_pos(window.point(start + (end - start) * step / steps))
    robot.mouse_up(0)
    if key is not None:
        robot.key_up(int(key))


def handle_places(project):
    return {
        handle.id: complex(place)
        for handle, place in zip(
            project.layer_runtime.shown.clip.layer.handles,
            project.layer_runtime.shown.handle_positions,
            strict=True,
        )
    }


@pytest.mark.usefixtures("everything")
def test_a_person_makes_an_animation_and_takes_it_back(window, tmp_path):
    session = window.session
    window.frames(10)

    def open_sample(robot):
        robot.set_ref("Welcome")
        robot.item_click("**/sample Bar")

    window.run(open_sample)
    window.settle()
    project = session.project
    first = project.document
    width, height = project.document.canvas
    left, right = complex(0.1 * width, height / 2), complex(0.9 * width, height / 2)

    def add_handles(robot):
        for place in (left, right):
            robot.mouse_move_to_pos(window.point(place))
            robot.mouse_click(0)

    window.run(add_handles)
    assert len(project.layer.handles) == 2
    places = list(handle_places(project).values())
    np.testing.assert_allclose(places, [left, right], rtol=0, atol=2)

    playback.seek(session, 24)
    window.settle()
    window.run(lambda robot: drag(robot, window, right, right + 0.5j * width))
    window.settle()
    assert [key.frame for key in project.layer.keys] == [0, 24]
    assert handle_places(project)[1].imag > height
    assert all(key.pose.certificate.is_certified for key in project.layer.keys)
    assert project.history.undo_label == "Pose"

    playback.seek(session, 0)
    window.run(lambda robot: robot.key_press(int(window.Key.space)))
    assert project.timeline.playhead.since is not None
    window.frames(10)
    shown = {project.layer_runtime.shown.frame}
    window.frames(10)
    assert project.layer_runtime.shown.frame not in shown
    assert project.layer_runtime.shown.is_current
    window.run(lambda robot: robot.key_press(int(window.Key.space)))
    assert project.timeline.playhead.since is None

    path = tmp_path / "bar.lissom"
    saving.write_project(session, path, None)
    window.settle()
    assert project.history.is_saved
    out = tmp_path / "frames"
    editing.edit_document(session, scene_commands.set_export(ExportSettings(framing="canvas")))
    exporting.start_export(session, out)
    while session.export.run is not None or session.jobs.kinds:
        window.settle()
    names = sorted(file.name for file in out.iterdir())
    assert names == [f"frame_{frame:04d}.png" for frame in range(49)]
    last = np.asarray(Image.open(out / "frame_0000.png"))
    source = np.asarray(Image.open(BAR).convert("RGBA"))
    opaque = source[..., 3] >= 8
    np.testing.assert_array_equal(last[opaque], source[opaque])
    assert "Open folder" in [toast.label for toast in session.notices.toasts]

    for _ in range(4):
        window.run(lambda robot: robot.key_press(int(window.Key.mod_ctrl) | int(window.Key.z)))
    assert project.document is first
    reopened = window.open(path)
    assert [key.frame for key in reopened.document.layers[0].keys] == [0, 24]
    assert len(reopened.document.layers[0].handles) == 2


def test_dragging_follows_and_is_one_step(window, bar, monkeypatch):
    session = window.session
    session.diagnostics.solver_seconds = 0.0
    monkeypatch.setattr(window.clock, "cost", 1e-4)
    start = handle_places(bar)[1]
    before = bar.document
    window.run(lambda robot: drag(robot, window, start, start + 150j, steps=12))
    window.settle()
    assert bar.visible_drag is None
    lag = bar.document.layers[0].target_errors(bar.document.layers[0].keys[0].pose)[1]
    assert lag < 0.05 * abs(150j)
    # It is looked at before the steps and after.
    assert session.diagnostics.solver_seconds >= 0.999 * window.clock.cost
    editing.undo(session)
    assert bar.document is before


@pytest.mark.parametrize("leave", [playback.toggle_play, lambda s: playback.seek(s, 24)])
def test_a_pose_that_the_playhead_leaves_comes_to_rest(window, bar, leave):
    session = window.session
    wanted = handle_places(bar)[1] + 150j
    drag_handles(session, {1: Target(position=wanted)})
    release_drag(session)
    leave(session)
    assert bar.visible_drag is None
    assert bar.drag is not None
    window.settle()
    assert bar.drag is None
    (key,) = bar.document.layers[0].keys
    assert key.frame == 0
    assert bar.document.layers[0].target_errors(key.pose)[1] < 5
    assert bar.history.undo_label == "Pose"


def test_a_pose_that_rests_in_the_hand_ends_where_the_playhead_leaves_it(window, bar):
    session = window.session
    drag_handles(session, {1: Target(position=handle_places(bar)[1] + 150j)}, gesture="hand")
    window.settle()
    posed = bar.document
    assert bar.history.is_held
    assert bar.history.committed is not posed, "it becomes a step when the hand lets go"
    playback.seek(session, 24)
    window.settle()
    assert bar.drag is None
    assert bar.document is posed


def test_undo_takes_back_a_pose_that_the_playhead_has_left(window, bar):
    session = window.session
    before = bar.document
    drag_handles(session, {1: Target(position=handle_places(bar)[1] + 150j)})
    session.jobs.wait_until_idle()
    window.frames()
    assert bar.document is not before
    playback.seek(session, 24)
    editing.undo(session)
    window.settle()
    assert bar.document is before


def test_a_pose_that_is_held_is_of_the_frame_that_the_playhead_is_on(window, bar):
    insert_key(window.session)
    playback.seek(window.session, 20)
    window.frames(2)
    shown = bar.layer_runtime.shown
    playback.seek(window.session, 21)
    window.frames(2)
    assert bar.layer_runtime.shown.frame == 21
    assert bar.layer_runtime.shown.vertices is shown.vertices


def test_the_coarse_mesh_is_shown_while_the_playhead_moves(window):
    session = window.session
    session.settings.default_meshing = Meshing(triangles=30_000)
    project = window.open(BAR)
    session.display.full_detail = False
    window.frames(30)
    assert project.layer_runtime.shown.mesh is project.layer_runtime.fine.mesh
    playback.seek(session, 3)
    window.frames()
    assert project.layer_runtime.shown.mesh is project.layer_runtime.store.mesh
    window.frames(20)
    assert project.layer_runtime.shown.mesh is project.layer_runtime.fine.mesh


def test_a_shape_that_is_held_back_is_left_alone_when_the_hand_lets_go(window, bar):
    session = window.session
    drag_handles(session, {1: Target(position=handle_places(bar)[1] + 9000)}, gesture="hand")
    window.settle()
    held = bar.layer_runtime.shown.positions
    assert bar.visible_drag.solver.state.status is Status.AT_LIMITS
    release_drag(session)
    window.settle()
    assert bar.visible_drag is None
    np.testing.assert_array_equal(bar.layer_runtime.shown.positions, held)


@pytest.mark.usefixtures("everything")
def test_inbetweens_follow_a_drag_before_the_hand_lets_go(window, bar):
    session = window.session
    editing.edit_layer(session, shape_commands.set_variant, "metric")
    playback.seek(session, 24)
    window.settle()
    set_targets(session, {1: Target(position=handle_places(bar)[1] + 120j)})
    window.settle()
    before = bar.layer_runtime.store.positions(bar.clip, 12)
    start = handle_places(bar)[1]
    ghosts, halfway = [], {}

    def play(robot):
        robot.mouse_move_to_pos(window.point(start))
        robot.mouse_down(0)
        for step in range(1, 7):
            robot.mouse_move_to_pos(window.point(start + 25j * step))
            ghosts.append(bar.layer_runtime.store.vertices(bar.layer_runtime.store.whole, 12))
        while session.jobs.kinds:
            robot.yield_()
        halfway.update(
            grab=bar.visible_drag,
            known=bar.layer_runtime.store.has(bar.clip),
            positions=bar.layer_runtime.store.positions(bar.clip, 12),
        )
        robot.mouse_up(0)

    window.run(play)
    assert None not in ghosts
    assert halfway["grab"] is not None
    assert halfway["known"]
    assert np.abs(halfway["positions"] - before).max() > 40
    window.settle()
    assert bar.layer_runtime.store.has(bar.clip)
    exact = bar.layer_runtime.store.positions(bar.clip, 12)
    np.testing.assert_allclose(
        halfway["positions"], exact, rtol=0, atol=0.01 * bar.layer_runtime.picture.size[0]
    )


def test_a_new_handle_moves_nothing(window, bar):
    start = handle_places(bar)[1]
    window.run(lambda robot: drag(robot, window, start, start + 120j))
    window.settle()
    before = bar.layer_runtime.shown.positions
    add_handle(window.session, handle_places(bar)[0] + 200)
    window.settle()
    np.testing.assert_allclose(bar.layer_runtime.shown.positions, before, rtol=0, atol=1e-9)
    remove_handles(window.session, frozenset({0}))
    window.settle()
    np.testing.assert_allclose(bar.layer_runtime.shown.positions, before, rtol=0, atol=1e-9)


def test_a_key_between_keys_starts_from_what_is_shown(window, bar):
    session = window.session
    playback.seek(session, 20)
    window.settle()
    target = bar.layer_runtime.shown.pose.targets[1]
    set_targets(session, {1: Target(position=target.position + 150j)})
    window.settle()
    playback.seek(session, 10)
    window.settle()
    between = bar.layer_runtime.shown.positions
    insert_key(session)
    window.settle()
    assert [key.frame for key in bar.document.layers[0].keys] == [0, 10, 20]
    np.testing.assert_allclose(bar.layer_runtime.shown.positions, between, rtol=0, atol=1.0)


def test_without_auto_key_a_pose_is_loose_until_it_is_inserted(window, bar):
    session = window.session
    window.run(lambda robot: robot.key_press(int(window.Key.k)))
    assert not session.settings.preferences.auto_key
    playback.seek(session, 12)
    start = handle_places(bar)[1]
    window.run(lambda robot: drag(robot, window, start, start + 100j))
    window.settle()
    assert [key.frame for key in bar.document.layers[0].keys] == [0]
    assert bar.unkeyed_pose is not None
    window.run(lambda robot: robot.key_press(int(window.Key.i)))
    window.settle()
    assert bar.unkeyed_pose is None
    assert [key.frame for key in bar.document.layers[0].keys] == [0, 12]


def test_inserting_a_key_where_there_is_one_says_so(window, bar):
    before = bar.document
    window.run(lambda robot: robot.key_press(int(window.Key.i)))
    assert bar.document is before
    (toast,) = window.session.notices.toasts
    assert toast.text == "Frame 0 already has a key. Drag a handle to change it."


def test_keys_of_the_pointer(window, bar):
    places = handle_places(bar)

    def play(robot):
        robot.mouse_move_to_pos(window.point(places[0]))
        robot.key_down(int(window.Key.mod_ctrl))
        robot.mouse_click(0)
        robot.key_up(int(window.Key.mod_ctrl))

    window.run(play)
    assert bar.document.layers[0].anchor == bar.document.layers[0].handle(0).position

    def select_both(robot):
        robot.mouse_move_to_pos(window.point(places[0]))
        robot.mouse_click(0)
        robot.key_down(int(window.Key.mod_shift))
        robot.mouse_move_to_pos(window.point(places[1]))
        robot.mouse_click(0)
        robot.key_up(int(window.Key.mod_shift))

    window.run(select_both)
    assert bar.selection.handles == {0, 1}
    window.run(lambda robot: robot.key_press(int(window.Key.up_arrow)))
    window.settle()
    assert bar.document.layers[0].keys[0].pose.targets[0].position.imag > places[0].imag

    def alt_click(robot):
        robot.mouse_move_to_pos(window.point(handle_places(bar)[1]))
        robot.key_down(int(window.Key.mod_alt))
        robot.mouse_click(0)
        robot.key_up(int(window.Key.mod_alt))

    window.run(alt_click)
    assert [handle.id for handle in bar.document.layers[0].handles] == [0]


def test_a_box_selects_the_handles_in_it(window, bar):
    session = window.session
    left, right = handle_places(bar).values()
    editing.select_handles(session, frozenset())
    side, above = 0.05 * bar.layer_runtime.picture.size[0], 1j * bar.layer_runtime.picture.size[1]

    def span(start, end, key=None):
        window.run(lambda robot: drag(robot, window, start, end, key=key))

    span(left - 2 * side + above, left - side - above)
    assert bar.selection.handles == set()
    span(left - side + above, left + side - above)
    assert bar.selection.handles == {0}
    span(right + side - above, right - side + above, window.Key.mod_shift)
    assert bar.selection.handles == {0, 1}
    span(right + side - above, right - side + above)
    assert bar.selection.handles == {1}
    span(left - side + above, right + side - above)
    assert bar.selection.handles == {0, 1}
    assert session.tools.active_tool is None
    assert len(bar.layer.handles) == 2


def turned(bar, identity=1):
    """Return the target angle of a pose at a handle, in degrees."""
    return np.degrees(bar.layer.keys[0].pose.targets[identity].rotation)


@pytest.mark.parametrize(("press", "angle"), [(0.0, 40.0), (0.5, -25.0), (-0.5j, 40.0)])
def test_alt_drag_turns_the_shape_as_far_as_the_pointer(window, bar, press, angle):
    """It turns from where the pointer leaves the handle, wherever on it that was pressed."""
    start = handle_places(bar)[1]
    arm = 0.12 * bar.layer_runtime.picture.size[0]
    grip = window.grip(bar)

    def turn(robot):
        robot.mouse_move_to_pos(window.point(start + press * grip))
        robot.key_down(int(window.Key.mod_alt))
        robot.mouse_down(0)
        for share in (0.0, 0.5, 1.0):
            swept = np.exp(1j * np.radians(share * angle))
            robot.mouse_move_to_pos(window.point(start + arm * swept))
        robot.mouse_up(0)
        robot.key_up(int(window.Key.mod_alt))

    window.run(turn)
    window.settle()
    assert turned(bar) == pytest.approx(angle, abs=2)
    assert np.degrees(bar.layer_runtime.shown.handle_rotations[1]) == pytest.approx(angle, abs=6)
    assert bar.history.undo_label == "Pose"


def test_the_ring_turns_the_shape_around_the_selected_handle(window, bar):
    start = handle_places(bar)[1]
    radius = window.ring(bar)

    def turn(robot):
        robot.mouse_move_to_pos(window.point(start + radius))
        robot.mouse_down(0)
        for share in (0.5, 1.0):
            swept = np.exp(1j * np.radians(share * 30))
            robot.mouse_move_to_pos(window.point(start + 1.5 * radius * swept))
        robot.mouse_up(0)

    assert bar.selection.handles == {1}
    window.run(turn)
    window.settle()
    assert turned(bar) == pytest.approx(30, abs=2)
    assert len(bar.layer.handles) == 2


def test_a_click_on_the_ring_changes_nothing(window, bar):
    before = bar.document
    place = handle_places(bar)[1] + 1j * window.ring(bar)

    def click(robot):
        robot.mouse_move_to_pos(window.point(place))
        robot.mouse_click(0)

    window.run(click)
    window.settle()
    assert bar.document is before
    assert bar.selection.handles == {1}


@pytest.mark.parametrize("by", ["escape", "right button"])
def test_a_drag_is_taken_back_and_the_next_one_goes_on(window, bar, by):
    session, before = window.session, bar.document
    start = handle_places(bar)[1]
    free = (handle_places(bar)[0] + start) / 2

    def take_back(robot, place):
        robot.mouse_move_to_pos(window.point(place))
        robot.mouse_down(0)
        for reach in (60j, 64j):
            robot.mouse_move_to_pos(window.point(place + reach))
            assert session.jobs.wait_until_idle()
        robot.yield_(2)
        assert session.tools.hint.endswith("Esc cancels")
        assert bar.document is not before
        if by == "escape":
            robot.key_press(int(window.Key.escape))
        else:
            robot.mouse_down(1)
            robot.mouse_up(1)
        assert bar.document is before
        assert session.tools.active_tool is None
        robot.mouse_move_to_pos(window.point(place + 90j))
        robot.mouse_up(0)

    for place in (start, free):
        window.run(lambda robot, place=place: take_back(robot, place))
        window.settle()
        assert bar.document is before
        assert bar.selection.handles == {1}
        np.testing.assert_allclose(handle_places(bar)[1], start, rtol=0, atol=1e-9)
    window.run(lambda robot: drag(robot, window, start, start + 60j))
    window.settle()
    assert bar.history.undo_label == "Pose"
    assert handle_places(bar)[1].imag > start.imag + 30


def test_a_press_on_the_shape_that_is_dragged_is_one_step(window, bar):
    before = bar.document
    left, right = handle_places(bar).values()
    middle = (left + right) / 2
    window.run(lambda robot: drag(robot, window, middle, middle + 60j))
    window.settle()
    assert len(bar.layer.handles) == 3
    assert handle_places(bar)[2].imag > middle.imag + 30
    window.run(lambda robot: robot.key_press(int(window.Key.mod_ctrl) | int(window.Key.z)))
    assert bar.document is before


def test_a_pose_is_copied_and_pasted_by_keys(window, bent):
    pose = bent.layer.key(24).pose
    ctrl = int(window.Key.mod_ctrl)
    window.run(lambda robot: robot.key_press(ctrl | int(window.Key.c)))
    playback.scrub(window.session, 40)
    window.settle()
    window.run(lambda robot: robot.key_press(ctrl | int(window.Key.v)))
    window.settle()
    assert bent.layer.key_frames == {0, 24, 40}
    assert bent.layer.key(40).pose.phi is pose.phi
    assert bent.layer_runtime.shown.is_current


def test_wheel_zooms_at_the_pointer(window, bar):
    place = handle_places(bar)[0]
    before = window.point(place)

    def zoom(robot):
        robot.mouse_move_to_pos(before)
        robot.mouse_wheel_y(3)

    window.run(zoom)
    after = window.point(place)
    assert bar.viewport.view is not None
    np.testing.assert_allclose([after.x, after.y], [before.x, before.y], rtol=0, atol=1.0)


def check_fitted(window, project, lower, upper):
    """Hold the view against the box that it should fit: centred, and tight one way."""
    view = project.view_on(window.session.display.screen)
    np.testing.assert_allclose(view.centre, (lower + upper) / 2, rtol=0, atol=0.01)
    fill = np.array([(upper - lower).real, (upper - lower).imag]) * view.scale
    room = np.array(window.session.display.screen) - fill
    np.testing.assert_allclose(
        room.min(), 0.16 * min(window.session.display.screen), rtol=0, atol=0.5
    )


def corners(points):
    x, y = points.real, points.imag
    return complex(x.min(), y.min()), complex(x.max(), y.max())


def move_away(window):
    viewing.set_view(
        window.session, View(centre=-5000j, scale=3.0, size=window.session.display.screen)
    )
    window.frames(2)


def test_home_fits_the_pose_wherever_it_is(window, bent):
    for frame in (0, 12, 24):
        playback.seek(window.session, frame)
        window.settle()
        move_away(window)
        window.run(lambda robot: robot.key_press(int(window.Key.home)))
        check_fitted(window, bent, *corners(bent.layer_runtime.shown.positions))


@pytest.mark.usefixtures("everything")
def test_shift_home_fits_the_whole_motion(window, bent):
    points = []
    for frame in range(0, 25, 3):
        playback.seek(window.session, frame)
        window.settle()
        points.append(bent.layer_runtime.shown.positions)
    move_away(window)
    chord = int(window.Key.mod_shift) | int(window.Key.home)
    window.run(lambda robot: robot.key_press(chord))
    window.settle()
    check_fitted(window, bent, *corners(np.concatenate(points)))


def test_a_camera_that_is_moved_waits_for_no_motion(window, bent):
    viewing.zoom_to_motion(window.session)
    move_away(window)
    window.settle()
    assert bent.viewport.view.centre == -5000j


def test_f_fits_the_selected_handles_or_the_shape(window, bent):
    def press(robot):
        robot.key_press(int(window.Key.f))

    whole = corners(bent.layer_runtime.shown.positions)
    bent.selection.handles = frozenset()
    move_away(window)
    window.run(press)
    check_fitted(window, bent, *whole)
    for selected in ({1}, {0, 1}):
        bent.selection.handles = frozenset(selected)
        move_away(window)
        window.run(press)
        places = handle_places(bent)
        chosen = corners(np.array([places[identity] for identity in selected]))
        view = bent.view_on(window.session.display.screen)
        np.testing.assert_allclose(view.centre, sum(chosen) / 2, rtol=0, atol=0.01)
        near = np.array([*chosen]) - view.centre
        assert (np.abs(near.real) * view.scale < 0.5 * window.session.display.screen[0]).all()
        assert (np.abs(near.imag) * view.scale < 0.5 * window.session.display.screen[1]).all()


def test_unsaved_changes_are_asked_about(window, bar, tmp_path):
    session = window.session
    saving.request_quit(session)
    window.frames(3)
    assert not session.is_quitting

    def decline(robot):
        robot.set_ref("//$FOCUSED")
        robot.item_click("Cancel")

    window.run(decline)
    assert session.dialogs.current is None
    assert session.project is bar
    bar.file.path = tmp_path / "kept.lissom"
    saving.save_then(session, do(saving.discard_project))
    window.settle()
    assert bar.file.path.is_file()
    assert session.project is None


def test_ctrl_click_on_the_shape_puts_the_anchor_there(window, bent):
    before, wanted = (
        len(bent.document.layers[0].handles),
        complex(bent.layer_runtime.shown.positions.mean()),
    )

    def play(robot):
        robot.mouse_move_to_pos(window.point(wanted))
        robot.key_down(int(window.Key.mod_ctrl))
        robot.mouse_click(0)
        robot.key_up(int(window.Key.mod_ctrl))

    window.run(play)
    window.settle()
    assert len(bent.document.layers[0].handles) == before
    assert bent.document.layers[0].anchor is not None
    moved = bent.document.layers[0].map_of(bent.document.layers[0].keys[1].pose)(
        np.array([bent.document.layers[0].anchor])
    )
    assert abs(moved[0] - wanted) < 3
    assert abs(marks.find_anchor(bent, bent.layer_runtime.shown) - wanted) < 3
    toggle_anchor_at_handle(window.session, 0)
    window.settle()
    assert marks.find_anchor(bent, bent.layer_runtime.shown) is None  # the handle itself shows it


@pytest.mark.usefixtures("everything")
def test_an_anchor_that_was_chosen_for_the_person_is_shown(window, bent):
    assert bent.document.layers[0].anchor is None
    place = marks.find_anchor(bent, bent.layer_runtime.shown)
    rest = bent.layer_runtime.store.sampler.sites.anchor
    moved = bent.document.layers[0].map_of(bent.document.layers[0].keys[1].pose)(np.array([rest]))
    assert abs(place - moved[0]) < 3
    shown = window.picture()
    editing.edit_document(
        window.session, set_anchor(0, complex(bent.document.layers[0].handle(0).position))
    )
    window.settle()
    assert window.picture() != shown


def test_three_hints_lead_to_the_first_motion(window):
    """Click, drag, move the playhead and drag again; one handle is enough."""
    session = window.session
    project = window.open(BAR)
    steps = [hints.find_first_step(project)]
    place = complex(*project.document.canvas) / 2
    add_handle(session, place)
    window.settle()
    steps.append(hints.find_first_step(project))
    set_targets(session, {0: Target(position=place + 60j)})
    window.settle()
    steps.append(hints.find_first_step(project))
    playback.seek(session, 24)
    window.settle()
    set_targets(session, {0: Target(position=place)})
    window.settle()
    steps.append(hints.find_first_step(project))
    assert steps == [0, 1, 2, None]
