"""Disks that are full, places that may not be written to, signals to the window, no OpenGL.

Each fault is a real one, in a process of its own: limits and permissions of the system, a disk in
memory that is as good as full, a screen that nobody looks at. What was there stays whole, and what
went wrong is told in one line that says what to do.
"""

import os
import re
import resource
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

from app.document import Document
from app.errors import LissomError
from app.storage.assets import sample_images
from app.storage.autosave import UNKNOWN, Autosave, find_leftovers, load_leftover
from app.storage.preferences import (
    Preferences,
    load_preferences,
    make_settings_folder,
    save_preferences,
    settings_folder,
)
from app.storage.project_file import load_project, save_project
from tests.campaigns.kills import FORMATS, LAYERED, expect, export_friend, number_of, numbered

ROOT = Path(__file__).parents[2]
NOBODY, UNKNOWN_PERSON = 65534, 54321  # ids of people; the latter has no entry anywhere
LEFT = 20_000  # bytes that are free on a disk that is as good as full
PATIENCE = 120.0  # seconds for anything to happen
MOST_SECONDS = 15.0  # from a signal to the end of the window, on a busy machine


def words_of(work: Callable[[], object], *prepare: Callable[[], object]) -> str:
    """Do something in another process, prepared in it; return what it told instead of doing it."""
    ours, theirs = os.pipe()
    process = os.fork()
    if process == 0:
        status = 3
        try:
            os.dup2(os.open(os.devnull, os.O_WRONLY), 1)
            os.dup2(theirs, 2)
            for step in prepare:
                step()
            work()
            status = 0
        except (LissomError, SystemExit) as error:
            if isinstance(error, LissomError):
                os.write(2, f"{error}".encode())
            status = 2
        finally:
            os._exit(status)
    os.close(theirs)
    with os.fdopen(ours, "r") as told:
        words = told.read()
    status = os.waitstatus_to_exitcode(os.waitpid(process, 0)[1])
    expect(status == (2 if words else 0), f"it ends with {status} and {words!r}")
    expect("Traceback" not in words, words)
    return words


def full_disks(rng: np.random.Generator, count: int) -> dict[str, float]:
    """Write where files may have so many bytes only, and on a disk that is really full."""
    document = load_project(sample_images() / LAYERED)
    works = {"project": 0.4, "unsaved work": 0.3, "preferences": 0.1, "export": 0.2}
    kinds = rng.choice(list(works), count, p=list(works.values()))
    for kind in kinds:
        with tempfile.TemporaryDirectory() as name:
            if kind == "export":
                _full_export(rng, Path(name))
            else:
                _full_write(rng, Path(name), document, kind)
    return {"writes refused": count, "on a full disk": _full_tmpfs(document, exports=count > FEW)}


def _full_write(rng: np.random.Generator, folder: Path, document: Document, kind: str) -> None:
    autosave = Autosave(folder)
    write = {
        "project": lambda number: save_project(folder / "a", numbered(document, number)),
        "unsaved work": lambda number: autosave.write(numbered(document, number), UNKNOWN),
        "preferences": lambda number: save_preferences(folder, Preferences(scale=1 + number / 9)),
    }[kind]
    write(1)
    before = _contents(folder)
    size = max(map(len, before.values()))
    limit = partial(_limit_files, int(rng.integers(0, 0.9 * size)))
    words = words_of(lambda: write(2), limit)
    expect(re.search(r"it takes [\d.,]+ [KM]B; make room", words) is not None, words)
    expect(_contents(folder) == before, f"the {kind} before is not whole")
    autosave.forget()


def _full_export(rng: np.random.Generator, folder: Path) -> None:
    name = str(rng.choice(FORMATS))
    words = words_of(
        partial(export_friend, folder, name, "#ff0000"),
        partial(_limit_files, int(rng.integers(0, 2500))),
    )
    expect("make room" in words, words)
    expect(words.count("\n") == 1, words)
    expect(_contents(folder) == {}, "something is left of an export")


