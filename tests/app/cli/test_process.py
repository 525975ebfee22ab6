"""Signals end the program soon, whatever it does, and what was not saved is kept first."""

import os
import signal
import subprocess
import sys
from contextlib import contextmanager
from pathlib import Path

import pytest
from documents import disc_document

from app.cli import window_process
from app.cli.commands import doctor
from app.cli.main import EXIT_FAILED, main
from app.cli.process import STILL_AT_WORK
from app.document import History
from app.document.commands import scene_commands
from app.editor import error_reports
from app.editor.actions.project_files import autosaving
from app.editor.parts.dialogs import ProblemReport
from app.editor.parts.project_file import ProjectFile
from app.editor.parts.selection import Selection
from app.editor.parts.settings import SessionSettings
from app.editor.project import Project
from app.editor.session import Session
from app.editor.work.jobs import Jobs
from app.editor.work.layer_runtime import LayerRuntimes
from app.errors import LissomError
from app.storage.autosave import load_recoverable_file, load_report

pytestmark = pytest.mark.skipif(os.name == "nt", reason="Windows has no such signals")

# What a command does, as text, between the signals that it hears.
LISTEN = """
import signal, sys, threading, time
from app.cli import process
# As in a terminal: what runs unattended may hand on that it ignores some of them.
signal.signal(signal.SIGINT, signal.default_int_handler)
signal.signal(signal.SIGTERM, signal.SIG_DFL)
signal.signal(signal.SIGHUP, signal.SIG_DFL)
def say(*words):
    print(*words, flush=True)
wake = None
{before}
heard = process.SignalHandler(wake)
try:
    with heard:
        say("ready")
        {work}
except KeyboardInterrupt:
    {after}
sys.exit(heard.exit_status)
"""


# A process that crashes, with what Python tells of it in a folder.
CRASH = """
import os, sys
from pathlib import Path
from app.cli.process import redirect_faulthandler
from app.storage import open_fault_log
with redirect_faulthandler(open_fault_log(Path(sys.argv[1]))):
    os.abort()
"""


@contextmanager
def listening(*, work, before="", after="say(heard.signal_name)"):
    """Start a process that listens to signals, and wait until it does."""
    with subprocess.Popen(
        [sys.executable, "-c", LISTEN.format(before=before, work=work, after=after)],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        cwd=Path(__file__).parents[3],
        text=True,
    ) as process:
        assert process.stdout.readline() == "ready\n"
        yield process


@pytest.mark.parametrize("name", ["SIGINT", "SIGTERM", "SIGHUP"])
def test_a_signal_ends_a_command_with_the_status_that_shells_know(name):
    number = getattr(signal, name)
    with listening(work="time.sleep(60)") as process:
        process.send_signal(number)
        assert process.communicate()[0] == f"{name}\n"
    assert process.returncode == 128 + number


def test_a_signal_that_does_not_interrupt_the_main_thread_ends_its_wait():
    before = """
def meet():
    sys.stdin.readline()
    signal.pthread_kill(threading.get_ident(), signal.SIGTERM)
threading.Thread(target=meet, daemon=True).start()"""
    with listening(before=before, work="time.sleep(60)") as process:
        assert process.communicate("now\n")[0] == "SIGTERM\n"
    assert process.returncode == 143


def test_stuck_process_ends_after_a_signal():
    with listening(
        before="process.PATIENCE = 0.1", work="time.sleep(60)", after="time.sleep(60)"
    ) as process:
        process.send_signal(signal.SIGTERM)
        out, said = process.communicate()
    assert out == ""
    assert said == f"lissom: {STILL_AT_WORK.format(signal='SIGTERM')}\n"
    assert process.returncode == 143


def test_what_waits_is_woken_and_more_signals_change_nothing():
    before = "waiting = threading.Event(); wake = waiting.set"
    work = "waiting.wait(); say(heard.is_signalled); sys.stdin.read()"
    with listening(before=before, work=work) as process:
        process.send_signal(signal.SIGHUP)
        assert process.stdout.readline() == "True\n"
        process.send_signal(signal.SIGTERM)
        process.send_signal(signal.SIGINT)
        assert process.communicate()[1] == ""
    assert process.returncode == 129


def test_a_signal_that_is_to_be_ignored_is_ignored():
    before = "signal.signal(signal.SIGHUP, signal.SIG_IGN)"
    with listening(before=before, work="time.sleep(60)") as process:
        process.send_signal(signal.SIGHUP)
        process.send_signal(signal.SIGTERM)
        assert process.communicate()[0] == "SIGTERM\n"
    assert process.returncode == 143


class EndedWindow:
    """A window with unsaved work in it, until an exception or a signal ends it."""

    error = None

    def __init__(self, session, _):
        self.session = session
        self._is_woken = False

    def wake(self):
        self._is_woken = True

    def run(self, *, is_over, farewell):
        document = disc_document()
        project = Project(
            file=ProjectFile(name="disc"),
            history=History(document, saved=True),
            runtimes=LayerRuntimes(layers={}),
            selection=Selection(active=0),
        )
        project.history.do(scene_commands.add_marker(0, "unsaved"))
        self.session.project = project
        try:
            if self.error is not None:
                raise self.error
            os.kill(os.getpid(), signal.SIGTERM)
            assert is_over()
        finally:
            farewell()


