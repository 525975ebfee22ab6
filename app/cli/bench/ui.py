"""The window: its start, the way from a picture to a drag, its frames, and its latency."""

import statistics
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path

import numpy as np
from imgui_bundle import ImVec2

import app
from app.cli.bench import idle
from app.cli.bench.start import MARKS
from app.cli.bench.table import Row, Table
from app.cli.process import share_interpreter
from app.document import Meshing, Target, Variant, clip_of
from app.editor import Jobs, Project, Puppet, Session, do
from app.editor.actions import files, playback
from app.errors import LissomError
from app.render import Renderer
from app.render.gpu import create_context
from app.storage import decode_picture, load_project, sample_images
from app.ui.window import PAUSE, SIZE, Offscreen, Window, has_display, share_heap
from engine.domain import mesh_inside

SAMPLE, PICTURE = "giraffe.lissom", "dragon.png"
TABS = ("Handle", "Deform", "Distortion", "Mesh", "Export")
REFRESH = 1 / 60  # seconds from frame to frame of a screen
REACH = 40.0  # pixels around a handle in which it is dragged, unless told
HARD = 6.0  # how much farther a hard pull goes
LATER = 20  # pictures that are shown while a hand goes from a handle to the timeline
PATIENCE = 120.0  # seconds that anything may take


@dataclass(frozen=True, slots=True, kw_only=True)
class Extent:
    """How much is measured: repeats of the start and of opening, frames, moves of the pointer.

    And in how many pixels around it a handle is dragged, for how many seconds the window is left
    alone, how large it is, and by which variant the in-betweens are.
    """

    triangles: int = 100_000
    repeats: int = 3
    frames: int = 60
    moves: int = 100
    reach: float = REACH
    idle: float = 10.0
    size: tuple[int, int] = SIZE
    variant: Variant = Variant.METRIC


def tables(extent: Extent | None = None) -> Iterator[Table]:
    """Measure the window without a display, on whatever draws here; its start also on one."""
    extent = extent or Extent()
    share_interpreter()
    share_heap()
    yield _start(extent)
    with tempfile.TemporaryDirectory() as folder:
        stage = Driver(Path(folder), extent.size)
        yield _opening(stage, extent)
        stage.settle()
        files.show(stage.session, Path(folder) / SAMPLE, _giraffe(extent))
        stage.settle()
        yield from _frames(stage, extent)
        yield _latency(stage, extent)
        yield _release(stage, extent)
        yield _playhead(stage, extent)
    yield idle.table(extent.idle)


@dataclass(frozen=True, slots=True, kw_only=True)
class _Frame:
    """Seconds of a frame: by the clock until all of it was drawn, and of the interface alone."""

    whole: float
    own: float


class _Watched(Window):
    """A window that knows how long its thread has drawn the viewport's picture."""

    canvas_seconds = 0.0

    def draw_canvas(self) -> None:
        begun = time.thread_time()
        super().draw_canvas()
        self.canvas_seconds += time.thread_time() - begun


class _Screen(Offscreen):
    """A screen that knows how long its thread has drawn what ImGui made."""

    paint_seconds = 0.0

    def paint(self) -> None:
        begun = time.thread_time()
        super().paint()
        self.paint_seconds += time.thread_time() - begun


