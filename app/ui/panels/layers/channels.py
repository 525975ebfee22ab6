"""A layer's opacity, transform and draw order, each with the button that keys it."""

import math
from typing import Any

from imgui_bundle import imgui

from app.document import (
    DRAW_ORDER,
    LAYER_KINDS,
    OPACITY,
    TRANSFORM,
    Channel,
    Document,
    DrawOrder,
    Layer,
    Quantity,
    Transform,
    value_at,
)
from app.editor import Action, do
from app.editor.actions.timing.channel_keys import set_channel_value
from app.texts import _
from app.ui.panels.key_diamond import diamond_room, draw_key_diamond
from app.ui.style.sliders import Scale, number_field, slider
from app.ui.style.theme import Look
from app.ui.style.values import format_draw_order
from app.ui.style.widgets import draw_tooltip, label, small_text

PERCENT = Scale(left=0, right=100)
MOVES = {
    "right": _("Move the layer and its children right. A change sets a key at this frame."),
    "up": _("Move the layer and its children up. A change sets a key at this frame."),
    "turn": _(
        "Turn the layer and its children counter-clockwise. A change sets a key at this frame."
    ),
}


def draw_transform_channel(
    document: Document, look: Look, layer: Layer, frame: int
) -> list[Action]:
    """Draw a layer's transform at a frame. A change makes a key there."""
    if layer.has_parent and not layer.keys_of(TRANSFORM):
        return []
    channel = Channel(TRANSFORM, layer.id)
    transform = value_at(document, channel, frame)
    turn, shift = math.degrees(transform.turn), transform.shift
    entered: dict[str, float] = {}
    label(look, _("Transform"))
    gap = imgui.get_style().item_inner_spacing.x
    each = (imgui.get_content_region_avail().x - diamond_room(look) - 2 * gap) / 3
    values = {
        "right": (shift.real, "%.1f px"),
        "up": (shift.imag, "%.1f px"),
        "turn": (turn, "%.1f°"),
    }
    for index, (name, (value, text)) in enumerate(values.items()):
        if index:
            imgui.same_line(0, gap)
        imgui.set_next_item_width(each)
        found = number_field(f"moved {name}", value, text)
        draw_tooltip(MOVES[name])
        if found is not None:
            entered[name] = found
    actions = draw_key_diamond(document, look, channel, frame)
    if entered:
        right, up = entered.get("right", shift.real), entered.get("up", shift.imag)
        radians = math.radians(entered.get("turn", turn))
        actions.append(do(set_channel_value, channel, Transform(complex(right, up), radians)))
    if layer.has_parent and layer.keys_of(TRANSFORM):
        small_text(look, _("While the layer has a parent, only the parent moves it."))
    return actions


def draw_order_channel(document: Document, look: Look, layer: Layer, frame: int) -> list[Action]:
    """Draw the neighbour of a layer in the draw order from the present frame on."""
    others = [each for each in reversed(document.layers) if each is not layer]
    if not others:
        return []
    actions: list[Action] = []
    channel = Channel(DRAW_ORDER, layer.id)
    now = value_at(document, channel, frame)
    label(look, _("Draw order"))
    imgui.set_next_item_width(-diamond_room(look))
    if imgui.begin_combo("##painted", format_draw_order(document, now)):
        if imgui.selectable(_("as in the list"), now.beside is None)[0] and now.beside is not None:
            actions.append(do(set_channel_value, channel, DrawOrder(None)))
        for in_front, id_, text in (
            (True, "in front of", _("in front of {name}")),
            (False, "behind", _("behind {name}")),
        ):
            imgui.separator()
            actions += [
                do(set_channel_value, channel, DrawOrder(each.id, in_front))
                for each in others
                if imgui.selectable(
                    f"{text.format(name=each.name)}###{id_} {each.id}",
                    each.id == now.beside and now.in_front == in_front,
                )[0]
            ]
        imgui.end_combo()
    draw_tooltip(_("From frame {frame} to the next order key").format(frame=frame))
    return actions + draw_key_diamond(document, look, channel, frame)


def draw_value_channels(document: Document, look: Look, layer: Layer, frame: int) -> list[Action]:
    """Draw the opacity and the effects of a layer, by what their values measure."""
    actions: list[Action] = []
    room = diamond_room(look)
    for kind in (OPACITY, *(kind for kind in LAYER_KINDS.values() if kind.uniform)):
        channel = Channel(kind, layer.id)
        value = value_at(document, channel, frame)
        is_for_all = kind is OPACITY and not layer.keys_of(OPACITY)
        hint = (
            _("It is the same in all frames until you set a key.")
            if is_for_all
            else _("A change sets a key at this frame.")
        )
        label(look, _(kind.label))
        changed: Any = None
        if kind.fields[0].quantity is Quantity.COLOUR:
            imgui.set_next_item_width(-room)
            edited, levels = imgui.color_edit3(f"##{kind.name}", list(value))
            draw_tooltip(hint)
            changed = tuple(min(max(level, 0.0), 1.0) for level in levels[:3]) if edited else None
        else:
            shown = 100 * value
            faded = slider(look, kind.name, shown, PERCENT, text="%.0f %%", hint=hint, room=room)
            changed = None if faded is None else min(max(faded.value / 100, 0.0), 1.0)
        actions += draw_key_diamond(document, look, channel, frame)
        if changed is not None:
            actions.append(do(set_channel_value, channel, changed))
    return actions
