"""Hands that do two things at once, work that fails, and windows that are too small."""

import threading
from dataclasses import replace

import numpy as np
import pytest
from harness import PATIENCE
from imgui_bundle import ImVec2, imgui
from sessions import run_update_steps

from app.document import channel_commands, pose_channel, shape_commands
from app.document.channels.tangent_mode import TangentMode
from app.document.commands import handle_commands
from app.document.keyframe import Target
from app.document.queries.target_error import HELD_BY_LIMITS, measure_target_errors
from app.document.settings import FrameRange, Meshing
from app.editor.actions import dialog_actions, editing, playback, viewing
from app.editor.actions.layer_setup import resolving
from app.editor.actions.posing.handles import add_handle
from app.editor.actions.posing.inserting import INSERTING, insert_key
from app.editor.actions.posing.pose_drag import set_targets
from app.editor.actions.posing.pose_solver import POSING
from app.editor.actions.project_files import autosaving, export_settings, files, saving
from app.editor.actions.timing import keys, timeline_drag
from app.editor.actions.updates import measuring_jobs, stage_jobs
from app.editor.parts.timeline.gestures import KeyBox
from app.editor.work.derived import Derived
from app.errors import CANCELLED, report_progress
from app.motion.extents.extent import BoundingBox, extent_key
from app.storage.assets import sample_images
from app.storage.autosave import SECONDS
from app.ui.bars.status import SLOW
from app.ui.viewport import marks
from engine.maps.bounds import Bounds

BAR = sample_images() / "bar.png"
TABS = ("Handle", "Layers", "Animate", "Shape", "Export", "Measure")


def place_of(project, identity):
    shown = project.layer_runtime.shown
    index = [handle.id for handle in shown.clip.layer.handles].index(identity)
    return complex(shown.handle_positions[index])


def undo_all(window):
    while window.session.project.history.undo_label is not None:
        window.act(editing.undo)


def details(window):
    return [toast.details for toast in window.session.notices.toasts if toast.details]


def frames_of(project):
    return [key.frame for key in project.layer.keys]


def press(robot, *chord):
    robot.key_press(sum(int(key) for key in chord))


# Two things at once.


def test_undo_during_a_drag(window, loose):
    first = loose.document
    start = place_of(loose, 1)

    def play(robot):
        robot.mouse_move_to_pos(window.point(start))
        robot.mouse_down(0)
        robot.mouse_move_to_pos(window.point(start - 20j))
        window.session.jobs.wait_until_idle()
        robot.yield_()
        assert loose.document is not first
        press(robot, window.Key.mod_ctrl, window.Key.z)
        # Nor does it come again as Ctrl is let go.
        robot.yield_(3)
        window.session.jobs.wait_until_idle()
        robot.yield_()
        assert loose.document is first
        robot.mouse_move_to_pos(window.point(start - 40j))
        robot.mouse_up(0)

    window.run(play)
    window.settle()
    assert frames_of(loose) == [0, 24]
    assert loose.document is first, "the drag is over"


def test_undo_of_a_drag_that_is_not_to_be_seen_yet_takes_nothing_else_back(window, loose):
    before = loose.document
    with window.session.jobs.held(POSING):
        set_targets(window.session, {1: Target(position=900 + 50j)})
        window.act(editing.undo)
    window.settle()
    assert loose.document is before
    editing.undo(window.session)
    assert frames_of(loose) == [0]


def test_undo_takes_a_loose_pose_back_first(window, loose):
    window.act(viewing.toggle_auto_key)
    before = loose.document
    set_targets(window.session, {1: Target(position=place_of(loose, 1) - 80j)})
    window.settle()
    assert loose.unkeyed_pose is not None
    window.run(lambda robot: press(robot, window.Key.mod_ctrl, window.Key.z))
    assert loose.unkeyed_pose is None
    assert loose.document is before


def test_undo_and_redo_go_through_loose_poses_one_by_one(window, loose):
    session = window.session
    window.act(viewing.toggle_auto_key)
    before = loose.document
    poses = [None]
    for shift in (-30j, -60j, -90j):
        set_targets(session, {1: Target(position=place_of(loose, 1) + shift)})
        window.settle()
        poses.append(loose.unkeyed_pose)
    assert len(set(poses)) == 4
    for pose in poses[-2::-1]:
        editing.undo(session)
        assert loose.unkeyed_pose is pose
    assert loose.document is before
    for pose in poses[1:]:
        editing.redo(session)
        assert loose.unkeyed_pose is pose
    window.frames(2)
    assert loose.layer_runtime.shown.pose is poses[-1]
    insert_key(session)
    assert loose.unkeyed_pose is None
    assert loose.layer.key(24).pose is poses[-1]
    editing.undo(session)
    assert (loose.document, loose.unkeyed_pose) == (before, poses[-1])


