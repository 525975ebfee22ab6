"""Failures are reported in words, and the window lives on."""

import errno
import os
import threading
from contextlib import suppress
from dataclasses import replace

import pytest
from harness import Harness

from app.document.keyframe import Target
from app.editor.actions.posing.handles import add_handle
from app.editor.actions.posing.pose_drag import set_targets
from app.editor.actions.posing.pose_solver import POSING
from app.editor.actions.project_files import autosaving, exporting, files, recovery, saving
from app.editor.actions.updates import stage_jobs
from app.editor.parts.dialogs import FileDialog, Question, RecoveryDialog
from app.editor.work.jobs import Job, JobKind
from app.errors import CANCELLED
from app.storage import NO_FOLDER
from app.storage.assets import sample_images
from app.storage.autosave import (
    SECONDS,
    Autosave,
    SourceInfo,
    find_recoverable_files,
    load_recoverable_file,
    remove_recoverable_file,
)
from app.storage.files.file_lock import FileLock, FileLockedError
from app.storage.project.archive import NO_PROJECT
from app.storage.project_file import load_project, save_project
from app.ui.bars.status import ENDLESS
from app.ui.viewport.canvas import Canvas
from app.ui.window.desktop import window_title


@pytest.fixture
def project(window):
    return window.again(Harness.open, sample_images() / "bar.png")


@pytest.fixture
def end():
    """What a worker waits for that never ends before the test does."""
    event = threading.Event()
    yield event
    event.set()


def texts(window):
    return [toast.text for toast in window.session.notices.toasts]


@pytest.mark.parametrize(
    ("name", "content", "reason"),
    [
        ("torn.png", b"\x89PNG\r\n\x1a\n and no more", "is damaged"),
        ("torn.lissom", b"PK no zip at all", NO_PROJECT),
        ("missing.png", None, "cannot read"),
    ],
)
def test_a_file_that_cannot_be_opened_says_why(window, tmp_path, name, content, reason):
    path = tmp_path / name
    if content is not None:
        path.write_bytes(content)
    files.open_file(window.session, path)
    window.settle()
    assert window.session.project is None
    (text,) = texts(window)
    assert name in text
    assert reason in text


def test_a_full_disk_loses_nothing(window, project, tmp_path, monkeypatch):
    path = tmp_path / "kept.lissom"
    saving.write_project(window.session, path, None)
    window.settle()
    before = path.read_bytes()

    def full(*_):
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr("app.storage.files.atomic.os.fsync", full)
    saving.write_project(window.session, path, None)
    window.settle()
    assert any("No space left" in text for text in texts(window))
    assert path.read_bytes() == before
    assert [each for each in tmp_path.iterdir() if each.suffix != ".lock"] == [path]
    assert window.session.project is project


@pytest.mark.usefixtures("project")
def test_an_export_that_cannot_begin_says_why(window, tmp_path):
    out = tmp_path / "file"
    out.write_bytes(b"")
    window.act(exporting.start_export, out)
    window.settle()
    assert window.session.export.run is None
    assert any("it is a file" in text for text in texts(window))


def crash(window, project):
    """End without a farewell while there is unsaved work, and start again; what it goes by."""
    window.clock.now += SECONDS
    project.file.autosaved = None
    autosaving.autosave(window.session)
    window.settle()
    window.session.settings.autosave = Autosave(window.folder)
    for lock in window.folder.glob("unsaved-*.lock"):
        lock.unlink()
    window.session.project = None
    recovery.ask_recovery(window.session)
    window.frames(3)
    (leftover,) = find_recoverable_files(window.folder)
    return load_recoverable_file(leftover)[1]


def test_unsaved_work_comes_back_after_a_crash(window, project):
    crashed = Autosave(window.folder)
    crashed.write(project.document, project.file.origin)
    (orphan,) = window.folder.glob("unsaved-*.lissom")
    assert find_recoverable_files(window.folder) == []
    orphan.with_suffix(".lock").unlink()
    assert find_recoverable_files(window.folder) == [orphan]
    window.session.project = None
    recovery.ask_recovery(window.session)
    window.frames(3)
    assert window.session.dialogs.current is not None
    window.session.dialogs.current = None
    recovery.recover_file(window.session, orphan)
    window.settle()
    recovered = window.session.project
    assert recovered is not None
    assert not recovered.history.is_saved
    assert not orphan.exists()
    crashed.remove()


