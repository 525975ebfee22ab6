"""Whatever follows a drag at once, the document gets the pose at rest at the drag's targets."""

import threading
from dataclasses import replace

import numpy as np
import pytest
from bars import check_at_rest, drag_bar
from PIL import Image

from app.document import channel_commands, pose_channel, shape_commands
from app.document.commands import scene_commands
from app.document.keyframe import Target
from app.document.settings import FrameRange
from app.editor.actions import editing, playback, viewing
from app.editor.actions.layer_setup import resolving
from app.editor.actions.posing.handles import add_handle, mirror_handles, remove_handles
from app.editor.actions.posing.inserting import INSERTING, insert_key
from app.editor.actions.posing.pose_drag import release_drag, set_targets
from app.editor.actions.posing.pose_solver import POSING, is_display_final
from app.editor.actions.project_files import exporting, saving
from app.editor.layering.layer_list import duplicate_layer
from app.editor.layering.layer_selection import set_active_layer
from app.editor.layering.pictures import add_layers, make_still
from app.editor.parts.dialogs import Question
from app.editor.poses import copying, library, pasting
from app.storage import load_project
from engine.maps import Bounds


def loosened(bounds):
    return Bounds(k=bounds.k, sigma_a=bounds.sigma_a + 1, sigma_b=bounds.sigma_b)


# Commands of the menus are asked for in `test_commands_after_drags`.
FOLLOWS = {
    "variant": lambda session: editing.edit_layer(session, shape_commands.set_variant, "nu"),
    "limits": lambda session: resolving.set_limits(session, loosened(session.project.layer.bounds)),
    "solve again": resolving.solve_keys_again,
    "another drag elsewhere": lambda session: (
        playback.scrub(session, 0),
        set_targets(session, {0: Target(position=200 + 60j)}),
    ),
    "duplicate the layer": lambda session: duplicate_layer(session, 0),
}


@pytest.mark.parametrize("name", FOLLOWS)
def test_drag_comes_to_rest_whatever_follows(window, loose, name):
    start = loose.document
    goal = drag_bar(window, loose)
    assert loose.drag is not None
    assert not loose.drag.is_at_rest, "it takes several pictures"
    FOLLOWS[name](window.session)
    window.settle()
    playback.stop_playback(window.session)
    window.settle()
    assert not loose.pending.changes
    check_at_rest(loose.document, goal)
    set_active_layer(window.session, 0)
    while loose.document is not start:
        assert loose.history.undo_label is not None
        editing.undo(window.session)
    assert loose.drag is None


def test_drag_goes_on_while_rough_frames_play(window, loose):
    session = window.session
    loose.layer_runtime.shown = replace(loose.layer_runtime.shown, is_approximate=True)
    assert not is_display_final(session, loose)
    loose.timeline.playhead = loose.timeline.playhead.play(loose.document, session.clock())
    assert is_display_final(session, loose)
    loose.layer_runtime.shown = replace(loose.layer_runtime.shown, placeholder=loose.layer.domain)
    assert not is_display_final(session, loose)


@pytest.mark.parametrize("is_seen", [True, False])
def test_moved_and_copied_keys_come_to_rest_too(window, loose, is_seen):
    if is_seen:
        goal = drag_bar(window, loose)
    else:
        with window.session.jobs.held(POSING):
            goal = drag_bar(window, loose)
        assert loose.drag.preview is None
    editing.edit_document(window.session, channel_commands.copy_keys({pose_channel(0): {24}}, 24))
    editing.edit_document(window.session, channel_commands.move_keys({pose_channel(0): {24}}, 6))
    window.settle()
    for frame in (30, 48):
        check_at_rest(loose.document, goal, frame=frame)
    assert loose.layer.key(30).pose.phi is loose.layer.key(48).pose.phi


@pytest.mark.parametrize("auto_key", [True, False])
def test_a_drag_is_in_a_key_as_was_wanted_when_it_began(window, loose, auto_key):
    if not auto_key:
        viewing.toggle_auto_key(window.session)
    with window.session.jobs.held(POSING):
        goal = drag_bar(window, loose)
        viewing.toggle_auto_key(window.session)
    window.settle()
    assert (loose.unkeyed_pose is None) == auto_key
    if auto_key:
        check_at_rest(loose.document, goal)


