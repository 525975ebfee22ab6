"""The file dialogs of the system: a script stands for the program that shows them."""

import json
import os
import shutil
import sys
from functools import partial
from pathlib import Path

import pytest

from app.editor.action import do
from app.editor.actions import dialog_actions
from app.editor.actions.posing.handles import add_handle
from app.editor.actions.project_files import files, saving
from app.editor.parts.dialogs import FileDialog, Question
from app.storage.assets import sample_images
from app.ui.dialogs import native_dialog

MOST_POLLS = 3000
PROGRAM = """\
#!{python}
import json, os, sys, time
from pathlib import Path
place = Path(os.path.dirname(os.path.abspath(__file__)))
(place / "asked.part").write_text(json.dumps([os.getpid(), *sys.argv[1:]]))
(place / "asked.part").rename(place / "asked")
while not (place / "answer").exists():
    time.sleep(0.002)
answer, status = json.loads((place / "answer").read_text())
sys.stdout.buffer.write(os.fsencode(answer))
sys.exit(status)
"""


class Program:
    """A stand-in for zenity, with a given answer at a given time."""

    def __init__(self, window, place):
        self.window = window
        self.place = place

    def asked(self):
        """Wait until the program runs; return what it was asked."""
        self._wait((self.place / "asked").exists)
        return json.loads((self.place / "asked").read_text())[1:]

    def answer(self, text, status=0):
        (self.place / "answer.part").write_text(json.dumps([text, status]))
        (self.place / "answer.part").rename(self.place / "answer")

    def wait_for_the_window(self):
        """Draw frames until the window has the answer, with the clock as it is."""
        now, dialog = self.window.clock.now, self.window.session.dialogs.current

        def is_answered():
            self.window.clock.now = now
            session = self.window.session
            return session.dialogs.current is not dialog or not session.dialogs.uses_system

        self._wait(is_answered)

    def _wait(self, is_there):
        for _ in range(MOST_POLLS):
            if is_there():
                return
            self.window.frames()
        pytest.fail("nothing came of the dialog")


@pytest.fixture
def program(window, tmp_path, monkeypatch):
    place = tmp_path / "bin"
    place.mkdir()
    script = place / "zenity"
    script.write_text(PROGRAM.format(python=sys.executable))
    script.chmod(0o755)
    monkeypatch.setenv("PATH", f"{place}:/usr/bin:/bin")
    monkeypatch.setenv("XDG_SESSION_DESKTOP", "gnome")
    window.session.dialogs.uses_system = native_dialog.find_system_dialogs() is not None
    assert window.session.dialogs.uses_system
    program = Program(window, place)
    yield program
    # Nothing may be left running.
    window.session.dialogs.current = None
    window.frames()
    program.answer("")


def note(chosen, _, path):
    chosen.append(path)


@pytest.fixture
def chosen():
    return []


@pytest.fixture
def ask(window, tmp_path, chosen):
    """Opens a dialog for a file to write, by default."""

    def open_dialog(**changes):
        settings = {
            "title": "Save it",
            "folder": tmp_path,
            "name": "walk.png",
            "suffixes": (".png", ".jpg"),
            "writes": True,
            "chosen": lambda path: do(partial(note, chosen), path),
        }
        window.act(dialog_actions.show_dialog, FileDialog(**(settings | changes)))

    return open_dialog


def later(window):
    """Let more time pass than a dialog takes to come up."""
    window.clock.now += 2 * native_dialog.TOO_SOON


def test_a_picture_is_opened_and_the_window_does_not_wait(window, program):
    window.act(files.ask_file_to_open)
    asked = program.asked()
    assert "--file-selection" in asked
    assert "--save" not in asked
    assert f"--filename={window.session.settings.usual_folder}/" in asked
    (patterns,) = [word for word in asked if word.startswith(".lissom, ")]
    assert "*.lissom" in patterns
    assert "*.png *.PNG" in patterns
    drawn = window.session.clock()
    window.frames(10)
    assert window.session.clock() > drawn
    assert window.session.project is None
    program.answer(f"{sample_images() / 'bar.png'}\n")
    program.wait_for_the_window()
    assert window.session.dialogs.current is None
    window.settle()
    assert window.session.project.file.name == "bar"
    assert window.session.settings.usual_folder == sample_images()


def test_saving_asks_before_it_replaces_and_adds_the_suffix(program, ask, chosen, tmp_path):
    ask()
    asked = program.asked()
    assert "--save" in asked
    assert "--confirm-overwrite" in asked
    assert f"--filename={tmp_path}/walk.png" in asked
    assert asked[asked.index("--title") + 1] == "Save it"
    program.answer(f"{tmp_path}/run\n")
    program.wait_for_the_window()
    assert chosen == [tmp_path / "run.png"]


def test_a_name_that_its_suffix_makes_an_existing_one_is_asked_about(
    window, program, ask, chosen, tmp_path
):
    (tmp_path / "run.png").write_bytes(b"")
    ask()
    program.asked()
    program.answer(f"{tmp_path}/run\n")
    program.wait_for_the_window()
    assert chosen == []
    assert isinstance(window.session.dialogs.current, Question)
    assert "run.png" in window.session.dialogs.current.text
    window.run(lambda robot: robot.item_click("//###dialog/Replace"))
    assert chosen == [tmp_path / "run.png"]
    assert window.session.dialogs.current is None


def test_frames_land_in_a_folder_of_their_own_where_other_files_are(program, ask, chosen, tmp_path):
    desktop = tmp_path / "Desktop"
    desktop.mkdir()
    (desktop / "letter.txt").write_text("")
    ask(suffixes=(), name="walk frames", folder=desktop)
    program.asked()
    program.answer(str(desktop))
    program.wait_for_the_window()
    assert chosen == [desktop / "walk frames"]


