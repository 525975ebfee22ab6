"""Files that are dropped on the window."""

import os
from collections.abc import Callable, Sequence
from pathlib import Path

import imgui_bundle  # noqa: F401 - before glfw: it brings the library itself

from glfw.library import glfw  # isort: skip


def accept_files(window: object, take: Callable[[list[Path]], None]) -> object:
    """Hand over the files that are dropped on a window, as long as what is returned is kept."""

    def dropped(_: object, count: int, names: Sequence[bytes]) -> None:
        take([Path(os.fsdecode(names[i])) for i in range(count)])

    # By glfw.set_drop_callback, a name that is not UTF-8 would end the program.
    listen = glfw.glfwSetDropCallback  # type: ignore[union-attr]  # it is there by now
    callback = listen.argtypes[1](dropped)
    listen(window, callback)
    return callback
