"""When the X server goes away, unsaved work is kept first."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from app.cli.window_process import DISPLAY_GONE, WORK_KEPT
from app.storage.autosave import find_recoverable_files, load_recoverable_file
from tests.campaigns.windows import lost_displays, screen

ROOT = Path(__file__).parents[3]

# The command of the window, with one that looks at a display as GLFW does, has unsaved work, and
# speaks to the display once more after a line of input. Nothing is drawn.
LOOKS = """
import ctypes
from documents import disc_document
from app.cli import window_process
from app.cli.main import main
from app.document import History
from app.document.commands import scene_commands
from app.editor.parts.project_file import ProjectFile
from app.editor.parts.selection import Selection
from app.editor.project import Project
from app.editor.work.layer_runtime import LayerRuntimes

class Looks:
    def __init__(self, session, _):
        self.session = session
    def wake(self):
        pass
    def run(self, **_):
        history = History(disc_document(), saved=True)
        history.do(scene_commands.add_marker(0, "unsaved"))
        file, selection = ProjectFile(name="disc"), Selection(active=0)
        self.session.project = Project(
            file=file, history=history, runtimes=LayerRuntimes(layers={}), selection=selection
        )
        x11 = ctypes.CDLL("libX11.so.6")
        x11.XOpenDisplay.restype = ctypes.c_void_p
        display = ctypes.c_void_p(x11.XOpenDisplay(None))
        print("open", flush=True)
        input()
        x11.XSync(display, 0)
        print("went on", flush=True)

window_process.Window = Looks
raise SystemExit(main(["window"]))
"""

needs_server = pytest.mark.skipif(
    shutil.which("Xvfb") is None, reason="there is no X server to end"
)


@needs_server
def test_unsaved_work_is_kept_when_the_display_goes(tmp_path):
    paths = os.pathsep.join(map(str, (ROOT, ROOT / "tests" / "support")))
    own = {"HOME": str(tmp_path), "XDG_CONFIG_HOME": str(tmp_path), "PYTHONPATH": paths}
    with screen() as shown:
        looks = subprocess.Popen(
            [sys.executable, "-c", LOOKS],
            cwd=ROOT,
            env={**os.environ, **own, "DISPLAY": shown.name},
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
        )
        assert looks.stdout.readline() == "open\n", looks.communicate()
        shown.server.kill()
        shown.server.wait()
        output, said = looks.communicate("\n")
    assert (output, looks.returncode) == ("", 1), said
    assert DISPLAY_GONE in said
    assert WORK_KEPT in said
    (kept,) = find_recoverable_files(tmp_path / "lissom")
    assert load_recoverable_file(kept)[0].markers[0].name == "unsaved"


@needs_server
@pytest.mark.long
def test_edits_survive_the_end_of_the_display():
    assert lost_displays(np.random.default_rng(0), 1)["most edits lost"] == 0
