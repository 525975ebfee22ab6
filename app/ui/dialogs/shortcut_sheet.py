"""The list of all shortcuts, with a search, in which the keys of actions are changed."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from itertools import chain, combinations_with_replacement, pairwise
from typing import NamedTuple

from imgui_bundle import ImVec2, imgui

from app.editor import Action, Session, ShortcutSheet, do
from app.editor.actions.action_spec import ActionSpec
from app.editor.actions.dialog_actions import choose_keys, edit_shortcut_sheet
from app.texts import N_, _
from app.ui.shortcuts.keys import (
    ALT,
    CTRL,
    KEY_MAP,
    PRESSED_KEYS,
    SHIFT,
    chord_text,
    chords_of,
    format_chord,
    own_chords,
    shown_keys,
)
from app.ui.shortcuts.pointer_help import POINTER_HELP
from app.ui.shortcuts.table import ACTIONS, ENDED_BY_ESC, MENUS
from app.ui.style.theme import Look, colour_u32
from app.ui.style.widgets import draw_tooltip, heading

Key = imgui.Key
COLUMN = 20.0  # em, at least
HEADING = 2  # rows of a group's heading
# What these do is not an action's.
RESERVED = (Key.space, Key.tab, Key.enter, Key.keypad_enter)


class _Row(NamedTuple):
    """A line of the list: an action, or a gesture of the pointer."""

    text: str
    keys: str
    spec: ActionSpec | None = None


def draw_shortcut_sheet(sheet: ShortcutSheet, session: Session, look: Look) -> list[Action]:
    """Draw the list, and above it the search or the question for new keys."""
    spec = ACTIONS.get(sheet.changed)
    keys = session.settings.preferences.keys
    if spec is None:
        actions = _draw_search(sheet, keys, look)
    else:
        imgui.set_scroll_y(0.0)  # to the question
        actions = _ask_keys(sheet, spec, keys)
    imgui.dummy(ImVec2(0, 0.3 * look.em))
    return actions + _draw_rows(sheet, look)


def _draw_search(sheet: ShortcutSheet, keys: Mapping[str, str], look: Look) -> list[Action]:
    imgui.align_text_to_frame_padding()
    imgui.text_unformatted(_("Click a key to change it."))
    imgui.same_line(0, 1.5 * look.em)
    imgui.set_next_item_width(16 * look.em)
    is_changed, text = imgui.input_text_with_hint("##search", _("Search all actions"), sheet.search)
    actions = [do(edit_shortcut_sheet, replace(sheet, search=text))] if is_changed else []
    if keys:
        imgui.same_line(0, 1.5 * look.em)
        if imgui.button(_("Reset all keys")):
            actions.append(do(choose_keys, {}, sheet))
    return actions


def _ask_keys(sheet: ShortcutSheet, spec: ActionSpec, keys: Mapping[str, str]) -> list[Action]:
    """Ask for the keys of an action, and tell if they belong to another one."""
    done = replace(sheet, changed="", taken=0)
    others = {label: text for label, text in keys.items() if label != spec.label}

    def choose(given: Mapping[str, Sequence[int]]) -> Action:
        texts = {label: ", ".join(map(chord_text, chords)) for label, chords in given.items()}
        return do(choose_keys, others | texts, done)

    actions: list[Action] = []
    imgui.align_text_to_frame_padding()
    owner = _owner_of(sheet.taken, spec) if sheet.taken else None
    if owner is None:
        imgui.text_unformatted(_("Press the new keys for “{label}”.").format(label=spec.label))
        imgui.same_line()
        if imgui.button(_("No keys")):
            actions.append(choose({spec.label: ()}))
    else:
        imgui.text_unformatted(
            _("{keys} belongs to “{owner}”.").format(
                keys=format_chord(sheet.taken), owner=owner.label
            )
        )
        imgui.same_line()
        if imgui.button(_("Use it for “{label}”").format(label=spec.label)):
            left = [each for each in chords_of(owner) if each != sheet.taken]
            actions.append(choose({owner.label: left, spec.label: (sheet.taken,)}))
    if spec.label in keys:
        imgui.same_line()
        own = ", ".join(map(format_chord, own_chords(spec))) or _("none")
        if imgui.button(_("Reset to {keys}").format(keys=own)):
            actions.append(do(choose_keys, others, done))
    imgui.same_line()
    if imgui.button(_("Cancel")) or imgui.is_key_pressed(Key.escape):
        actions.append(do(edit_shortcut_sheet, done))
    chord = _pressed_chord()
    if chord is not None and _owner_of(chord, spec) is not None:
        actions.append(do(edit_shortcut_sheet, replace(sheet, taken=chord)))
    elif chord is not None:
        actions.append(choose({spec.label: (chord,)}))
    return actions[:1]


def _pressed_chord() -> int | None:
    """Return the key that is pressed now, with its modifiers."""
    io = imgui.get_io()
    held = ((CTRL, io.key_ctrl), (SHIFT, io.key_shift), (ALT, io.key_alt))
    modifiers = sum(modifier for modifier, is_held in held if is_held)
    for key in PRESSED_KEYS:
        if key not in (*RESERVED, Key.escape) and imgui.is_key_pressed(key, repeat=False):
            return int(key) | modifiers
    return None


def _owner_of(chord: int, but: ActionSpec) -> ActionSpec | None:
    """Return another action with a key chord."""
    specs = dict.fromkeys((*ACTIONS.values(), *ENDED_BY_ESC))
    return next((each for each in specs if each is not but and chord in chords_of(each)), None)


def _draw_rows(sheet: ShortcutSheet, look: Look) -> list[Action]:
    """Draw the actions with keys and the gestures of the pointer, or what the search finds."""
    rows = {
        menu: [_Row(spec.label, shown_keys(spec), spec) for spec in chain(*groups)]
        for menu, groups in MENUS.items()
    }
    rows[N_("Pointer")] = [_Row(gesture.effect, gesture.gesture) for gesture in POINTER_HELP]
    wanted = sheet.search.casefold().strip()
    for menu, own in rows.items():
        rows[menu] = [
            row
            for row in own
            if (wanted in f"{row.text} {row.keys}".casefold() if wanted else row.keys)
            or (row.spec is not None and row.spec.label in KEY_MAP.chosen)
        ]
    rows = {menu: own for menu, own in rows.items() if own}
    if not rows:
        imgui.text_disabled(_("No action has this name."))
        return []
    actions: list[Action] = []
    style = imgui.get_style()
    # Tighter than elsewhere, so that all shortcuts are visible at once.
    imgui.push_style_var(imgui.StyleVar_.item_spacing, ImVec2(style.item_spacing.x, 0.2 * look.em))
    room = 0.9 * imgui.get_main_viewport().size.x - 4 * look.em
    for count in (3, 2, 1):
        columns = _columns({group: len(rows[group]) for group in rows}, count)
        texts = [[row for group in column for row in rows[group]] for column in columns]
        # Where the keys begin in each column.
        keys_at = [_widest(row.text for row in own) + 1.6 * look.em for own in texts]
        keys = [_widest(row.keys for row in own) for own in texts]
        widths = [max(sum(both), COLUMN * look.em) for both in zip(keys_at, keys, strict=True)]
        if sum(widths) + (count - 1) * look.em <= room:
            break
    if imgui.begin_table("sheet", len(columns), imgui.TableFlags_.sizing_fixed_fit):
        for column, start, width in zip(columns, keys_at, widths, strict=True):
            imgui.table_next_column()
            for group in column:
                heading(look, _(group))
                for row in rows[group]:
                    actions += _draw_row(sheet, look, row, start)
            imgui.dummy(ImVec2(width, 0))
        imgui.end_table()
    imgui.pop_style_var()
    return actions


def _draw_row(sheet: ShortcutSheet, look: Look, row: _Row, keys_at: float) -> list[Action]:
    """Draw a row; a click on the keys of an action asks for others."""
    imgui.text_unformatted(row.text)
    imgui.same_line(keys_at)
    spec = row.spec
    if spec is None or (chords_of(spec) and int(Key.escape) in chords_of(spec)):
        imgui.text_disabled(row.keys)
        return []
    text = row.keys or _("none")
    place, size = imgui.get_cursor_screen_pos(), imgui.calc_text_size(text)
    room = ImVec2(max(size.x, 3 * look.em), size.y)
    is_pressed = imgui.invisible_button(f"keys of {spec.label}", room)
    is_lit = imgui.is_item_hovered() or sheet.changed == spec.label
    draw_tooltip(_("Change the keys"))
    palette = look.palette
    colour = palette.accent if is_lit or spec.label in KEY_MAP.chosen else palette.dim
    imgui.get_window_draw_list().add_text(place, colour_u32(colour), text)
    if not is_pressed:
        return []
    return [do(edit_shortcut_sheet, replace(sheet, changed=spec.label, taken=0))]


def _widest(texts: Iterable[str]) -> float:
    return max((imgui.calc_text_size(text).x for text in texts), default=0.0)


def _columns(sizes: Mapping[str, int], count: int) -> list[list[str]]:
    """Split groups into columns of nearly equal height, in order. `sizes` are in rows."""
    names = list(sizes)
    cuts = combinations_with_replacement(range(len(names) + 1), count - 1)
    parted = [
        [names[begin:end] for begin, end in pairwise((0, *inner, len(names)))] for inner in cuts
    ]
    return min(
        parted,
        key=lambda columns: max(
            sum(sizes[name] + HEADING for name in column) for column in columns
        ),
    )