def test_a_handle_that_comes_or_goes_meanwhile_keeps_its_place(window, loose):
    goal = drag_bar(window, loose)
    add_handle(window.session, complex(loose.layer_runtime.shown.handle_positions.mean()))
    (added,) = loose.selection.handles
    remove_handles(window.session, frozenset({0}))
    window.settle()
    layer, pose = loose.layer, loose.layer.key(24).pose
    assert pose.targets.keys() == {1, added}
    check_at_rest(loose.document, goal)
    assert layer.target_errors(pose)[added] < 1e-6


def test_layers_are_chosen_at_once_and_both_drags_come_to_rest(window, loose):
    duplicate_layer(window.session, 0)
    window.settle()
    (other,) = loose.runtimes.layers.keys() - {0}
    goals = {}
    with window.session.jobs.held(POSING):
        for identity in (0, other):
            set_active_layer(window.session, identity)
            goals[identity] = drag_bar(window, loose)
        assert loose.selection.active == other
    window.settle()
    for identity, goal in goals.items():
        check_at_rest(loose.document, goal, layer=identity)


def test_a_save_has_a_drag_on_each_of_many_layers(window, loose, tmp_path):
    for _ in range(3):
        duplicate_layer(window.session, 0)
        window.frames()
    path, goals = tmp_path / "a.lissom", {}
    with window.session.jobs.held(POSING):
        for layer in loose.document.layers:
            set_active_layer(window.session, layer.id)
            goals[layer.id] = drag_bar(window, loose)
        saving.write_project(window.session, path, None)
        assert not path.exists()
    window.until(lambda: not loose.pending.changes)
    saved = load_project(path)
    for identity, goal in goals.items():
        check_at_rest(saved, goal, layer=identity)


def test_a_picture_is_exported_as_it_comes_to_rest(window, loose, tmp_path):
    goal = drag_bar(window, loose)
    out = tmp_path / "last.png"
    export = replace(loose.document.export, format="picture", framing="canvas")
    editing.edit_document(window.session, scene_commands.set_export(export))
    exporting.start_export(window.session, out)
    assert window.session.export.run is None
    window.until(lambda: out.exists() and window.session.export.run is None)
    assert loose.drag is None
    check_at_rest(loose.document, goal)
    # Once more, of the pose at rest.
    again = tmp_path / "again.png"
    exporting.start_export(window.session, again)
    window.until(lambda: again.exists() and window.session.export.run is None)
    np.testing.assert_array_equal(np.asarray(Image.open(out)), np.asarray(Image.open(again)))


def test_an_export_that_waits_for_a_pose_is_asked_about_and_cancelled(window, loose, tmp_path):
    session = window.session
    export = replace(loose.document.export, format="picture", framing="canvas")
    editing.edit_document(session, scene_commands.set_export(export))
    # The one before, which has its file, is no part of it.
    exporting.start_export(session, tmp_path / "before.png")
    window.until(lambda: (tmp_path / "before.png").exists() and session.export.run is None)
    goal = drag_bar(window, loose)
    exporting.start_export(session, tmp_path / "a.png")
    assert loose.pending.deferred
    exporting.start_export(session, tmp_path / "b.png")
    assert "An export is running." in session.notices.toasts[-1].text
    saving.request_quit(session)
    assert question(window).title == "An export is running"
    session.dialogs.current = None
    exporting.cancel_export(session)
    assert session.notices.toasts[-1].text == "The export was cancelled. Nothing was written."
    window.settle()
    assert [path.name for path in tmp_path.iterdir()] == ["before.png"]
    check_at_rest(loose.document, goal)


def test_copying_the_picture_leaves_an_export_alone_that_is_prepared(
    window, loose, tmp_path, monkeypatch
):
    monkeypatch.setattr("app.editor.actions.project_files.exporting.clipboard_program", lambda: ())
    few = FrameRange(0, 2)
    export = replace(loose.document.export, format="gif", framing="canvas", frames=few)
    editing.edit_document(window.session, scene_commands.set_export(export))
    with window.session.jobs.held(exporting.PREPARING):
        exporting.start_export(window.session, tmp_path / "a.gif")
        window.frames()
        exporting.copy_picture(window.session)
        assert window.session.notices.toasts[-1].text == exporting.UNDER_WAY
    window.until(lambda: (tmp_path / "a.gif").exists() and window.session.export.run is None)


def question(window):
    dialog = window.session.dialogs.current
    return dialog if isinstance(dialog, Question) else None


