"""Keys of the system, on their way to Dear ImGui."""

from imgui_bundle import imgui  # before glfw: it brings the library itself

from app.ui.shortcuts.tap_counter import TapCounter

import glfw  # isort: skip
from glfw.library import glfw as library  # isort: skip

Key = imgui.Key
COUNTED = {
    glfw.KEY_LEFT: Key.left_arrow,
    glfw.KEY_RIGHT: Key.right_arrow,
    glfw.KEY_UP: Key.up_arrow,
    glfw.KEY_DOWN: Key.down_arrow,
    glfw.KEY_PAGE_UP: Key.page_up,
    glfw.KEY_PAGE_DOWN: Key.page_down,
}


def count_taps(window: object, taps: TapCounter) -> object:
    """Pass the keys of a window on unless they are counted. Keep the returned object alive."""

    def pressed(window: object, code: int, scancode: int, action: int, modifiers: int) -> None:
        key, waiting = COUNTED.get(code), imgui.get_current_context().input_events_queue.size()
        is_repeat = action == glfw.REPEAT
        is_down = action == glfw.PRESS
        if key is None or is_repeat or not taps.drops(key, is_down=is_down, waiting=waiting):
            pass_on(window, code, scancode, action, modifiers)

    # glfw.set_key_callback knows only callbacks in Python.
    listen = library.glfwSetKeyCallback  # type: ignore[union-attr]  # it is there by now
    callback = listen.argtypes[1](pressed)
    pass_on = listen(window, callback)
    return callback
