"""What goes wrong is told in words, and the window lives on."""

import errno

import pytest

from app.editor.actions import exporting, files, posing, saving
from app.editor.dialogs import FileDialog
from app.storage.assets import sample_images
from app.storage.autosave import SECONDS, Autosave, find_leftovers, load_leftover
from app.storage.project_file import load_project
from app.ui.timeline import timeline
from app.ui.window.title import window_title


@pytest.fixture
def project(window):
    return window.open(sample_images() / "bar.png")


def texts(window):
    return [toast.text for toast in window.session.toasts]


@pytest.mark.parametrize(
    ("name", "content", "reason"),
    [
        ("torn.png", b"\x89PNG\r\n\x1a\n and no more", "not a picture"),
        ("torn.lissom", b"PK no zip at all", "not a Lissom project"),
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
    saving.write(window.session, path, None)
    window.settle()
    before = path.read_bytes()

    def full(*_):
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr("app.storage.files.atomic.os.fsync", full)
    saving.write(window.session, path, None)
    window.settle()
    assert any("No space left" in text for text in texts(window))
    assert path.read_bytes() == before
    assert list(tmp_path.iterdir()) == [path]
    assert window.session.project is project


@pytest.mark.usefixtures("project")
def test_an_export_that_cannot_begin_says_why(window, tmp_path):
    out = tmp_path / "file"
    out.write_bytes(b"")
    window.act(exporting.start, out)
    window.settle()
    assert window.session.export is None
    assert any("it is a file" in text for text in texts(window))


@pytest.mark.usefixtures("project")
def test_a_panel_that_raises_is_told_and_the_rest_lives_on(window, monkeypatch, capfd):
    def broken(*_):
        raise ZeroDivisionError("a bug")

    monkeypatch.setattr(timeline, "draw_bar", broken)
    window.frames(3)
    (toast,) = window.session.toasts
    assert "Timeline" in toast.text
    assert "a bug" in toast.details
    window.session.toasts = []
    monkeypatch.undo()
    window.frames(3)
    assert window.session.toasts == []
    capfd.readouterr()


def crash(window, project):
    """End without a farewell while there is unsaved work, and start again; what it goes by."""
    window.clock.now += SECONDS
    project.autosaved = None
    saving.autosave(window.session)
    window.settle()
    window.session.autosave = Autosave(window.folder)
    for lock in window.folder.glob("unsaved-*.lock"):
        lock.unlink()
    window.session.project = None
    files.offer_recovery(window.session)
    window.frames(3)
    (leftover,) = find_leftovers(window.folder)
    return load_leftover(leftover)[1]


def test_unsaved_work_comes_back_after_a_crash(window, project):
    crashed = Autosave(window.folder)
    crashed.write(project.document, project.origin)
    (orphan,) = window.folder.glob("unsaved-*.lissom")
    assert find_leftovers(window.folder) == []
    orphan.with_suffix(".lock").unlink()
    assert find_leftovers(window.folder) == [orphan]
    window.session.project = None
    files.offer_recovery(window.session)
    window.frames(3)
    assert window.session.dialog is not None
    window.session.dialog = None
    files.recover(window.session, orphan)
    window.settle()
    recovered = window.session.project
    assert recovered is not None
    assert not recovered.history.is_saved
    assert not orphan.exists()
    crashed.forget()


def test_recovered_work_has_its_name_and_goes_back_to_its_file_once_that_was_shown(
    window, project, tmp_path
):
    path = tmp_path / "posed.lissom"
    saving.write(window.session, path, None)
    window.settle()
    saved = path.read_bytes()
    place = complex(*project.document.canvas) / 2
    window.act(posing.add_handle, place)
    window.settle()
    crash(window, project)

    window.run(lambda robot: robot.item_click("//###dialog/Open"))
    window.settle()
    recovered = window.session.project
    assert window_title(window.session) == "posed.lissom* – Lissom"
    assert (recovered.name, recovered.path) == ("posed", path)
    assert len(recovered.figure.handles) == 1
    assert any("posed.lissom" in text for text in texts(window))
    assert path.read_bytes() == saved
    # A second crash finds it again.
    assert crash(window, recovered) == (recovered.name, path)
    window.run(lambda robot: robot.item_click("//###dialog/Open"))
    window.settle()

    window.act(saving.save)
    window.frames(2)
    dialog = window.session.dialog
    assert isinstance(dialog, FileDialog)
    assert dialog.writes
    assert dialog.folder / dialog.name == path
    assert path.read_bytes() == saved
    dialog.chosen(path).apply(window.session)
    window.session.dialog = None
    window.settle()
    assert window_title(window.session) == "posed.lissom – Lissom"
    assert len(load_project(path).figures[0].handles) == 1
    assert find_leftovers(window.folder) == []

    window.act(posing.add_handle, place / 2)
    window.settle()
    window.act(saving.save)
    window.settle()
    assert window.session.dialog is None
    assert len(load_project(path).figures[0].handles) == 2


def test_recovered_work_on_a_picture_has_its_name_and_no_file(window, project):
    window.act(posing.add_handle, complex(*project.document.canvas) / 2)
    window.settle()
    assert crash(window, project) == ("bar", None)
    window.run(lambda robot: robot.item_click("//###dialog/Open"))
    window.settle()
    assert window_title(window.session) == "bar* – Lissom"
    assert window.session.project.path is None
