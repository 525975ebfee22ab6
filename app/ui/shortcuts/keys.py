"""Keys in words, as the system writes them that Lissom runs on."""

import sys
from functools import cache

from imgui_bundle import imgui

Key = imgui.Key
# On macOS Dear ImGui takes the command key for Ctrl.
IS_MAC = sys.platform == "darwin"
# Whole numbers: combined as members, these keys fail to form a flag in Python 3.11.2.
CTRL, SHIFT, ALT = int(Key.mod_ctrl), int(Key.mod_shift), int(Key.mod_alt)
MODIFIERS = {CTRL: "Ctrl", SHIFT: "Shift", ALT: "Alt"}
# In the order in which Apple writes them.
MAC_MODIFIERS = {ALT: "⌥", SHIFT: "⇧", CTRL: "⌘"}
KEY_NAMES = {
    "UpArrow": "Up",
    "DownArrow": "Down",
    "LeftArrow": "Left",
    "RightArrow": "Right",
    "PageUp": "PgUp",
    "PageDown": "PgDn",
    "Delete": "Del",
    "Equal": "+",
    "Minus": "−",
    "LeftBracket": "[",
    "RightBracket": "]",
}
# As they are written in the table of bindings: "PageUp", "1", "F9".
KEYS = {
    "".join(part.capitalize() for part in name.split("_")): int(key)
    for name, key in Key.__members__.items()
}


@cache
def parse_chords(text: str) -> tuple[int, ...]:
    """Return ImGui's key chords of a text such as "Ctrl+Shift+Z, Ctrl+Y"."""
    by_name = {name: modifier for modifier, name in MODIFIERS.items()} | KEYS
    chords = text.split(", ") if text else []
    return tuple(sum(by_name[name] for name in chord.split("+")) for chord in chords)


@cache
def format_chord(chord: int, *, is_mac: bool = IS_MAC) -> str:
    """Return a key chord as menus show it: "Ctrl+Shift+S", or "⇧⌘S" on macOS."""
    names = MAC_MODIFIERS if is_mac else MODIFIERS
    key = imgui.get_key_name(Key(chord & ~sum(MODIFIERS)))
    parts = [name for modifier, name in names.items() if chord & modifier]
    return ("" if is_mac else "+").join([*parts, KEY_NAMES.get(key, key)])


@cache
def format_modified(modifier: int, what: str, *, is_mac: bool = IS_MAC) -> str:
    """Return what the pointer does while a modifier is held: "Ctrl+click", or "⌘ click"."""
    return f"{MAC_MODIFIERS[modifier]} {what}" if is_mac else f"{MODIFIERS[modifier]}+{what}"
