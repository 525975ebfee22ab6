"""Which key types a sign on the keyboard's layout.

Dear ImGui names keys by the letters and most signs that they type. A key that types + has the name
of its place on an English keyboard, such as ] on a German one.
"""

from imgui_bundle import imgui  # before glfw: it brings the library itself

import glfw  # isort: skip

Key = imgui.Key
# Keys of GLFW that may type other signs than on English keyboards.
SIGN_KEYS = {
    glfw.KEY_APOSTROPHE: Key.apostrophe,
    glfw.KEY_COMMA: Key.comma,
    glfw.KEY_MINUS: Key.minus,
    glfw.KEY_PERIOD: Key.period,
    glfw.KEY_SLASH: Key.slash,
    glfw.KEY_SEMICOLON: Key.semicolon,
    glfw.KEY_EQUAL: Key.equal,
    glfw.KEY_LEFT_BRACKET: Key.left_bracket,
    glfw.KEY_BACKSLASH: Key.backslash,
    glfw.KEY_RIGHT_BRACKET: Key.right_bracket,
    glfw.KEY_GRAVE_ACCENT: Key.grave_accent,
    glfw.KEY_WORLD_1: Key.oem102,
}


def find_plus_key() -> Key | None:
    """Return ImGui's key that types + without Shift, if there is one."""
    for place, key in SIGN_KEYS.items():
        if glfw.get_key_name(place, 0) == "+":
            return key
    return None
