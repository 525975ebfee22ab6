"""Processes that are ended at random moments while they save, keep unsaved work, or export.

After each kill a person comes back, and finds what was promised: the project file is whole, and the
last one that was told to be saved or a later one; of unsaved work no more than a minute is lost;
every exported file is whole; and what was left half written goes away at the next start, where an
export was not only asked to end: then it leaves nothing itself.
"""

import os
import signal
import struct
import tempfile
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import replace
from functools import partial
from pathlib import Path
from types import MappingProxyType

import numpy as np

from app.cli.main import main
from app.document import Document, History, Variant
from app.document.commands import scene_commands
from app.document.settings import Marker
from app.editor.actions.project_files import autosaving
from app.editor.parts.project_file import ProjectFile
from app.editor.parts.selection import Selection
from app.editor.parts.settings import SessionSettings
from app.editor.project import Project
from app.editor.session import Session
from app.editor.work.jobs import Jobs
from app.editor.work.layer_runtime import LayerRuntimes
from app.storage.assets import sample_images
from app.storage.autosave import find_recoverable_files, load_recoverable_file
from app.storage.files.atomic import PART, atomic_file, remove_abandoned_files
from app.storage.project_file import load_project, save_project
from tests.campaigns.slowest import note

LAYERED = "friend.lissom"
FRIEND = sample_images() / LAYERED
# What ends an export: a kill as often as all others together.
SIGNALS = (*(3 * [signal.SIGKILL]), signal.SIGTERM, signal.SIGHUP, signal.SIGINT)
MOST_LOST = 60.0  # seconds of edits
# Seconds that pass for the editor in one of ours: writing seems to take as many times longer.
LAPSE = 40.0
FORMATS = ("png", "gif", "apng", "webp", "mp4", "webm", "spritesheet", "glb", "html")
# Long enough for several files, short enough for many kills.
SCOPE = ("--frames", "0:5", "--size", "120x90")
# Sheets of other frames, whose data tell them apart.
OTHER_SCOPE = ("--frames", "6:11", "--size", "120x90")
OLD, NEW = "#ff0000", "#00ff00"
MODEL_SCOPE = ("--frames", "0:5", "--triangles", "200")
TOLD = struct.Struct("<qd")


class LostError(AssertionError):
    """Something that was promised to be there is not."""


def expect(holds: bool, what: str) -> None:  # noqa: FBT001 - the only argument but words
    """Fail unless something holds."""
    if not holds:
        raise LostError(what)


class Victim:
    """A process that works until it is killed, and tells what it has done.

    Parameters
    ----------
    work : callable
        Takes what tells a number and a time; runs in the other process, and returns its status.
    """

    def __init__(self, work: Callable[[Callable[[int, float], None]], int | None]) -> None:
        ours, theirs = os.pipe()
        self._begun = time.perf_counter()
        self._process = os.fork()
        if self._process == 0:
            status = 3
            try:
                os.close(ours)
                for stream in (1, 2):
                    os.dup2(os.open(os.devnull, os.O_WRONLY), stream)
                status = work(lambda number, at: os.write(theirs, TOLD.pack(number, at)) and None)
            finally:
                os._exit(status or 0)
        os.close(theirs)
        self._told = ours

    def wait_for_word(self) -> tuple[int, float]:
        """Wait until it has told something."""
        return TOLD.unpack(os.read(self._told, TOLD.size))

    def kill(self, number: int = signal.SIGKILL) -> tuple[bool, list[tuple[int, float]]]:
        """Kill it, or ask it to end; return whether that ended it, and all else that it told."""
        os.kill(self._process, number)
        status = os.waitstatus_to_exitcode(os.waitpid(self._process, 0)[1])
        note(signal.Signals(number).name, time.perf_counter() - self._begun)
        killed = -number if number == signal.SIGKILL else 128 + number
        expect(status in (0, killed), f"it ended by itself, with {status}")
        with os.fdopen(self._told, "rb") as told:
            words = told.read()
        return status != 0, list(TOLD.iter_unpack(words))


def numbered(document: Document, number: int) -> Document:
    """Return a document that says which one it is, and is packed to another size each time."""
    padding = MappingProxyType({"padding.bin": bytes(number % 7 * 40_000)})
    return replace(document, markers=(Marker(frame=0, name=f"{number}"),), unknown_members=padding)


def number_of(document: Document) -> int:
    """Return which document it is."""
    return int(document.markers[0].name)


