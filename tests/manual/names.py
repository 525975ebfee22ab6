"""The names that the program has for what can be done: menus, tabs, labels, keys and options.

What the manual writes in italics must be one of them.
"""

import argparse
import ast
import re
from collections.abc import Iterator
from functools import cache
from itertools import chain
from pathlib import Path

from app.cli.main import COMMANDS, build_parser
from app.document import (
    GROUP_BLEND_SECTIONS,
    LAYER_KINDS,
    LIMIT_PRESETS,
    PRESETS,
    SPRING_PRESETS,
    WEIGHT_PRESETS,
)
from app.editor.actions import tutorials
from app.export_formats import EXPORT_FORMATS
from app.ui.shortcuts.keys import (
    ALT,
    CTRL,
    KEYS,
    MAC_MODIFIERS,
    SHIFT,
    chords_of,
    format_chord,
    format_modified,
)
from app.ui.shortcuts.pointer_help import POINTER_HELP
from app.ui.shortcuts.table import ACTIONS, MENUS, SUBMENUS
from app.ui.shortcuts.window_actions import PAGES

ROOT = Path(__file__).parents[2]
ASKED = ROOT / "app" / "ui"  # where what is read on the screen is written
HELD = {"alt": ALT, "ctrl": CTRL, "shift": SHIFT}
ARROW = " › "
LEAST = 5  # letters that a text with gaps must have to be known again
GAP = "\0"


class UnknownNameError(ValueError):
    """Something that the program does not have."""


def check_name(text: str) -> None:
    """Refuse what is written in italics and is no name of the program, by its whole path."""
    first, *rest = text.split(ARROW)
    if first in MENUS:
        groups = MENUS[first]
        opened = [group for group in groups if rest and SUBMENUS.get(group[0]) == rest[0]]
        if opened:
            groups, rest = tuple(opened), rest[1:]
        entries = {spec.label for spec in chain(*groups)}
        if all(part in entries or _is_written(part, "bars/menus.py") for part in rest[:1]):
            rest = rest[1:]
        else:
            raise UnknownNameError(f"the menu {first} has no entry {rest[0]!r}")
    elif rest and first not in PAGES:
        raise UnknownNameError(f"there is no menu or tab {first!r}")
    else:
        rest = [first, *rest]
    for part in rest:
        if not _is_known(part):
            raise UnknownNameError(f"nothing in the program is named {part!r}")


def key(name: str) -> tuple[str, str]:
    """Return the keys of a named action, elsewhere and on macOS."""
    if name not in ACTIONS:
        raise UnknownNameError(f"no action is named {name!r}")
    binding = ACTIONS[name]
    if not binding.keys:
        if not binding.key_text:
            raise UnknownNameError(f"{name!r} has no keys")
        return binding.key_text, binding.key_text
    mac = chords_of(binding, is_mac=True)[0]
    return format_chord(chords_of(binding, is_mac=False)[0], is_mac=False), format_chord(
        mac, is_mac=True
    )


def press(name: str) -> tuple[str, str]:
    """Return how a single key is called."""
    if name.lower() in HELD:
        return name, MAC_MODIFIERS[HELD[name.lower()]]
    if name not in KEYS:
        raise UnknownNameError(f"there is no key {name!r}")
    return format_chord(KEYS[name], is_mac=False), format_chord(KEYS[name], is_mac=True)


def hold(modifiers: str, what: str) -> tuple[str, str]:
    """Return what the pointer does while keys are held, such as "ctrl+shift", "drag"."""
    plain = mac = what
    for modifier in reversed(modifiers.split("+")):
        plain = format_modified(HELD[modifier], plain, is_mac=False)
        mac = format_modified(HELD[modifier], mac, is_mac=True)
    return plain, mac


def key_groups() -> dict[str, list[tuple[str, tuple[str, str]]]]:
    """Return all keys by the menus that their actions are in."""
    return {
        menu: [
            (spec.label, key(spec.label)) for spec in chain(*groups) if spec.keys or spec.key_text
        ]
        for menu, groups in MENUS.items()
    }


def gestures() -> list[tuple[str, str]]:
    """Return what the pointer does, and how; written as on Linux and Windows."""
    return [(gesture.effect, gesture.gesture) for gesture in POINTER_HELP]


