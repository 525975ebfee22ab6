"""A layer's opacity, transform and draw order channels."""

import math

from imgui_bundle import imgui

from app.document import (
    Document,
    Layer,
    change_frame,
    draw_order_key_at,
    keyed_frame,
    opacity_at,
    transform_at,
)
from app.editor import Action, do
from app.editor.layering.layer_channels import (
    delete_draw_order_key,
    delete_opacity_key,
    delete_transform_key,
    key_draw_order,
    key_opacity,
    key_transform,
)
from app.editor.layering.layer_list import set_layer_opacity
from app.texts import _
from app.ui.style.sliders import Scale, number_field, slider
from app.ui.style.theme import Look
from app.ui.style.widgets import FILL, draw_tooltip, label, small_text, text_button

PERCENT = Scale(left=0, right=100)
MOVES = {
    "right": _("Move the layer and its children right. A change sets a key at this frame."),
    "up": _("Move the layer and its children up. A change sets a key at this frame."),
    "turn": _(
        "Turn the layer and its children counter-clockwise. A change sets a key at this frame."
    ),
}


def draw_opacity_channel(document: Document, look: Look, layer: Layer, frame: int) -> list[Action]:
    actions, opacity = [], opacity_at(document, layer, frame)
    label(look, _("Opacity"))
    hint = (
        _("Opacity of the layer. A change sets a key at this frame.")
        if layer.opacity_keys
        else _("Opacity of the layer")
    )
    faded = slider(look, "opacity", 100 * opacity, PERCENT, text="%.0f %%", hint=hint)
    if faded is not None:
        fade = key_opacity if layer.opacity_keys else set_layer_opacity
        actions.append(do(fade, layer.id, min(max(faded.value / 100, 0.0), 1.0)))
    keyed = keyed_frame(layer, layer.opacity_keys, frame)
    is_keyed = any(key.frame == keyed for key in layer.opacity_keys)
    changed = imgui.checkbox(_("Key opacity"), is_keyed)[0]
    draw_tooltip(_("The layer fades evenly from key to key"))
    if changed and is_keyed:
        actions.append(do(delete_opacity_key, layer.id))
    elif changed:
        actions.append(do(key_opacity, layer.id, opacity))
    return actions


def draw_transform_channel(
    document: Document, look: Look, layer: Layer, frame: int
) -> list[Action]:
    """Draw a layer's transform at a frame. A change makes a key there."""
    if layer.has_parent and not layer.transform_keys:
        return []
    actions: list[Action] = []
    moved = transform_at(document, layer, frame)
    turn = math.degrees(math.atan2(moved.factor.imag, moved.factor.real))
    shift = moved.shift - (1 - moved.factor) * layer.pivot
    entered: dict[str, float] = {}
    label(look, _("Transform"))
    each = (imgui.get_content_region_avail().x - 2 * imgui.get_style().item_inner_spacing.x) / 3
    values = {
        "right": (shift.real, "%.1f px"),
        "up": (shift.imag, "%.1f px"),
        "turn": (turn, "%.1f°"),
    }
    for name, (value, text) in values.items():
        imgui.set_next_item_width(each)
        found = number_field(f"moved {name}", value, text)
        draw_tooltip(MOVES[name])
        if found is not None:
            entered[name] = found
        imgui.same_line(0, imgui.get_style().item_inner_spacing.x)
    imgui.new_line()
    if entered:
        right, up = entered.get("right", shift.real), entered.get("up", shift.imag)
        radians = math.radians(entered.get("turn", turn))
        actions.append(do(key_transform, layer.id, complex(right, up), radians))
    keyed = keyed_frame(layer, layer.transform_keys, frame)
    if any(key.frame == keyed for key in layer.transform_keys) and text_button(
        _("Delete transform key"),
        FILL,
        _("The layer then moves from the key before to the key after"),
    ):
        actions.append(do(delete_transform_key, layer.id))
    if layer.has_parent and layer.transform_keys:
        small_text(look, _("While the layer has a parent, only the parent moves it."))
    return actions


def draw_order_channel(document: Document, look: Look, layer: Layer, frame: int) -> list[Action]:
    """Draw the neighbour of a layer in the draw order from the present frame on."""
    others = [each for each in reversed(document.layers) if each is not layer]
    if not others:
        return []
    actions: list[Action] = []
    now = draw_order_key_at(document, layer, frame)
    beside = None if now is None or now.beside is None else document.layer(now.beside)
    text = _("as in the list")
    if now is not None and beside is not None:
        text = _("in front of {name}") if now.in_front else _("behind {name}")
        text = text.format(name=beside.name)
    label(look, _("Draw order"))
    if imgui.begin_combo("##painted", text):
        if imgui.selectable(_("as in the list"), beside is None)[0] and beside is not None:
            actions.append(do(key_draw_order, layer.id, None))
        for in_front, id_, text in (
            (True, "in front of", _("in front of {name}")),
            (False, "behind", _("behind {name}")),
        ):
            imgui.separator()
            actions += [
                do(key_draw_order, layer.id, each.id, in_front)
                for each in others
                if imgui.selectable(
                    f"{text.format(name=each.name)}###{id_} {each.id}",
                    each is beside and now is not None and now.in_front == in_front,
                )[0]
            ]
        imgui.end_combo()
    draw_tooltip(_("From frame {frame} to the next order key").format(frame=frame))
    keyed = change_frame(layer.draw_order_keys, layer.cycles, frame)
    if any(each.frame == keyed for each in layer.draw_order_keys) and text_button(
        _("Delete order key"), FILL, _("The previous order key then stays in effect")
    ):
        actions.append(do(delete_draw_order_key, layer.id))
    return actions
