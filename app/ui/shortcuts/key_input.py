"""Shortcuts: they work wherever the pointer is."""

from imgui_bundle import imgui

from app.editor import Action, Session, do
from app.editor.actions import playback, viewing
from app.editor.actions.posing.pose_drag import nudge_handles
from app.editor.tools import move_tool
from app.ui.shortcuts.keys import CTRL
from app.ui.shortcuts.table import BINDINGS

Key = imgui.Key
MODIFIERS = int(imgui.Key.mod_mask_)
# All keys of shortcuts, without modifiers.
_KEYS = {Key(chord & ~MODIFIERS) for binding in BINDINGS.values() for chord in binding.chords()} | {
    Key.left_arrow,
    Key.right_arrow,
    Key.up_arrow,
    Key.down_arrow,
}
ARROWS = {Key.left_arrow: -1, Key.right_arrow: 1, Key.up_arrow: 1j, Key.down_arrow: -1j}


def collect_key_actions(session: Session) -> list[Action]:
    """Return the actions whose keys were pressed, unless the person types into a field."""
    if session.dialogs.current is not None:
        return []
    if _close_menu() or imgui.get_io().want_text_input:
        return []
    # First, because copy and select depend on the focus.
    actions = _follow_focus(session)
    if [key for key in _KEYS if imgui.is_key_down(key)]:
        actions += _press_shortcuts(session) + _nudges(session)
    return actions + _space(session)


def _press_shortcuts(session: Session) -> list[Action]:
    """Return the actions of shortcuts that were pressed, or why they are disabled."""
    actions: list[Action] = []
    for binding in BINDINGS.values():
        # Typed characters belong to the active drag.
        keys = [
            key for key in binding.chords() if session.active_tool is None or not _is_typed(key)
        ]
        flags = imgui.InputFlags_.route_always
        if binding.repeats_while_held:
            flags |= imgui.InputFlags_.repeat
        if not any(imgui.shortcut(chord, flags) for chord in keys):
            continue
        if binding.is_possible(session):
            actions.append(binding.action)
        elif reason := binding.disabled_reason(session):
            actions.append(do(viewing.show_notice, reason))
    return actions


def _follow_focus(session: Session) -> list[Action]:
    """Set the focus to timeline or drawing: under the pointer, or else in ImGui's focus."""
    context = imgui.get_current_context()
    for window in (context.hovered_window, context.nav_window):
        title = window.root_window.name.rpartition("###")[2] if window is not None else ""
        if title in {"Timeline", "Viewport"}:
            in_timeline = title == "Timeline"
            return (
                [do(viewing.focus_timeline, in_timeline)]
                if in_timeline != session.is_timeline_focused
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


def _nudges(session: Session) -> list[Action]:
    if session.project is None or not (session.moves or session.project.selected_handles):
        return []
    nudge = move_tool.nudge_layer if session.moves else nudge_handles
    step = 10.0 if imgui.get_io().key_shift else 1.0
    return [
        do(nudge, step * direction)
        for key, direction in ARROWS.items()
        if imgui.is_key_pressed(key)
    ]


def _space(session: Session) -> list[Action]:
    """Return the play action if Space was tapped. Space that is held moves the view."""
    if session.project is None or not imgui.is_key_released(Key.space):
        return []
    return [do(playback.toggle_play_on_space)]
