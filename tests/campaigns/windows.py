"""Real windows, in which somebody edits all the time, and what ends them.

Signals, kills and X servers that go away come at random moments; two windows work on one file. A
person comes back, and finds what was promised: nothing that was told to be saved is lost, what is
unsaved is kept but for the last seconds, and no window replaces what the other one has saved.
"""

import os
import select
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from functools import partial
from pathlib import Path
from typing import NamedTuple

import numpy as np

from app.storage.assets import sample_images
from app.storage.autosave import find_recoverable_files, load_recoverable_file
from app.storage.files.atomic import PART
from app.storage.project_file import load_project, save_project
from tests.campaigns.kills import check_nothing_left, expect, number_of, numbered
from tests.campaigns.slowest import timed

ROOT = Path(__file__).parents[2]
PATIENCE = 120.0  # seconds for anything to happen
MOST_SECONDS = 15.0  # from a signal to the end of the window, on a busy machine
KEPT_EVERY = 1.0  # seconds between two looks at what is unsaved; the usual 20 would take long
IDLE = 5.0  # seconds after which a window in which nothing happens looks again
MOST_LOST = 10.0  # seconds of edits then, on a busy machine

# Runs the window, and does in it what is said on standard input, or edits on and on; tells each.
DRIVEN = """
import os, sys, threading, time
from pathlib import Path
from app.cli import window_process
from app.cli.main import main
from app.document.commands import scene_commands
from app.editor import do
from app.editor.actions.project_files import files, saving
from app.editor.parts.dialogs import Question

saving.SECONDS = float(sys.argv[1])
asked = Path(sys.argv[2])

def name(session, number):
    history = session.project.history
    renames = bool(history.document.markers)
    rename, add = scene_commands.rename_marker, scene_commands.add_marker
    history.do(rename(0, f"{number}") if renames else add(0, f"{number}"))

def close(session):
    session.dialogs.current = None

class Driven(window_process.Window):
    def __init__(self, *arguments):
        super().__init__(*arguments)
        threading.Thread(target=self.drive, daemon=True).start()
    def drive(self):
        dialogs = self.session.dialogs
        self.until(lambda: self.session.project or isinstance(dialogs.current, Question))
        print("opened" if self.session.project else dialogs.current.title, flush=True)
        for line in sys.stdin:
            word, number = line.split()
            getattr(self, word)(int(number))
    def until(self, holds):
        while not holds():
            time.sleep(0.002)
    def let(self, *action):
        self.queue_action(do(*action))
        self.wake()
    def anyway(self, _):
        self.queue_action(self.session.dialogs.current.answers[1][1])
        self.let(close)
        self.until(lambda: self.session.project)
        print("opened", flush=True)
    def edit(self, number):
        self.let(name, number)
        told = f"{number}"
        self.until(lambda: [m for m in self.session.project.document.markers if m.name == told])
        print("edited", number, flush=True)
    def save(self, number):
        self.let(saving.write_project, asked, None)
        history, session = self.session.project.history, self.session
        self.until(lambda: history.is_saved or isinstance(session.dialogs.current, Question))
        print("saved" if history.is_saved else session.dialogs.current.title, number, flush=True)
        if not history.is_saved:
            self.let(close)
            self.until(lambda: session.dialogs.current is None)
    def work(self, saves):
        for number in range(1_000_000):
            self.edit(number)
            if saves and number % saves == saves - 1:
                self.save(number)

window_process.Window = Driven
raise SystemExit(main(sys.argv[3:]))
"""


class Screen(NamedTuple):
    """An X server that nobody looks at, and its name."""

    server: subprocess.Popen[bytes]
    name: str


@contextmanager
def screen() -> Iterator[Screen]:
    """Start an X server, and end it."""
    ours, theirs = os.pipe()
    command = ["Xvfb", "-displayfd", str(theirs), "-screen", "0", "1280x800x24", "-noreset"]
    server = subprocess.Popen(command, pass_fds=[theirs], stderr=subprocess.DEVNULL)
    os.close(theirs)
    try:
        expect(bool(select.select([ours], [], [], PATIENCE)[0]), "Xvfb does not start")
        yield Screen(server, f":{os.read(ours, 16).decode().strip()}")
    finally:
        os.close(ours)
        server.terminate()
        server.wait()