def test_a_loose_pose_waits_at_its_frame(window, loose):
    session = window.session
    window.act(viewing.toggle_auto_key)
    set_targets(session, {1: Target(position=place_of(loose, 1) - 80j)})
    window.settle()
    pose = loose.unkeyed_pose
    playback.scrub(session, 24)
    assert loose.unkeyed_pose is pose
    playback.scrub(session, 7)
    window.settle()
    assert loose.unkeyed_pose is None
    assert loose.layer_runtime.shown.pose is None
    playback.toggle_play(session)
    playback.seek(session, 24)
    assert loose.unkeyed_pose is None
    playback.scrub(session, 24)
    window.settle()
    assert loose.unkeyed_pose is pose
    assert loose.layer_runtime.shown.pose is pose


def test_deleting_a_handle_while_it_is_dragged(window, loose):
    start = place_of(loose, 1)

    def play(robot):
        robot.mouse_move_to_pos(window.point(start))
        robot.mouse_down(0)
        robot.mouse_move_to_pos(window.point(start - 20j))
        press(robot, window.Key.delete)
        robot.mouse_move_to_pos(window.point(start - 40j))
        robot.mouse_up(0)

    window.run(play)
    window.settle()
    assert [handle.id for handle in loose.document.layers[0].handles] == [0]
    assert loose.selection.handles == frozenset()
    assert loose.visible_drag is None


def test_deleting_a_key_while_it_is_dragged(window, loose):
    def play(robot):
        robot.set_ref("###Timeline")
        robot.mouse_move("**/key 24")
        at = robot.item_info("**/key 24").rect_full.get_center()
        robot.mouse_down(0)
        robot.mouse_move_to_pos(ImVec2(at.x + 60, at.y))
        assert frames_of(loose) != [0, 24]
        press(robot, window.Key.delete)
        robot.mouse_move_to_pos(ImVec2(at.x + 90, at.y))
        robot.mouse_up(0)

    window.run(play)
    window.settle()
    assert frames_of(loose) == [0]
    assert loose.selection.frames == frozenset()
    assert loose.timeline.gesture is None


@pytest.mark.parametrize(
    ("change", "frames"),
    [
        (editing.delete_selection, [0]),
        (
            lambda session: editing.edit_document(
                session, channel_commands.move_keys({pose_channel(0): {24}}, 6)
            ),
            [0, 30],
        ),
        (lambda session: keys.scale_selected_keys(session, 0.5), [0, 12]),
    ],
)
def test_key_that_goes_while_the_solver_still_follows_does_not_come_back(
    window, loose, change, frames
):
    editing.select_keys(window.session, frozenset({24}))
    set_targets(window.session, {1: Target(position=place_of(loose, 1) - 150j)})
    assert loose.visible_drag is not None
    change(window.session)
    window.settle()
    assert frames_of(loose) == frames


def test_other_changes_come_after_the_pose_at_rest(window, loose):
    set_targets(window.session, {1: Target(position=place_of(loose, 1) - 150j)})
    keys.set_fps(window.session, 12.0)
    assert loose.drag is None
    assert loose.document.layers[0].target_errors(loose.document.layers[0].key(24).pose)[1] < 10


def test_weights_and_places_that_change_leave_the_solver_at_work(window, loose):
    rest = loose.layer.handle(1).position
    for command in (
        handle_commands.set_handle_weight(0, {1}, 3.0),
        handle_commands.move_handle(0, 1, rest - 30),
    ):
        target = place_of(loose, 1) - 20j
        set_targets(window.session, {1: Target(position=target)})
        editing.edit_document(window.session, command)
        window.settle()
        pose = loose.layer.key(24).pose
        assert abs(loose.layer.map_of(pose)(np.array([rest]))[0] - target) < 2
    # The point under the new handle has no target.
    assert loose.layer.target_errors(pose)[1] < 1e-6