def _full_tmpfs(document: Document, *, exports: bool) -> int:
    """Write where a disk in memory has no room; return how often, 0 where there can be none."""
    done = 0
    with tempfile.TemporaryDirectory() as name, _small_disk(Path(name)) as disk:
        if disk is None:
            return 0
        save_project(disk / "a", numbered(document, 1))
        (disk / "filler").write_bytes(bytes(shutil.disk_usage(disk).free - LEFT))
        before = _contents(disk)
        writes = [
            partial(save_project, disk / "a", numbered(document, 2)),
            partial(Autosave(disk).write, numbered(document, 2), UNKNOWN),
            partial(export_friend, disk, "apng", "#ff0000"),
        ]
        for write in writes if exports else writes[:2]:
            words = words_of(write)
            expect("No space left on device" in words and "are free there" in words, words)
            for lock in disk.glob("*.lock"):
                lock.unlink()
            expect(_contents(disk) == before, "what was there is not whole")
            done += 1
        expect(number_of(load_project(disk / "a")) == 1, "it cannot be opened on a full disk")
    return done


@contextmanager
def _small_disk(folder: Path) -> Iterator[Path | None]:
    mount = ["mount", "-t", "tmpfs", "-o", "size=2m", "tmpfs", str(folder)]
    try:
        is_there = subprocess.run(mount, capture_output=True, check=False).returncode == 0
    except OSError:
        is_there = False
    try:
        yield folder if is_there else None
    finally:
        if is_there:
            subprocess.run(["umount", str(folder)], check=True)


def _limit_files(size: int) -> None:
    resource.setrlimit(resource.RLIMIT_FSIZE, (size, size))


def _contents(folder: Path) -> dict[str, bytes]:
    return {path.name: path.read_bytes() for path in folder.iterdir() if path.suffix != ".lock"}


def refused_places(_: np.random.Generator, __: int) -> dict[str, float]:
    """Write where somebody who is not root may not."""
    document = load_project(sample_images() / LAYERED)
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        folder.chmod(0o777)
        path = folder / "a.lissom"
        save_project(path, numbered(document, 1))
        before = path.read_bytes()
        save = partial(save_project, path, numbered(document, 2))

        path.chmod(0o444)
        _expect_words(save, "it may only be read")
        path.chmod(0o666)

        def lose() -> None:
            # Of their own, and taken away between two saves.
            own = folder / "own"
            own.mkdir()
            save_project(own / "b", numbered(document, 1))
            own.chmod(0o555)
            with suppress(LissomError):
                save_project(own / "b", numbered(document, 2))
                os._exit(4)
            expect(number_of(load_project(own / "b")) == 1, "the project before is gone")
            own.chmod(0o755)
            save_project(own / "b", numbered(document, 2))

        expect(words_of(lose, _be_nobody) == "", "a folder whose permission was lost")

        settings = folder / "settings"
        keep = partial(Autosave(settings).write, numbered(document, 2), UNKNOWN)
        settings.write_bytes(b"")
        _expect_words(keep, "cannot be made")
        settings.unlink()
        settings.mkdir(mode=0o755)
        (settings / "unsaved-1.lissom").write_bytes(before)
        (settings / "unsaved-2.lissom").write_bytes(before)
        (settings / "unsaved-2.lissom").chmod(0)
        _expect_words(keep, "may not be written to")
        _expect_words(partial(make_settings_folder, settings), "may not be written to")
        _expect_words(partial(save_preferences, settings, Preferences()), "may not be written to")

        def look() -> None:
            expect(len(find_leftovers(settings)) == 2, "unsaved work is not offered")
            load_leftover(settings / "unsaved-1.lissom")
            expect(load_preferences(settings) == Preferences(), "other preferences")

        expect(words_of(look, _be_nobody) == "", "unsaved work in a folder that is read only")
        settings.chmod(0)
        expect(words_of(partial(find_leftovers, settings), _be_nobody) == "", "a secret folder")
        settings.chmod(0o755)

        folder.chmod(0o555)
        _expect_words(save, "may not be written to; choose another one")
        expect(path.read_bytes() == before, "what may not be written to was written to")

        def without_home() -> None:
            os.environ.pop("HOME", None)
            os.environ.pop("XDG_CONFIG_HOME", None)
            make_settings_folder(settings_folder())

        if os.getuid() == 0:
            words = words_of(without_home, partial(os.setuid, UNKNOWN_PERSON))
            expect("cannot be made" in words, words)
        folder.chmod(0o755)
    return {"places refused": 9}