class Driver:
    """The window that is measured, with a clock that can be put forward."""

    def __init__(self, folder: Path, size: tuple[int, int] = SIZE) -> None:
        self._ahead = 0.0
        self._woken = threading.Event()
        self.session = Session(
            clock=lambda: time.perf_counter() + self._ahead, jobs=Jobs(), folder=folder
        )
        self.session.jobs.wake = self._woken.set
        self._gl = create_context()
        self._window = _Watched(self.session, lambda: Renderer(self._gl))
        self._screen = _Screen(self._window, self._gl, size=size)
        self.frame()

    @property
    def device(self) -> str:
        """What draws."""
        return str(self._gl.info["GL_RENDERER"])

    @property
    def project(self) -> Project:
        """What is open."""
        if self.session.project is None:
            raise RuntimeError([toast.text for toast in self.session.toasts])
        return self.session.project

    def frame(self, ahead: float = 0.0) -> _Frame:
        """Draw a frame, with the session's clock put forward before it."""
        self._ahead += ahead
        drawn = self._window.canvas_seconds + self._screen.paint_seconds
        begun, worked = time.perf_counter(), time.thread_time()
        self._screen.frame(painted=True)
        whole, own = time.perf_counter() - begun, time.thread_time() - worked
        drawn = self._window.canvas_seconds + self._screen.paint_seconds - drawn
        return _Frame(whole=whole, own=own - drawn)

    def until(self, is_true: Callable[[], bool]) -> None:
        """Draw frames, as a screen would show them, until something is true."""
        patience = time.perf_counter() + PATIENCE
        while not is_true():
            if time.perf_counter() > patience:
                raise TimeoutError(f"the window did not get on: {self.session.jobs.kinds}")
            self.refresh()

    def refresh(self) -> _Frame:
        """Draw a frame, and wait until a screen would show the next one, as the window does."""
        due = time.perf_counter() + REFRESH
        self._woken.clear()
        frame = self.frame()
        if self._window.awaits_worker:
            self._woken.wait(PAUSE)
        else:
            time.sleep(max(0.0, due - time.perf_counter()))
        return frame

    def settle(self) -> None:
        """Wait for the workers to finish everything; frames are drawn only where one is due."""
        self.refresh()
        while self.session.jobs.kinds:
            if not self.session.jobs.settle(PATIENCE):
                raise TimeoutError(f"the window did not get on: {self.session.jobs.kinds}")
            self.refresh()

    def show_tab(self, title: str) -> None:
        """Bring a panel to the front."""
        self._screen.show_tab(title)
        for _ in range(3):
            self.frame()
        self.settle()

    def ask(self, verb: Callable[..., None], *arguments: object) -> None:
        """Do something at the end of the next frame, as if a panel had asked for it."""
        self._window.ask(do(verb, *arguments))

    def point(self, place: complex) -> complex:
        """Return where a place of the drawing's plane is on the screen, x + iy."""
        return complex(*self._screen.point(place))

    def mouse(self, point: complex, *, down: bool | None = None) -> None:
        """Put the mouse on a point of the screen; press its button or let it go, if told to."""
        self._screen.move_mouse(ImVec2(point.real, point.imag))
        if down is not None:
            self._screen.press(down=down)


def _start(extent: Extent) -> Table:
    """Measure from the command to the window, each time in a process of its own."""
    times = [_open_window() for _ in range(extent.repeats)]
    rows = [
        Row(name=mark, seconds=statistics.median(column), note=f"at most {_ms(max(column))}")
        for mark, column in zip(MARKS, zip(*times, strict=True), strict=True)
    ]
    where = "on the screen" if has_display() else "without a display"
    return Table(title=f"From the command to the window, {where}", rows=tuple(rows))


def _open_window() -> list[float]:
    """Return the seconds to each mark."""
    begun = time.perf_counter()
    with subprocess.Popen(
        [sys.executable, "-m", "app.cli.bench.start"],
        cwd=Path(app.__file__).parents[1],
        stdout=subprocess.PIPE,
    ) as process:
        times = [time.perf_counter() - begun for _ in process.stdout or ()]
    if process.returncode or len(times) != len(MARKS):
        raise LissomError(f"the window did not open: exit status {process.returncode}")
    return times


def _opening(stage: Driver, extent: Extent) -> Table:
    """Measure from a dropped picture to a drag."""
    stage.session.meshing = Meshing(triangles=extent.triangles)
    path = sample_images() / PICTURE
    times = [_open_and_drag(stage, path, extent.reach) for _ in range(extent.repeats)]
    shown, followed = (
        Row(name=name, seconds=statistics.median(column), note=f"at most {_ms(max(column))}")
        for name, column in zip(
            ("until a click adds a handle", "until that handle has followed the pointer"),
            zip(*times, strict=True),
            strict=True,
        )
    )
    triangles = len(stage.project.figure.domain.mesh.triangles)
    return Table(
        title=f"From a dropped picture ({PICTURE}, {triangles:,} triangles) to a drag",
        rows=(shown, followed),
    )


def _open_and_drag(stage: Driver, path: Path, reach: float) -> tuple[float, float]:
    session = stage.session
    stage.mouse(0j)
    session.project = None
    stage.settle()
    begun = time.perf_counter()
    stage.ask(files.open_file, path)
    stage.until(lambda: session.project is not None and session.project.puppet.shown is not None)
    # What is drawn from now on takes the pointer.
    stage.refresh()
    shown = time.perf_counter() - begun
    project = stage.project
    vertices = project.figure.domain.mesh.vertices
    inside = complex(vertices[np.argmin(abs(vertices - vertices.mean()))])
    point = stage.point(inside)
    stage.mouse(point)
    stage.refresh()
    stage.mouse(point, down=True)
    stage.until(lambda: bool(project.figure.handles))
    stage.mouse(point + reach)
    stage.until(lambda: abs(_handle_place(project) - inside) > 1.0)
    followed = time.perf_counter() - begun
    stage.mouse(point + reach, down=False)
    stage.settle()
    return shown, followed