def answer(window):
    """Let the question be answered by its first answer."""
    _, action = question(window).answers[0]
    window.session.dialogs.current = None
    action.apply(window.session)


ON_ITS_WAY = {
    "a key": lambda window, _: (
        playback.scrub(window.session, 7),
        window.settle(),
        insert_key(window.session),
    ),
    "a layer": lambda window, folder: add_layers(window.session, [drawn(folder)]),
    "a pose of the library": lambda window, _: (
        playback.scrub(window.session, 7),
        window.settle(),
        library.save_pose_to_library(window.session),
    ),
    "solved keys": lambda window, _: resolving.solve_keys_again(window.session),
    "a pull of an in-between": lambda window, _: (
        playback.scrub(window.session, 7),
        window.settle(),
        set_targets(window.session, {1: Target(position=700 + 30j)}),
    ),
}


def drawn(folder):
    path = folder / "layer.png"
    picture = np.zeros((80, 120, 4), np.uint8)
    picture[10:70, 10:110] = 200, 60, 40, 255
    Image.fromarray(picture).save(path)
    return path


@pytest.mark.parametrize("what", ON_ITS_WAY)
def test_closing_asks_about_what_is_on_its_way(window, loose, tmp_path, what):
    path = tmp_path / "a.lissom"
    saving.write_project(window.session, path, None)
    window.settle()
    assert loose.history.is_saved
    ON_ITS_WAY[what](window, tmp_path)
    saving.close_project(window.session)
    window.until(lambda: question(window) is not None or window.session.project is None)
    assert window.session.project is loose, "it was closed without a question"
    answer(window)
    window.until(lambda: window.session.project is None)
    saved = load_project(path)
    assert len(saved.layers) == len(loose.document.layers)
    assert [len(f.keys) for f in saved.layers] == [len(f.keys) for f in loose.document.layers]
    assert len(saved.layers[0].library) == len(loose.document.layers[0].library)


def test_second_close_asks_at_once(window, loose, tmp_path):
    saving.write_project(window.session, tmp_path / "a.lissom", None)
    window.settle()
    playback.scrub(window.session, 7)
    window.settle()
    with window.session.jobs.held(INSERTING):
        insert_key(window.session)
        saving.close_project(window.session)
        assert question(window) is None
        saving.close_project(window.session)
        assert saving.NOT_FINISHED.format(tasks=INSERTING.label) in question(window).text
    window.session.dialogs.current = None
    window.settle()
    assert window.session.project is loose


def test_a_pose_without_a_key_is_asked_about_and_kept(window, loose, tmp_path):
    path = tmp_path / "a.lissom"
    saving.write_project(window.session, path, None)
    window.settle()
    window.session.settings.prefer(auto_key=False)
    playback.scrub(window.session, 7)
    window.settle()
    set_targets(window.session, {1: Target(position=700 + 30j)})
    window.settle()
    assert loose.unkeyed_pose is not None
    # Also by the autosave.
    window.clock.now += 60
    window.settle()
    (kept,) = window.folder.glob("unsaved-*.lissom")
    assert load_project(kept).layers[0].key_frames == {0, 7, 24}
    saving.close_project(window.session)
    window.frames(2)
    assert "The pose at frame 7 has no key yet" in question(window).text
    answer(window)
    window.until(lambda: window.session.project is None)
    assert load_project(path).layers[0].key_frames == {0, 7, 24}


def test_two_keys_that_are_inserted_at_once_both_come(window, loose):
    playback.scrub(window.session, 7)
    window.settle()
    with window.session.jobs.held(INSERTING):
        for frame in (7, 14):
            playback.scrub(window.session, frame)
            insert_key(window.session)
    window.settle()
    texts = [toast.text for toast in window.session.notices.toasts]
    assert loose.layer.key_frames == {0, 7, 14, 24}, texts


def test_decoded_pictures_go_with_the_steps_that_have_them(window, loose, tmp_path):
    for number in range(4):
        path = drawn(tmp_path)
        window.act(add_layers, [path.rename(tmp_path / f"{number}.png")])
        window.settle()
        window.act(editing.undo)
        window.settle()
    assert loose.runtimes.pictures.keys() <= loose.history.picture_files


def test_within_a_job_the_clock_goes_on(window):
    """Else no test would see a pose that takes more than one picture."""
    seen = []
    thread = threading.Thread(target=lambda: seen.extend(window.clock() for _ in range(3)))
    thread.start()
    thread.join()
    assert seen[0] < seen[1] < seen[2]
    assert window.clock() == window.clock()


