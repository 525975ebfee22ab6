"""A layer's opacity, transform and draw order, each with the button that keys it."""

import math
from collections.abc import Mapping
from typing import Any

from imgui_bundle import ImVec2, imgui

from app.document import (
    DRAW_ORDER,
    IK_TARGET,
    LAYER_KINDS,
    MAX_SCALE,
    OPACITY,
    TRANSFORM,
    Channel,
    Document,
    DrawOrder,
    IkTarget,
    Layer,
    Quantity,
    Transform,
    bones_above,
    shared_bone,
    value_at,
)
from app.editor import Action, do
from app.editor.actions.timing.channel_keys import set_channel_value
from app.editor.layering.layer_posing import (
    apply_own_transform,
    plant_layer,
    release_layer,
    set_ik_parents,
    set_transforms,
)
from app.texts import _, ngettext
from app.ui.panels.key_diamond import diamond_room, draw_key_diamond
from app.ui.style.sliders import Scale, number_field, slider
from app.ui.style.theme import Look
from app.ui.style.values import format_draw_order
from app.ui.style.widgets import FILL, draw_tooltip, label, small_text

PERCENT = Scale(left=0, right=100)
MOVES = {
    "right": _("Move the layer and its children right. A change sets a key at this frame."),
    "up": _("Move the layer and its children up. A change sets a key at this frame."),
    "turn": _(
        "Turn the layer and its children counter-clockwise. A change sets a key at this frame."
    ),
    "scale": _("Scale the layer and its children at its joint. A change sets a key at this frame."),
}


def draw_transform_channel(
    document: Document, look: Look, layer: Layer, frame: int
) -> list[Action]:
    """Draw a layer's transform at a frame. A change makes a key there."""
    channel = Channel(TRANSFORM, layer.id)
    transform = value_at(document, channel, frame)
    shift = transform.shift
    entered, actions = _draw_fields(
        document,
        look,
        channel,
        frame,
        {
            "right": (shift.real, "%.1f px", MOVES["right"]),
            "up": (shift.imag, "%.1f px", MOVES["up"]),
            "turn": (math.degrees(transform.turn), "%.1f°", MOVES["turn"]),
            "scale": (100 * transform.scale, "%.0f %%", MOVES["scale"]),
        },
    )
    if entered is not None:
        right, up, turn, scale = entered
        scale = min(max(scale / 100, 1 / MAX_SCALE), MAX_SCALE)
        value = Transform(complex(right, up), math.radians(turn), scale)
        actions.append(do(set_transforms, {layer.id: value}, label=_("Set transform")))
    joint = layer.attachment_key_at(frame)
    if joint is not None and joint.parent is not None and not joint.applies_transform:
        small_text(look, _("In this older project only the parent moves the layer."))
        if imgui.button(_("Apply transform"), ImVec2(FILL, 0)):
            actions.append(do(apply_own_transform, layer.id))
    return actions


def draw_ik_target(document: Document, look: Look, layer: Layer, frame: int) -> list[Action]:
    """Draw how many parents bend with an attached layer, and its IK target."""
    parents = len(document.parent_chain(layer.id, frame)) - 1
    if not parents:
        return []
    actions: list[Action] = []
    bones = len(bones_above(document, layer.id, frame))
    label(look, _("Bends"))
    imgui.set_next_item_width(FILL)
    if imgui.begin_combo("##ik parents", _format_bones(bones)):
        actions += [
            do(set_ik_parents, layer.id, count)
            for count in range(parents + 1)
            if imgui.selectable(_format_bones(count), count == bones)[0]
        ]
        imgui.end_combo()
    draw_tooltip(_("How many parents bend when you pull the layer with the tool Move"))
    if shared := shared_bone(document, layer.id, frame):
        bone, other = shared
        text = _("{name} also bends for {other}: one of the two misses its IK target. Bend fewer.")
        small_text(look, text.format(name=bone.name, other=other.name))
    if not bones:
        return actions
    channel, keys = Channel(IK_TARGET, layer.id), layer.keys_of(IK_TARGET)
    if keys:
        target = value_at(document, channel, frame)
        entered, keyed = _draw_fields(
            document,
            look,
            channel,
            frame,
            {
                "x": (target.place.real, "%.1f px", _("Pixels from the left edge of the scene")),
                "y": (target.place.imag, "%.1f px", _("Pixels from the bottom edge of the scene")),
                "target turn": (math.degrees(target.turn), "%.1f°", _("Rotation in the scene")),
                "mix": (100 * target.mix, "%.0f %%", _("0 % follows the parents")),
            },
        )
        actions += keyed
        if entered is not None:
            x, y, turn, mix = entered
            mix = min(max(mix / 100, 0.0), 1.0)
            value = IkTarget(complex(x, y), math.radians(turn), mix)
            actions.append(do(set_channel_value, channel, value))
    if bones > 1:
        is_planted = keys and value_at(document, channel, frame).mix > 0
        verb, text = (
            (release_layer, _("Release layer")) if is_planted else (plant_layer, _("Plant layer"))
        )
        if imgui.button(text, ImVec2(FILL, 0)):
            actions.append(do(verb))
    return actions


def _format_bones(count: int) -> str:
    if not count:
        return _("no parent")
    return ngettext("with {count} parent", "with {count} parents", count).format(count=count)


def _draw_fields(
    document: Document,
    look: Look,
    channel: Channel[Any],
    frame: int,
    values: Mapping[str, tuple[float, str, str]],
) -> tuple[tuple[float, ...] | None, list[Action]]:
    """Draw a channel's numbers, two in a row, each with its format and tooltip, and its diamond.

    Return all numbers if one was changed, and the actions of the diamond.
    """
    gap, room = imgui.get_style().item_inner_spacing.x, diamond_room(look)
    entered, has_changed, actions = list[float](), False, list[Action]()
    for index, (name, (value, text, hint)) in enumerate(values.items()):
        if index % 2:
            imgui.same_line(0, gap)
        else:
            label(look, "" if index else _(channel.kind.label))
            width = (imgui.get_content_region_avail().x - room - gap) / 2
        imgui.set_next_item_width(width)
        found = number_field(f"moved {name}", value, text)
        draw_tooltip(hint)
        has_changed |= found is not None
        entered.append(value if found is None else found)
        if index == 1:
            actions += draw_key_diamond(document, look, channel, frame)
    return tuple(entered) if has_changed else None, actions


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
