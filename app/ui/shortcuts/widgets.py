"""Menu entries and buttons of named actions. A disabled one shows the reason in its tooltip."""

from imgui_bundle import imgui, imgui_ctx

from app.editor import Action, Session
from app.editor.actions.action_spec import ActionSpec
from app.ui.shortcuts.keys import shown_keys
from app.ui.style.theme import Look, icon_glyph
from app.ui.style.widgets import FILL, draw_tooltip, icon_button, main_button, text_button


def draw_action_item(session: Session, spec: ActionSpec) -> list[Action]:
    reason = spec.disabled_reason(session)
    clicked, _ = imgui.menu_item(
        spec.menu_title(session), shown_keys(spec), spec.is_active(session), reason is None
    )
    draw_tooltip(reason or "")
    return [spec.action] if clicked else []


def draw_action_text_button(session: Session, spec: ActionSpec, width: float) -> list[Action]:
    """Draw the button of a named action, with its icon and its label."""
    is_active, reason = spec.is_active(session), spec.disabled_reason(session)
    slot = imgui.Col_.button_active if is_active else imgui.Col_.button
    with imgui_ctx.push_style_color(imgui.Col_.button, imgui.get_style_color_vec4(slot)):
        is_pressed = text_button(
            f"{icon_glyph(spec.icon)}  {spec.label}###{spec.label}",
            width,
            spec.hint or spec.label,
            shown_keys(spec),
            reason=reason,
        )
    return [spec.action] if is_pressed else []


def draw_action_main_button(session: Session, look: Look, spec: ActionSpec) -> list[Action]:
    """Draw the main button of a panel for a named action, with its icon and its label."""
    reason = spec.disabled_reason(session)
    text = f"{icon_glyph(spec.icon)}  {spec.label}###{spec.label}"
    is_pressed = main_button(look, text, FILL, spec.hint, shown_keys(spec), reason=reason)
    return [spec.action] if is_pressed else []


def draw_action_button(
    session: Session, look: Look, spec: ActionSpec, icon: str = ""
) -> list[Action]:
    """Draw the square button of a named action, with its icon or the given one."""
    is_pressed = icon_button(
        look,
        icon_glyph(icon or spec.icon),
        spec.label,
        spec.hint or spec.label,
        keys=shown_keys(spec),
        active=spec.is_active(session),
        reason=spec.disabled_reason(session),
    )
    look.note_place(spec.label)
    return [spec.action] if is_pressed else []