def test_what_could_not_be_kept_is_not_said_to_be(monkeypatch, capfd):
    def refuse(_):
        raise LissomError("the disk is full")

    monkeypatch.setattr(autosaving, "autosave_now", refuse)
    window_process._keep(None)
    assert capfd.readouterr().err.endswith(
        "unsaved work could not be backed up: the disk is full\n"
    )


@pytest.mark.parametrize(
    ("error", "status"), [(None, 143), (ZeroDivisionError("a bug"), 1), (LissomError("odd"), 1)]
)
def test_what_was_not_saved_is_kept_however_the_window_ends(
    tmp_path, monkeypatch, capfd, error, status
):
    ended = []
    monkeypatch.setenv("XDG_CONFIG_HOME", str(tmp_path))
    monkeypatch.setattr(window_process, "has_display", lambda: True)
    monkeypatch.setattr(window_process, "Window", EndedWindow)
    monkeypatch.setattr(EndedWindow, "error", error)
    monkeypatch.setattr(window_process, "exit_within", lambda *_: None)
    monkeypatch.setattr("app.cli.process.exit_within", lambda *_: None)
    monkeypatch.setattr(sys, "setswitchinterval", lambda _: None)
    monkeypatch.setattr(os, "_exit", ended.append)
    assert main(["window"]) == status
    assert ended == [1] * (error is not None)
    said = capfd.readouterr().err
    assert window_process.WORK_KEPT in said
    assert error is None or f"{error}" in said
    (kept,) = tmp_path.rglob("unsaved-*.lissom")
    assert load_recoverable_file(kept)[0].markers[0].name == "unsaved"
    reports = list(tmp_path.rglob("report.txt"))
    assert len(reports) == (error is not None)
    for report in reports:
        text = report.read_text(encoding="utf-8")
        assert f"{type(error).__name__}: {error}" in text
        assert str(Path(__file__).parent) not in text
        assert report.stat().st_mode & 0o777 == 0o600


class LostDisplay:
    """Xlib, whose server goes away when a test says so."""

    def __init__(self):
        self.handler = None

    def XSetIOErrorHandler(self, handler):  # noqa: N802 - Xlib's own name
        self.handler = handler


@pytest.mark.skipif(sys.platform != "linux", reason="other systems have no X server")
def test_unsaved_work_is_kept_when_the_display_is_lost(tmp_path, monkeypatch, capfd):
    ended, display = [], LostDisplay()

    class LostWindow(EndedWindow):
        def run(self, *, is_over, farewell):
            history = History(disc_document(), saved=True)
            history.do(scene_commands.add_marker(0, "unsaved"))
            self.session.project = Project(
                file=ProjectFile(name="disc"),
                history=history,
                runtimes=LayerRuntimes(layers={}),
                selection=Selection(active=0),
            )
            display.handler(None)
            assert list(tmp_path.rglob("unsaved-*.lissom"))
            assert ended == [EXIT_FAILED]
            assert not is_over()
            farewell()

    monkeypatch.setenv("XDG_CONFIG_HOME", str(tmp_path))
    # The handler as Python knows it: it returns here, where the process would have ended.
    monkeypatch.setattr("app.cli.process.ctypes.CFUNCTYPE", lambda *_: lambda handler: handler)
    monkeypatch.setattr("app.cli.process.ctypes.CDLL", lambda _: display)
    monkeypatch.setattr(window_process, "has_display", lambda: True)
    monkeypatch.setattr(window_process, "Window", LostWindow)
    monkeypatch.setattr(window_process, "exit_within", lambda *_: None)
    monkeypatch.setattr(sys, "setswitchinterval", lambda _: None)
    monkeypatch.setattr(os, "_exit", ended.append)
    main(["window"])
    said = capfd.readouterr().err
    assert "the display is gone" in said
    assert "your unsaved work was backed up" in said
    (kept,) = tmp_path.rglob("unsaved-*.lissom")
    assert load_recoverable_file(kept)[0].markers[0].name == "unsaved"


def test_where_a_process_crashed_is_kept_for_the_next_start(tmp_path):
    ended = subprocess.run(
        [sys.executable, "-c", CRASH, str(tmp_path)], cwd=Path(__file__).parents[3], check=False
    )
    assert ended.returncode == -signal.SIGABRT
    session = Session(clock=float, jobs=Jobs(), settings=SessionSettings(folder=tmp_path))
    error_reports.keep_fault_report(session)
    assert "Fatal Python error: Aborted" in load_report(tmp_path)
    error_reports.discard_report(session, ProblemReport(text="", is_kept=True))
    error_reports.keep_fault_report(session)
    assert load_report(tmp_path) == "", "it is reported once"


def test_a_command_that_fails_itself_tells_it_without_names_of_files(monkeypatch, capfd, tmp_path):
    def broken(_):
        raise ZeroDivisionError(f"a bug in {tmp_path}/wave of Ann.lissom")

    monkeypatch.setattr(doctor, "run", broken)
    assert main(["doctor"]) == 1
    said = capfd.readouterr().err
    assert "ZeroDivisionError: a bug in …" in said
    assert "nothing is sent" in said
    assert str(tmp_path) not in said
    assert str(Path(__file__).parent) not in said