def check_nothing_left(folder: Path, kept: set[str]) -> int:
    """Expect that a fresh start leaves nothing but what is kept; return how much it removed."""
    before = {path.name for path in folder.iterdir()} - kept
    expect(all(map(PART.fullmatch, before)), f"there is {before} besides")
    remove_abandoned_files(folder)
    after = {path.name for path in folder.iterdir()} - kept
    expect(not after, f"{after} is never removed")
    return len(before)


def kill_saves(rng: np.random.Generator, kills: int) -> dict[str, float]:
    """Kill processes that save a project with layers again and again."""
    document = load_project(FRIEND)
    survived = replaced = swept = 0
    with tempfile.TemporaryDirectory() as name, spared(Path(name)) as mark:
        folder, path = Path(name), Path(name) / "a.lissom"
        while survived < kills:
            save_project(path, numbered(document, 0))
            victim = Victim(lambda tell: _save_on(tell, path, document))
            first, _ = victim.wait_for_word()
            time.sleep(rng.uniform(0.0, 0.12))
            _, told = victim.kill()
            last = max([first, *(number for number, _ in told)])
            found = number_of(load_project(path))
            expect(found in (last, last + 1), f"{last} was saved, {found} is there")
            survived += 1
            replaced += found == last + 1
            swept += check_nothing_left(folder, {"a.lissom", mark})
    return {"kills": survived, "replaced but not told": replaced, "half-written removed": swept}


def _save_on(tell: Callable[[int, float], None], path: Path, document: Document) -> None:
    tell(0, 0.0)
    for number in range(1, 1_000_000):
        save_project(path, numbered(document, number))
        tell(number, 0.0)


def kill_autosaves(rng: np.random.Generator, kills: int) -> dict[str, float]:
    """Kill editors in which somebody edits all the time and never saves."""
    document = load_project(FRIEND)
    survived = found = swept = 0
    worst = 0.0
    while survived < kills:
        with tempfile.TemporaryDirectory() as name:
            folder = Path(name)
            victim = Victim(lambda tell, at=folder: _edit_on(tell, at, document))
            first = victim.wait_for_word()
            time.sleep(rng.uniform(0.0, 1.6))
            _, told = victim.kill()
            edits = dict([first, *told])
            leftovers = find_recoverable_files(folder)
            expect(len(leftovers) <= 1, "the same work is offered twice")
            last = max(edits)
            kept = number_of(load_recoverable_file(leftovers[0])[0]) if leftovers else None
            since = edits[kept] if kept is not None else edits[min(edits)]
            lost = edits[last] - since
            expect(lost <= MOST_LOST, f"{lost:.0f} s of edits are lost")
            expect(kept is not None or edits[last] - edits[min(edits)] < MOST_LOST, "all is lost")
            worst = max(worst, lost)
            survived += 1
            found += kept is not None
            names = {path.name for path in leftovers} | {p.name for p in folder.glob("*.lock")}
            swept += check_nothing_left(folder, names)
    return {
        "kills": survived,
        "recovered": found,
        "most lost, s": worst,
        "half-written removed": swept,
    }


def _edit_on(tell: Callable[[int, float], None], folder: Path, document: Document) -> None:
    start = time.perf_counter()

    def clock() -> float:
        return 1000.0 + LAPSE * (time.perf_counter() - start)

    session = Session(clock=clock, jobs=Jobs(clock), settings=SessionSettings(folder=folder))
    session.project = Project(
        file=ProjectFile(name="a"),
        history=History(document, saved=True),
        runtimes=LayerRuntimes(layers={}),
        selection=Selection(active=document.layers[-1].id),
    )
    number = 0
    session.project.history.do(scene_commands.add_marker(0, "0"))
    while True:
        tell(number, clock())
        autosaving.write_due_files(session)
        session.jobs.deliver()
        time.sleep(0.004)
        number += 1
        session.project.history.do(scene_commands.rename_marker(0, f"{number}"))


