"""Files that are dropped, work that is kept by itself, and preferences that outlive a crash."""

from dataclasses import replace
from types import MappingProxyType

import pytest
from harness import Harness

from app.document import UnreadMotion
from app.document.commands import handle_commands
from app.document.keyframe import Target
from app.editor.actions import editing, viewing
from app.editor.actions.posing.handles import add_handle
from app.editor.actions.posing.motion_presets import preset_setup
from app.editor.actions.posing.pose_drag import drag_handles, release_drag, set_targets
from app.editor.actions.posing.pose_solver import POSING
from app.editor.actions.project_files import autosaving, files, recovery, saving
from app.editor.parts.dialogs import Question
from app.storage import decode_picture, project_file
from app.storage.assets import sample_images
from app.storage.autosave import SECONDS
from app.storage.pictures import parallel
from app.storage.pictures.programs import PROGRAM_FILE
from app.storage.preferences import CHECKER, Preferences, load_preferences
from app.storage.project_file import load_project, save_project
from app.storage.thumbnail import read_thumbnail

BAR, RING = sample_images() / "bar.png", sample_images() / "ring.png"


@pytest.fixture
def project(window):
    return window.again(Harness.open, BAR)


@pytest.fixture
def drop(window):
    """Drops files on the window."""

    def take(*paths):
        window.program.take_dropped(list(paths))
        window.frames(2)
        window.settle()

    return take


def texts(window):
    return [toast.text for toast in window.session.notices.toasts]


def change(window, project):
    """Make a change that is not saved."""
    place = complex(*project.document.canvas) / 2
    shift = 0.1 * len(project.layer.handles) * project.document.canvas[0]
    window.act(add_handle, place + shift)
    window.settle()
    assert not project.history.is_saved


def test_a_dropped_picture_opens(window, drop):
    drop(BAR)
    assert window.session.project.file.name == "bar"
    assert texts(window) == []


def test_a_dropped_project_opens(window, project, drop, tmp_path):
    path = tmp_path / "mine.LISSOM"
    saving.write_project(window.session, path, None)
    window.settle()
    window.act(saving.discard_project)
    drop(path)
    assert window.session.project is not project
    assert window.session.project.file.path == path
    assert window.session.settings.preferences.recent[0] == path


def test_unknown_motion_is_reported(window, project, tmp_path):
    unread = UnreadMotion(index=0, content={"motion": "nosuch"}, reason="it is not known")
    layer = replace(project.layer, unread_motions=(unread,))
    path = tmp_path / "later.lissom"
    save_project(path, project.document.with_layer(layer))
    window.act(files.open_file, path)
    window.settle()
    assert any("motion that this version cannot show" in text for text in texts(window))
    window.act(preset_setup.begin_motion_setup)
    window.settle()
    assert window.session.tools.motion_setup is not None


def test_several_dropped_pictures_become_layers(window, drop, tmp_path):
    notes = tmp_path / "notes.txt"
    notes.write_bytes(b"")
    drop(notes, RING, BAR)
    project = window.session.project
    assert [layer.name for layer in project.document.layers] == ["ring", "bar"]
    assert project.layer.name == "bar"


def test_of_other_dropped_files_the_first_that_can_be_opened_opens(window, drop, tmp_path):
    notes = tmp_path / "notes.txt"
    notes.write_bytes(b"")
    drop(notes, RING)
    assert window.session.project.file.name == "ring"
    assert "Opened ring.png; only one file at a time." in texts(window)


def test_a_picture_dropped_on_a_scene_may_become_a_layer(window, project, drop):
    drop(RING)
    assert isinstance(window.session.dialogs.current, Question)
    window.run(lambda robot: robot.item_click("//###dialog/New layer"))
    window.settle()
    assert window.session.project is project
    assert [layer.name for layer in project.document.layers] == ["bar", "ring"]
    assert project.layer.name == "ring"
    window.act(editing.undo)
    window.settle()
    assert len(project.document.layers) == 1
    assert project.layer.name == "bar"
    window.act(editing.redo)
    window.settle()
    assert set(project.runtimes.layers) == {layer.id for layer in project.document.layers}