def beside_the_axis(window, project):
    """Add a handle that has no partner, but room for one; return its id."""
    add_handle(window.session, complex(project.layer_runtime.shown.handle_positions.mean()) + 60)
    window.settle()
    (added,) = project.selection.handles
    return added


def test_mirroring_handles_is_one_step_also_while_a_pose_is_on_its_way(window, loose):
    added = beside_the_axis(window, loose)
    drag_bar(window, loose)
    drag = loose.drag
    window.until(lambda: drag.preview is not None)
    # Left while the solver is ahead of what the document has.
    playback.scrub(window.session, 7)
    window.frames()
    loose.selection.handles = frozenset({added})
    mirror_handles(window.session)
    assert len(loose.layer.handles) == 4, [toast.text for toast in window.session.notices.toasts]
    editing.undo(window.session)
    assert len(loose.layer.handles) == 3
    assert loose.layer.key(24).pose is drag.newest


def test_undo_takes_back_first_what_was_done_since_a_drag_that_is_not_seen_yet(window, loose):
    added = beside_the_axis(window, loose)
    before, handles = loose.document, loose.layer.handles
    with window.session.jobs.held(POSING):
        drag_bar(window, loose)
        loose.selection.handles = frozenset({added})
        mirror_handles(window.session)
        assert loose.drag is None
        editing.undo(window.session)
        assert loose.layer.handles == handles
        mirror_handles(window.session)
        editing.undo(window.session)
        editing.undo(window.session)
        assert loose.document is before
    window.settle()
    assert loose.drag is None
    assert loose.document is before


def test_a_drag_that_was_undone_before_anything_was_seen_is_done_again(window, loose):
    before = loose.document
    with window.session.jobs.held(POSING):
        goal = drag_bar(window, loose)
        assert loose.drag.preview is None
        editing.undo(window.session)
        assert loose.document is before
        editing.redo(window.session)
    window.settle()
    check_at_rest(loose.document, goal)
    editing.undo(window.session)
    assert loose.document is before


def test_undo_takes_back_first_a_paste_that_still_waits_and_nothing_is_lost(window, loose):
    before = loose.document
    with window.session.jobs.held(POSING):
        copying.copy_pose_or_keys(window.session)
        goal = drag_bar(window, loose)
        playback.scrub(window.session, 40)
        pasting.paste_copied(window.session, "flipped")
        assert [each.what for each in loose.pending.deferred] == ["Paste flipped"]
        editing.undo(window.session)
        assert not loose.pending.deferred
        assert loose.drag is not None, "the drag goes on"
    window.settle()
    check_at_rest(loose.document, goal)
    assert loose.layer.key_frames == {0, 24}
    rested = loose.document
    editing.undo(window.session)
    assert loose.document is before
    editing.redo(window.session)
    assert loose.document is rested


def test_a_save_that_waits_is_not_taken_back(window, loose, tmp_path):
    loose.file.path = tmp_path / "bent.lissom"
    with window.session.jobs.held(POSING):
        drag_bar(window, loose)
        saving.save(window.session)
        editing.undo(window.session)
        assert [each.what for each in loose.pending.deferred] == ["Save"]
    window.settle()
    assert loose.file.path.exists()


def test_handles_that_come_before_a_drag_knows_where_it_begins_are_held_by_it(window, loose):
    playback.scrub(window.session, 12)
    window.settle()
    places = loose.layer_runtime.shown.handle_positions
    with window.session.jobs.held(POSING):
        set_targets(window.session, {0: Target(position=places[0] + 5j)})
        release_drag(window.session)
        add_handle(window.session, complex(places.mean()))
        (added,) = loose.selection.handles
        set_targets(window.session, {1: Target(position=places[1] + 5j)})
        release_drag(window.session)
    window.settle()
    assert loose.layer.key(12).pose.targets.keys() == {0, 1, added}


def test_a_drag_of_a_layer_that_stands_still_since_comes_to_rest(window, loose):
    drag_bar(window, loose)
    drag = loose.drag
    window.until(lambda: drag.preview is not None)
    playback.scrub(window.session, 7)
    window.frames(1)
    make_still(window.session, 0)
    copying.copy_pose_or_keys(window.session)
    window.until(lambda: not loose.pending.changes)
    assert drag.is_at_rest
