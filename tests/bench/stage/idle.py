"""Opens the window and leaves it alone, to measure what it takes to do nothing.

`python -m tests.bench.stage.idle SECONDS [FILE]` prints the processor's seconds of all its threads.
"""

import subprocess
import sys
import tempfile
import threading
import time
from pathlib import Path

from app.editor import Jobs, Session, do
from app.editor.actions.project_files import files
from app.editor.parts.settings import SessionSettings
from app.render import Renderer
from app.render.gpu.context import window_context
from app.storage import sample_images
from app.ui.window.desktop import has_display
from app.ui.window.window import Window
from tests.bench.table import Row, Table

SAMPLE = "dragon.png"  # samples that move would play
REST = 8.0  # seconds without work, after which nothing is on its way any more
PATIENCE = 60.0


def table(seconds: float) -> Table:
    """Measure a window that nobody touches: the welcome view, and a drawing that is open."""
    title = f"Processor time of a window that nobody touches, in {seconds:g} s"
    if not has_display():
        row = Row(name="not measured", seconds=None, note="it needs a screen: set DISPLAY")
        return Table(title=title, rows=(row,))
    rows = []
    for name, path in (("the welcome view", None), (SAMPLE, sample_images() / SAMPLE)):
        files_named = [] if path is None else [str(path)]
        done = subprocess.run(
            [sys.executable, "-m", "tests.bench.stage.idle", str(seconds), *files_named],
            stdout=subprocess.PIPE,
            text=True,
            check=True,
        )
        used = float(done.stdout)
        rows.append(Row(name=name, seconds=used, note=f"{used / seconds:.1%} of a core"))
    return Table(title=title, rows=tuple(rows))


def _watch(session: Session, seconds: float) -> None:
    """Wait until the window rests, then tell what it uses; on a thread of its own."""
    end, rests_since = time.monotonic() + PATIENCE, time.monotonic()
    while time.monotonic() < min(end, rests_since + REST):
        if session.jobs.kinds or session.notices.toasts:
            rests_since = time.monotonic()
        time.sleep(0.1)
    before = time.process_time()
    time.sleep(seconds)
    print(time.process_time() - before, flush=True)
    # The window looks at it when it wakes the next time.
    session.is_quitting = True


def main() -> None:
    """Open the window on the screen, with the file that the command line names."""
    seconds, paths = float(sys.argv[1]), sys.argv[2:]
    with tempfile.TemporaryDirectory() as name:
        session = Session(
            clock=time.perf_counter, jobs=Jobs(), settings=SessionSettings(folder=Path(name))
        )
        window = Window(session, lambda: Renderer(window_context()))
        for path in paths:
            window.queue_action(do(files.open_file, Path(path)))
        threading.Thread(target=_watch, args=(session, seconds), daemon=True).start()
        window.run()


if __name__ == "__main__":
    main()
