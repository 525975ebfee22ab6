"""Menu entries and buttons of named actions."""

from imgui_bundle import imgui, imgui_ctx

from app.editor import Action, Session
from app.ui.shortcuts.table import BINDINGS
from app.ui.style.theme import Look
from app.ui.style.widgets import draw_tooltip, icon_button, text_button


def draw_action_item(session: Session, name: str) -> list[Action]:
    binding = BINDINGS[name]
    clicked, _ = imgui.menu_item(
        binding.menu_title(session),
        binding.shown_keys,
        binding.is_active(session),
        binding.is_possible(session),
    )
    reason = binding.disabled_reason(session)
    if reason:
        draw_tooltip(reason)
    return [binding.action] if clicked else []


def draw_action_text_button(session: Session, name: str, width: float) -> list[Action]:
    """Draw the button of a named action, with its icon and its label."""
    binding = BINDINGS[name]
    is_active = binding.is_active(session)
    slot = imgui.Col_.button_active if is_active else imgui.Col_.button
    with imgui_ctx.push_style_color(imgui.Col_.button, imgui.get_style_color_vec4(slot)):
        is_pressed = text_button(
            f"{binding.icon}  {binding.label}###{name}",
            width,
            binding.disabled_reason(session) or binding.hint or binding.label,
            binding.shown_keys,
            enabled=binding.is_possible(session),
        )
    return [binding.action] if is_pressed else []


def draw_action_button(session: Session, look: Look, name: str, icon: str = "") -> list[Action]:
    """Draw the square button of a named action, with its icon or the given one."""
    binding = BINDINGS[name]
    is_pressed = icon_button(
        look,
        icon or binding.icon,
        binding.label,
        binding.hint or binding.label,
        keys=binding.shown_keys,
        active=binding.is_active(session),
        enabled=binding.is_possible(session),
    )
    look.note_place(name)
    return [binding.action] if is_pressed else []