def test_a_folder_is_chosen_as_such(program, ask, chosen, tmp_path):
    ask(suffixes=(), name="walk frames")
    assert "--directory" in program.asked()
    empty = tmp_path / "empty"
    empty.mkdir()
    program.answer(f"{empty}\n")
    program.wait_for_the_window()
    assert chosen == [empty]


def test_a_name_that_is_not_utf_8_is_taken_as_it_is(window, program, ask, chosen, tmp_path):
    ask(folder=tmp_path / os.fsdecode(b"caf\xe9"), name=os.fsdecode(b"\xe9.png"))
    assert f"--filename={tmp_path}/caf\N{REPLACEMENT CHARACTER}/" in " ".join(program.asked())
    program.answer(os.fsdecode(b"/caf\xe9.png"))
    program.wait_for_the_window()
    assert window.session.dialogs.current is None
    assert chosen == [Path(os.fsdecode(b"/caf\xe9.png"))]


def test_cancelling_the_dialog_closes_it(window, program, ask, chosen):
    ask()
    program.asked()
    later(window)
    window.frames(3)
    program.answer("", status=1)
    program.wait_for_the_window()
    assert window.session.dialogs.current is None
    assert window.session.dialogs.uses_system
    assert chosen == []


def test_a_program_that_cannot_show_anything_is_replaced_by_our_browser(
    window, program, ask, chosen, tmp_path
):
    program.answer("", status=255)
    ask()
    program.wait_for_the_window()
    assert isinstance(window.session.dialogs.current, FileDialog)
    window.frames(2)
    window.run(lambda robot: robot.item_click("//###dialog/Save"))
    assert chosen == [tmp_path / "walk.png"]


def test_a_program_that_fails_late_is_replaced_by_our_browser_with_a_word(
    window, program, ask, chosen, tmp_path
):
    ask()
    program.asked()
    later(window)
    window.frames(3)
    program.answer("", status=255)
    program.wait_for_the_window()
    assert not window.session.dialogs.uses_system
    assert [toast.text for toast in window.session.notices.toasts] == [
        "The system's file dialog did not open, so Lissom shows its own."
    ]
    window.frames(2)
    window.run(lambda robot: robot.item_click("//###dialog/Save"))
    assert chosen == [tmp_path / "walk.png"]


def test_a_second_empty_answer_offers_our_browser(window, program, ask, chosen, tmp_path):
    for count in (1, 2):
        ask()
        program.asked()
        later(window)
        window.frames(3)
        program.answer("", status=1)
        program.wait_for_the_window()
        offers = [each for each in window.session.notices.toasts if each.label]
        assert len(offers) == count - 1
        for name in ("asked", "answer"):
            (program.place / name).unlink()
    window.act(offers[0].action.verb, *offers[0].action.arguments)
    window.frames(2)
    window.run(lambda robot: robot.item_click("//###dialog/Save"))
    assert chosen == [tmp_path / "walk.png"]


def test_a_program_that_does_not_start_is_replaced_by_our_browser(window, program, ask):
    (program.place / "zenity").write_text("#!/no/such/interpreter")
    ask()
    window.frames(3)
    assert isinstance(window.session.dialogs.current, FileDialog)
    assert not window.session.dialogs.uses_system


def test_the_person_may_prefer_our_browser(window, program, ask, chosen, tmp_path):
    ask()
    program.asked()
    window.run(lambda robot: robot.item_click("//###dialog/Use Lissom's own dialog"))
    window.frames(2)
    window.run(lambda robot: robot.item_click("//###dialog/Save"))
    assert chosen == [tmp_path / "walk.png"]
    assert not is_running(program)


@pytest.mark.parametrize("way", ["Cancel", "escape"])
def test_window_can_cancel_a_dialog_that_never_answers(window, program, ask, chosen, way):
    ask()
    program.asked()
    if way == "Cancel":
        window.run(lambda robot: robot.item_click("//###dialog/Cancel"))
    else:
        window.run(lambda robot: robot.key_press(int(window.Key.escape)))
    window.frames(2)
    assert window.session.dialogs.current is None
    assert not is_running(program)
    assert chosen == []


def test_a_question_that_comes_up_takes_the_dialog_away(window, program, ask):
    project = window.open(sample_images() / "bar.png")
    window.act(add_handle, complex(*project.document.canvas) / 2)
    ask()
    program.asked()
    window.act(saving.request_quit)
    window.frames(2)
    assert isinstance(window.session.dialogs.current, Question)
    assert not is_running(program)
    assert not window.session.is_quitting


def test_the_window_takes_the_dialog_with_it(window, program, ask):
    ask()
    program.asked()
    window.program.shell.release()
    assert not is_running(program)


def test_without_a_program_our_browser_is_used(window, ask, chosen, tmp_path, monkeypatch):
    monkeypatch.setenv("PATH", str(tmp_path))
    monkeypatch.setattr(native_dialog.sys, "platform", "linux")
    assert native_dialog.find_system_dialogs() is None
    ask()
    window.frames(2)
    window.run(lambda robot: robot.item_click("//###dialog/Save"))
    assert chosen == [tmp_path / "walk.png"]


@pytest.mark.parametrize("platform", ["win32", "darwin"])
def test_other_systems_have_dialogs_always(platform, monkeypatch):
    monkeypatch.setattr(native_dialog.sys, "platform", platform)
    monkeypatch.setattr(shutil, "which", lambda _: None)
    assert native_dialog.find_system_dialogs() is not None


def is_running(program):
    process = json.loads((program.place / "asked").read_text())[0]
    try:
        os.kill(process, 0)
    except ProcessLookupError:
        return False
    return True
