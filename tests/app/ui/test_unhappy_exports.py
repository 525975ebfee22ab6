"""Exports that are cancelled, fail midway, or outlive their project."""

import errno
import gc
import itertools
import os
import re
import sys
import threading
import weakref
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from harness import MOST_FRAMES, PATIENCE, Harness
from imgui_bundle import hello_imgui
from messages import says
from PIL import Image

from app.document import PreviewPose, scene_commands, shape_commands
from app.document.settings import ExportSettings, FrameRange
from app.editor.actions import editing, playback
from app.editor.actions.layer_setup import cut_out_editing
from app.editor.actions.posing.handles import add_handle, remove_handles
from app.editor.actions.project_files import autosaving, export_settings, exporting, files, saving
from app.editor.actions.timing import keys
from app.editor.layering import pictures
from app.editor.parts.dialogs import Question
from app.export.writers.gif import GifWriter
from app.export.writers.png import PngSequence
from app.export.writers.video import VideoWriter
from app.motion import layer_stages
from app.motion.inbetweens import pose_sampler
from app.storage import SAME_FILE
from app.storage.assets import sample_images
from app.ui.dialogs.native_dialog import REPLACE
from app.ui.window import exporter

BAR = sample_images() / "bar.png"
SIZE = (120, 40)
FRAMES = 9
# Seconds after which whoever waits for a worker that waits itself would wait forever. No export
# takes as long, on a machine of any speed.
DEADLOCK = 4 * PATIENCE


@pytest.fixture
def project(window):
    """A bar with a handle and nine frames; each takes more than half of an export's share."""
    project = window.again(Harness.open, BAR)
    add_handle(window.session, complex(*project.document.canvas) / 2)
    keys.set_last_frame(window.session, FRAMES - 1)
    editing.edit_document(window.session, scene_commands.set_export(ExportSettings(size=SIZE)))
    window.settle()
    window.clock.cost = 0.6 * exporter.BUDGET
    yield project
    window.clock.cost = 0.0


def begin(window, out, count=3):
    """Start an export, and wait until some of its frames are drawn."""
    session = window.session
    window.act(exporting.start_export, out)
    window.until(lambda: session.export.run is not None and session.export.run.done >= count)


def finish(window):
    window.until(lambda: window.session.export.run is None)
    window.settle()


def texts(window):
    return [toast.text for toast in window.session.notices.toasts]


def is_whole(path):
    with Image.open(path) as picture:
        picture.load()
        return picture.size == SIZE


@pytest.mark.usefixtures("project")
def test_window_gives_an_export_a_share_of_each_frame_and_never_idles_meanwhile(
    window, tmp_path, monkeypatch
):
    session, awake = window.session, []
    monkeypatch.setattr(hello_imgui, "request_refresh", lambda: awake.append(True))
    saving.write_project(
        session, tmp_path / "saved.lissom", None
    )  # no autosave is to keep it awake
    window.settle()
    window.act(exporting.start_export, tmp_path / "frames")
    session.jobs.wait_until_idle()
    session.notices.toasts = []
    steps = []
    for _ in range(MOST_FRAMES):
        awake.clear()
        window.frames()
        if session.export.run is None:
            break
        if steps:
            assert set(session.jobs.kinds) <= {autosaving.WRITING}
            assert awake
        steps.append(session.export.run.done)
    assert steps[-1] == FRAMES
    assert max(np.diff([0, *steps])) <= 2  # of them use the share up
    session.notices.toasts = []
    window.frames(40)  # what it leads to is drawn yet
    awake.clear()
    window.frames(2)
    assert not awake


def question(window):
    """Return the open question, whatever it is about."""
    dialog = window.session.dialogs.current
    assert isinstance(dialog, Question), dialog
    return dialog


def answer(window, text):
    window.run(lambda robot: robot.item_click(f"//###dialog/{text}"))
    window.frames(2)


