"""Taps and keys on a real X server, at any pace: none is lost, and none comes out of turn.

Somebody goes through an animation by taps on the ruler, marks each frame, and undoes every second
mark; what the project holds in the end tells of each of them.
"""

import os
import select
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path

import numpy as np
from animations import still_document
from documents import altered

from app.document import scene_commands
from app.document.settings import FrameRange
from app.storage.project_file import load_project, save_project
from tests.campaigns.kills import expect
from tests.campaigns.windows import PATIENCE, ROOT, screen

LOW, HIGH, LAST = range(1, 111), range(138, 248), 249  # frames to tap on, the last one
# A window that rests after each picture, and tells where frames 0 and 1 are on the ruler.
WINDOW = """
import sys
import time

from app.cli.main import main
from app.ui.timeline import timeline
from app.ui.window.window import Window

rest, *words = sys.argv[1:]
draw, run, printed = timeline.draw_ruler, Window.run, None

def draw_ruler(track, frame):
    global printed
    places = track.x(0), track.x(1), (track.ruler_top + track.markers_top) / 2
    if places != printed:
        print(*places, flush=True)
    printed = places
    return draw(track, frame)

def run_slowly(window, is_over, farewell):
    run(window, is_over=lambda: time.sleep(float(rest)) or is_over(), farewell=farewell)

timeline.draw_ruler, Window.run = draw_ruler, run_slowly
sys.exit(main(words))
"""


def campaign(seed: int, amount: int) -> Iterator[tuple[str, dict[str, float]]]:
    """Tap at all paces, on a quiet and a busy machine, and where pictures are slow."""
    rng = np.random.default_rng(seed)
    paces = {"as quick as can be": (0.0, 0.0), "20 ms": (0.02, 0.02), "to 1 s": (0.02, 1.0)}
    for name, pace in paces.items():
        for busy in (0, 2 * (os.cpu_count() or 1)):
            where = f"{name}, {busy} others at work"
            yield where, tapped(rng, amount, pace=pace, busy=busy)
    yield "3 frames per second", tapped(rng, amount // 4, pace=(0.1, 0.5), rest=1 / 3)


def tapped(
    rng: np.random.Generator,
    count: int,
    *,
    pace: tuple[float, float] = (0.0, 0.0),
    rest: float = 0.0,
    busy: int = 0,
) -> dict[str, float]:
    """Tap, mark and undo in a window; fail where one was lost.

    Parameters
    ----------
    pace : tuple of float
        Seconds between taps, at least and at most.
    rest : float
        Seconds for which the window does nothing after each picture.
    busy : int
        Number of other processes that take as much of the processor as they get.
    """
    # From side to side: a press upon the playhead takes hold of it where it is.
    sides = [rng.permutation(side) for side in (LOW, HIGH)]
    frames = np.column_stack(sides).ravel()[:count].tolist()
    with tempfile.TemporaryDirectory() as home, ExitStack() as stack:
        path = Path(home) / "taps.lissom"
        # With a marker, since the first one makes the timeline higher by its lane.
        document = altered(still_document(), frames=FrameRange(0, LAST))
        save_project(path, scene_commands.add_marker(0)(document))
        before = path.read_bytes()
        shown = stack.enter_context(screen())
        environment = {
            **os.environ,
            "DISPLAY": shown.name,
            "HOME": home,
            "XDG_CONFIG_HOME": home,
            "LIBGL_ALWAYS_SOFTWARE": "1",
        }
        window = [sys.executable, "-c", WINDOW, str(rest), str(path)]
        process = stack.enter_context(_running(window, environment))
        expect(bool(select.select([process.stdout], [], [], PATIENCE)[0]), "no window")
        assert process.stdout is not None
        start, step, height = map(float, process.stdout.readline().split())
        for _ in range(busy):
            stack.enter_context(_running([sys.executable, "-c", "while True: pass"], environment))
        find = ["search", "--sync", "--onlyvisible", "--name", "Lissom$"]
        words: list[object] = [*find, "windowfocus", "--sync"]
        for number, frame in enumerate(frames):
            x = round(start + frame * (step - start))
            words += ["mousemove", x, round(height), "click", 1, "key", "m"]
            words += ["key", "ctrl+z"] * (number % 2)
            words += ["sleep", rng.uniform(*pace)] * (pace[1] > 0)
        subprocess.run(["xdotool", *map(str, words), "key", "ctrl+s"], env=environment, check=True)
        begun = time.monotonic()
        while path.read_bytes() == before:
            expect(process.poll() is None, "the window has ended")
            expect(time.monotonic() - begun < PATIENCE + 12 * count * rest, "nothing was saved")
            time.sleep(0.1)
        lag = time.monotonic() - begun
        marked = [marker.frame for marker in load_project(path).markers if marker.frame > 0]
    wrong = set(marked) ^ set(frames[::2])
    expect(not wrong, f"of {count} taps those on {sorted(wrong)} came to something else")
    return {"taps": count, "behind at the end, s": lag}


@contextmanager
def _running(command: list[str], environment: dict[str, str]) -> Iterator[subprocess.Popen[str]]:
    with subprocess.Popen(
        command, cwd=ROOT, env=environment, stdout=subprocess.PIPE, text=True
    ) as process:
        try:
            yield process
        finally:
            process.kill()
