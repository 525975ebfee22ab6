"""Key chords as text, written as this system writes them."""

import sys
from collections.abc import Mapping
from functools import cache

from imgui_bundle import imgui

from app.editor.actions.action_spec import ActionSpec
from app.texts import N_, _

Key = imgui.Key
# On macOS Dear ImGui treats the command key as Ctrl.
IS_MAC = sys.platform == "darwin"
# Plain integers: combined as enum members, these keys fail to form a flag in Python 3.11.2.
CTRL, SHIFT, ALT = int(Key.mod_ctrl), int(Key.mod_shift), int(Key.mod_alt)
MODIFIERS = {CTRL: N_("Ctrl"), SHIFT: N_("Shift"), ALT: N_("Alt")}
# In Apple's order.
MAC_MODIFIERS = {ALT: "⌥", SHIFT: "⇧", CTRL: "⌘"}
KEY_NAMES = {
    "UpArrow": _("Up"),
    "DownArrow": _("Down"),
    "LeftArrow": _("Left"),
    "RightArrow": _("Right"),
    "PageUp": _("PgUp"),
    "PageDown": _("PgDn"),
    "Delete": _("Del"),
    "Escape": _("Esc"),
    "Home": _("Home"),
    "End": _("End"),
    "Enter": _("Enter"),
    "Space": _("Space"),
    "Insert": _("Insert"),
    "Backspace": _("Backspace"),
    "Equal": "+",
    "Minus": "−",
    "LeftBracket": "[",
    "RightBracket": "]",
}
# Names as the table of actions writes them: "PageUp", "1", "F9".
KEYS = {
    "".join(part.capitalize() for part in name.split("_")): int(key)
    for name, key in Key.__members__.items()
}


# The keys of keyboards, without those that are held or lock.
PRESSED_KEYS = tuple(
    Key(value)
    for value in sorted(set(KEYS.values()))
    if int(Key.tab) <= value <= int(Key.oem102)
    and not int(Key.left_ctrl) <= value <= int(Key.menu)
    and not int(Key.caps_lock) <= value <= int(Key.pause)
)
# Characters of keys with signs, as keyboards type them. Some need Shift or AltGr for it.
SIGNS = {
    **{digit: KEYS[digit] for digit in "0123456789"},
    "[": KEYS["LeftBracket"],
    "]": KEYS["RightBracket"],
    "+": KEYS["Equal"],
    "-": KEYS["Minus"],
    ",": KEYS["Comma"],
    ".": KEYS["Period"],
    "/": KEYS["Slash"],
    "\\": KEYS["Backslash"],
    ";": KEYS["Semicolon"],
    "'": KEYS["Apostrophe"],
}


class KeyMap:
    """The key chords that the person chose in place of those of actions, by their labels."""

    def __init__(self) -> None:
        self._source: Mapping[str, str] = {}
        self.chosen: dict[str, tuple[int, ...]] = {}

    def use(self, source: Mapping[str, str]) -> None:
        """Use chords as text; those of keys that do not exist are ignored."""
        if source is self._source:
            return
        self._source, self.chosen = source, {}
        for label, text in source.items():
            try:
                self.chosen[label] = parse_chords(text)
            except KeyError:
                continue


KEY_MAP = KeyMap()


@cache
def parse_chords(text: str) -> tuple[int, ...]:
    """Return ImGui's key chords of a text such as "Ctrl+Shift+Z, Ctrl+Y"."""
    by_name = {name: modifier for modifier, name in MODIFIERS.items()} | KEYS
    chords = text.split(", ") if text else []
    return tuple(sum(by_name[name] for name in chord.split("+")) for chord in chords)


def chord_text(chord: int) -> str:
    """Return a key chord as `parse_chords` reads it."""
    names = [name for modifier, name in MODIFIERS.items() if chord & modifier]
    key = chord & ~sum(MODIFIERS)
    return "+".join([*names, next(name for name, value in KEYS.items() if value == key)])


@cache
def format_chord(chord: int, *, is_mac: bool = IS_MAC) -> str:
    """Return a key chord as menus show it: "Ctrl+Shift+S", or "⇧⌘S" on macOS."""
    key = imgui.get_key_name(Key(chord & ~sum(MODIFIERS)))
    names = MAC_MODIFIERS if is_mac else MODIFIERS
    parts = [_(name) for modifier, name in names.items() if chord & modifier]
    return ("" if is_mac else "+").join([*parts, KEY_NAMES.get(key, key)])


def chords_of(spec: ActionSpec, *, is_mac: bool = IS_MAC) -> tuple[int, ...]:
    """Return the key chords of an action on this system, or on the given one."""
    chosen = KEY_MAP.chosen.get(spec.label)
    return own_chords(spec, is_mac=is_mac) if chosen is None else chosen


def own_chords(spec: ActionSpec, *, is_mac: bool = IS_MAC) -> tuple[int, ...]:
    """Return the key chords that an action has unless the person chooses others."""
    return parse_chords((is_mac and spec.mac_keys) or spec.keys)


def shown_keys(spec: ActionSpec) -> str:
    """Return the first key chord of an action, as menus show it."""
    chords = chords_of(spec)
    return format_chord(chords[0]) if chords else spec.key_text


@cache
def format_modified(modifier: int, what: str, *, is_mac: bool = IS_MAC) -> str:
    """Return a pointer gesture with a modifier: "Ctrl+click", or "⌘ click" on macOS."""
    return f"{MAC_MODIFIERS[modifier]} {what}" if is_mac else f"{_(MODIFIERS[modifier])}+{what}"
