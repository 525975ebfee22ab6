"""The whole window without a display, with ImGui's test engine in it."""

import tempfile
import threading
import time
from collections.abc import Callable
from copy import copy
from dataclasses import fields, is_dataclass, replace
from pathlib import Path
from typing import TypeVar

from imgui_bundle import ImVec2, hello_imgui, imgui
from invariants import check_invariants
from offscreen import Offscreen
from PIL import Image

from app.document import History
from app.document.settings import Meshing
from app.editor.action import do
from app.editor.actions.project_files import files, saving
from app.editor.parts.settings import SessionSettings
from app.editor.project import Project
from app.editor.session import Session
from app.editor.tools.transform_tools.rotate_tool import RING
from app.editor.work.jobs import Jobs
from app.motion import CorrectedFrames
from app.render.gpu.context import create_context
from app.render.renderer import Renderer
from app.storage.preferences import Preferences
from app.ui.style.theme import FONT_SIZE
from app.ui.viewport.screen import GRIP
from app.ui.window.window import Window

Value = TypeVar("Value")
Robot = imgui.test_engine.TestContext
FRAME = 1 / 60
STEP = 0.005  # seconds that a worker's Newton step takes
MOST_FRAMES = 5000
PATIENCE = 120.0  # seconds that a slow machine has for what takes another a moment


class Clock:
    """A clock that goes only when it is told to, or by so much whenever it is looked at.

    Within a job it goes by a step at each look: a pose takes several pictures to come to rest, on
    a machine of any speed.
    """

    def __init__(self) -> None:
        self.now = 0.0
        self.cost = 0.0  # seconds
        self._within_jobs = threading.local()

    def __call__(self) -> float:
        if threading.current_thread() is threading.main_thread():
            self.now += self.cost
            return self.now
        worked = self._within_jobs
        worked.seconds = getattr(worked, "seconds", 0.0) + max(STEP, self.cost)
        return self.now + float(worked.seconds)