def test_playhead_that_goes_elsewhere_ends_the_pull(window, loose):
    set_targets(window.session, {1: Target(position=place_of(loose, 1) - 150j)})
    playback.scrub(window.session, 24)
    assert loose.visible_drag is not None
    playback.scrub(window.session, 7)
    assert loose.visible_drag is None
    window.settle()
    assert frames_of(loose) == [0, 24]


def test_playhead_stays_in_the_animation_that_undo_makes_shorter(window, loose):
    window.act(keys.set_last_frame, 100)
    window.act(playback.seek, 90)
    window.act(editing.undo)
    assert playback.current_frame(window.session, loose) == loose.document.frames.last == 48
    window.act(editing.redo)
    assert playback.current_frame(window.session, loose) in loose.document.frames


@pytest.mark.usefixtures("loose")
def test_end_of_the_preview_range_before_its_beginning_takes_that_along(window):
    session = window.session
    for frame, key, work in ((20, "b", (20, 48)), (10, "n", (10, 10)), (30, "b", (30, 30))):
        playback.seek(session, frame)
        window.run(lambda robot, key=key: press(robot, getattr(window.Key, key)))
        assert session.project.document.preview == FrameRange(*work)


def test_only_what_is_there_is_selected(window, loose):
    editing.select_handles(window.session, frozenset({1, 7}))
    assert loose.selection.handles == {1}
    poses = pose_channel(loose.selection.active)
    timeline_drag.begin_timeline_drag(
        window.session,
        KeyBox(start=0.0, channel=poses, keeps={poses: frozenset({24, 31})}),
        loose.timeline.time_range,
    )
    timeline_drag.move_timeline_drag(window.session, 10.0, poses)
    assert loose.selection.frames == {0, 24}
    timeline_drag.cancel_timeline_drag(window.session)
    assert loose.selection.frames == {24}


def test_loose_pose_stays_when_a_handle_is_deleted_by_its_key(window, loose):
    window.act(viewing.toggle_auto_key)
    set_targets(window.session, {1: Target(position=place_of(loose, 1) - 80j)})
    window.settle()
    before = loose.layer_runtime.shown.positions
    editing.select_handles(window.session, frozenset({0}))
    window.run(lambda robot: press(robot, window.Key.delete))
    window.settle()
    assert [handle.id for handle in loose.document.layers[0].handles] == [1]
    assert loose.unkeyed_pose is not None
    np.testing.assert_allclose(loose.layer_runtime.shown.positions, before, rtol=0, atol=1e-9)


def test_loose_pose_over_a_cage_that_is_rebuilt_is_given_up(window, loose):
    session = window.session
    window.act(viewing.toggle_auto_key)
    set_targets(session, {1: Target(position=place_of(loose, 1) - 80j)})
    window.settle()
    cage = loose.document.layers[0].domain.cage
    viewing.preview_meshing(session, Meshing(triangles=1_500, detail="fine"))
    resolving.rebuild_mesh(session)
    window.settle()
    assert len(loose.document.layers[0].domain.cage) != len(cage)
    assert loose.unkeyed_pose is None
    assert loose.layer_setup.meshing is None
    assert loose.layer_runtime.shown.is_current


# The solver at its bounds.


@pytest.mark.usefixtures("painted")
def test_handle_out_of_reach_is_reported_and_freed(window, loose, monkeypatch):
    session = window.session
    undo_all(window)
    editing.redo(session)
    editing.redo(session)
    playback.seek(session, 0)
    resolving.set_limits(session, Bounds(k=0.3, sigma_a=1.3, sigma_b=0.8))
    window.settle()
    start = place_of(loose, 1)
    far = start + 0.5 * loose.layer_runtime.picture.size[0]

    def pull(robot, end, steps=4):
        robot.mouse_move_to_pos(window.point(place_of(loose, 1)))
        robot.mouse_down(0)
        for step in range(1, steps + 1):
            robot.mouse_move_to_pos(window.point(start + (end - start) * step / steps))
        robot.key_down(imgui.Key.mod_alt)  # which keeps a target that is out of reach
        robot.mouse_up(0)
        robot.key_up(imgui.Key.mod_alt)

    viewing.set_view(session, replace(loose.view_on(session.display.screen), scale=0.3))
    window.frames(2)
    window.run(lambda robot: pull(robot, far))
    window.settle()
    pose = loose.document.layers[0].key(0).pose
    assert pose.certificate.is_certified
    assert loose.document.layers[0].bounds.allow(
        k=pose.certificate.k, sigma_a=pose.certificate.sigma_a, sigma_b=pose.certificate.sigma_b
    )
    np.testing.assert_allclose(pose.targets[1].position, far, rtol=0, atol=10)
    assert measure_target_errors(loose.layer, loose.layer_runtime.shown.pose).errors[1] > 100

    targets, written = [], []
    mark, text = marks.mark_handles, imgui.text_colored

    def marked(marks, **options):
        targets.extend(mark.target for mark in marks)
        return mark(marks, **options)

    def colored(colour, words):
        written.append(words)
        text(colour, words)

    with monkeypatch.context() as patch:
        patch.setattr(marks, "mark_handles", marked)
        patch.setattr(imgui, "text_colored", colored)
        window.show_tab("Handle")
        editing.select_handles(session, frozenset())
        window.frames(2)
        editing.select_handles(session, frozenset({1}))
        window.frames(3)
    assert targets[-1] == pose.targets[1].position
    assert any(HELD_BY_LIMITS in words for words in written)

    window.run(lambda robot: pull(robot, start))
    window.settle()
    assert not measure_target_errors(loose.layer, loose.layer_runtime.shown.pose).errors
    assert loose.document.layers[0].key(0).pose.certificate.is_certified