@pytest.mark.usefixtures("project")
def test_frames_that_are_there_are_replaced_only_after_a_question(window, tmp_path):
    out = tmp_path / "frames"
    out.mkdir()
    (out / "frame_0003.png").write_bytes(b"precious")
    (out / "frame_0005.png").write_bytes(b"precious")
    window.act(exporting.start_export, out)
    window.settle()
    assert window.session.export.run is None
    assert question(window).title == "Replace the 2 files?"
    assert "frame_0003.png … frame_0005.png" in question(window).text
    answer(window, "Cancel")
    assert (out / "frame_0003.png").read_bytes() == b"precious"
    assert len(list(out.iterdir())) == 2
    window.act(exporting.start_export, out)
    answer(window, "Replace")
    window.settle()
    finish(window)
    assert len(list(out.iterdir())) == FRAMES
    assert all(map(is_whole, out.iterdir()))
    # They are this export's own now.
    window.act(export_settings.repeat_export)
    assert window.session.dialogs.current is None
    window.settle()
    finish(window)


def test_another_format_asks_before_it_replaces_a_file(window, project, tmp_path):
    editing.edit_document(
        window.session, scene_commands.set_export(ExportSettings(format="gif", size=SIZE))
    )
    window.act(export_settings.start_export_at, tmp_path / "bar.gif")
    window.settle()
    finish(window)
    (tmp_path / "bar.webp").write_bytes(b"precious")
    editing.edit_document(
        window.session, scene_commands.set_export(ExportSettings(format="webp", size=SIZE))
    )
    window.act(export_settings.repeat_export)
    assert question(window).title == REPLACE
    answer(window, "Cancel")
    assert (tmp_path / "bar.webp").read_bytes() == b"precious"
    assert project.exports.by_format == {"gif": tmp_path / "bar.gif"}


def test_dots_in_the_name_of_a_folder_are_no_endings(window, project, tmp_path):
    export_settings.set_export_destination(window.session, tmp_path / "shot.010")
    window.act(export_settings.repeat_export)
    window.settle()
    finish(window)
    assert [path.name for path in tmp_path.iterdir()] == ["shot.010"]
    assert project.exports.by_format == {"png": tmp_path / "shot.010"}


def test_cancelled_frames_are_whole_and_the_next_export_works(window, project, tmp_path):
    out = tmp_path / "frames"
    begin(window, out)
    window.until(lambda: any(out.glob("frame_*.png")))
    window.act(exporting.cancel_export)
    window.settle()
    assert window.session.export.run is None
    written = sorted(out.iterdir())
    assert [path.name for path in written] == [f"frame_{i:04d}.png" for i in range(len(written))]
    assert 0 < len(written) < FRAMES
    assert all(map(is_whole, written))
    assert exporting.CANCELLED_MIDWAY in texts(window)
    before = project.document
    remove_handles(window.session, frozenset({0}))
    assert project.document is not before
    window.act(exporting.start_export, out)
    window.settle()
    finish(window)
    written = sorted(out.iterdir())
    assert len(written) == FRAMES
    assert all(map(is_whole, written))


@pytest.mark.usefixtures("project")
@pytest.mark.parametrize("name", ["film.apng", "film.webp", "sheet.png", "film.webm"])
def test_cancelled_file_is_not_there(window, tmp_path, name):
    format_ = "spritesheet" if name == "sheet.png" else name.split(".")[1]
    editing.edit_document(
        window.session, scene_commands.set_export(ExportSettings(format=format_, size=SIZE))
    )
    begin(window, tmp_path / name)
    assert list(tmp_path.iterdir()) != []
    window.act(exporting.cancel_export)
    window.settle()
    assert list(tmp_path.iterdir()) == []
    assert exporting.CANCELLED_UNWRITTEN in texts(window)
    window.act(exporting.start_export, tmp_path / name)
    window.settle()
    finish(window)
    beside = ["sheet.json"] if name == "sheet.png" else []
    assert sorted(path.name for path in tmp_path.iterdir()) == [*beside, name]


def test_export_is_cancelled_while_it_is_prepared(window, project, tmp_path):
    exporting.start_export(window.session, tmp_path / "frames")
    exporting.cancel_export(window.session)
    window.settle()
    assert window.session.export.run is None
    assert not project.exports.by_format
    assert list(tmp_path.iterdir()) == []


class Held:
    """A worker that comes to a place as the first: it waits until it is let go on.

    Where the window waits for it meanwhile, it waits in vain.
    """

    def __init__(self) -> None:
        self.begun, self.end = threading.Event(), threading.Event()
        self.has_waited_in_vain = False

    def wait(self) -> None:
        if not self.begun.is_set():
            self.begun.set()
            self.has_waited_in_vain = not self.end.wait(DEADLOCK)


