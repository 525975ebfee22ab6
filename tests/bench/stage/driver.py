"""The window that is measured, and hands that play, scrub and drag in it."""

import threading
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from imgui_bundle import ImVec2

from app.document import Target
from app.editor import Jobs, Project, Session, do
from app.editor.actions import playback
from app.editor.parts.settings import SessionSettings
from app.render import Renderer
from app.render.gpu.context import create_context
from app.ui.window.window import PAUSE, SIZE, Window
from tests.support.offscreen import Offscreen

REFRESH = 1 / 60  # seconds from frame to frame of a screen
REACH = 40.0  # pixels around a handle in which it is dragged, unless told
PATIENCE = 120.0  # seconds that anything may take


@dataclass(frozen=True, slots=True, kw_only=True)
class DrawnFrame:
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
            clock=lambda: time.perf_counter() + self._ahead,
            jobs=Jobs(),
            settings=SessionSettings(folder=folder),
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
            raise RuntimeError([toast.text for toast in self.session.notices.toasts])
        return self.session.project

    def frame(self, ahead: float = 0.0) -> DrawnFrame:
        """Draw a frame, with the session's clock put forward before it."""
        self._ahead += ahead
        drawn = self._window.canvas_seconds + self._screen.paint_seconds
        begun, worked = time.perf_counter(), time.thread_time()
        self._screen.frame(painted=True)
        whole, own = time.perf_counter() - begun, time.thread_time() - worked
        drawn = self._window.canvas_seconds + self._screen.paint_seconds - drawn
        return DrawnFrame(whole=whole, own=own - drawn)

    def until(self, is_true: Callable[[], bool]) -> None:
        """Draw frames, as a screen would show them, until something is true."""
        patience = time.perf_counter() + PATIENCE
        while not is_true():
            if time.perf_counter() > patience:
                raise TimeoutError(f"the window did not get on: {self.session.jobs.kinds}")
            self.refresh()

    def refresh(self) -> DrawnFrame:
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
            if not self.session.jobs.wait_until_idle(PATIENCE):
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
        self._window.queue_action(do(verb, *arguments))

    def point(self, place: complex) -> complex:
        """Return where a place of the drawing's plane is on the screen, x + iy."""
        return complex(*self._screen.point(place))

    def mouse(self, point: complex, *, down: bool | None = None) -> None:
        """Put the mouse on a point of the screen; press its button or let it go, if told to."""
        self._screen.move_mouse(ImVec2(point.real, point.imag))
        if down is not None:
            self._screen.press(down=down)


def still(stage: Driver, count: int) -> list[DrawnFrame]:
    """Let everything rest."""
    stage.settle()
    return [stage.frame() for _ in range(count)]


def playing(stage: Driver, count: int) -> list[DrawnFrame]:
    """Play so that each frame of the window shows another one of the animation."""
    stage.ask(playback.toggle_play)
    stage.settle()
    frames = [stage.frame(1 / stage.project.document.fps) for _ in range(count)]
    stage.ask(playback.stop_playback)
    stage.settle()
    return frames


def scrubbing(stage: Driver, count: int) -> list[DrawnFrame]:
    """Put the playhead on a frame farther each time."""
    frames = []
    for number in range(count):
        stage.ask(playback.scrub, number % stage.project.document.frames.last)
        frames.append(stage.frame())
    return frames


def dragging(stage: Driver, count: int, reach: float) -> list[DrawnFrame]:
    """Drag, with the solver at work beside."""
    drag = HandleDrag(stage, reach)
    frames = []
    for number in range(count):
        drag.move(number)
        frames.append(stage.refresh())
    drag.end()
    return frames


class HandleDrag:
    """The first handle, pulled around by the mouse in the first frame of the animation."""

    def __init__(self, stage: Driver, reach: float) -> None:
        self._stage = stage
        self._reach = reach
        self._project = stage.project
        stage.ask(playback.scrub, self._project.layer.keys[0].frame)
        stage.settle()
        self.handle = self._project.layer.handles[0].id
        self._start = self._point = stage.point(handle_place(self._project))
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
        posing = self._project.visible_drag
        return posing.targets[self.handle] if posing and posing.targets else None

    @property
    def _is_followed(self) -> bool:
        """Whether the solver is on its way."""
        posing = self._project.visible_drag
        return posing is not None and posing.solver is not None

    @property
    def followed(self) -> Target | None:
        """The wish that the pose in the picture was solved for."""
        shown = self._project.layer_runtime.shown
        return shown.pose.targets[self.handle] if shown and shown.pose else None

    def let_go(self) -> None:
        """Let go of the handle where it is."""
        self._stage.mouse(self._point, down=False)

    def end(self) -> None:
        """Let go, and wait until everything rests."""
        self.let_go()
        self._stage.settle()


def handle_place(project: Project) -> complex:
    """Return where the first handle is on the screen's plane."""
    return (
        complex(project.layer_runtime.shown.handle_positions[0])
        if project.layer_runtime.shown
        else 0j
    )