def test_bound_that_bounds_nothing_is_refused_in_words(window, loose):
    window.show_tab("Shape")
    before = loose.document

    def enter(robot):
        robot.set_ref("//Shape")
        robot.item_open("**/Details")
        robot.item_input_value("**/##bound k", -3.0)

    window.run(enter)
    window.settle()
    assert loose.document is before
    (toast,) = window.session.notices.toasts
    assert "between 0 and 1" in toast.text
    assert toast.details == ""


# Work that takes long, or fails.


INBETWEENS = (
    stage_jobs.GLIMPSING,
    stage_jobs.SKETCHING,
    stage_jobs.REFINING,
    stage_jobs.STREAMING,
)


def test_scrubbing_while_the_worker_builds(window, loose):
    with window.session.jobs.held(*INBETWEENS):
        editing.edit_layer(window.session, shape_commands.set_variant, "nu")
        for frame in (3, 17, 9, 24, 0, 12):
            window.act(playback.scrub, frame)
            window.frames(2)
            assert playback.current_frame(window.session, loose) == frame
            assert loose.layer_runtime.shown is not None
        assert not loose.layer_runtime.shown.is_current
    window.settle()
    assert loose.layer_runtime.shown.is_current
    assert loose.layer_runtime.shown.frame == 12


@pytest.mark.usefixtures("everything")
def test_poses_that_follow_each_other_twice_are_prepared_once(window, loose):
    editing.edit_layer(window.session, shape_commands.set_variant, "nu")
    editing.edit_document(
        window.session, channel_commands.copy_keys({pose_channel(0): {0, 24}}, 48)
    )
    # Passed through, the keys would be met with other velocities at the ends.
    frames = {0, 24, 48, 72}
    editing.edit_document(
        window.session,
        channel_commands.set_tangent_mode({pose_channel(0): frames}, TangentMode.CORNER),
    )
    window.settle()
    assert frames_of(loose) == [0, 24, 48, 72]
    # None of it is known of this one.
    editing.edit_layer(window.session, shape_commands.set_variant, "metric")
    for _ in range(20):
        window.frames()
        window.session.jobs.wait_until_idle()
    prepared = loose.layer_runtime.store.prepared(loose.clip)
    assert prepared is not None
    assert prepared[0] is prepared[2]
    assert len(set(prepared)) == 2


