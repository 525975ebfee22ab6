"""Key chords as text, written as this system writes them."""

import sys
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


@cache
def parse_chords(text: str) -> tuple[int, ...]:
    """Return ImGui's key chords of a text such as "Ctrl+Shift+Z, Ctrl+Y"."""
    by_name = {name: modifier for modifier, name in MODIFIERS.items()} | KEYS
    chords = text.split(", ") if text else []
    return tuple(sum(by_name[name] for name in chord.split("+")) for chord in chords)


@cache
def format_chord(chord: int, *, is_mac: bool = IS_MAC) -> str:
    """Return a key chord as menus show it: "Ctrl+Shift+S", or "⇧⌘S" on macOS."""
    key = imgui.get_key_name(Key(chord & ~sum(MODIFIERS)))
    names = MAC_MODIFIERS if is_mac else MODIFIERS
    parts = [_(name) for modifier, name in names.items() if chord & modifier]
    return ("" if is_mac else "+").join([*parts, KEY_NAMES.get(key, key)])


def chords_of(spec: ActionSpec, *, is_mac: bool = IS_MAC) -> tuple[int, ...]:
    """Return the key chords of an action on this system, or on the given one."""
    return parse_chords((is_mac and spec.mac_keys) or spec.keys)


def shown_keys(spec: ActionSpec) -> str:
    """Return the first key chord of an action, as menus show it."""
    return format_chord(chords_of(spec)[0]) if spec.keys else spec.key_text


@cache
def format_modified(modifier: int, what: str, *, is_mac: bool = IS_MAC) -> str:
    """Return a pointer gesture with a modifier: "Ctrl+click", or "⌘ click" on macOS."""
    return f"{MAC_MODIFIERS[modifier]} {what}" if is_mac else f"{_(MODIFIERS[modifier])}+{what}"
