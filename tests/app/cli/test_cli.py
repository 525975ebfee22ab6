import json
import os
import pkgutil
import subprocess
import sys
import threading
from typing import get_args

import pytest
from documents import disc_document

from app.cli import commands, options, window_process
from app.cli.commands import pose
from app.cli.main import COMMANDS, EXIT_PIPE_CLOSED, main
from app.cut_out import CutOut
from app.document import FRAMINGS, SPRING_PRESETS, VARIANTS, Meshing
from app.editor.actions.project_files import autosaving, saving
from app.editor.work.jobs import Job
from app.storage import SourceInfo
from app.storage.assets import sample_images
from engine.domain.outline.enclosure import Detail, Holes

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
    "words", [["nonsense"], ["domain"], ["domain", __file__, "--out"], ["--nonsense"]]
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


# One process answers all of them, one after the other: what is loaded once stays loaded.
LOADED = """
import contextlib, io, json, sys
from app.cli.main import main
for words in json.load(sys.stdin):
    said = io.StringIO()
    try:
        with contextlib.redirect_stderr(said), contextlib.redirect_stdout(io.StringIO()):
            main(words)
    except SystemExit as leaving:
        heavy = {"numpy", "scipy", "PIL", "shapely", "moderngl", "imgui_bundle"} & set(sys.modules)
        print(json.dumps([leaving.code, sorted(heavy), said.getvalue()]))
"""
LIGHT = (
    ("--help", 0),
    ("--version", 0),
    ("domain --help", 0),
    ("window no.lissom", 2),
    ("domain", 2),
    ("domain {here} --out x.npz --detail finest", 2),
    ("domain no.png --out x.npz", 2),
    ("domain {here} --out x.npz --background blue", 2),
    ("domain {here} --out x.npz --background none --mask {here}", 2),
    ("doctor --help", 0),
    ("move {here} --speed fast", 2),
    ("pose no.png no.json --out x.lissom", 2),
    ("certify no.lissom", 2),
    ("certify {here} --variant mu", 2),
    ("deform no.npz --out x.npz", 2),
    ("interpolate no.npz --variant nu --times 0,1 --out x.npz", 2),
    ("interpolate {here} --variant nu --times one --out x.npz", 2),
    ("export no.lissom --out x", 2),
    ("export {here} --out x --size big", 2),
    ("figures --out x --triangles 10", 2),
    ("desktop", 2),
    ("desktop --install --remove", 2),
    ("thumbnail no.lissom --out x.png", 2),
    ("thumbnail {here} --out x.png --size 0", 2),
    ("manual", 2),
    ("nonsense", 2),
)


def test_nothing_heavy_is_loaded_when_the_words_suffice():
    calls = [words.format(here=__file__).split() for words, _ in LIGHT]
    done = subprocess.run(
        [sys.executable, "-c", LOADED],
        input=json.dumps(calls),
        capture_output=True,
        text=True,
        check=True,
    )
    answers = [json.loads(line) for line in done.stdout.splitlines()]
    assert len(answers) == len(LIGHT)
    for (words, status), (code, heavy, said) in zip(LIGHT, answers, strict=True):
        assert (code, heavy) == (status, []), words
        if status == 2:
            assert error_line(said)


def test_the_words_to_choose_from_are_those_that_the_program_knows():
    assert set(options.DETAILS) == set(get_args(Detail))
    assert get_args(Holes) == options.HOLES
    assert set(options.VARIANTS) == set(VARIANTS)
    assert set(options.FRAMINGS) == set(FRAMINGS)
    defaults = Meshing()
    assert defaults.detail == options.DEFAULT_DETAIL
    assert defaults.triangles == options.DEFAULT_TRIANGLES
    assert CutOut().tolerance == options.DEFAULT_TOLERANCE
    epilog = pose.EPILOG.replace("\n", " ")
    assert (
        f"The presets are {', '.join(list(SPRING_PRESETS)[:-1])} and {list(SPRING_PRESETS)[-1]}."
        in epilog
    )


def test_every_command_says_what_it_understands_and_does_it():
    assert {module.name for module in pkgutil.iter_modules(commands.__path__)} == set(COMMANDS)


@pytest.fixture
def closed_pipe():
    """The end of a pipe that nobody reads."""
    reading, writing = os.pipe()
    os.close(reading)
    with os.fdopen(writing, "w") as pipe:
        yield pipe


# In a process of its own: where SIGPIPE is not ignored, it ends the one that writes.
@pytest.mark.parametrize("words", [("domain", "--help"), ("move", "--list")])
def test_command_is_no_error_when_its_reader_stops(closed_pipe, words):
    environment = {name: value for name, value in os.environ.items() if name != "PYTHONUNBUFFERED"}
    done = subprocess.run(
        [sys.executable, "-m", "app", *words],
        env=environment,
        stdout=closed_pipe,
        stderr=subprocess.PIPE,
        text=True,
        check=False,
    )
    assert done.returncode == EXIT_PIPE_CLOSED == 141
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
def test_window_is_an_error_in_words_when_its_display_is_missing(tmp_path):
    done = subprocess.run(
        [sys.executable, "-m", "app", "window"],
        env={
            **os.environ,
            "DISPLAY": ":9999",
            "WAYLAND_DISPLAY": "",
            "XDG_CONFIG_HOME": str(tmp_path),
        },
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 2
    assert "lissom: error: The window cannot be opened" in done.stderr
    assert "Traceback" not in done.stderr


def test_an_autosave_that_is_written_while_the_person_leaves_is_not_offered(tmp_path, monkeypatch):
    begun, left = threading.Event(), threading.Event()

    class LeftWindow:
        def __init__(self, session, _):
            self.session = session

        def wake(self):
            pass

        def run(self, *, farewell, **_):
            session = self.session

            def keep():
                begun.set()
                left.wait()
                session.settings.autosave.write(disc_document(), SourceInfo("disc", None))

            session.jobs.put(Job(kind=autosaving.AUTOSAVING, work=keep, done=print, failed=print))
            begun.wait()
            saving.close_window(session)
            left.set()
            farewell()

    monkeypatch.setenv("XDG_CONFIG_HOME", str(tmp_path))
    monkeypatch.setattr(window_process, "has_display", lambda: True)
    monkeypatch.setattr(window_process, "Window", LeftWindow)
    monkeypatch.setattr(window_process, "exit_within", lambda *_: None)
    monkeypatch.setattr(sys, "setswitchinterval", lambda _: None)
    assert main(["window"]) == 0
    assert left.is_set()
    assert list(tmp_path.rglob("unsaved-*")) == []
    assert len(list(tmp_path.rglob("preferences.json"))) == 1


@pytest.mark.parametrize("command", ["export", "certify", "interpolate"])
def test_the_variants_are_reported_as_they_are_written(command, capsys):
    with pytest.raises(SystemExit):
        main([command, str(SAMPLE), "--variant", "mu"])
    said = error_line(capsys.readouterr().err)
    assert "'scaled-eta'" in said
    assert "<" not in said
