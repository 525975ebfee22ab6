"""Shortcuts: they work wherever the pointer is.

A key acts by the character that it types, as well as by its place on the keyboard.
"""

import math
from collections.abc import Callable
from dataclasses import replace
from itertools import chain

from imgui_bundle import imgui

from app.editor import Action, Session, do
from app.editor.actions import dialog_actions, playback, viewing
from app.editor.actions.posing.pose_drag import nudge_handles
from app.editor.tools import move_tool
from app.editor.tools.transform_tools.handle_box_tool import change_handles_by_key
from app.editor.tools.transform_tools.layer_box_tool import change_layer_by_key
from app.ui.shortcuts.keys import CTRL, PRESSED_KEYS, SIGNS, chords_of
from app.ui.shortcuts.table import ACTIONS, ENDED_BY_ESC
from app.ui.shortcuts.tap_counter import TapCounter

Key = imgui.Key
MODIFIERS = int(imgui.Key.mod_mask_)
ARROWS = {Key.left_arrow: -1 + 0j, Key.right_arrow: 1 + 0j, Key.up_arrow: 1j, Key.down_arrow: -1j}
TURN, GROWTH = math.radians(1.0), 1.01  # of a selection, per press of Ctrl and an arrow
PLUS = int(Key.equal)  # the key of + on English keyboards


def collect_key_actions(
    session: Session, taps: TapCounter, plus_key: Callable[[], Key | None] = lambda: None
) -> list[Action]:
    """Return the actions whose keys were pressed, unless the person types into a field.

    `plus_key` returns the key that types +, if it is not the one of English keyboards.
    """
    io, is_elsewhere = imgui.get_io(), session.dialogs.current is not None or _close_menu()
    # Dear ImGui's own focus moves by one item with each tap.
    is_in_menu = imgui.get_current_context().open_popup_stack.size() or io.nav_visible
    taps.is_on = not (is_elsewhere or is_in_menu or io.want_text_input)
    if taps.is_waiting:
        taps.read_frame()
    if is_elsewhere or io.want_text_input:
        return []
    # First, because copy and select depend on the focus.
    actions = _follow_focus(session)
    typed = _typed_signs()
    if typed or [key for key in PRESSED_KEYS if imgui.is_key_down(key)]:
        # Arrow keys that move something do not also go to a key.
        nudges = _nudges(session, taps)
        actions += nudges or _press_shortcuts(session, taps, typed, plus_key())
    return [replace(action, is_by_key=True) for action in actions + _space(session)]


def _typed_signs() -> set[int]:
    """Return the keys of signs that other keys have typed, as AltGr+8 types [ in German."""
    typed = map(chr, imgui.get_io().input_queue_characters)
    keys = {SIGNS[sign] for sign in typed if sign in SIGNS}
    return {key for key in keys if not imgui.is_key_down(Key(key))}


def _press_shortcuts(
    session: Session, taps: TapCounter, typed: set[int], plus: Key | None
) -> list[Action]:
    """Return the actions of pressed shortcuts: of each key the first that is possible.

    `typed` are keys whose signs other keys have typed; `plus` is the key that types +.

    If none is possible, a notice says why. Esc says nothing, since it belongs to many actions.
    """
    project, pressed, reasons = session.project, dict[int, list[Action]](), dict[int, str]()
    is_dragging = session.tools.active_tool is not None or (
        project is not None and project.timeline.gesture is not None
    )
    for spec in dict.fromkeys((*ENDED_BY_ESC, *ACTIONS.values())):
        flags = imgui.InputFlags_.route_always
        if spec.repeats_while_held:
            flags |= imgui.InputFlags_.repeat
        # Typed characters belong to the drag.
        keys = [key for key in chords_of(spec) if not (is_dragging and _is_typed(key))]
        for key in keys:
            is_pressed = imgui.shortcut(key, flags) or key in typed
            if not is_pressed and plus is not None and key & ~MODIFIERS == PLUS:
                is_pressed = imgui.shortcut(int(plus) | key & MODIFIERS, flags)
            if key in pressed or not is_pressed:
                continue
            reason = spec.disabled_reason(session)
            if reason is None:
                times = taps.times(key & ~MODIFIERS) if spec.repeats_while_held else 1
                pressed[key] = [spec.action] * times
            elif key != Key.escape:
                reasons[key] = reason
    answers = [do(dialog_actions.show_notice, reason) for reason in reasons.values()]
    return [*chain.from_iterable(pressed.values()), *answers]


def _follow_focus(session: Session) -> list[Action]:
    """Set the focus to timeline or drawing: under the pointer, or else in ImGui's focus."""
    context = imgui.get_current_context()
    for window in (context.hovered_window, context.nav_window):
        title = window.root_window.name.rpartition("###")[2] if window is not None else ""
        if title in {"Timeline", "Viewport"}:
            in_timeline = title == "Timeline"
            return (
                [do(viewing.focus_timeline, in_timeline)]
                if in_timeline != session.display.is_timeline_focused
                else []
            )
    return []


def _is_typed(key: int) -> bool:
    """Return whether a key can be part of a number or a word."""
    return not int(key) & CTRL and key != Key.delete


def _close_menu() -> bool:
    """Close the front menu or popup by Escape. Return whether there was one."""
    popups = imgui.get_current_context().open_popup_stack
    # A text field that is being edited handles Escape itself.
    if not popups.size() or not imgui.shortcut(Key.escape, imgui.InputFlags_.route_global):
        return False
    level = popups.size() - 1
    # The parent menu closes too. It would reopen the child while the pointer is on its entry.
    while level and popups[level].window.flags & imgui.WindowFlags_.child_menu:
        level -= 1
    imgui.internal.close_popup_to_level(level, restore_focus_to_window_under_popup=True)
    return True


def _nudges(session: Session, taps: TapCounter) -> list[Action]:
    is_moving = session.tools.mode == "move"
    # While cutting out, handles are hidden.
    if session.project is None or session.tools.is_cutting:
        return []
    if not (is_moving or session.project.selection.handles):
        return []
    io = imgui.get_io()
    pressed = [way * taps.times(key) for key, way in ARROWS.items() if imgui.is_key_pressed(key)]
    if io.key_ctrl:
        change = change_layer_by_key if is_moving else change_handles_by_key
        times = 10.0 if io.key_shift else 1.0
        return [
            do(change, -TURN * times * way.real, GROWTH ** (times * way.imag)) for way in pressed
        ]
    nudge = move_tool.nudge_layer if is_moving else nudge_handles
    step = 10.0 if io.key_shift else 1.0
    return [do(nudge, step * way) for way in pressed]


def _space(session: Session) -> list[Action]:
    """Return the play action if Space was tapped. Space that is held moves the view."""
    if session.project is None or not imgui.is_key_released(Key.space):
        return []
    return [do(playback.toggle_play_on_space)]