def _be_nobody() -> None:
    if os.getuid() == 0:
        os.setgroups([])
        os.setgid(NOBODY)
        os.setuid(NOBODY)


def _expect_words(work: Callable[[], object], words: str) -> None:
    told = words_of(work, _be_nobody)
    expect(words in told, told)


# Runs the window, and adds markers all the time from when a project is open; tells each.
EDIT = """
import sys, threading, time
from app.cli.commands import window
from app.cli.main import main
from app.editor import do
from app.editor.actions import keys, playback

class Edited(window.Window):
    def __init__(self, *arguments):
        super().__init__(*arguments)
        threading.Thread(target=self.edit, daemon=True).start()
    def edit(self):
        session, number = self.session, 0
        while session.project is None:
            time.sleep(0.01)
        while number < session.project.document.frames.last:
            self.ask(do(playback.seek, number))
            self.ask(do(keys.mark_here))
            self.wake()
            while not any(m.frame == number for m in session.project.document.markers):
                time.sleep(0.01)
            print(number, flush=True)
            number += 1

window.Window = Edited
raise SystemExit(main(sys.argv[1:]))
"""


def ended_windows(rng: np.random.Generator, count: int) -> dict[str, float]:
    """End windows, in which somebody edits all the time, by signals at random moments."""
    if shutil.which("Xvfb") is None:
        return {"windows ended": 0}
    ends = []
    with virtual_screen() as screen:
        for _ in range(count):
            number = int(rng.choice([signal.SIGTERM, signal.SIGHUP, signal.SIGINT]))
            ends.append(
                _end_window(
                    rng, screen, lambda window, n=number: window.send_signal(n), 128 + number
                )
            )
    return _told(ends)


def lost_displays(rng: np.random.Generator, count: int) -> dict[str, float]:
    """End the X servers of windows, in which somebody edits all the time, at random moments."""
    if shutil.which("Xvfb") is None:
        return {"windows ended": 0}
    ends = []
    for _ in range(count):
        with virtual_screen() as screen:
            ends.append(_end_window(rng, screen, lambda _, s=screen: s.server.kill(), 1))
    return _told(ends)


def _told(ends: list[tuple[float, int]]) -> dict[str, float]:
    longest, lost = (max(column) for column in zip(*ends, strict=True))
    return {
        "windows ended": len(ends),
        "longest until the end, s": longest,
        "most edits lost": lost,
    }


class Screen(NamedTuple):
    """An X server that nobody looks at, and its name."""

    server: subprocess.Popen[bytes]
    name: str


def _end_window(
    rng: np.random.Generator,
    screen: Screen,
    end: Callable[[subprocess.Popen[str]], None],
    status: int,
) -> tuple[float, int]:
    """End a window; return the seconds that it takes, and how many edits are lost."""
    with tempfile.TemporaryDirectory() as home:
        return _end_window_at(rng, screen, end, status, Path(home))