def check_command(line: str) -> None:
    """Refuse a command line with a command or an option that does not exist."""
    words = line.split()
    if words[:1] != ["lissom"]:
        return
    command = words[1] if len(words) > 1 and words[1] in COMMANDS else "window"
    known = set(options()[command])
    for word in words[1:]:
        if word.startswith("-") and word.partition("=")[0] not in known:
            raise UnknownNameError(f"lissom {command} has no option {word}")
        if re.fullmatch("[a-z]+", word) and word == words[1] and word not in COMMANDS:
            raise UnknownNameError(f"there is no command {word!r}")


@cache
def options() -> dict[str, tuple[str, ...]]:
    """Return the options of all commands."""
    found = {}
    for command in COMMANDS:
        actions = _subparser(build_parser([command]), command)._actions
        found[command] = tuple(word for action in actions for word in action.option_strings)
    return found


def help_of(command: str) -> str:
    """Return what `lissom COMMAND --help` prints, on lines of 100 letters."""
    parser = _subparser(build_parser([command]), command)
    parser.formatter_class = _Wide
    return parser.format_help()


class _Wide(argparse.RawDescriptionHelpFormatter):
    def __init__(self, prog: str) -> None:
        super().__init__(prog, width=100)


def _subparser(parser: argparse.ArgumentParser, command: str) -> argparse.ArgumentParser:
    choices = next(action.choices for action in parser._actions if action.choices)
    return choices[command]


def _is_known(part: str) -> bool:
    tables: set[str] = {binding.label for binding in ACTIONS.values()} | set(PAGES) | set(MENUS)
    tables |= {format_.label for format_ in EXPORT_FORMATS.values()} | {
        sample.name for sample in tutorials.sample_files()
    }
    tables |= {format_.group for format_ in EXPORT_FORMATS.values()}
    tables |= {kind.label for kind in LAYER_KINDS.values()}
    words = [
        *WEIGHT_PRESETS,
        *PRESETS,
        *SPRING_PRESETS,
        *(label for section in GROUP_BLEND_SECTIONS for label in section.values()),
        *(stretch.name for stretch in LIMIT_PRESETS),
    ]
    tables |= {*words, *map(str.capitalize, words)}
    return part in tables or _is_written(part, "")


def _is_written(part: str, where: str) -> bool:
    """Tell whether a part of the interface writes a text, with whatever stands in its gaps."""
    return any(
        pattern.fullmatch(part) is not None for path, pattern in _written() if path.endswith(where)
    )


@cache
def _written() -> tuple[tuple[str, re.Pattern[str]], ...]:
    """Return all texts of the interface's source, docstrings apart, as patterns."""
    found = []
    others = [ROOT / "app" / "export_formats.py"]
    for path in [*sorted(ASKED.rglob("*.py")), *others]:
        for text in _texts(ast.parse(path.read_text(encoding="utf-8"))):
            seen = _seen(text)
            if not seen or (GAP in seen and len(seen.replace(GAP, "")) < LEAST):
                continue
            pattern = ".+".join(map(re.escape, seen.split(GAP)))
            found.append((path.as_posix(), re.compile(pattern)))
    return tuple(found)


def _texts(tree: ast.Module) -> Iterator[str]:
    inner = set()
    for node in ast.walk(tree):
        if isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant):
            inner.add(id(node.value))  # a docstring
        if isinstance(node, ast.JoinedStr):
            inner |= {id(part) for part in node.values}
    for node in ast.walk(tree):
        if isinstance(node, ast.JoinedStr):
            yield "".join(map(_part, node.values))
        elif isinstance(node, ast.Constant) and id(node) not in inner:
            yield node.value if isinstance(node.value, str) else ""


def _part(node: ast.expr) -> str:
    if isinstance(node, ast.Constant):
        return str(node.value)
    assert isinstance(node, ast.FormattedValue)
    text = ast.unparse(node.value)
    is_icon = text.startswith("icons.") or text in {"icon", "palette"}
    return "" if is_icon or text.endswith(".icon") else GAP


def _seen(text: str) -> str:
    """Return what is seen of a label, without its icons, its identity, and a number in it."""
    shown = re.sub("[\ue000-\uf8ff]", "", text).partition("##")[0]
    # The fields of a text of the catalogue, such as {count:,}, are gaps too.
    shown = re.sub(r"\{\w*(:[^}]*)?\}", GAP, shown)
    return re.sub(r" %[\d.]*[dfg](%%)?$", "", shown).strip()