def test_a_layer_beyond_memory_is_refused(window, project, drop, monkeypatch):
    sizes = [decode_picture(path.read_bytes(), path.name).size for path in (BAR, RING)]
    both = sum(4 * width * height for width, height in sizes)
    monkeypatch.setattr(parallel, "memory_budget", lambda: both - 1)
    drop(RING)
    window.run(lambda robot: robot.item_click("//###dialog/New layer"))
    window.settle()
    assert "decoded, the picture needs" in texts(window)[-1]
    assert len(project.document.layers) == 1


def test_a_dropped_thing_that_cannot_be_opened_is_named(window, project, drop, tmp_path):
    notes = tmp_path / "notes.txt"
    notes.write_bytes(b"")
    folder = tmp_path / "frames.png"
    folder.mkdir()
    change(window, project)
    for path, reason in ((notes, "neither a picture nor a project"), (folder, "a folder")):
        drop(path)
        assert texts(window)[-1].startswith(f"{path.name} is {reason}")
        assert window.session.dialogs.current is None
    drop()
    assert len(texts(window)) == 2
    foreign = tmp_path / "walk.xcf"
    foreign.write_bytes(b"gimp xcf v011")
    drop(foreign)
    advice = PROGRAM_FILE.format(name="walk.xcf", program="GIMP")
    assert texts(window)[-1] == f"{advice}."
    assert window.session.project is project


def test_changes_are_asked_about_before_a_dropped_file_opens(window, project, drop):
    change(window, project)
    for answer in ("Cancel", "Don't save"):
        drop(RING)
        window.run(lambda robot: robot.item_click("//###dialog/New scene"))
        window.settle()
        assert isinstance(window.session.dialogs.current, Question)
        assert window.session.project is project
        window.run(lambda robot, answer=answer: robot.item_click(f"//###dialog/{answer}"))
    window.settle()
    assert window.session.project.file.name == "ring"


def test_changes_made_while_a_file_is_read_are_asked_about(window, project):
    with window.session.jobs.held():
        window.act(files.open_file, RING)
        assert window.session.dialogs.current is None
        window.act(add_handle, complex(*project.document.canvas) / 2)
    window.settle()
    assert window.session.project is project
    assert len(project.layer.handles) == 1
    assert isinstance(window.session.dialogs.current, Question)
    window.run(lambda robot: robot.item_click("//###dialog/Don't save"))
    assert window.session.project.file.name == "ring"


def test_changes_made_while_unsaved_work_is_read_are_asked_about(window, project, tmp_path):
    path = tmp_path / "unsaved.lissom"
    save_project(path, project.document)
    with window.session.jobs.held():
        window.act(recovery.recover_file, path)
        window.act(add_handle, complex(*project.document.canvas) / 2)
    window.settle()
    assert window.session.project is project
    assert isinstance(window.session.dialogs.current, Question)
    window.run(lambda robot: robot.item_click("//###dialog/Cancel"))
    assert path.exists()


@pytest.mark.parametrize("verb", [saving.request_quit, saving.close_project])
def test_changes_made_while_the_project_is_saved_are_asked_about(window, project, tmp_path, verb):
    saving.write_project(window.session, tmp_path / "bar.lissom", None)
    window.settle()
    change(window, project)
    window.act(verb)
    with window.session.jobs.held(saving.SAVING):
        window.run(lambda robot: robot.item_click("//###dialog/Save"))
        window.act(add_handle, complex(*project.document.canvas) / 3)
    window.settle()
    assert window.session.project is project
    assert not window.session.is_quitting
    assert len(project.layer.handles) == 2
    assert isinstance(window.session.dialogs.current, Question)
    window.run(lambda robot: robot.item_click("//###dialog/Save"))
    window.settle()
    assert len(load_project(tmp_path / "bar.lissom").layers[0].handles) == 2
    assert window.session.is_quitting or window.session.project is None
    window.session.is_quitting = False