@pytest.fixture
def held(monkeypatch):
    """Returns the worker that is held where it calls a function of a module."""
    every = []

    def hold(module, name, is_meant=lambda: True):
        real, held = getattr(module, name), Held()
        every.append(held)

        def waits(*given, **options):
            if is_meant():
                held.wait()
            return real(*given, **options)

        monkeypatch.setattr(module, name, waits)
        return held

    yield hold
    for held in every:
        held.end.set()


# The sites are prepared before an export is planned, intervals while it is made: each format is
# cancelled in one of both.
@pytest.mark.parametrize(
    ("name", "stage"),
    [
        ("frames", "intervals"),
        ("bar.gif", "sites"),
        ("sheet.png", "intervals"),
        ("bar.webm", "sites"),
        ("bar.html", "intervals"),
    ],
)
@pytest.mark.usefixtures("loose")
def test_cancel_is_answered_at_once_while_it_is_prepared(window, tmp_path, held, name, stage):
    session, out = window.session, tmp_path / name
    format_ = {"frames": "png", "sheet.png": "spritesheet"}.get(name, name[4:])
    few = FrameRange(0, FRAMES - 1)
    settings = ExportSettings(format=format_, size=SIZE, framing="canvas", frames=few)
    editing.edit_document(session, scene_commands.set_export(settings))
    window.settle()
    where = {
        "sites": (layer_stages, "PoseSampler"),
        "intervals": (pose_sampler, "prepare_inbetweens"),
    }
    worker = held(*where[stage])
    window.act(exporting.start_export, out)
    window.until(worker.begun.is_set)
    assert (session.export.run is None) == (stage == "sites")
    left = session.export.run and weakref.ref(session.export.run.evaluator.layers[0].store.mesh)
    window.act(exporting.cancel_export)
    window.frames()
    assert not worker.has_waited_in_vain
    assert session.export.run is None
    assert exporting.PREPARING not in session.jobs.kinds
    # Nothing is half there.
    written = [path for path in tmp_path.rglob("*") if path.is_file()]
    assert all(map(is_whole, written))
    stays = "Frames that were written stay" if written else "Nothing was written"
    assert f"The export was cancelled. {stays}." in texts(window)
    # The next one begins at once, and what was left takes no part in it.
    window.act(exporting.start_export, out)
    window.until(lambda: any("Exported" in text for text in texts(window)))
    assert not worker.has_waited_in_vain
    made = {path: path.stat().st_mtime_ns for path in tmp_path.rglob("*")}
    worker.end.set()
    assert not any(exporting.PREPARING.complaint in text for text in texts(window))
    window.until(lambda: left is None or is_gone(left))
    window.until(lambda: not session.jobs.abandoned_count)
    assert {path: path.stat().st_mtime_ns for path in tmp_path.rglob("*")} == made


def is_gone(reference):
    gc.collect()
    return reference() is None


