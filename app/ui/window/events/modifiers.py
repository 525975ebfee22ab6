"""Modifiers whose release the window did not receive, as when a window manager took Alt+F4.

While another program grabs the keyboard, X11 sends its keys to no other window, and GLFW sees no
change of focus when the grab ends. GLFW then still treats a released key as pressed.
"""

import ctypes
import ctypes.util
from functools import cache
from typing import Any, Final, NamedTuple

from imgui_bundle import glfw_utils  # before glfw: it brings the library itself

import glfw  # isort: skip


class _Modifier(NamedTuple):
    """A key of GLFW, its X11 symbol, and its bit in the state of the pointer."""

    key: int
    symbol: int
    bit: int


SHIFT, CONTROL, ALT, SUPER = 1, 4, 8, 64
MODIFIERS: Final = (
    _Modifier(glfw.KEY_LEFT_SHIFT, 0xFFE1, SHIFT),
    _Modifier(glfw.KEY_RIGHT_SHIFT, 0xFFE2, SHIFT),
    _Modifier(glfw.KEY_LEFT_CONTROL, 0xFFE3, CONTROL),
    _Modifier(glfw.KEY_RIGHT_CONTROL, 0xFFE4, CONTROL),
    _Modifier(glfw.KEY_LEFT_ALT, 0xFFE9, ALT),
    _Modifier(glfw.KEY_RIGHT_ALT, 0xFFEA, ALT),
    _Modifier(glfw.KEY_LEFT_SUPER, 0xFFEB, SUPER),
    _Modifier(glfw.KEY_RIGHT_SUPER, 0xFFEC, SUPER),
)
KEY_RELEASE, KEY_RELEASE_MASK = 3, 1 << 1


class _KeyEvent(ctypes.Structure):
    """X11's XKeyEvent, padded to the size of the union of all events."""

    _fields_ = (
        ("type", ctypes.c_int),
        ("serial", ctypes.c_ulong),
        ("send_event", ctypes.c_int),
        ("display", ctypes.c_void_p),
        ("window", ctypes.c_ulong),
        ("root", ctypes.c_ulong),
        ("subwindow", ctypes.c_ulong),
        ("time", ctypes.c_ulong),
        ("x", ctypes.c_int),
        ("y", ctypes.c_int),
        ("x_root", ctypes.c_int),
        ("y_root", ctypes.c_int),
        ("state", ctypes.c_uint),
        ("keycode", ctypes.c_uint),
        ("same_screen", ctypes.c_int),
        ("room", ctypes.c_long * 24),
    )


@cache
def _x11() -> Any:
    name = ctypes.util.find_library("X11")
    if name is None:
        return None
    library = ctypes.CDLL(name)
    display, window = ctypes.c_void_p, ctypes.c_ulong
    library.XQueryPointer.argtypes = [display, window, *[ctypes.c_void_p] * 7]
    library.XKeysymToKeycode.argtypes = [display, ctypes.c_ulong]
    library.XKeysymToKeycode.restype = ctypes.c_ubyte
    library.XSendEvent.argtypes = [display, window, ctypes.c_int, ctypes.c_long, ctypes.c_void_p]
    return library


def _held(library: Any, display: int, window: int) -> int:
    """Return the bits of all held modifiers, from the X server."""
    root, child, state = ctypes.c_ulong(), ctypes.c_ulong(), ctypes.c_uint()
    places = [ctypes.c_int() for _ in range(4)]
    answers = (root, child, *places, state)
    library.XQueryPointer(display, window, *map(ctypes.byref, answers))
    return state.value


def release_stuck_modifiers() -> None:
    """Release the modifiers that GLFW wrongly treats as held; once a frame.

    On other systems, each window receives the held modifiers when it gets the keyboard back.
    """
    if glfw.get_platform() != glfw.PLATFORM_X11:
        return
    window = glfw_utils.glfw_window_hello_imgui()
    held = [modifier for modifier in MODIFIERS if glfw.get_key(window, modifier.key) == glfw.PRESS]
    library = _x11() if held else None
    if library is None:
        return
    display = glfw.get_x11_display()  # type: ignore[no-untyped-call]
    target = glfw.get_x11_window(window)
    state = _held(library, display, target)
    for modifier in held:
        if state & modifier.bit:
            continue
        code = library.XKeysymToKeycode(display, modifier.symbol)
        event = _KeyEvent(
            type=KEY_RELEASE, display=display, window=target, keycode=code, same_screen=1
        )
        library.XSendEvent(display, target, 0, KEY_RELEASE_MASK, ctypes.byref(event))
