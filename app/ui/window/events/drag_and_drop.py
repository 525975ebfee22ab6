"""Files that are dropped on the window."""

import os
from collections.abc import Callable, Sequence
from pathlib import Path

import imgui_bundle  # noqa: F401 - before glfw: it brings the library itself

from glfw.library import glfw  # isort: skip


def accept_files(window: object, take: Callable[[list[Path]], None]) -> object:
    """Call `take` with the files dropped on a window. Keep the returned object alive meanwhile."""

    def dropped(_: object, count: int, names: Sequence[bytes]) -> None:
        take([Path(os.fsdecode(names[i])) for i in range(count)])

    # glfw.set_drop_callback would end the program at a name that is not UTF-8.
    listen = glfw.glfwSetDropCallback  # type: ignore[union-attr]  # it is there by now
    callback = listen.argtypes[1](dropped)
    listen(window, callback)
    return callback
