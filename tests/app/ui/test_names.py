"""Files whose names are not UTF-8, as Linux lets them be: the window shows and uses them."""

import os
import shutil
import subprocess
import sys
from functools import partial
from pathlib import Path

import pytest

from app.document import scene_commands
from app.document.settings import ExportSettings
from app.editor.action import do
from app.editor.actions import dialog_actions, editing
from app.editor.actions.project_files import export_settings, files, recovery, saving
from app.editor.actions.timing import keys
from app.editor.parts.dialogs import FileDialog
from app.storage.assets import sample_images
from app.storage.autosave import Autosave, SourceInfo
from app.storage.preferences import load_preferences
from app.storage.project_file import load_project

NAME, ALIKE = os.fsdecode(b"caf\xe9"), os.fsdecode(b"caf\xe8")
SHOWN = "caf\N{REPLACEMENT CHARACTER}"


@pytest.fixture
def folder(tmp_path):
    place = tmp_path / NAME
    try:
        place.mkdir()
    except OSError:
        pytest.skip("this system lets no name be anything but UTF-8")
    shutil.copy(sample_images() / "bar.png", place / f"{NAME}.png")
    return place


@pytest.fixture
def opened(window, folder):
    return window.open(folder / f"{NAME}.png")


def messages(window):
    """Return the messages, after some frames in which errors of drawing appear, too."""
    window.frames(3)
    return [toast.text for toast in window.session.notices.toasts]


def press(window, *names):
    for name in names:
        window.run(lambda robot, name=name: robot.key_press(int(window.Key[name])))
        window.frames(2)


def test_a_picture_is_opened_under_a_name_that_can_be_shown(window, opened):
    assert opened.file.name == opened.layer.name == SHOWN
    window.show_tab("Layers")
    assert messages(window) == []


@pytest.mark.usefixtures("opened")
def test_a_project_is_saved_and_found_among_the_recent_files(window, folder):
    path = folder / f"{NAME}.lissom"
    window.act(saving.write_project, path, None)
    window.settle()
    assert messages(window) == [f"Saved {SHOWN}.lissom."]
    assert load_project(path).layers[0].name == SHOWN
    window.act(saving.close_project)
    assert messages(window) == [f"Saved {SHOWN}.lissom."]
    window.settle()
    recent = (path, folder / f"{NAME}.png")
    assert (
        load_preferences(window.folder).recent
        == window.session.settings.preferences.recent
        == recent
    )

    def choose(robot):
        robot.set_ref("##MainMenuBar")
        robot.menu_click("File/Open recent/###recent 0")

    window.run(choose)
    window.settle()
    assert window.session.project.file.path == path
    assert window.session.project.file.name == SHOWN


@pytest.mark.usefixtures("opened")
def test_failures_and_questions_tell_the_name(window, folder):
    missing = folder / f"{ALIKE}.png"
    window.act(files.open_file, missing)
    window.settle()
    window.act(files.open_recent_file, missing)
    failed, gone = messages(window)
    assert failed.startswith(f"{SHOWN}.png cannot be opened: cannot read ")
    assert gone.startswith(f"{SHOWN}.png is no longer in ")
    window.act(saving.write_project, folder / f"{NAME}.lissom", None)
    window.settle()
    window.act(keys.set_last_frame, 7)
    window.act(saving.close_project)
    assert window.session.dialogs.current is not None
    window.run(lambda robot: robot.item_click("//###dialog/Don't save"))
    assert window.session.project is None
    assert len(messages(window)) == 3


def test_unsaved_work_is_offered_under_the_name(window, opened, folder):
    left = Autosave(window.folder)
    left.write(opened.document, SourceInfo(NAME, folder / f"{NAME}.lissom"))
    os.close(left._lock)  # as the system does when its process ends
    window.act(saving.discard_project)
    window.act(recovery.ask_recovery)
    (candidate,) = window.session.dialogs.current.candidates
    assert candidate.origin == SourceInfo(SHOWN, folder / f"{NAME}.lissom")
    assert messages(window) == []
    window.run(lambda robot: robot.item_click("//###dialog/**/Open"))
    window.settle()
    assert window.session.project.file.path == folder / f"{NAME}.lissom"
    assert len(messages(window)) == 1


@pytest.mark.parametrize("writes", [False, True])
def test_our_file_browser_lists_and_chooses_it(window, folder, writes):
    chosen = []
    shutil.copy(folder / f"{NAME}.png", folder / f"{ALIKE}.png")
    question = FileDialog(
        title="Which",
        folder=folder,
        name=f"{NAME}.png" if writes else "",
        suffixes=(".png",),
        writes=writes,
        chosen=lambda path: do(partial(note, chosen), path),
    )
    window.act(dialog_actions.show_dialog, question)
    window.frames(3)
    press(window, *([] if writes else ["down_arrow", "down_arrow"]), "enter")
    assert chosen == [folder / f"{NAME}.png"]
    assert messages(window) == []


def note(chosen, _, path):
    chosen.append(path)


@pytest.mark.usefixtures("opened")
@pytest.mark.parametrize(("kind", "ending"), [("html", ".html"), ("png", " frames")])
def test_an_export_goes_there(window, folder, kind, ending):
    name = f"{NAME}{ending}"
    window.act(keys.set_last_frame, 2)
    window.act(editing.edit_document, scene_commands.set_export(ExportSettings(format=kind)))
    window.show_tab("Export")
    window.act(export_settings.start_export_at, folder / name)
    window.until(lambda: window.session.notices.toasts)
    assert messages(window)[0].startswith("Exported ")
    assert (folder / name).exists()


DROP = """
import ctypes, os, sys
import imgui_bundle
import glfw
from app.ui.window.events.drag_and_drop import accept_files

glfw.init_hint(glfw.PLATFORM, glfw.PLATFORM_NULL)
assert glfw.init()
glfw.window_hint(glfw.CLIENT_API, glfw.NO_API)
window = glfw.create_window(100, 100, "", None, None)
paths = []
kept = accept_files(window, paths.extend)
listener = glfw.library.glfw.glfwSetDropCallback(window, ctypes.cast(None, type(kept)))
listener(window, 2, (ctypes.c_char_p * 2)(b"/caf\\xe9.png", b"/\\xc3\\xa4.png"))
glfw.poll_events()
print(*map(os.fsencode, paths))
"""


def test_it_is_dropped_on_the_window():
    """By GLFW on no screen at all, in a process of its own."""
    done = subprocess.run(
        [sys.executable, "-c", DROP],
        cwd=Path(__file__).parents[3],
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.stdout == r"b'/caf\xe9.png' b'/\xc3\xa4.png'" + "\n", done.stderr
