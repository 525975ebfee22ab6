"""The real window, on a real X server without a screen, moved by real X events."""

import ctypes
import ctypes.util
import os
import select
import shutil
import signal
import subprocess
import sys
import time
from contextlib import contextmanager
from functools import partial
from pathlib import Path

import numpy as np
import pytest
from PIL import ImageGrab

from app.cli.window_process import WORK_KEPT
from app.editor.actions import dialog_actions
from app.editor.actions.project_files import saving
from app.storage.assets import sample_images
from app.storage.autosave import find_recoverable_files, load_recoverable_file
from app.storage.preferences import load_preferences
from app.storage.project_file import load_project

BAR = sample_images() / "bar.png"
SCREEN = (1500, 900)
# Seconds after which what has not happened never will: no machine has as much else to do.
PATIENCE = 300.0
PAUSE = 0.02
SIGHT = 30  # levels: how much the colours vary where something is drawn
NEAR = 12  # pixels: what changes around a handle when it comes or goes


def until(is_so, what):
    """Wait until something is so; give up when nobody would wait any longer."""
    end = time.monotonic() + PATIENCE
    while not (found := is_so()):
        assert time.monotonic() < end, f"no sign of {what}"
        time.sleep(PAUSE)
    return found


@pytest.fixture
def display():
    """A display of its own, on whatever number is free."""
    missing = [program for program in ("Xvfb", "xdotool") if shutil.which(program) is None]
    if missing:
        reason = f"{' and '.join(missing)} not installed: bash .ci/setup test"
        # Where everything was set up for the tests, it is to run.
        (pytest.fail if os.environ.get("CI") else pytest.skip)(reason)
    ours, theirs = os.pipe()
    command = ["Xvfb", "-displayfd", str(theirs), "-screen", "0", "{}x{}x24".format(*SCREEN)]
    server = subprocess.Popen(
        [*command, "-noreset", "-nolisten", "tcp"], pass_fds=[theirs], stderr=subprocess.DEVNULL
    )
    os.close(theirs)
    try:
        assert select.select([ours], [], [], PATIENCE)[0], "Xvfb does not start"
        yield f":{os.read(ours, 16).decode().strip()}"
    finally:
        os.close(ours)
        server.terminate()
        server.wait()


