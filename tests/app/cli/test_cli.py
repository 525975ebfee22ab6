import os
import subprocess
import sys
import threading

import pytest
from documents import disc_document

from app.cli.commands import window
from app.cli.main import COMMANDS, main
from app.editor.actions import saving
from app.editor.jobs import Job
from app.storage.assets import sample_images

SAMPLE = sample_images() / "giraffe.lissom"


def run(*words: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [sys.executable, "-m", "app", *words], capture_output=True, text=True, check=False
    )


def error_line(text: str) -> str:
    lines = [line for line in text.splitlines() if line.startswith("lissom: error:")]
    assert len(lines) == 1, text
    assert "Traceback" not in text
    return lines[0]


@pytest.mark.parametrize(
    "words", [["nonsense"], ["domain"], ["domain", "a.png", "--out"], ["--nonsense"]]
)
def test_bad_usage_is_one_line(words, capsys):
    with pytest.raises(SystemExit) as leaving:
        main(words)
    assert leaving.value.code == 2
    assert "--help" in error_line(capsys.readouterr().err)


@pytest.mark.parametrize("command", COMMANDS)
def test_every_command_explains_itself(command, capsys):
    with pytest.raises(SystemExit) as leaving:
        main([command, "--help"])
    assert leaving.value.code == 0
    text = capsys.readouterr().out
    assert f"usage: lissom {command}" in text
    assert "examples:" in text


def test_the_program_runs_as_a_process(tmp_path):
    refused = run("domain", str(tmp_path / "no\nsuch.png"), "--out", str(tmp_path / "out.npz"))
    assert refused.returncode == 2
    assert "no such.png" in error_line(refused.stderr)
    assert refused.stdout == ""
    assert list(tmp_path.iterdir()) == []
    assert run("--version").stdout.startswith("lissom ")


def test_help_does_not_load_the_numerics():
    code = "import sys, app.cli.main as m; m.build_parser([]); print('numpy' in sys.modules)"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "False"


def test_a_reader_that_stops_early_is_no_error():
    reading, writing = os.pipe()
    os.close(reading)
    with os.fdopen(writing, "wb") as closed:
        done = subprocess.run(
            [sys.executable, "-m", "app", "certify", str(SAMPLE), "--json"],
            stdout=closed,
            stderr=subprocess.PIPE,
            text=True,
            check=False,
        )
    assert done.returncode == 141
    assert done.stderr == ""


@pytest.mark.skipif(sys.platform != "linux", reason="other systems always have a display")
def test_without_a_display_the_window_says_what_works(monkeypatch, capsys):
    monkeypatch.delenv("DISPLAY", raising=False)
    monkeypatch.delenv("WAYLAND_DISPLAY", raising=False)
    with pytest.raises(SystemExit) as leaving:
        main([str(SAMPLE)])
    assert leaving.value.code == 2
    assert "no display" in error_line(capsys.readouterr().err)


@pytest.mark.skipif(sys.platform != "linux", reason="other systems always have a display")
def test_a_display_that_is_not_there_is_an_error_in_words():
    done = subprocess.run(
        [sys.executable, "-m", "app", str(SAMPLE)],
        env={**os.environ, "DISPLAY": ":9999", "WAYLAND_DISPLAY": ""},
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 2
    assert "lissom: error: the window cannot be opened" in done.stderr
    assert "Traceback" not in done.stderr


def test_an_autosave_that_is_written_while_the_person_leaves_is_not_offered(tmp_path, monkeypatch):
    begun, left = threading.Event(), threading.Event()

    class LeftWindow:
        def __init__(self, session, _):
            self.session = session

        def run(self):
            session = self.session

            def keep():
                begun.set()
                left.wait(10)
                session.autosave.write(disc_document())

            session.jobs.put(Job(kind=saving.AUTOSAVING, work=keep, done=print, failed=print))
            assert begun.wait(10)
            saving.leave(session)
            left.set()

    monkeypatch.setenv("XDG_CONFIG_HOME", str(tmp_path))
    monkeypatch.setattr(window, "has_display", lambda: True)
    monkeypatch.setattr(window, "Window", LeftWindow)
    monkeypatch.setattr(sys, "setswitchinterval", lambda _: None)
    assert main(["window"]) == 0
    assert left.is_set()
    assert list(tmp_path.rglob("unsaved-*")) == []
    assert len(list(tmp_path.rglob("preferences.json"))) == 1