FAILURES = {
    "In-betweens": (
        "app.motion.caches.inbetween_cache.compute_segments",
        lambda session: editing.edit_layer(session, shape_commands.set_variant, "nu"),
    ),
    "Measuring": (
        "app.editor.actions.updates.measuring_jobs.measure_curves",
        lambda session: editing.edit_layer(session, shape_commands.set_variant, "nu"),
    ),
    "Measuring the motion": (
        "app.editor.actions.updates.measuring_jobs.measure_extent",
        lambda session: editing.edit_layer(session, shape_commands.set_variant, "nu"),
    ),
    "Smooth playback": (
        "app.motion.caches.inbetween_jobs.build_series",
        lambda session: editing.edit_layer(session, shape_commands.set_variant, "nu"),
    ),
    "Solving the keys": (
        "app.editor.actions.layer_setup.resolving.step_resolver",
        resolving.solve_keys_again,
    ),
    "Rebuilding": (
        "app.solving.resolve_keys.build_picture_domain",
        lambda session: (
            viewing.preview_meshing(session, Meshing(triangles=1_500, detail="normal")),
            resolving.rebuild_mesh(session),
        ),
    ),
    "Posing": (
        "app.editor.actions.posing.pose_solver._take_steps",
        lambda session: set_targets(session, {1: Target(position=900 + 50j)}),
    ),
    "Inserting a key": (
        "app.editor.actions.posing.inserting.fit_shown_pose",
        lambda session: keys.insert_key_in_row_at(session, 12),
    ),
    "Saving": (
        "app.editor.actions.project_files.saving.save_project",
        lambda session: saving.write_project(session, session.settings.folder / "bar.lissom", None),
    ),
    "Opening": (
        "app.editor.actions.project_files.files.open_picture",
        lambda session: files.open_file(session, BAR),
    ),
}


@pytest.mark.parametrize("kind", FAILURES)
@pytest.mark.usefixtures("everything")
def test_raising_job_is_reported_once(window, loose, monkeypatch, request, kind):
    where, begin = FAILURES[kind]
    asked = []

    def broken(*_, **__):
        asked.append(kind)
        raise ZeroDivisionError("a bug")

    if kind == "Measuring the motion":
        # It asks in every frame.
        window.show_tab("Export")
        window.settle()
        request.addfinalizer(lambda: window.show_tab("Handle"))
    with monkeypatch.context() as patch:
        patch.setattr(where, broken)
        begin(window.session)
        window.settle()
        window.frames(20)
    (text,) = details(window)
    assert "a bug" in text
    assert asked == [kind]
    window.session.notices.toasts = []
    undo_all(window)
    assert frames_of(loose) == [0]
    assert loose.document.layers[0].handles == ()
    playback.seek(window.session, 5)
    add_handle(window.session, complex(*loose.layer_runtime.picture.size) / 2)
    window.settle()
    assert loose.layer_runtime.shown.is_current
    assert loose.key_resolver is None


@pytest.mark.usefixtures("loose")
@pytest.mark.usefixtures("everything")
def test_work_that_tells_how_far_it_is_is_cancelled_at_once_and_ends(window, monkeypatch):
    jobs, ended = window.session.jobs, threading.Event()

    def endless(*_, **__):
        try:
            while True:
                report_progress(0.4)
        finally:
            ended.set()

    monkeypatch.setattr(jobs, "_clock", window.clock)
    monkeypatch.setattr("app.motion.caches.inbetween_cache.compute_segments", endless)
    window.act(editing.edit_layer, shape_commands.set_variant, "nu")
    window.until(lambda: any(jobs.share_of(kind) == 0.4 for kind in jobs.kinds))
    window.clock.now += SLOW
    window.frames(3)
    window.run(lambda robot: robot.item_click("//**/Cancel"))
    assert ended.wait(PATIENCE)
    window.settle()
    assert any(CANCELLED in toast.text for toast in window.session.notices.toasts)


WAITING = {
    stage_jobs.SKETCHING: lambda session: editing.edit_layer(
        session, shape_commands.set_variant, "nu"
    ),
    measuring_jobs.SPANNING: lambda session: (
        setattr(session.project.measured, "extent", Derived(None)),
        export_settings.preview_export_frame(session, BoundingBox(0j, 1 + 1j)),
        run_update_steps(session),
    ),
    resolving.SOLVING_KEYS: resolving.solve_keys_again,
    POSING: lambda session: set_targets(session, {1: Target(position=900 + 50j)}),
    INSERTING: lambda session: keys.insert_key_in_row_at(session, 12),
}


def test_a_new_key_stands_in_for_in_betweens_that_are_not_prepared(window, loose):
    """Never the pose of the key that was changed, however long in-betweens take."""
    with window.session.jobs.held(*INBETWEENS):
        width, height = loose.document.canvas
        set_targets(window.session, {1: Target(position=complex(0.85 * width, 0.1 * height))})
        window.until(lambda: POSING not in window.session.jobs.kinds)
        mesh, (first, last) = loose.layer_runtime.shown.mesh, loose.layer.keys
        for frame, key in ((18, last), (6, first)):
            playback.seek(window.session, frame)
            window.frames(1)
            shown = loose.layer_runtime.shown
            assert not shown.is_current
            assert shown.mesh is mesh
            np.testing.assert_array_equal(shown.positions, mesh.pose_vertices(key.pose))
            window.frames(2)
            assert loose.layer_runtime.shown is shown, "nothing is worked out again while it waits"
        # Where the handles will be is not known yet: the targets come once they are.
        set_targets(window.session, {1: Target(position=complex(0.85 * width, 0.4 * height))})
        window.frames(2)
    window.settle()
    assert loose.layer_runtime.shown.is_current
    assert frames_of(loose) == [0, 6, 24]