def kill_exports(
    rng: np.random.Generator, kills: int, formats: tuple[str, ...] = FORMATS
) -> dict[str, float]:
    """Kill exports of every format; what they take the place of was exported before."""
    formats = formats[: max(1, kills // 4)]  # each is exported twice before
    total = np.zeros(3, dtype=int)
    for number, name in enumerate(formats):
        share = kills * (number + 1) // len(formats) - kills * number // len(formats)
        if share:
            total += _kill_exports_of(rng, share, name)
    return dict(zip(("kills", "ended before", "half-written removed"), total.tolist(), strict=True))


def _kill_exports_of(rng: np.random.Generator, kills: int, name: str) -> tuple[int, int, int]:
    survived = finished = swept = 0
    with tempfile.TemporaryDirectory() as root:
        old, new, place = (Path(root) / part for part in ("old", "new", "place"))
        for folder in (old, new, place):
            folder.mkdir()
        project = Path(root) / LAYERED
        save_project(project, quick_friend())
        _run(partial(export_friend, old, name, OLD, project))
        begun = time.perf_counter()
        _run(partial(export_friend, new, name, NEW, project))
        seconds = time.perf_counter() - begun
        whole = {
            path.name: {path.read_bytes(), (new / path.name).read_bytes()} for path in old.iterdir()
        }
        expect(len(whole) > 0, f"{name} exports nothing")
        while survived < kills:
            with spared(place) as mark:
                for file in old.iterdir():
                    (place / file.name).write_bytes(file.read_bytes())
                victim = Victim(lambda _: export_friend(place, name, NEW, project))
                time.sleep(rng.uniform(0.2, 1.0) * seconds)
                number = int(rng.choice(SIGNALS))
                was_killed, _ = victim.kill(number)
                _check_export(place, new, whole, mark, name)
                survived += was_killed
                finished += not was_killed
                left = check_nothing_left(place, {*whole, mark})
                expect(number == signal.SIGKILL or not left, "what ended in order left something")
                swept += left
    return survived, finished, swept


def _check_export(
    place: Path, new: Path, whole: dict[str, set[bytes]], mark: str, name: str
) -> None:
    for path in place.iterdir():
        if path.name == mark or PART.fullmatch(path.name):
            continue
        expect(path.name in whole, f"{path.name} is there besides")
        expect(path.read_bytes() in whole[path.name], f"{path.name} is half there")
    if name == "spritesheet" and (place / "a.json").exists():
        fits = [(place / n).read_bytes() == (new / n).read_bytes() for n in ("a.png", "a.json")]
        expect(fits[0] == fits[1], "the data are of another sprite sheet")


def quick_friend() -> Document:
    """Return what moves in the sample with layers, by the variant that is prepared soonest."""
    document = load_project(FRIEND)
    moving = [layer for layer in document.layers if len(layer.keys) > 1]
    layers = tuple(replace(layer, variant=Variant.NU) for layer in moving)
    return replace(document, layers=layers, switch_groups=())


def export_friend(folder: Path, name: str, background: str, project: Path = FRIEND) -> int:
    """Export the sample with layers as the command line does; return its exit status."""
    ending = {"spritesheet": "png"}.get(name, name)
    out = folder if name == "png" else folder / f"a.{ending}"
    frames = OTHER_SCOPE if name == "spritesheet" and background == OLD else SCOPE
    scope = MODEL_SCOPE if name in {"glb", "html"} else (*frames, "--background", background)
    return main(["export", str(project), "--out", str(out), "--format", name, *scope])


def _run(work: Callable[[], object]) -> None:
    """Do something in another process, since OpenGL and forks do not go together."""
    process = os.fork()
    if process == 0:
        try:
            for stream in (1, 2):
                os.dup2(os.open(os.devnull, os.O_WRONLY), stream)
            work()
            os._exit(0)
        finally:
            os._exit(3)
    expect(os.waitstatus_to_exitcode(os.waitpid(process, 0)[1]) == 0, "an export fails")


@contextmanager
def spared(folder: Path) -> Iterator[str]:
    """Write a file in a folder meanwhile, which nobody may take for abandoned; yield its name."""
    with atomic_file(folder / "written meanwhile") as file:
        (mark,) = (path.name for path in folder.iterdir() if PART.fullmatch(path.name))
        file.write(b"whole")
        yield mark
        expect((folder / mark).exists(), "what another process writes was removed")
    (folder / "written meanwhile").unlink()


KINDS = (
    ("saves", kill_saves, 0.45),
    ("autosaves", kill_autosaves, 0.3),
    ("exports", kill_exports, 0.25),
)


def campaign(seed: int, amount: int) -> Iterator[tuple[str, dict[str, float]]]:
    """Kill so many processes of all kinds together, and yield the figures of each kind."""
    for name, kill, share in KINDS:
        rng = np.random.default_rng([seed, len(name)])
        yield f"killed {name}", kill(rng, max(1, round(share * amount)))