def _end_window_at(
    rng: np.random.Generator,
    screen: Screen,
    end: Callable[[subprocess.Popen[str]], None],
    status: int,
    home: Path,
) -> tuple[float, int]:
    environment = {
        **os.environ,
        "DISPLAY": screen.name,
        "HOME": str(home),
        "XDG_CONFIG_HOME": str(home),
        "LIBGL_ALWAYS_SOFTWARE": "1",
    }
    with subprocess.Popen(
        [sys.executable, "-c", EDIT, str(sample_images() / "bar.png")],
        cwd=ROOT,
        env=environment,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    ) as process:
        try:
            expect(bool(select.select([process.stdout], [], [], PATIENCE)[0]), "no window")
            first = process.stdout.readline()
            time.sleep(rng.uniform(0, 2))
            begun = time.monotonic()
            end(process)
            told, said = process.communicate(timeout=PATIENCE)
            seconds = time.monotonic() - begun
        finally:
            process.kill()
    last = int((first + told).split()[-1])
    expect(process.returncode == status, f"it ends with {process.returncode}: {said}")
    expect("your unsaved work was kept" in said, said)
    expect("Traceback" not in said, said)
    expect(seconds < MOST_SECONDS, f"it takes {seconds} s to end")
    (kept,) = find_leftovers(home / "lissom")
    names = len(load_leftover(kept)[0].markers)
    expect(names >= last + 1, f"{last + 1} markers were set, {names} kept")
    return seconds, max(0, last + 1 - names)


@contextmanager
def virtual_screen() -> Iterator[Screen]:
    """Start an X server on whatever number is free, and end it."""
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


WITHOUT_GL = (
    {"MESA_GL_VERSION_OVERRIDE": "2.1"},
    {"MESA_GLSL_VERSION_OVERRIDE": "120"},
    {"GALLIUM_DRIVER": "none", "MESA_LOADER_DRIVER_OVERRIDE": "none"},
)


def refused_gl(_: np.random.Generator, __: int) -> dict[str, float]:
    """Export, and open the window, where OpenGL is too old or has no driver."""
    tried = 0
    with tempfile.TemporaryDirectory() as name:
        export = ["export", str(sample_images() / "giraffe.lissom"), "--out", name]
        for variables in WITHOUT_GL:
            words = _run_app(export, variables)
            expect("cannot draw on this machine" in words, words)
            expect("apt install" in words, words)
            tried += 1
        expect(_contents(Path(name)) == {}, "something was written")
    if shutil.which("Xvfb") is not None:
        with virtual_screen() as screen:
            for variables in WITHOUT_GL:
                words = _run_app([], {**variables, "DISPLAY": screen.name})
                expect("the window cannot be opened" in words, words)
                expect("lissom doctor" in words, words)
                tried += 1
    for display in ("", ":9999"):
        words = _run_app([], {"DISPLAY": display, "WAYLAND_DISPLAY": ""})
        expect("display" in words, words)
        expect("command line" in words, words)
        tried += 1
    return {"refusals told": tried}


def _run_app(words: list[str], variables: dict[str, str]) -> str:
    with tempfile.TemporaryDirectory() as home:
        done = subprocess.run(
            [sys.executable, "-m", "app", *words],
            cwd=ROOT,
            env={**os.environ, "HOME": home, "XDG_CONFIG_HOME": home, **variables},
            capture_output=True,
            text=True,
            timeout=PATIENCE,
            check=False,
        )
    expect(done.returncode == 2, f"it ends with {done.returncode}: {done.stderr}")
    expect("Traceback" not in done.stderr, done.stderr)
    return done.stderr


FEW = 10  # with which only the quick ones are tried, as in the tests
# Each with its share of the amount; those that always do the same come once.
KINDS = (
    ("full disks", full_disks, 0.8),
    ("refused places", refused_places, 0.0),
    ("signals to the window", ended_windows, 0.1),
    ("displays that go away", lost_displays, 0.1),
    ("no OpenGL", refused_gl, 0.0),
)


def campaign(seed: int, amount: int) -> Iterator[tuple[str, dict[str, float]]]:
    """Try so many faults, and yield the figures of each kind."""
    for name, try_them, share in KINDS if amount > FEW else KINDS[:2]:
        rng = np.random.default_rng([seed, len(name)])
        yield name, try_them(rng, max(1, round(share * amount)))
