"""Opens the window as `lissom` does, tells how far it is, and closes it, to measure its start."""

import subprocess
import sys
import tempfile
import time
from pathlib import Path

from app.editor import Jobs, Session, do
from app.editor.actions import tutorials
from app.editor.actions.project_files import recovery, saving
from app.editor.parts.settings import SessionSettings
from app.render import Renderer
from app.render.gpu.context import create_context, window_context
from app.storage import load_preferences
from app.ui.window.desktop import has_display
from app.ui.window.window import Window
from tests.bench.table import Table, row_at_most
from tests.support.offscreen import Offscreen

MARKS = ("first frame", "welcome view with all its pictures")


def table(repeats: int) -> Table:
    """Measure from the command to the window, each time in a process of its own."""
    times = [_seconds_to_marks() for _ in range(repeats)]
    rows = tuple(map(row_at_most, MARKS, zip(*times, strict=True)))
    where = "on the screen" if has_display() else "without a display"
    return Table(title=f"From the command to the window, {where}", rows=rows)


def _seconds_to_marks() -> list[float]:
    begun = time.perf_counter()
    with subprocess.Popen(
        [sys.executable, "-m", "tests.bench.stage.start"], stdout=subprocess.PIPE
    ) as process:
        times = [time.perf_counter() - begun for _ in process.stdout or ()]
    if process.returncode or len(times) != len(MARKS):
        raise RuntimeError(f"the window did not open: exit status {process.returncode}")
    return times


class Start:
    """What a window has shown since it opened."""

    def __init__(self, window: Window) -> None:
        self._window = window
        self._frames = 0
        window.queue_action(do(self.look))

    def look(self, session: Session) -> None:
        """Tell what the frame before this one has shown; leave when that was everything."""
        self._frames += 1
        if self._frames == 2:
            print(MARKS[0], flush=True)
        thumbnails = self._window.thumbnails
        read = 0 if thumbnails is None else len(thumbnails.files)
        if self._frames > 2 and read == len(tutorials.sample_files()):
            print(MARKS[1], flush=True)
            saving.request_quit(session)
        else:
            self._window.queue_action(do(self.look))


def main() -> None:
    """Open the window, on the screen if there is one."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        session = Session(
            clock=time.perf_counter,
            jobs=Jobs(),
            settings=SessionSettings(folder=folder, preferences=load_preferences(folder)),
        )
        recovery.ask_recovery(session)
        if has_display():
            window = Window(session, lambda: Renderer(window_context()))
            Start(window)
            window.run()
            return
        gl = create_context()
        window = Window(session, lambda: Renderer(gl))
        Start(window)
        screen = Offscreen(window, gl)
        while not session.is_quitting:
            screen.frame(painted=True)


if __name__ == "__main__":
    main()