class Driven:
    """A window that does what it is told.

    Parameters
    ----------
    shown : Screen
    home : Path
        The person's folder, with settings and unsaved work.
    file : Path
        What it opens.
    saved : Path
        Where it saves.
    seconds : float
        Between two looks at what is unsaved.
    """

    def __init__(
        self, shown: Screen, home: Path, file: Path, saved: Path, seconds: float = 20.0
    ) -> None:
        own = {"DISPLAY": shown.name, "HOME": str(home), "XDG_CONFIG_HOME": str(home)}
        self.process = subprocess.Popen(
            [sys.executable, "-c", DRIVEN, str(seconds), str(saved), str(file)],
            cwd=ROOT,
            env={**os.environ, **own, "LIBGL_ALWAYS_SOFTWARE": "1"},
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
        )

    def hear(self) -> str:
        """Return the next line that it tells."""
        is_there = bool(select.select([self.process.stdout], [], [], PATIENCE)[0])
        expect(is_there, "a window says nothing")
        line = self.process.stdout.readline().strip() if self.process.stdout else ""
        expect(bool(line), f"a window ended: {self.process.poll()}")
        return line

    def tell(self, word: str, number: int = 0) -> None:
        """Say what it shall do."""
        if self.process.stdin is not None:
            print(word, number, file=self.process.stdin, flush=True)

    def do(self, word: str, number: int = 0) -> str:
        """Say what it shall do, and return what it tells."""
        self.tell(word, number)
        return self.hear()

    def end(self, number: int = signal.SIGKILL) -> tuple[str, str]:
        """Send it a signal; return all else that it told and said."""
        self.process.send_signal(number)
        return self.process.communicate(timeout=PATIENCE)


@contextmanager
def driven(*arguments: object, **keywords: object) -> Iterator[Driven]:
    """Lend a driven window that has opened its file, and end it."""
    window = Driven(*arguments, **keywords)  # type: ignore[arg-type]
    try:
        yield window
    finally:
        window.process.kill()
        with suppress(ValueError):  # it was heard to its end
            window.process.communicate()


def signalled(rng: np.random.Generator, count: int) -> dict[str, float]:
    """End windows by signals that ask them to."""
    ends = []
    with screen() as shown:
        for _ in timed(range(count)):
            number = int(rng.choice([signal.SIGTERM, signal.SIGHUP, signal.SIGINT]))
            end = partial(_send, number=number)
            ends.append(_end_in_order(rng, shown, end, 128 + number))
    return _told(ends)


def lost_displays(rng: np.random.Generator, count: int) -> dict[str, float]:
    """End the X servers of windows."""
    ends = []
    for _ in timed(range(count)):
        with screen() as shown:
            ends.append(_end_in_order(rng, shown, lambda _, s=shown: s.server.kill(), 1))
    return _told(ends)


def _send(window: Driven, number: int) -> None:
    window.process.send_signal(number)


def _told(ends: list[tuple[float, int]]) -> dict[str, float]:
    longest, lost = (max(column) for column in zip(*ends, strict=True))
    return {
        "windows ended": len(ends),
        "longest until the end, s": longest,
        "most edits lost": lost,
    }


def _end_in_order(
    rng: np.random.Generator, shown: Screen, end: Callable[[Driven], None], status: int
) -> tuple[float, int]:
    """End a window; return the seconds that it takes, and how many edits are lost."""
    with tempfile.TemporaryDirectory() as name:
        home, picture = Path(name), sample_images() / "bar.png"
        with driven(shown, home, picture, home / "a.lissom") as window:
            expect(window.hear() == "opened", "the picture is not opened")
            first = window.do("work")
            time.sleep(rng.uniform(0, 2))
            begun = time.monotonic()
            end(window)
            told, said = window.process.communicate(timeout=PATIENCE)
            seconds = time.monotonic() - begun
        last = int((first + told).split()[-1])
        expect(window.process.returncode == status, f"{window.process.returncode}: {said}")
        expect("your unsaved work was backed up" in said, said)
        expect("Traceback" not in said, said)
        expect(seconds < MOST_SECONDS, f"it takes {seconds} s to end")
        (kept,) = find_recoverable_files(home / "lissom")
        number = number_of(load_recoverable_file(kept)[0])
        expect(number >= last, f"edit {last} was made, {number} is kept")
        return seconds, max(0, last - number)


def killed(rng: np.random.Generator, count: int) -> dict[str, float]:
    """Kill windows that save now and then, or never, and keep what is unsaved every second."""
    worst, in_files, swept = 0.0, 0, 0
    with screen() as shown:
        for number in timed(range(count)):
            with tempfile.TemporaryDirectory() as name:
                lost, in_file, left = _kill(rng, shown, Path(name), saves=(0, 7, 40)[number % 3])
            worst, in_files, swept = max(worst, lost), in_files + in_file, swept + left
    return {
        "windows killed": count,
        "most lost, s": worst,
        "found saved": in_files,
        "half-written removed": swept,
    }


