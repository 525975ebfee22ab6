"""Options of single export formats, from the table of formats."""

from dataclasses import replace
from typing import Any, TypeVar

from imgui_bundle import imgui

from app.export_formats import FormatOptions, Option
from app.ui.style.theme import Look
from app.ui.style.widgets import FILL, draw_tooltip, label, option_buttons

T = TypeVar("T", bound=FormatOptions)


def draw_format_options(look: Look, options: T) -> T:
    """Draw the options of a format, one below the other. Return the changed options."""
    for name, option in options.option_fields().items():
        label(look, option.label)
        value = _chosen(look, name, option, getattr(options, name))
        options = replace(options, **{name: value})
    return options


def _chosen(look: Look, name: str, option: Option, value: Any) -> Any:
    """Draw an option. Return the chosen value, or the present value."""
    has_number = value is not None and not isinstance(value, bool)
    if option.choices:
        words = [(word, word) for _, word in option.choices]
        # A value without a label belongs to the last choice, which stands for any number.
        present = next((word for each, word in option.choices if each == value), words[-1][0])
        room = 4.0 * look.em if has_number else 0.0
        chosen = option_buttons(look, name, words, present, room=room)
        if option.tip:
            draw_tooltip(option.tip)
        if chosen is not None:
            return next(each for each, word in option.choices if word == chosen)
        if has_number:
            imgui.same_line(0, imgui.get_style().item_inner_spacing.x)
            imgui.set_next_item_width(FILL)
    if not has_number:
        return value
    entered: float
    if isinstance(value, int):
        entered = imgui.input_int(f"##{name}", value, 0)[1]
    else:
        entered = round(imgui.input_float(f"##{name}", value, 0.0, 0.0, "%.3g px")[1], 6)
    done = imgui.is_item_deactivated_after_edit()
    if option.tip and not option.choices:
        draw_tooltip(option.tip)
    return min(max(entered, option.minimum), option.maximum) if done else value
