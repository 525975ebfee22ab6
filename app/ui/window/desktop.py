"""The desktop: whether there is one, and the window's title, icon and name on it."""

import io
import os
import sys

import numpy as np
from imgui_bundle import glfw_utils  # before glfw: it brings the library itself
from PIL import Image

import glfw  # isort: skip

from app.editor import Session
from app.errors import display_name
from app.storage import app_icon

NAME = "Lissom"
APPLICATION = "lissom"  # the name of the program's desktop entry
ICON_SIDES = (16, 32, 64)  # pixels
# Environment variables that name the display of X11 or Wayland.
DISPLAYS = ("DISPLAY", "WAYLAND_DISPLAY")


def has_display() -> bool:
    """Return whether the environment names a screen for the window."""
    return sys.platform != "linux" or any(map(os.environ.get, DISPLAYS))


def window_title(session: Session) -> str:
    """Return the name of the open project, with a star if it has unsaved changes."""
    project = session.project
    if project is None:
        return NAME
    name = (
        display_name(project.file.path.name) if project.file.path is not None else project.file.name
    )
    mark = "" if project.history.is_saved else "*"
    return f"{name}{mark} – {NAME}"


def show_icon() -> None:
    """Set the window's icon, on systems where a program provides it."""
    if glfw.get_platform() not in {glfw.PLATFORM_X11, glfw.PLATFORM_WIN32}:
        return
    with Image.open(io.BytesIO(app_icon())) as icon:
        pictures = [np.asarray(icon.resize((side, side))) for side in ICON_SIDES]
    # As lists, because glfw reads them much faster than arrays.
    images = [(*picture.shape[:2], picture.tolist()) for picture in pictures]
    window = glfw_utils.glfw_window_hello_imgui()
    glfw.set_window_icon(window, len(images), images)  # type: ignore[arg-type]  # tuples of theirs


def name_application() -> None:
    """Set the window's application name, so that the desktop finds its menu entry."""
    glfw.init()
    glfw.window_hint_string(glfw.WAYLAND_APP_ID, APPLICATION)
    glfw.window_hint_string(glfw.X11_INSTANCE_NAME, APPLICATION)
    glfw.window_hint_string(glfw.X11_CLASS_NAME, NAME)