def test_recovered_work_has_its_name_and_goes_back_to_its_file_once_that_was_shown(
    window, project, tmp_path
):
    path = tmp_path / "posed.lissom"
    saving.write_project(window.session, path, None)
    window.settle()
    saved = path.read_bytes()
    place = complex(*project.document.canvas) / 2
    window.act(add_handle, place)
    window.settle()
    crash(window, project)

    window.run(lambda robot: robot.item_click("//###dialog/**/Open"))
    window.settle()
    recovered = window.session.project
    assert window_title(window.session) == "posed.lissom* – Lissom"
    assert (recovered.file.name, recovered.file.path) == ("posed", path)
    assert len(recovered.layer.handles) == 1
    assert any("posed.lissom" in text for text in texts(window))
    assert path.read_bytes() == saved
    # A second crash finds it again.
    assert crash(window, recovered) == (recovered.file.name, path)
    window.run(lambda robot: robot.item_click("//###dialog/**/Open"))
    window.settle()

    window.act(saving.save)
    window.frames(2)
    dialog = window.session.dialogs.current
    assert isinstance(dialog, FileDialog)
    assert dialog.writes
    assert dialog.folder / dialog.name == path
    assert path.read_bytes() == saved
    dialog.chosen(path).apply(window.session)
    window.session.dialogs.current = None
    window.settle()
    assert window_title(window.session) == "posed.lissom – Lissom"
    assert len(load_project(path).layers[0].handles) == 1
    assert find_recoverable_files(window.folder) == []

    window.act(add_handle, place / 2)
    window.settle()
    window.act(saving.save)
    window.settle()
    assert window.session.dialogs.current is None
    assert len(load_project(path).layers[0].handles) == 2


def test_recovered_work_on_a_picture_has_its_name_and_no_file(window, project):
    window.act(add_handle, complex(*project.document.canvas) / 2)
    window.settle()
    assert crash(window, project) == ("bar", None)
    window.run(lambda robot: robot.item_click("//###dialog/**/Open"))
    window.settle()
    assert window_title(window.session) == "bar* – Lissom"
    assert window.session.project.file.path is None


@pytest.fixture
def saved(window, project, tmp_path):
    """A project that is saved in a file, and open."""
    path = tmp_path / "a.lissom"
    saving.write_project(window.session, path, None)
    window.settle()
    assert window.session.project is project
    return path


def question(window):
    dialog = window.session.dialogs.current
    assert isinstance(dialog, Question)
    return dialog


def answer(window, text):
    window.run(lambda robot: robot.item_click(f"//###dialog/**/{text}"))
    window.settle()


def test_a_file_that_another_window_has_open_is_opened_only_after_a_question(window, saved):
    saving.set_project(window.session, None)
    other = FileLock(saved)
    files.open_file(window.session, saved)
    window.settle()
    assert window.session.project is None
    assert "a.lissom is already open by" in question(window).text
    answer(window, "Cancel")
    assert window.session.project is None

    files.open_file(window.session, saved)
    window.settle()
    answer(window, "Open a copy")
    assert window.session.project.file.path is None
    assert window.session.project.file.name == "a"

    files.open_file(window.session, saved)
    window.settle()
    answer(window, "Open anyway")
    assert window.session.project.file.path == saved
    other.release()


def test_a_file_is_held_while_it_is_open_and_no_longer(window, saved, tmp_path):
    with pytest.raises(FileLockedError):
        FileLock(saved)
    # It is no other window's.
    files.open_file(window.session, saved)
    window.settle()
    assert window.session.dialogs.current is None
    elsewhere = tmp_path / "b.lissom"
    saving.write_project(window.session, elsewhere, None)
    window.settle()
    FileLock(saved).release()
    with pytest.raises(FileLockedError):
        FileLock(elsewhere)
    window.act(saving.discard_project)
    FileLock(elsewhere).release()
    assert {path.name for path in tmp_path.iterdir()} == {"a.lissom", "b.lissom"}


def test_file_opens_with_a_notice_when_it_cannot_be_locked(window, saved, monkeypatch):
    def no_locks(_):
        raise OSError(errno.ENOLCK, "No locks available")

    saving.set_project(window.session, None)
    monkeypatch.setattr("app.storage.files.file_lock.lock", no_locks)
    files.open_file(window.session, saved)
    window.settle()
    assert window.session.project.file.path == saved
    assert any("No locks available" in text for text in texts(window))