WRITERS = {"png": PngSequence, "mp4": VideoWriter, "gif": GifWriter}
# At which frame, and where in its way to the disk, the worker is when the hand cancels: each of
# these in one format, and each format at one with frames before it and at one without.
STAGES = {
    "the first is encoded": ("encode", 0, "bar.mp4"),
    "the first is written": ("add", 0, "frames"),
    "one in the middle is written": ("add", FRAMES // 2, "bar.gif"),
    "the last is encoded": ("encode", FRAMES - 1, "frames"),
    "the last is written": ("add", FRAMES - 1, "bar.mp4"),
    "the end is written": ("finish", 0, "bar.gif"),
}


@pytest.mark.parametrize("stage", STAGES)
@pytest.mark.usefixtures("project")
def test_cancel_is_answered_at_once_whatever_frame_is_made(window, tmp_path, held, stage):
    verb, at, name = STAGES[stage]
    session, out = window.session, tmp_path / name
    format_ = "png" if name == "frames" else name[4:]
    settings = ExportSettings(format=format_, size=SIZE, background="#ffffff")
    editing.edit_document(session, scene_commands.set_export(settings))
    window.settle()
    calls = itertools.count()
    worker = held(WRITERS[format_], verb, lambda: next(calls) == at)
    window.act(exporting.start_export, out)
    window.until(worker.begun.is_set)
    window.frames(20)  # what can be drawn until then, is
    run = session.export.run
    assert run is not None
    assert at <= run.done <= FRAMES
    window.act(exporting.cancel_export)
    window.frames()
    assert not worker.has_waited_in_vain
    assert session.export.run is None
    worker.end.set()
    window.until(lambda: not export_threads())
    window.frames()
    written = sorted(path for path in tmp_path.rglob("*") if path.is_file())
    if format_ == "png":
        assert [path.name for path in written] == [
            f"frame_{i:04d}.png" for i in range(len(written))
        ]
        assert all(map(is_whole, written))
    else:
        assert written == []
    message = exporting.CANCELLED_MIDWAY if written else exporting.CANCELLED_UNWRITTEN
    assert message in texts(window)
    window.act(exporting.start_export, out)
    window.until(lambda: any("Exported 9 frames" in text for text in texts(window)))


@pytest.mark.usefixtures("project")
@pytest.mark.parametrize("name", ["bar.glb", "bar.gif", "pose.png"])
def test_a_late_cancel_says_what_is_so(window, tmp_path, held, name):
    """Until the disk has all of a file it can be cancelled; then a message says it is there."""
    session, out = window.session, tmp_path / name
    format_ = "picture" if name == "pose.png" else name[4:]
    editing.edit_document(
        session, scene_commands.set_export(ExportSettings(format=format_, size=SIZE))
    )
    worker = held(os, "fsync", is_of_an_export)
    window.act(exporting.start_export, out)
    window.until(worker.begun.is_set)
    window.act(exporting.cancel_export)
    assert not worker.has_waited_in_vain
    assert exporting.CANCELLED_UNWRITTEN in texts(window)
    assert list(tmp_path.iterdir()) == []
    worker.end.set()
    window.until(lambda: not export_threads())
    assert list(tmp_path.iterdir()) == []
    worker, session.notices.toasts = held(Path, "replace", is_of_an_export), []
    window.act(exporting.start_export, out)
    window.until(worker.begun.is_set)
    window.act(exporting.cancel_export)
    assert session.export.run is not None
    worker.end.set()
    finish(window)
    assert not any("cancelled" in text for text in texts(window))
    assert any("Exported" in text for text in texts(window))
    assert list(tmp_path.iterdir()) == [out]


@pytest.mark.usefixtures("project")
def test_a_sheet_and_its_data_are_both_there_or_neither(window, tmp_path, held):
    session, out = window.session, tmp_path / "sheet.png"
    editing.edit_document(
        session, scene_commands.set_export(ExportSettings(format="spritesheet", size=SIZE))
    )
    worker = held(Path, "replace", is_of_an_export)
    window.act(exporting.start_export, out)
    window.until(worker.begun.is_set)
    window.act(exporting.cancel_export)
    worker.end.set()
    finish(window)
    assert any("Exported" in text for text in texts(window))
    assert sorted(tmp_path.iterdir()) == [tmp_path / "sheet.json", out]


def is_of_an_export(thread=None):
    return "ThreadPoolExecutor" in (thread or threading.current_thread()).name


def export_threads():
    return list(filter(is_of_an_export, threading.enumerate()))


@pytest.mark.usefixtures("project")
def test_quitting_asks_about_an_export_that_runs(window, tmp_path, held):
    session = window.session
    saving.write_project(session, tmp_path / "saved.lissom", None)
    window.settle()
    calls = itertools.count()
    # It lasts longer than the answers.
    worker = held(PngSequence, "add", lambda: next(calls) == 3)
    begin(window, tmp_path / "frames")
    window.until(worker.begun.is_set)
    window.act(saving.request_quit)
    assert not session.is_quitting
    assert question(window).title == exporting.RUNNING
    answer(window, "Cancel")
    assert session.export.run is not None
    window.act(saving.request_quit)
    answer(window, "Quit")
    assert session.is_quitting
    session.is_quitting = False
    hello_imgui.get_runner_params().app_shall_exit = False
    exporting.cancel_export(session)
    worker.end.set()
    window.until(lambda: not export_threads())


def test_disk_that_gets_full_midway_ends_the_export(window, project, tmp_path, monkeypatch):
    out = tmp_path / "frames"
    sync, written = os.fsync, []

    def full_after_three(file):
        written.append(file)
        if len(written) > 3:
            raise OSError(errno.ENOSPC, "No space left on device")
        sync(file)

    with monkeypatch.context() as patch:
        patch.setattr("app.storage.files.atomic.os.fsync", full_after_three)
        begin(window, out, count=1)
        finish(window)
    (text,) = (text for text in texts(window) if "export" in text)
    assert "No space left" in text
    left = list(out.iterdir())
    assert len(left) <= 3
    assert all(path.suffix == ".png" for path in left)
    assert all(map(is_whole, left))
    assert window.session.project is project
    window.act(export_settings.repeat_export)
    window.settle()
    finish(window)
    assert len(list(out.iterdir())) == FRAMES


@pytest.mark.usefixtures("project")
def test_frame_that_cannot_be_drawn_ends_the_export(window, tmp_path, monkeypatch):
    def broken(*_, **__):
        raise ZeroDivisionError("a bug")

    with monkeypatch.context() as patch:
        patch.setattr("app.export.writers.png.encode_png", broken)
        window.act(exporting.start_export, tmp_path / "frames")
        window.settle()
        finish(window)
    (toast,) = (toast for toast in window.session.notices.toasts if toast.details)
    assert "a bug" in toast.details
    window.session.notices.toasts = []
    assert window.session.export.run is None
    assert list((tmp_path / "frames").iterdir()) == []
    window.act(export_settings.repeat_export)
    window.settle()
    finish(window)
    assert len(list((tmp_path / "frames").iterdir())) == FRAMES


@pytest.mark.usefixtures("project")
def test_export_goes_on_when_another_project_is_opened(window, tmp_path):
    out = tmp_path / "frames"
    begin(window, out)
    saving.discard_project(window.session)
    window.frames(2)
    files.open_file(window.session, sample_images() / "s.png")
    window.settle()
    other = window.session.project
    assert other.file.name == "s"
    finish(window)
    assert len(list(out.iterdir())) == FRAMES
    assert all(map(is_whole, out.iterdir()))
    assert not other.exports.by_format
    assert other.document.export == ExportSettings()
    assert any("Exported 9 frames" in text for text in texts(window))


@pytest.mark.usefixtures("project")
def test_second_export_waits_for_the_first(window, tmp_path):
    begin(window, tmp_path / "first")
    window.act(exporting.start_export, tmp_path / "second")
    window.settle()
    finish(window)
    assert [path.name for path in tmp_path.iterdir()] == ["first"]


@pytest.mark.usefixtures("everything")
def test_export_and_in_betweens_of_the_window_do_not_wait_for_each_other(window, project, tmp_path):
    editing.edit_layer(window.session, shape_commands.set_variant, "nu")
    keys.insert_key_in_row_at(window.session, FRAMES - 1)
    window.settle()
    sampler = project.layer_runtime.store.sampler
    known = dict(sampler._samples)
    assert known
    with sampler._lock:  # as a worker has it while it prepares an interval
        window.act(exporting.start_export, tmp_path / "frames")
        window.settle()
        finish(window)
    assert len(list((tmp_path / "frames").iterdir())) == FRAMES
    remove_handles(window.session, frozenset({0}))
    window.act(exporting.start_export, tmp_path / "more frames")
    window.session.jobs.wait_until_idle()
    # In-betweens of the same maps, whatever handles they have.
    assert {id(pose.phi) for pose in sampler._samples} == {id(pose.phi) for pose in known}


def test_picture_may_go_once_it_is_open(window, tmp_path):
    picture = tmp_path / "gone.png"
    picture.write_bytes(BAR.read_bytes())
    window.open(picture)
    picture.unlink()
    path = tmp_path / "kept.lissom"
    saving.write_project(window.session, path, None)
    keys.set_last_frame(window.session, 2)
    window.act(exporting.start_export, tmp_path / "frames")
    window.settle()
    finish(window)
    assert len(list((tmp_path / "frames").iterdir())) == 3
    reopened = window.open(path)
    assert reopened.document.layers[0].picture.data == BAR.read_bytes()


@pytest.mark.usefixtures("project")
@pytest.mark.parametrize("name", ["bar.glb", "bar.html"])
def test_models_are_exported_and_cancelled_as_all_else(window, tmp_path, name):
    session = window.session
    editing.edit_document(
        session, scene_commands.set_export(ExportSettings(format=name[4:], size=SIZE))
    )
    window.act(exporting.start_export, tmp_path / name)
    session.jobs.wait_until_idle()
    window.frames()
    window.act(exporting.cancel_export)
    window.settle()
    assert list(tmp_path.iterdir()) == []
    assert exporting.CANCELLED_UNWRITTEN in texts(window)
    window.act(exporting.start_export, tmp_path / name)
    window.settle()
    finish(window)
    assert (tmp_path / name).stat().st_size > 1000
    assert f"Exported {name}." in texts(window)


@pytest.fixture
def clipboard(tmp_path, monkeypatch):
    """A clipboard that is a file, by the program of X servers."""
    if sys.platform != "linux":
        pytest.skip("the clipboard of Linux")
    kept, programs = tmp_path / "kept.png", tmp_path / "programs"
    programs.mkdir()
    (programs / "xclip").write_text(f"#!/bin/sh\ncat > {kept}\n")
    (programs / "xclip").chmod(0o755)
    monkeypatch.setenv("PATH", f"{programs}:{os.environ['PATH']}")
    monkeypatch.setenv("DISPLAY", ":7")
    monkeypatch.delenv("WAYLAND_DISPLAY", raising=False)
    return kept


def test_the_pose_that_is_shown_is_exported_and_copied(window, project, tmp_path, clipboard):
    session = window.session
    editing.edit_document(
        session,
        scene_commands.set_export(ExportSettings(format="picture", size=SIZE, framing="canvas")),
    )
    playback.seek(session, 4)
    window.settle()
    rest = project.layer.keys[0].pose
    moved = replace(rest, phi=rest.phi + 20)
    project.history.set_preview_pose(
        PreviewPose(layer=project.selection.active, frame=4, pose=moved)
    )
    assert project.unkeyed_pose is moved
    out = tmp_path / "pose.png"

    def exported():
        window.settle()
        finish(window)
        assert is_whole(out)
        with Image.open(out) as image:
            return np.asarray(image).astype(int)

    window.act(exporting.start_export, out)
    shifted = exported()
    editing.undo(session)
    window.act(exporting.start_export, out)
    assert question(window).title == REPLACE
    answer(window, "Replace")
    pixels = exported()
    assert np.abs(pixels - shifted).max() > 50
    window.act(exporting.copy_picture)
    window.settle()
    finish(window)
    assert "The picture is on the clipboard." in texts(window)
    with Image.open(clipboard) as image:
        assert np.array_equal(np.asarray(image), pixels)
    assert [path for path in session.settings.folder.iterdir() if path.suffix == ".png"] == []
    assert project.exports.by_format["picture"] == out


@pytest.mark.usefixtures("project")
def test_missing_clipboard_program_is_reported(window, monkeypatch, tmp_path):
    monkeypatch.setenv("PATH", str(tmp_path))
    monkeypatch.setattr("sys.platform", "linux")
    window.act(exporting.copy_picture)
    assert window.session.export.run is None
    assert any("sudo apt install xclip" in text for text in texts(window)), texts(window)


def test_nothing_is_written_over_what_the_project_was_made_from(window, tmp_path):
    drawing, layer, saved = (tmp_path / name for name in ("a.png", "b.png", "walk.json"))
    drawing.write_bytes(BAR.read_bytes())
    layer.write_bytes(BAR.read_bytes())
    session, project = window.session, window.open(drawing)
    pictures.add_layers(session, [layer])
    window.settle()
    saving.write_project(session, saved, None)
    window.settle()
    (link := tmp_path / "link.png").symlink_to(layer)
    before = {path: path.read_bytes() for path in (drawing, layer, saved)}

    def refused(action, *arguments):
        session.notices.toasts = []
        window.act(action, *arguments)
        window.settle()
        assert session.export.run is None
        texts = [toast.text + toast.details for toast in session.notices.toasts]
        assert any(re.search(says(SAME_FILE), text, re.IGNORECASE) for text in texts), texts
        assert {path: path.read_bytes() for path in before} == before

    editing.edit_document(
        session, scene_commands.set_export(ExportSettings(format="picture", size=SIZE))
    )
    for out in (drawing, link):
        refused(export_settings.start_export_at, out)
        refused(cut_out_editing.save_mask, out)
        refused(saving.write_project, out, None)
    refused(cut_out_editing.save_mask, saved)
    editing.edit_document(
        session, scene_commands.set_export(ExportSettings(format="spritesheet", size=SIZE))
    )
    refused(export_settings.start_export_at, tmp_path / "walk.png")
    assert project.file.path == saved
