"""Disks that are full, places that may not be written to, little memory, no OpenGL.

Each fault is a real one, in a process of its own: limits and permissions of the system, a disk in
memory that is as good as full, a screen that nobody looks at. What was there stays whole, and what
went wrong is told in one line that says what to do.
"""

import os
import re
import resource
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from functools import partial
from pathlib import Path

import numpy as np

from app.document import Document
from app.errors import LissomError
from app.folders import settings_folder
from app.storage.assets import sample_images
from app.storage.autosave import (
    UNKNOWN_SOURCE,
    Autosave,
    find_recoverable_files,
    load_recoverable_file,
)
from app.storage.preferences import (
    Preferences,
    load_preferences,
    make_settings_folder,
    save_preferences,
)
from app.storage.project_file import load_project, save_project
from tests.campaigns.kills import FORMATS, LAYERED, expect, export_friend, number_of, numbered
from tests.campaigns.slowest import timed
from tests.campaigns.windows import screen

ROOT = Path(__file__).parents[2]
NOBODY, UNKNOWN_PERSON = 65534, 54321  # ids of people; the latter has no entry anywhere
LEFT = 20_000  # bytes that are free on a disk that is as good as full
PATIENCE = 120.0  # seconds for anything to happen


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
    for kind in timed(kinds):
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
        "unsaved work": lambda number: autosave.write(numbered(document, number), UNKNOWN_SOURCE),
        "preferences": lambda number: save_preferences(folder, Preferences(scale=1 + number / 9)),
    }[kind]
    write(1)
    before = _contents(folder)
    size = max(map(len, before.values()))
    limit = partial(_limit_files, int(rng.integers(0, 0.9 * size)))
    words = words_of(lambda: write(2), limit)
    expect(re.search(r"The file needs [\d.,]+ [KM]B", words) is not None, words)
    expect(_contents(folder) == before, f"the {kind} before is not whole")
    autosave.remove()


def _full_export(rng: np.random.Generator, folder: Path) -> None:
    name = str(rng.choice(FORMATS))
    words = words_of(
        partial(export_friend, folder, name, "#ff0000"),
        partial(_limit_files, int(rng.integers(0, 2500))),
    )
    expect("free some space" in words, words)
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
            partial(Autosave(disk).write, numbered(document, 2), UNKNOWN_SOURCE),
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
        _expect_words(save, "the file is read-only")
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
        keep = partial(Autosave(settings).write, numbered(document, 2), UNKNOWN_SOURCE)
        settings.write_bytes(b"")
        _expect_words(keep, "cannot be made")
        settings.unlink()
        settings.mkdir(mode=0o755)
        (settings / "unsaved-1.lissom").write_bytes(before)
        (settings / "unsaved-2.lissom").write_bytes(before)
        (settings / "unsaved-2.lissom").chmod(0)
        _expect_words(keep, "no permission to write to")
        _expect_words(partial(make_settings_folder, settings), "no permission to write to")
        _expect_words(
            partial(save_preferences, settings, Preferences()), "no permission to write to"
        )

        def look() -> None:
            expect(len(find_recoverable_files(settings)) == 2, "unsaved work is not offered")
            load_recoverable_file(settings / "unsaved-1.lissom")
            expect(load_preferences(settings) == Preferences(), "other preferences")

        expect(words_of(look, _be_nobody) == "", "unsaved work in a folder that is read only")
        settings.chmod(0)
        expect(
            words_of(partial(find_recoverable_files, settings), _be_nobody) == "", "a secret folder"
        )
        settings.chmod(0o755)

        folder.chmod(0o555)
        _expect_words(save, "choose another folder")
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


def small_memory(rng: np.random.Generator, count: int) -> dict[str, float]:
    """Let commands have little memory: they do what they are asked, or tell in one line."""
    ended = 0
    for number in timed(range(count)):
        words, limit = WITH_LIMITS[number % len(WITH_LIMITS)], int(rng.integers(40, 1500))
        with tempfile.TemporaryDirectory() as name:
            own = [word.format(samples=sample_images(), out=f"{name}/out") for word in words]
            size = limit * 1_000_000
            done = subprocess.run(
                [sys.executable, "-m", "app", *own],
                cwd=ROOT,
                env={**os.environ, "HOME": name, "XDG_CONFIG_HOME": name},
                preexec_fn=lambda size=size: resource.setrlimit(resource.RLIMIT_AS, (size, size)),
                capture_output=True,
                text=True,
                timeout=PATIENCE,
                check=False,
            )
            what = f"{words[0]} with {limit} MB ends with {done.returncode}: {done.stderr[-500:]}"
            told = [line for line in done.stderr.splitlines() if "lissom: error:" in line]
            expect(done.returncode == 0 or (done.returncode == 2 and len(told) == 1), what)
            expect("Traceback" not in done.stderr, what)
            expect(not (done.returncode and Path(name, "out").is_file()), what)
            ended += done.returncode == 0
    return {"commands": count, "had enough": ended}


WITH_LIMITS = (
    ("domain", "{samples}/giraffe.png", "--out", "{out}"),
    ("export", "{samples}/friend.lissom", "--frames", "0:3", "--size", "160x120", "--out", "{out}"),
    ("thumbnail", "{samples}/dragon.lissom", "--out", "{out}"),
    ("pose", "{samples}/ring.png", "{samples}/ring.json", "--out", "{out}"),
    ("export", "{samples}/giraffe.lissom", "--format", "glb", "--out", "{out}"),
)
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
        with screen() as shown:
            for variables in WITHOUT_GL:
                words = _run_app([], {**variables, "DISPLAY": shown.name})
                expect("The window cannot be opened" in words, words)
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
    ("little memory", small_memory, 0.2),
    ("no OpenGL", refused_gl, 0.0),
)


def campaign(seed: int, amount: int) -> Iterator[tuple[str, dict[str, float]]]:
    """Try so many faults, and yield the figures of each kind."""
    for name, try_them, share in KINDS if amount > FEW else KINDS[:2]:
        rng = np.random.default_rng([seed, len(name)])
        yield name, try_them(rng, max(1, round(share * amount)))