@pytest.fixture
def kept(window):
    """Returns how many handles the autosave has, None if there is none; lets jobs end."""

    def read():
        window.settle()
        found = list(window.folder.glob("unsaved-*.lissom"))
        assert len(found) <= 1
        return len(load_project(found[0]).layers[0].handles) if found else None

    return read


def pass_time(window, seconds):
    window.clock.now += seconds
    window.frames()


def test_the_autosave_comes_some_time_after_a_change(window, project, kept):
    pass_time(window, SECONDS)
    assert kept() is None
    project.file.autosaved_at = window.clock.now
    change(window, project)
    pass_time(window, SECONDS - 1)
    assert kept() is None
    pass_time(window, 1)
    assert kept() == 1
    written = next(window.folder.glob("unsaved-*.lissom")).stat().st_mtime_ns
    pass_time(window, 2 * SECONDS)
    assert kept() == 1
    assert next(window.folder.glob("unsaved-*.lissom")).stat().st_mtime_ns == written


def test_more_changes_are_kept_in_its_place(window, project, kept):
    project.file.autosaved_at = window.clock.now
    change(window, project)
    pass_time(window, SECONDS)
    assert kept() == 1
    change(window, project)
    pass_time(window, 0.5 * SECONDS)
    assert kept() == 1
    pass_time(window, 0.5 * SECONDS)
    assert kept() == 2


def test_refused_autosave_is_reported_once(window, project, kept, monkeypatch):
    project.file.autosaved_at = window.clock.now
    change(window, project)
    pass_time(window, SECONDS)
    assert kept() == 1
    with monkeypatch.context() as patched:
        patched.setattr(project_file, "MOST_VALUES", 3)
        for has_notice in (True, False, False):
            change(window, project)
            pass_time(window, SECONDS)
            window.settle()
            notices = [text for text in texts(window) if "could not open the file again" in text]
            assert len(notices) == has_notice
    assert kept() == 1
    pass_time(window, SECONDS)
    assert kept() == 4


def test_the_autosave_waits_for_the_hand_but_not_for_ever(window, project, kept):
    project.file.autosaved_at = window.clock.now
    change(window, project)
    place = complex(*project.document.canvas) / 2
    project.file.autosaved_at -= SECONDS
    with window.session.jobs.held(POSING):
        drag_handles(window.session, {0: Target(position=place)})
        window.clock.now += SECONDS / 2
        window.frames(20)
        assert not list(window.folder.glob("unsaved-*.lissom"))
        window.clock.now += SECONDS / 2
        window.until(lambda: bool(list(window.folder.glob("unsaved-*.lissom"))))
        assert project.visible_drag is not None
    assert kept() == 1


def test_what_is_saved_stays_so_though_a_pose_had_not_settled(window, project, tmp_path):
    change(window, project)
    change(window, project)
    place = complex(*project.document.canvas)
    set_targets(window.session, {0: Target(position=place), 1: Target(position=1.2 * place)})
    window.frames(2)
    assert project.visible_drag is not None
    path = tmp_path / "bar.lissom"
    saving.write_project(window.session, path, None)
    window.settle()
    assert project.visible_drag is None
    assert project.history.is_saved
    (saved,), (now,) = load_project(path).layers[0].keys, project.layer.keys
    assert saved.pose.targets == now.pose.targets
    assert (saved.pose.psi == now.pose.psi).all()
    window.act(saving.request_quit)
    assert window.session.dialogs.current is None
    window.session.is_quitting = False


def test_the_autosave_goes_when_the_work_is_saved(window, project, kept, tmp_path):
    change(window, project)
    pass_time(window, SECONDS)
    assert kept() == 1
    saving.write_project(window.session, tmp_path / "bar.lissom", None)
    window.settle()
    assert kept() is None