def test_what_somebody_else_saved_meanwhile_is_replaced_only_after_a_question(
    window, project, saved
):
    other = load_project(saved)
    ours = replace(other, fps=12.0)
    save_project(saved, ours)
    theirs = saved.read_bytes()
    window.act(add_handle, complex(*project.document.canvas) / 2)
    window.settle()
    window.act(saving.save)
    window.settle()
    assert "Another window or program has changed a.lissom" in question(window).text
    answer(window, "Save as…")
    assert isinstance(window.session.dialogs.current, FileDialog)
    window.session.dialogs.current = None
    assert saved.read_bytes() == theirs
    assert not project.history.is_saved
    window.act(saving.save)
    window.settle()
    answer(window, "Replace")
    assert len(load_project(saved).layers[0].handles) == 1
    window.act(add_handle, complex(*project.document.canvas) / 3)
    window.settle()
    window.act(saving.save)
    window.settle()
    assert window.session.dialogs.current is None
    assert len(load_project(saved).layers[0].handles) == 2


def test_a_file_that_was_only_copied_or_touched_is_no_other_one(window, project, saved):
    content = saved.read_bytes()
    saved.unlink()
    saved.write_bytes(content)
    os.utime(saved, (2e9, 2e9))
    window.act(add_handle, complex(*project.document.canvas) / 2)
    window.settle()
    window.act(saving.save)
    window.settle()
    assert window.session.dialogs.current is None
    assert len(load_project(saved).layers[0].handles) == 1


def test_removed_folder_is_reported_and_the_work_stays(window, project, saved):
    for path in saved.parent.iterdir():
        path.unlink()
    saved.parent.rmdir()
    window.act(add_handle, complex(*project.document.canvas) / 2)
    window.settle()
    window.act(saving.save)
    window.settle()
    assert any(NO_FOLDER.format(folder=saved.parent) in text for text in texts(window))
    assert not project.history.is_saved
    saved.parent.mkdir()
    window.act(saving.save)
    window.settle()
    assert project.history.is_saved
    assert saved.exists()


def test_unsaved_work_that_could_not_be_kept_is_kept_as_soon_as_there_is_room(
    window, project, monkeypatch
):
    def full(*_):
        raise OSError(errno.ENOSPC, "No space left on device")

    window.act(add_handle, complex(*project.document.canvas) / 2)
    window.settle()
    window.session.settings.autosave.remove()
    with monkeypatch.context() as patch:
        patch.setattr("app.storage.files.atomic.os.fsync", full)
        project.file.autosaved = None
        window.clock.now += SECONDS
        window.settle()
        assert any("Unsaved work cannot be autosaved" in text for text in texts(window))
        window.session.notices.toasts = []
        window.clock.now += SECONDS
        window.settle()
        assert texts(window) == []  # it was reported
    assert list(window.folder.glob("unsaved-*.lissom")) == []
    window.clock.now += SECONDS
    window.settle()
    assert len(list(window.folder.glob("unsaved-*.lissom"))) == 1


def test_older_work_that_waits_to_be_kept_does_not_replace_what_was_kept_at_once(
    window, project, end
):
    middle = complex(*project.document.canvas) / 2
    window.act(add_handle, middle)
    window.settle()
    window.session.settings.autosave.remove()
    project.file.autosaved = None
    busy = Job(kind=JobKind("Busy", lane="keep"), work=end.wait, done=lambda _: None, failed=print)
    window.session.jobs.put(busy)
    window.clock.now += SECONDS
    window.frames(2)
    assert autosaving.AUTOSAVING in window.session.jobs.kinds
    window.act(add_handle, middle + 50)
    autosaving.autosave_now(window.session)
    end.set()
    window.settle()
    (kept,) = window.folder.glob("unsaved-*.lissom")
    assert len(load_recoverable_file(kept)[0].layers[0].handles) == 2