class Harness:
    """The one window of a process, its clock, and a robot that does what a person would."""

    Key = imgui.Key

    def __init__(self) -> None:
        self.clock = Clock()
        self.folder = Path(tempfile.mkdtemp(prefix="lissom-test-"))
        self.paints = False  # whether frames of which no picture is taken are drawn, too
        self.session = Session(
            clock=self.clock, jobs=Jobs(), settings=SessionSettings(folder=self.folder)
        )
        self._tests = 0
        self._made: dict[tuple[object, ...], tuple[float, Project, Preferences]] = {}
        self.gl = create_context()
        self.program = Window(self.session, lambda: Renderer(self.gl))
        self._screen = Offscreen(self.program, self.gl, with_test_engine=True)
        self._engine = hello_imgui.get_imgui_test_engine()
        settings = imgui.test_engine.get_io(self._engine)
        settings.config_run_speed = imgui.test_engine.TestRunSpeed.fast
        settings.config_log_to_tty = False
        # What the window brings to the front stays there when the robot is done.
        settings.config_restore_focus_after_tests = False
        self.frames(3)

    def resize(self, size: tuple[int, int], scale: float = 1.0, *, density: float = 1.0) -> None:
        """Give the window another size in pixels, its contents another scale, or a finer screen."""
        self._screen.resize(size, density)
        self.session.settings.preferences = Preferences(
            scale=scale, theme=self.session.settings.preferences.theme
        )
        self.frames(3)

    def reset(self) -> None:
        """Go back to the welcome view of a person who opens Lissom for the first time."""
        self.paints = False
        jobs = self.session.jobs
        if not jobs.wait_until_idle(PATIENCE):
            # A test that failed has left a worker behind: the next ones are not to wait for it.
            jobs = Jobs()
        jobs.deliver()
        fresh = Session(clock=self.clock, jobs=jobs, settings=SessionSettings(folder=self.folder))
        saving.set_project(self.session, None)
        for field in fields(Session):
            if field.name not in {"diagnostics", "display", "revision"}:
                setattr(self.session, field.name, getattr(fresh, field.name))
        fresh.diagnostics.note_graphics(self.session.diagnostics.graphics)
        fresh.display.note_speed(full_detail=self.session.display.full_detail)
        fresh.display.resize(*self.session.display.screen)
        self.session.diagnostics, self.session.display = fresh.diagnostics, fresh.display
        # Small meshes, and nothing that nobody looks at, so that the tests are quick.
        self.session.settings.default_meshing = Meshing(triangles=2_000, detail="coarse")
        self.session.settings.prepares_ahead = False
        self.session.settings.autosave.remove()
        for leftover in self.folder.iterdir():
            leftover.unlink()
        self.frames()

    def open(self, path: Path) -> Project:
        """Open a picture or a project, and wait until it is there with all its in-betweens.

        What is open is given up.
        """
        saving.set_project(self.session, None)
        files.open_file(self.session, path)
        self.settle()
        assert self.session.project is not None, [
            toast.text for toast in self.session.notices.toasts
        ]
        return self.session.project

    def again(self, make: Callable[..., object], *arguments: object) -> Project:
        """Show the project that a function makes in this window, which is made only once.

        Whoever asks for it has what may change in it for themselves.
        """
        known, prepares_ahead = (make, *arguments), self.session.settings.prepares_ahead
        if known not in self._made:
            # Whichever test comes first, it has only what all of them look at.
            self.session.settings.prepares_ahead = False
            make(self, *arguments)
            self.settle()
            self.session.settings.prepares_ahead = prepares_ahead
            assert self.session.project is not None
            self._made[known] = (
                self.clock.now,
                self.session.project,
                self.session.settings.preferences,
            )
        made_at, made, self.session.settings.preferences = self._made[known]
        project = own(made)
        project.timeline.moved_at += self.clock.now - made_at
        # What was kept of it went away with the test for which it was made.
        project.file.autosaved, project.file.autosaved_at, project.file.changed_at = (
            None,
            self.clock.now,
            None,
        )
        saving.set_project(self.session, project)
        self.frames()
        if prepares_ahead:
            self.settle()
        return project

    def point(self, place: complex) -> ImVec2:
        """Return where a place of the drawing's plane is on the screen."""
        return self._screen.point(place)

    def ring(self, project: Project) -> float:
        """Return the radius of the ring around the selected handle, in pixels of the picture."""
        return RING * self._em / project.view_on(self.session.display.screen).scale

    def grip(self, project: Project) -> float:
        """Return the radius within which a handle is grabbed, in pixels of the picture."""
        return GRIP * self._em / project.view_on(self.session.display.screen).scale

    @property
    def _em(self) -> float:
        return FONT_SIZE * self.session.settings.preferences.scale

    @property
    def awaits_worker(self) -> bool:
        """Whether the window sleeps until the worker, or the person, does something."""
        return self.program.awaits_worker

    def show_tab(self, title: str) -> None:
        """Bring a panel to the front."""
        self._screen.show_tab(title)
        self.frames(3)

    def text_height(self) -> float:
        """Return the height of a line of text in pixels."""
        return imgui.get_style().font_size_base * imgui.get_style().font_scale_main

    def status_height(self) -> float:
        """Return how much of the window's height the style's paddings take around a line."""
        style = imgui.get_style()
        return style.frame_padding.y + style.window_padding.y + style.display_safe_area_padding.y

    def frames(self, count: int = 1) -> None:
        """Draw some frames, with the clock going on."""
        for _ in range(count):
            self._frame()

    def act(self, verb: Callable[..., None], *arguments: object, is_by_key: bool = False) -> None:
        """Do something as a panel or a key would ask for it, with its errors told as theirs are."""
        self.program.queue_action(replace(do(verb, *arguments), is_by_key=is_by_key))
        self.frames()

    def settle(self) -> None:
        """Draw frames until no job is left, no pose is on its way, and no action waits."""
        for _ in range(MOST_FRAMES):
            self.frames()
            project = self.session.project
            drag = project.drag if project else None
            is_at_rest = drag is None or (project.history.is_held and drag.is_at_rest)
            if is_at_rest and not (self.session.jobs.kinds or self.program.shell.queue.waiting):
                break
            assert self.session.jobs.wait_until_idle(PATIENCE), self.session.jobs.kinds
        self.frames()

    def until(self, is_so: Callable[[], bool]) -> None:
        """Draw frames until something is so, however long the workers take to it."""
        end = time.monotonic() + PATIENCE
        while not is_so():
            told = [toast.text for toast in self.session.notices.toasts]
            assert time.monotonic() < end, (self.session.jobs.kinds, told)
            self.frames()
            # Meanwhile the workers have the interpreter for themselves.
            self.session.jobs.wait_until_idle(FRAME)

    def run(self, play: Callable[[Robot], None]) -> None:
        """Let the test engine's robot do something with the window, as a person would."""
        self._tests += 1
        failures: list[BaseException] = []
        test = imgui.test_engine.register_test(self._engine, "lissom", f"{self._tests}")

        def body(robot: Robot) -> None:
            try:
                play(robot)
            except BaseException as error:  # noqa: BLE001 - raised again below
                failures.append(error)
                robot.finish(imgui.test_engine.TestStatus.error)

        test.flags |= imgui.test_engine.TestFlags_.no_gui_warm_up.value
        test.test_func = body
        imgui.test_engine.queue_test(self._engine, test)
        for _ in range(MOST_FRAMES):
            self.frames()
            if imgui.test_engine.is_test_queue_empty(self._engine):
                break
        if failures:
            raise failures[0]
        assert test.output.status == imgui.test_engine.TestStatus.success, (
            test.output.log.get_text()
        )
        check_invariants(self.session)

    def picture(self) -> Image.Image:
        """Return what is on the screen."""
        self._frame(painted=True)
        return self._screen.picture()

    def repainted(self) -> Image.Image:
        """Return the last frame painted once more, with what was changed of its draw lists."""
        with self.gl:
            self._screen.paint()
        return self._screen.picture()

    def _frame(self, *, painted: bool = False) -> None:
        self.clock.now += FRAME
        self.program.paints = painted or self.paints
        self._screen.frame(painted=painted)


def own(value: Value) -> Value:
    """Return a value with all that may change in it copied, and what is frozen shared."""
    if isinstance(value, list):
        return [own(each) for each in value]
    if isinstance(value, dict):
        return {key: own(each) for key, each in value.items()}
    if isinstance(value, History | CorrectedFrames):
        copied = copy(value)
        vars(copied).update({name: own(each) for name, each in vars(value).items()})
        return copied
    if is_dataclass(value) and not value.__dataclass_params__.frozen:
        copied = copy(value)
        for field in fields(value):
            setattr(copied, field.name, own(getattr(value, field.name)))
        return copied
    return value