def test_the_autosave_goes_when_the_change_is_undone(window, project, kept):
    change(window, project)
    pass_time(window, SECONDS)
    assert kept() == 1
    window.act(editing.undo)
    assert kept() is None


@pytest.mark.parametrize("verb", [saving.discard_project, saving.close_window])
def test_the_autosave_goes_with_work_that_is_given_up(window, project, kept, verb):
    change(window, project)
    pass_time(window, SECONDS)
    assert kept() == 1
    verb(window.session)
    window.session.is_quitting = False
    assert list(window.folder.glob("unsaved-*")) == []


@pytest.mark.parametrize("verb", [saving.discard_project, editing.undo])
def test_nothing_stays_of_work_that_is_given_up_meanwhile(window, project, verb):
    with window.session.jobs.held(autosaving.AUTOSAVING):
        project.file.autosaved_at = window.clock.now
        change(window, project)
        pass_time(window, SECONDS)
        assert autosaving.AUTOSAVING in window.session.jobs.kinds
        window.act(verb)
    window.settle()
    assert list(window.folder.glob("unsaved-*")) == []


def test_a_saved_project_is_known_by_its_picture_in_the_welcome_view(window, project, tmp_path):
    path = tmp_path / "bar.lissom"
    saving.write_project(window.session, path, None)
    window.settle()
    small = read_thumbnail(path)
    assert small.shape[1] / small.shape[0] == pytest.approx(
        project.document.canvas[0] / project.document.canvas[1], rel=0.05
    )
    textures = window.program.thumbnails
    assert path not in textures.files
    window.act(saving.close_project)
    window.frames(30)
    shown = textures.get(path)
    assert shown.size == small.shape[1::-1]
    window.open(BAR)
    assert path not in textures.files
    # Samples stay: nobody writes to them.
    assert textures.files


def test_a_drag_keeps_what_a_later_version_wrote_about_its_target(window, project, tmp_path):
    change(window, project)
    path = tmp_path / "bar.lissom"
    (key,) = project.layer.keys
    unknown = MappingProxyType({"from the future": 1})
    targets = {i: replace(target, unknown=unknown) for i, target in key.pose.targets.items()}
    key = replace(key, pose=replace(key.pose, targets=targets))
    layer = replace(project.layer, keys=(key,))
    save_project(path, replace(project.document, layers=(layer,)))
    opened = window.open(path)
    place = opened.layer.handles[0].position
    drag_handles(window.session, {0: Target(position=place + 20j)})
    window.act(release_drag)
    window.settle()
    target = opened.layer.keys[0].pose.targets[0]
    assert target.position == place + 20j
    assert target.unknown == unknown
    window.act(
        editing.edit_document, handle_commands.move_handle(opened.selection.active, 0, place - 5)
    )
    assert opened.layer.keys[0].pose.targets[0].unknown == unknown


def test_preferences_are_kept_as_soon_as_they_change(window):
    assert load_preferences(window.folder) == Preferences()
    window.act(viewing.toggle_theme)
    window.settle()
    assert load_preferences(window.folder) == Preferences(theme="light")
    window.act(viewing.set_onion_skin, 1, 99, 99)
    window.act(viewing.enlarge_interface)
    window.settle()
    kept = load_preferences(window.folder)
    assert kept == window.session.settings.preferences
    assert (kept.ghosts_before, kept.ghosts_after, kept.ghost_step) == (1, 6, 24)
    assert kept.scale == 1.25


def test_a_backdrop_is_chosen_in_the_menu(window, project):
    del project

    def choose(robot):
        robot.set_ref("##MainMenuBar")
        robot.menu_click("View/Backdrop/White")

    window.run(choose)
    window.settle()
    white = window.picture()
    assert load_preferences(window.folder).backdrop == "#ffffff"
    corner = window.point(0j)
    pixel = (int(corner.x) - 20, int(corner.y) + 20)
    assert white.getpixel(pixel) == (255, 255, 255)
    window.act(viewing.set_backdrop, CHECKER)
    assert window.picture().getpixel(pixel) != (255, 255, 255)