def test_every_unsaved_work_is_offered_whenever_it_was_kept(window, project):
    for number, time in enumerate((1e9, 1e18, -1e9)):
        path = window.folder / f"unsaved-{number}.lissom"
        keeper = Autosave(window.folder)
        keeper._path = path
        keeper.write(project.document, SourceInfo(f"work {number}", None))
        os.close(keeper._lock)
        with suppress(OSError, OverflowError):
            os.utime(path, (time, time))
    saving.set_project(window.session, None)
    recovery.ask_recovery(window.session)
    window.frames(3)
    dialog = window.session.dialogs.current
    assert isinstance(dialog, RecoveryDialog)
    assert {each.origin.name for each in dialog.candidates} == {"work 0", "work 1", "work 2"}
    answer(window, "Discard")
    assert len(window.session.dialogs.current.candidates) == 2
    answer(window, "Later")
    assert window.session.dialogs.current is None
    window.run(lambda robot: robot.menu_click("//##MainMenuBar/File/Unsaved work…"))
    assert len(window.session.dialogs.current.candidates) == 2
    answer(window, "Open")
    assert window.session.project is not None
    assert len(find_recoverable_files(window.folder)) == 1
    remove_recoverable_file(find_recoverable_files(window.folder)[0])
    window.act(recovery.show_recovery)
    assert any("no unsaved work" in text for text in texts(window))


def test_a_worker_that_never_ends_can_be_cancelled_and_nothing_waits_for_it(
    window, project, tmp_path, monkeypatch, end
):
    monkeypatch.setattr(window.session.jobs, "_clock", window.clock)
    monkeypatch.setattr(
        "app.editor.actions.project_files.files.open_picture", lambda *_: end.wait()
    )
    files.open_file(window.session, sample_images() / "bar.png")
    window.frames(3)
    # What is kept does not wait for it.
    saving.write_project(window.session, tmp_path / "a.lissom", None)
    window.until(lambda: project.file.path is not None)
    assert (tmp_path / "a.lissom").exists()
    window.until(lambda: autosaving.WRITING not in window.session.jobs.kinds)
    window.clock.now += ENDLESS
    window.frames(3)
    assert [kind.label for kind in window.session.jobs.running_for(ENDLESS)] == ["Opening bar.png"]
    window.run(lambda robot: robot.item_click("//**/Cancel"))
    window.settle()
    assert any("bar.png cannot be opened: it was cancelled" in text for text in texts(window))
    assert window.session.project is project
    end.set()


def test_a_save_does_not_wait_for_ever_for_a_pose_that_never_settles(
    window, project, tmp_path, monkeypatch, end
):
    window.act(add_handle, complex(*project.document.canvas) / 2)
    window.settle()
    monkeypatch.setattr("app.editor.actions.posing.pose_solver._take_steps", lambda *_: end.wait())
    set_targets(window.session, {0: Target(position=complex(*project.document.canvas) / 3)})
    # What may wait longer is no obstacle.
    window.act(exporting.start_export, tmp_path / "frames")
    window.act(saving.write_project, tmp_path / "a.lissom", None)
    window.frames(3)
    assert not (tmp_path / "a.lissom").exists()
    window.clock.now += saving.PATIENCE
    window.until(lambda: project.file.path is not None)
    assert (tmp_path / "a.lissom").exists()
    window.act(stage_jobs.give_up, POSING)
    end.set()
    window.settle()
    assert any(CANCELLED in text for text in texts(window))


@pytest.mark.parametrize("has_room", [True, False])
def test_failing_graphics_driver_is_reported(window, project, monkeypatch, has_room):
    window.act(add_handle, complex(*project.document.canvas) / 2)
    window.settle()
    window.session.settings.autosave.remove()
    project.file.autosaved = None

    def lost(*_, **__):
        raise RuntimeError("the context was lost")

    def full(*_):
        raise OSError(errno.ENOSPC, "No space left on device")

    with monkeypatch.context() as patch:
        patch.setattr(Canvas, "draw", lost)
        if not has_room:
            patch.setattr("app.storage.files.atomic.os.fsync", full)
        window.frames(3)
    (text,) = (text for text in texts(window) if "the context was lost" in text)
    assert ("work was kept" in text) is has_room
    assert ("work could not be kept" in text) is not has_room
    window.session.notices.toasts = []
    kept = list(window.folder.glob("unsaved-*.lissom"))
    assert len(kept) == has_room
    assert all(len(load_recoverable_file(each)[0].layers[0].handles) == 1 for each in kept)
    window.frames(3)
    assert texts(window) == []