class Person:
    """Somebody who sees the screen, and has a mouse and a keyboard."""

    def __init__(self, display, home):
        self.display = display
        self._home = home
        self.settings = home / ".config" / "lissom"
        # No programs for file dialogs on this path, and nobody else's settings.
        self.environment = {
            "DISPLAY": display,
            "HOME": str(home),
            "PATH": str(home),
            "XDG_CONFIG_HOME": str(home / ".config"),
            "LIBGL_ALWAYS_SOFTWARE": "1",
        }

    @contextmanager
    def starts(self, *arguments, sign):
        """Start Lissom, and wait for its window and for something to show at a place."""
        with subprocess.Popen(
            [sys.executable, "-m", "app", *map(str, arguments)],
            env=self.environment,
            cwd=Path(__file__).parents[3],
            stderr=subprocess.PIPE,
            text=True,
        ) as process:
            try:
                self.window = until(partial(self._find, process), "the window")
                self.tell("windowfocus", "--sync", self.window)
                until(lambda: self.see(sign).std() > SIGHT, "what is drawn in the window")
                yield process
                assert process.stderr.read() == ""
            except BaseException:
                ImageGrab.grab(xdisplay=self.display).save(self._home / "screen.png")
                raise
            finally:
                process.kill()

    def _find(self, process):
        assert process.poll() is None, process.stderr.read()
        return self.tell("search", "--onlyvisible", "--name", "Lissom$", fails=True).strip()

    def tell(self, *words, fails=False):
        """Let xdotool do something; return what it says."""
        done = subprocess.run(
            ["xdotool", *map(str, words)],
            env=os.environ | {"DISPLAY": self.display},
            capture_output=True,
            text=True,
            timeout=PATIENCE,
            check=False,
        )
        assert fails or done.returncode == 0, done.stderr
        return done.stdout

    def see(self, place):
        """Return what is around a place of the screen."""
        return around(place, ImageGrab.grab(xdisplay=self.display))

    def do(self, what, place, *words):
        """Do something at a place that changes what is around it, and wait until that rests."""
        last = self.see(place)

        def rests():
            nonlocal last
            earlier, last = last, self.see(place)
            return not differ(last, earlier)

        self.tell("mousemove", *place)
        # What comes of the pointer alone, or has not come yet, is nothing that was done.
        until(rests, "the place")
        before = last
        self.tell(*words)

        def is_there():
            return rests() and differ(last, before)

        until(is_there, what)

    def drag(self, start, end, steps=6):
        """Drag a selected handle, and wait until the shape has followed."""
        words = ["mousemove", *start, "mousedown", 1]
        for step in range(1, steps + 1):
            place = (start[i] + (end[i] - start[i]) * step // steps for i in (0, 1))
            words += ["mousemove", *place]
        self.tell(*words, "mouseup", 1)
        until(lambda: is_orange(middle(self.see(end))), "the handle")

    def quit(self, process):
        """Press the keys that end the program, until it does: a window that just came is deaf."""

        def has_ended():
            self.tell("key", "ctrl+q")
            try:
                process.wait(2)
            except subprocess.TimeoutExpired:
                return False
            return True

        until(has_ended, "the end")
        assert process.returncode == 0

    def title(self):
        """Return what the window is called."""
        return self.tell("getwindowname", self.window).strip()

    def geometry(self):
        """Return place and size of the window."""
        lines = self.tell("getwindowgeometry", "--shell", self.window).splitlines()
        values = dict(line.split("=") for line in lines)
        return tuple(int(values[name]) for name in ("X", "Y", "WIDTH", "HEIGHT"))


def around(place, picture):
    x, y = place
    return np.asarray(picture.crop((x - NEAR, y - NEAR, x + NEAR, y + NEAR)), dtype=int)


def middle(look):
    """Return the mean colour of what a handle covers."""
    return look[NEAR - 5 : NEAR + 5, NEAR - 5 : NEAR + 5].mean(axis=(0, 1))


def is_orange(colour):
    """Tell whether a selected handle is there, wherever between the pixels its middle lies."""
    red, _, blue = colour
    return red > 200 and blue < 0.4 * red


def differ(one, other):
    return (np.abs(one - other).max(axis=2) > 24).mean() > 0.05


@pytest.fixture
def person(display, tmp_path):
    return Person(display, tmp_path)


@pytest.fixture
def bar(window):
    """The bar in a window of the same size without a screen, where one can ask for places."""
    return window.open(BAR)


@contextmanager
def grabbed_keyboard(display):
    """Take the keyboard from all windows, as a window manager does while it acts on a key."""
    x11 = ctypes.CDLL(ctypes.util.find_library("X11"))
    x11.XOpenDisplay.restype = ctypes.c_void_p
    x11.XDefaultRootWindow.restype = ctypes.c_ulong
    server = ctypes.c_void_p(x11.XOpenDisplay(display.encode()))
    root = ctypes.c_ulong(x11.XDefaultRootWindow(server))
    now = ctypes.c_ulong(0)
    try:
        assert x11.XGrabKeyboard(server, root, 0, 1, 1, now) == 0
        x11.XSync(server, 0)
        yield
    finally:
        x11.XUngrabKeyboard(server, now)
        x11.XSync(server, 0)
        x11.XCloseDisplay(server)


def place_of(window, bar, share):
    width, height = bar.layer_runtime.picture.size
    point = window.point(complex(share.real * width, (0.5 + share.imag) * height))
    return int(point.x), int(point.y)


def name_field(window):
    """Return where our file browser has the name of a project to save, and how that looks."""
    fields = []
    window.act(saving.save_as)
    window.frames(30)
    window.run(lambda robot: fields.append(robot.item_info("//###dialog/##file name").rect_full))
    place = int(fields[0].min.x) + 2 * NEAR, int(fields[0].get_center().y)
    look = around(place, window.picture())
    window.act(dialog_actions.close_dialog)
    return place, look


@pytest.mark.long
def test_a_person_animates_a_drawing_and_finds_it_again(window, bar, person, tmp_path):
    shares = (0.1, 0.5, 0.9, 0.88 - 0.6j, 0.8 + 0.8j)
    left, middle, right, low, high = (place_of(window, bar, share) for share in shares)
    field, selected_name = name_field(window)
    settings, path = person.settings, tmp_path / "posed.lissom"
    settings.mkdir(parents=True)
    (settings / "window.ini").write_bytes(b"[Window]\x00;;;<<<AppWindow>>>;;;\nWindowSize=")
    with person.starts(BAR, sign=middle) as process:
        person.do("the first handle", left, "click", 1)
        person.do("the second handle", right, "click", 1)
        person.drag(right, low)
        person.tell("key", "ctrl+Next")  # to the last frame
        person.drag(low, high)
        person.tell("key", "ctrl+s")
        until(lambda: not differ(person.see(field), selected_name), "the file browser")
        person.tell("type", "--delay", 40, "posed")
        assert person.title() == "bar* – Lissom"
        person.tell("key", "Return")
        until(path.is_file, "the project")
        until(lambda: person.title() == "posed.lissom – Lissom", "the name of the project")
        recent = (path,)
        until(lambda: load_preferences(settings).recent == recent, "the file among recent ones")
        person.tell("windowsize", "--sync", person.window, 1100, 700)
        person.tell("windowmove", "--sync", person.window, 90, 60)
        person.quit(process)
    document = load_project(path)
    assert len(document.layers[0].handles) == 2
    assert [key.frame for key in document.layers[0].keys] == [0, document.frames.last]
    assert all(key.pose.certificate.is_certified for key in document.layers[0].keys)
    first, last = (key.pose.targets[1].position for key in document.layers[0].keys)
    height = document.layers[0].picture.size[1]
    assert first.imag < 0.2 * height
    assert last.imag > 1.2 * height
    menu = 90 + NEAR, 60 + NEAR
    with person.starts(path, sign=menu) as process:
        # By this the desktop's entry knows its windows.
        assert person.tell("search", "--onlyvisible", "--class", "^Lissom$").strip()
        assert person.geometry() == (90, 60, 1100, 700)
        until(lambda: person.title() == "posed.lissom – Lissom", "the project")
        person.tell("key", "m")
        until(lambda: person.title() == "posed.lissom* – Lissom", "a marker")
        # As the system ends programs when a person logs out.
        process.terminate()
        assert WORK_KEPT in process.stderr.readline()
        process.wait()
    assert process.returncode == 128 + signal.SIGTERM
    (kept,) = find_recoverable_files(settings)
    recovered, origin = load_recoverable_file(kept)
    assert origin == ("posed", path)
    assert len(recovered.markers) == 1


# What the window does with them is asked in test_names.py; this asks the whole program.
@pytest.mark.long
def test_names_that_are_not_utf_8_keep_nobody_out(display, tmp_path):
    odd, shown = os.fsdecode(b"caf\xe9"), "caf\N{REPLACEMENT CHARACTER}"
    home = tmp_path / odd
    try:
        home.mkdir()
    except OSError:
        pytest.skip("this system lets no name be anything but UTF-8")
    drawing, person = home / f"{odd}.png", Person(display, home)
    shutil.copy(BAR, drawing)
    with person.starts(drawing, sign=(NEAR, NEAR)) as process:
        until(lambda: person.title() == f"{shown} – Lissom", "the drawing")
        person.quit(process)
    assert load_preferences(person.settings).recent == (drawing,)


WATCH = """
import time
from imgui_bundle import glfw_utils
import glfw
from app.ui.window.events import modifiers

def tell(*words):
    print(*words, flush=True)

glfw.init()
window = glfw.create_window(400, 300, "watch", None, None)
modifiers.glfw_utils = type("Ours", (), {"glfw_window_hello_imgui": staticmethod(lambda: window)})
tell(glfw.get_x11_window(window))
while True:
    order = input()
    for _ in range(10):
        time.sleep(0.01)
        glfw.poll_events()
    if order == "mend":
        modifiers.release_stuck_modifiers()
        glfw.poll_events()
    tell(glfw.get_key(window, glfw.KEY_LEFT_ALT))
"""


def test_a_key_that_was_let_go_unseen_is_not_held(person):
    """As after Alt+F4 and Cancel, where a window manager had the keyboard."""
    with subprocess.Popen(
        [sys.executable, "-c", WATCH],
        env=person.environment,
        cwd=Path(__file__).parents[3],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        text=True,
    ) as watch:

        def ask(order):
            watch.stdin.write(f"{order}\n")
            watch.stdin.flush()
            return int(watch.stdout.readline())

        window = int(watch.stdout.readline())
        ask("look")
        person.tell("windowfocus", "--sync", window)
        person.tell("keydown", "alt")
        until(lambda: ask("mend") == 1, "the key, which is held")
        with grabbed_keyboard(person.display):
            ask("look")
            person.tell("keyup", "alt")
        assert ask("look") == 1, "GLFW does not see that it was let go"
        until(lambda: ask("mend") == 0, "that it was let go")
        watch.kill()