@pytest.mark.parametrize("kind", WAITING, ids=lambda kind: kind.label)
@pytest.mark.usefixtures("everything")
def test_results_for_a_closed_project_go_nowhere(window, loose, kind):
    before = loose.document
    with window.session.jobs.held(kind):
        WAITING[kind](window.session)
        window.frames(2)
        assert kind in window.session.jobs.kinds
        closed = loose.document
        saving.discard_project(window.session)
        files.open_file(window.session, sample_images() / "s.png")
        window.frames(3)
    window.settle()
    other = window.session.project
    assert other.file.name == "s"
    assert len(other.document.layers[0].keys) == 1
    assert other.history.undo_label is None
    assert other.measured.extent.source in (None, extent_key(other.document))
    assert (other.visible_drag, other.key_resolver, other.unkeyed_pose) == (None, None, None)
    assert other.layer_runtime.shown.is_current
    assert loose.document is closed
    assert closed.layers[0].handles == before.layers[0].handles
    assert [toast for toast in window.session.notices.toasts if toast.tone == "error"] == []


@pytest.mark.usefixtures("loose")
def test_work_that_is_given_up_while_it_is_kept_does_not_come_back(window):
    with window.session.jobs.held(autosaving.AUTOSAVING):
        window.clock.now += 2 * SECONDS
        window.frames(2)
        assert autosaving.AUTOSAVING in window.session.jobs.kinds
        saving.discard_project(window.session)
        window.frames(2)
    window.settle()
    assert list(window.folder.glob("unsaved-*")) == []


def test_saved_work_is_not_kept_as_unsaved(window, loose, tmp_path):
    window.clock.now += 2 * SECONDS
    window.settle()
    assert len(list(window.folder.glob("unsaved-*.lissom"))) == 1
    saving.write_project(window.session, tmp_path / "bar.lissom", None)
    window.settle()
    assert loose.history.is_saved
    assert list(window.folder.glob("unsaved-*")) == []


# Where the pointer is right, and windows in which little is.


@pytest.mark.usefixtures("everything")
def test_click_in_the_plot_goes_to_its_frame(window, loose):
    window.act(playback.seek, 0)
    window.show_tab("Measure")
    window.settle()

    def click(robot):
        robot.set_ref("//Measure")
        box = robot.item_info("##over time k").rect_full
        robot.mouse_move_to_pos(box.get_center())
        robot.mouse_click(0)

    window.run(click)
    assert 8 <= playback.current_frame(window.session, loose) <= 16


@pytest.fixture
def sized(window):
    yield window.resize
    window.resize((1280, 800))


SIZES = [((1280, 800), 3.0), ((400, 300), 3.0), ((60, 40), 1.0)]


# What shows most in each size, and each state in one.
@pytest.mark.parametrize(
    ("kind", "size"),
    [
        *(("two keys", size) for size in SIZES),
        *zip(("welcome", "empty", "one key"), SIZES, strict=True),
    ],
)
def test_panels_draw_in_every_window(window, sized, request, kind, size):
    if kind == "two keys":
        request.getfixturevalue("loose")
    elif kind != "welcome":
        window.open(BAR)
        if kind == "one key":
            add_handle(window.session, 500 + 100j)
            set_targets(window.session, {0: Target(position=500 + 120j)})
            window.settle()
    sized(*size)
    for tab in TABS:
        window.show_tab(tab)
        window.settle()
        assert window.picture().size == size[0]
    if window.session.project is not None:
        window.act(viewing.show_heat_map, "sigma_b")
        window.act(viewing.toggle_overlay, "onion")
        window.act(playback.toggle_play)
        window.frames(5)
    window.act(dialog_actions.show_shortcuts)
    window.frames(3)
    assert window.picture().size == size[0]
    assert details(window) == []