def _kill(
    rng: np.random.Generator, shown: Screen, home: Path, saves: int
) -> tuple[float, bool, int]:
    """Kill a window; return the seconds of edits lost, whether a file has more, what was left."""
    path, picture = home / "a.lissom", sample_images() / "bar.png"
    with driven(shown, home, picture, path, KEPT_EVERY) as window:
        expect(window.hear() == "opened", "the picture is not opened")
        window.tell("work", saves)
        times, saved = dict[int, float](), -1
        until = time.monotonic() + rng.uniform(0.5, 6.0)
        while time.monotonic() < until:
            word, number = window.hear().split()
            times[int(number)] = time.monotonic()
            saved = int(number) if word == "saved" else saved
        rest, _ = window.end()
        at = time.monotonic()
    for line in rest.splitlines():
        if len(line.split()) == 2:
            word, number = line.split()
            times.setdefault(int(number), at)
            saved = int(number) if word == "saved" else saved
    in_file = number_of(load_project(path)) if path.exists() else -1
    expect(in_file >= saved, f"{saved} was saved, {in_file} is there")
    found = find_recoverable_files(home / "lissom")
    expect(len(found) <= 1, "the same work is offered twice")
    kept = number_of(load_recoverable_file(found[0])[0]) if found else -1
    since = times.get(max(in_file, kept), min(times.values()))
    lost = max(times.values()) - since
    expect(lost <= MOST_LOST, f"{lost:.1f} s of edits are lost")
    left = check_nothing_left(home, {"a.lissom", "lissom", *_locks(home)})
    settings = home / "lissom"
    names = {each.name for each in settings.iterdir() if not PART.fullmatch(each.name)}
    return lost, in_file >= kept, left + check_nothing_left(settings, names)


def _locks(folder: Path) -> set[str]:
    # Beside a project is a file that tells who works on it; without its window nobody holds it.
    return {each.name for each in folder.glob(".lissom-*.lock")}


def two_windows(rng: np.random.Generator, count: int) -> dict[str, float]:
    """Let two windows work on one file, and kill both."""
    questions = 0
    with screen() as shown:
        for _ in timed(range(count)):
            with tempfile.TemporaryDirectory() as name:
                questions += _against_each_other(rng, shown, Path(name))
    return {"pairs": count, "questions": questions}


def _against_each_other(rng: np.random.Generator, shown: Screen, home: Path) -> int:
    path = home / "a.lissom"
    save_project(path, numbered(load_project(sample_images() / "ring.lissom"), 0))
    with driven(shown, home, path, path, KEPT_EVERY) as one:
        expect(one.hear() == "opened", "it is not opened")
        with driven(shown, home, path, path, KEPT_EVERY) as other:
            expect(other.hear() == "Already open", "the second window does not ask")
            expect(other.do("anyway") == "opened", "it is not opened anyway")
            windows, number, questions = (one, other), 0, 0
            in_file, knows = 0, [0, 0]
            for _ in range(12):
                which = int(rng.integers(2))
                number += 1
                windows[which].do("edit", number)
                if rng.random() < 0.5:
                    told = windows[which].do("save", number)
                    is_own = knows[which] == in_file
                    words = "saved" if is_own else "Changed elsewhere"
                    expect(told == f"{words} {number}", f"{told} instead of {words} {number}")
                    questions += not is_own
                    if is_own:
                        in_file = knows[which] = number
                expect(number_of(load_project(path)) == in_file, "what was saved was replaced")
            for each, last in zip(windows, (number + 1, number + 2), strict=True):
                each.do("edit", last)
            time.sleep(3 * KEPT_EVERY + IDLE)
            for each in windows:
                each.end()
    found = {
        number_of(load_recoverable_file(each)[0])
        for each in find_recoverable_files(home / "lissom")
    }
    expect(found == {number + 1, number + 2}, f"{found} is kept of both")
    return questions


KINDS = (
    ("asked to end by signals", signalled, 0.2),
    ("displays that go away", lost_displays, 0.2),
    ("killed", killed, 0.45),
    ("two windows on one file", two_windows, 0.15),
)


def campaign(seed: int, amount: int) -> Iterator[tuple[str, dict[str, float]]]:
    """End so many windows, and yield the figures of each kind."""
    if shutil.which("Xvfb") is None:
        print("  there is no X server (Xvfb) for windows", file=sys.stderr)
        return
    for name, end_them, share in KINDS:
        rng = np.random.default_rng([seed, len(name)])
        yield name, end_them(rng, max(1, round(share * amount)))
