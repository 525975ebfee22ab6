"""Values of keys in words."""

from math import degrees
from typing import Any

from imgui_bundle import icons_fontawesome_6 as icons

from app.document import (
    DRAW_ORDER,
    FOOTAGE_TIME,
    VISIBILITY,
    Attachment,
    BaseKey,
    Channel,
    Document,
    DrawOrder,
    FootageTime,
    Key,
    Marker,
    Quantity,
    format_slider_value,
)
from app.texts import _

NOTHING = _("nothing")


def label_value(document: Document, channel: Channel[Any], key: BaseKey) -> str:
    """Return the value of a key that holds, as short as its lane needs it."""
    if channel.kind is VISIBILITY and isinstance(key, Key):
        return str(icons.ICON_FA_EYE if key.value else icons.ICON_FA_EYE_SLASH)
    return format_value(document, channel, key)


def format_value(document: Document, channel: Channel[Any], key: BaseKey) -> str:
    """Return the value of a key as words and numbers."""
    if isinstance(key, Marker):
        return key.name
    if isinstance(key, Attachment):
        parent = None if key.parent is None else document.find_layer(key.parent)
        return NOTHING if parent is None else parent.name
    if not isinstance(key, Key):
        return ""
    match channel.kind:
        case kind if kind is DRAW_ORDER:
            text = format_draw_order(document, key.value)
        case kind if kind is VISIBILITY:
            text = _("visible") if key.value else _("hidden")
        case kind if kind is FOOTAGE_TIME:
            text = format_footage_time(key.value)
        case kind:
            parts = (
                _format_field(document, each.quantity, kind.field_of(key.value, each.name))
                for each in kind.fields
            )
            text = ", ".join(parts)
    return text


def format_draw_order(document: Document, order: DrawOrder) -> str:
    beside = None if order.beside is None else document.find_layer(order.beside)
    if beside is None:
        return _("as in the list")
    text = _("in front of {name}") if order.in_front else _("behind {name}")
    return text.format(name=beside.name)


def format_footage_time(time: FootageTime) -> str:
    """Return in words how footage plays from a key on."""
    if not time.speed:
        return _("holds frame {start:.4g}").format(start=time.start)
    text = _("from {start:.4g}, loops") if time.loops else _("from {start:.4g}")
    speed = "" if time.speed == 1 else f", × {time.speed:.3g}"
    return text.format(start=time.start) + speed


def _format_field(document: Document, quantity: Quantity, value: Any) -> str:
    """Return one field of a value in its usual unit."""
    match quantity:
        case Quantity.SHARE:
            text = f"{100 * value:.0f} %"
        case Quantity.FACTOR:
            text = f"× {value:.3g}"
        case Quantity.POINT:
            text = f"({value.real:.1f}, {value.imag:.1f}) px"
        case Quantity.ANGLE:
            text = f"{degrees(value):.4g}°"
        case Quantity.LAYER:
            layer = None if value is None else document.find_layer(value)
            text = NOTHING if layer is None else layer.name
        case Quantity.COLOUR:
            text = "#" + "".join(f"{round(255 * part):02x}" for part in value)
        case Quantity.DEPTH:
            text = f"{value:+.2f}"
        case Quantity.VALUE:
            text = format_slider_value(value)
        case _:
            text = f"{value}"
    return text
