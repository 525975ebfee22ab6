"""Fields for the numbers of a key, in its menu."""

from dataclasses import replace
from math import degrees, radians
from typing import Any

from imgui_bundle import imgui

from app.document import Channel, Key, Quantity, ValueField, channel_commands
from app.editor import Action, do
from app.editor.actions import editing
from app.texts import _
from app.ui.style.sliders import number_field
from app.ui.style.theme import Look

FIELD = 4.5  # em: width and position of the fields
# Unit of the number that a person types, relative to the stored number, and its form.
UNITS = {
    Quantity.NUMBER: (1.0, "%.4g"),
    Quantity.FACTOR: (1.0, "%.3g"),
    Quantity.SHARE: (100.0, "%.0f %%"),
    Quantity.DEPTH: (1.0, "%.2f"),
    Quantity.ANGLE: (degrees(1.0), "%.4g°"),
}


def draw_value_fields(look: Look, channel: Channel[Any], key: Key[Any]) -> list[Action]:
    """Draw the fields of a key's value that are single numbers."""
    actions: list[Action] = []
    shown = [each for each in channel.kind.fields if each.quantity in UNITS]
    for each in shown:
        entered = _draw_number(look, channel, key, each)
        if entered is not None:
            value = replace(key.value, **{each.name: entered}) if _is_part(channel) else entered
            actions.append(
                do(editing.edit_document, channel_commands.set_key(channel, key.frame, value))
            )
    if shown:
        imgui.separator()
    return actions


def _is_part(channel: Channel[Any]) -> bool:
    return len(channel.kind.fields) > 1


def _draw_number(
    look: Look, channel: Channel[Any], key: Key[Any], field: ValueField
) -> float | None:
    """Draw a field. Return the number, in stored units, when a different one was entered."""
    unit, form = UNITS[field.quantity]
    imgui.align_text_to_frame_padding()
    imgui.text_unformatted(_(field.label))
    imgui.same_line(FIELD * look.em)
    imgui.set_next_item_width(FIELD * look.em)
    value = channel.kind.field_of(key.value, field.name)
    entered = number_field(f"{channel.kind.name} {field.name}", unit * value, form)
    if entered is None:
        return None
    return radians(entered) if field.quantity is Quantity.ANGLE else entered / unit