def _handle_place(project: Project) -> complex:
    """Return where the first handle is on the screen's plane."""
    return complex(project.puppet.shown.handle_places[0]) if project.puppet.shown else 0j


def _giraffe(extent: Extent) -> files.Opened:
    """Return the animated sample on a finer mesh."""
    document = load_project(sample_images() / SAMPLE)
    figure = document.figures[0]
    mesh = mesh_inside(*figure.domain.loops, triangles=extent.triangles)
    domain = replace(figure.domain, mesh=mesh)
    figure = replace(figure, domain=domain, variant=extent.variant)
    document = document.with_figure(figure)
    picture = decode_picture(figure.picture.data, SAMPLE)
    puppet = Puppet.of(clip_of(document, figure.id), picture)
    return files.Opened(document, {figure.id: puppet}, ())


def _frames(stage: Driver, extent: Extent) -> Iterator[Table]:
    """Measure frames of everything that a person does."""
    count = extent.frames
    runs = {
        "nothing moves": _still(stage, count),
        f"playing, {extent.variant}": playing(stage, count),
        "scrubbing": _scrubbing(stage, count),
        "dragging a handle": dragging(stage, count, extent.reach),
    }
    triangles = len(stage.project.figure.domain.mesh.triangles)
    what = "{:,} triangles, {} × {} pixels".format(triangles, *extent.size)
    yield Table(
        title=f"A frame by the clock until all of it is drawn: {what}, {stage.device}",
        rows=tuple(row_of(name, [frame.whole for frame in run]) for name, run in runs.items()),
    )
    for title in TABS:
        stage.show_tab(title)
        runs |= {
            f"{title} in front, nothing moves": _still(stage, count // 2),
            f"{title} in front, playing": playing(stage, count // 2),
        }
    yield Table(
        title=f"The interface's own part of a frame, processor time of its thread: {what}",
        rows=tuple(row_of(name, [frame.own for frame in run]) for name, run in runs.items()),
    )


def row_of(name: str, times: Sequence[float]) -> Row:
    """Return the median of the times of frames, and what most of them keep."""
    return Row(
        name=name,
        seconds=statistics.median(times),
        note=f"95 % within {_ms(float(np.quantile(times, 0.95)))}",
    )


def _ms(seconds: float) -> str:
    return f"{1e3 * seconds:.1f} ms"


def _still(stage: Driver, count: int) -> list[_Frame]:
    stage.settle()
    return [stage.frame() for _ in range(count)]


def playing(stage: Driver, count: int) -> list[_Frame]:
    """Play so that each frame of the window shows another one of the animation."""
    stage.ask(playback.toggle_play)
    stage.settle()
    frames = [stage.frame(1 / stage.project.document.fps) for _ in range(count)]
    stage.ask(playback.halt)
    stage.settle()
    return frames


def _scrubbing(stage: Driver, count: int) -> list[_Frame]:
    frames = []
    for number in range(count):
        stage.ask(playback.scrub, number % stage.project.document.frames.last)
        frames.append(stage.frame())
    return frames


def dragging(stage: Driver, count: int, reach: float) -> list[_Frame]:
    """Drag, with the solver at work beside."""
    drag = _Drag(stage, reach)
    frames = []
    for number in range(count):
        drag.move(number)
        frames.append(stage.refresh())
    drag.end()
    return frames


class _Drag:
    """The first handle, pulled around by the mouse in the first frame of the animation."""

    def __init__(self, stage: Driver, reach: float) -> None:
        self._stage = stage
        self._reach = reach
        self._project = stage.project
        stage.ask(playback.scrub, self._project.figure.keys[0].frame)
        stage.settle()
        self.handle = self._project.figure.handles[0].id
        self._start = self._point = stage.point(_handle_place(self._project))
        stage.mouse(self._start)
        stage.refresh()
        stage.mouse(self._start, down=True)
        stage.refresh()
        # Where it begins to move, what it needs is made once.
        self.move(0)
        stage.until(lambda: self._is_followed)

    def move(self, number: int) -> None:
        """Put the mouse where it is in this frame: farther on around a circle."""
        self._point = self._start + self._reach * complex(np.exp(0.1j * number))
        self._stage.mouse(self._point)

    @property
    def wish(self) -> Target | None:
        """Where the handle is wanted now."""
        posing = self._project.posing
        return None if posing is None else posing.targets[self.handle]

    @property
    def _is_followed(self) -> bool:
        """Whether the solver is on its way."""
        return self._project.posing is not None and self._project.posing.drag is not None

    @property
    def followed(self) -> Target | None:
        """The wish that the pose in the picture was solved for."""
        shown = self._project.puppet.shown
        return shown.pose.targets[self.handle] if shown and shown.pose else None

    def let_go(self) -> None:
        """Let go of the handle where it is."""
        self._stage.mouse(self._point, down=False)

    def end(self) -> None:
        """Let go, and wait until everything rests."""
        self.let_go()
        self._stage.settle()


def _release(stage: Driver, extent: Extent) -> Table:
    """Measure from letting a handle go to a pose that rests, and to the in-betweens around it."""
    times: list[list[float]] = []
    for number in range(extent.repeats):
        drag = _Drag(stage, extent.reach)
        for move in range(10):
            drag.move(20 * number + move)
            stage.refresh()
        let_go = time.perf_counter()
        drag.let_go()
        stage.refresh()
        marks = []
        for is_done in (_rests, _is_exact, _is_fine):
            stage.until(partial(is_done, stage.project))
            marks.append(time.perf_counter() - let_go)
        times.append(marks)
        stage.settle()
    names = (
        "until the pose rests",
        "until its in-betweens are exact, as they are drawn while it moves",
        "until they are exact in full detail",
    )
    rows = (
        row_of(name, column) for name, column in zip(names, zip(*times, strict=True), strict=True)
    )
    return Table(title="From the release of a handle", rows=tuple(rows))


def _playhead(stage: Driver, extent: Extent) -> Table:
    """Measure from moving the playhead, once a handle is let go, to the exact in-between."""
    rows = []
    for name, reach, wait in (
        ("the playhead is moved at once", extent.reach, 1),
        (f"{LATER} pictures later, after a hard pull", HARD * extent.reach, LATER),
    ):
        runs = [_leave(stage, reach, number, wait) for number in range(extent.repeats)]
        times, keys = zip(*runs, strict=True)
        note = (
            f"pictures of a key before it: median {statistics.median(keys):.0f}, most {max(keys)}"
        )
        rows.append(replace(row_of(name, times), note=note))
    return Table(
        title="From moving the playhead between keys, once a handle is let go, to the in-between",
        rows=tuple(rows),
    )


def _leave(stage: Driver, reach: float, number: int, wait: int) -> tuple[float, int]:
    """Pull, let go, and leave the pose: the seconds to the in-between, the pictures before it."""
    project = stage.project
    drag = _Drag(stage, reach)
    for move in range(10):
        drag.move(20 * number + move)
        stage.refresh()
    drag.let_go()
    for _ in range(wait):
        stage.refresh()
    first, second, *_ = project.figure.keys
    between = (first.frame + second.frame) // 2 + number
    moved = time.perf_counter()
    stage.ask(playback.scrub, between)
    stage.refresh()
    keys = 0
    while not _shows(project, between, exactly=True):
        keys += _shows(project, between)
        stage.refresh()
    seconds = time.perf_counter() - moved
    stage.settle()
    return seconds, keys


def _shows(project: Project, frame: int, *, exactly: bool = False) -> bool:
    """Tell whether a frame of the document as it is now is shown."""
    shown = project.puppet.shown
    if shown is None or shown.frame != frame or shown.clip != project.clip:
        return False
    return shown.is_current or not exactly


def _rests(project: Project) -> bool:
    return not project.is_posing


def _is_exact(project: Project) -> bool:
    return project.puppet.coarse.value.knows(project.clip)


def _is_fine(project: Project) -> bool:
    coarse, fine = project.puppet.coarse.value, project.puppet.fine.value
    if coarse.mesh.domain is project.figure.domain:
        return _is_exact(project)
    return fine is not None and fine.knows(project.clip)


def _latency(stage: Driver, extent: Extent) -> Table:
    """Measure from a move of the pointer to the first picture of a pose that was solved for it."""
    drag = _Drag(stage, extent.reach)
    sent: list[tuple[Target | None, float]] = []
    frames: list[int] = []
    seconds: list[float] = []
    while len(frames) < extent.moves:
        moved = time.perf_counter()
        drag.move(1 + len(sent))
        frame = stage.refresh()
        sent.append((drag.wish, moved))
        drawn = moved + frame.whole
        wishes = [wish for wish, _ in sent]
        if drag.followed in wishes:
            for number in range(len(frames), wishes.index(drag.followed) + 1):
                frames.append(len(sent) - number)
                seconds.append(drawn - sent[number][1])
    drag.end()
    return Table(
        title="From a move of the pointer to a picture that follows it, at 60 frames a second",
        rows=(
            row_of("time until that picture is drawn", seconds),
            Row(
                name="frames, the one that takes the move included",
                seconds=None,
                note=f"median {statistics.median(frames):.0f}, worst {max(frames)}, "
                f"of {len(frames)} moves",
            ),
        ),
    )
