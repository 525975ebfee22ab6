"""The list beside the graph: channels, and their curves with colours and numbers."""

from math import isnan
from typing import Any

from imgui_bundle import ImVec2, icons_fontawesome_6 as icons, imgui

from app.document import Channel, ChannelCurve, describe_channel, numbers_at, track_in
from app.editor import Action, do
from app.editor.actions.timing import graph
from app.texts import _
from app.ui.shortcuts.keys import CTRL, format_modified
from app.ui.shortcuts.widgets import draw_action_button
from app.ui.style.theme import SMALL, colour_u32, icon_glyph
from app.ui.style.widgets import draw_tooltip, push_text_size, shorten_text
from app.ui.timeline.graph.view import GraphView, format_number
from app.ui.timeline.rows.lanes import name_channel


def draw_legend(view: GraphView, frame: int) -> list[Action]:
    """Draw the channels. A click shows a channel, a click on a curve shows or hides the curve."""
    bands, em = view.bands, view.bands.look.em
    actions: list[Action] = []
    imgui.set_cursor_screen_pos(ImVec2(bands.corner.x, bands.ruler_top))
    size = ImVec2(bands.left - bands.corner.x - 0.3 * em, bands.bottom - bands.ruler_top)
    imgui.begin_child("legend", size)
    actions += draw_action_button(bands.session, bands.look, graph.toggle_speed)
    imgui.same_line()
    imgui.align_text_to_frame_padding()
    imgui.text_disabled(_("Speed") if view.is_speed else _("Value"))
    shown = graph.graphed_channels(bands.project)
    with push_text_size(SMALL):
        for channel in graph.listed_channels(bands.project, set(shown)):
            is_shown = channel in shown
            actions += _draw_channel(view, channel, is_shown=is_shown)
            if is_shown:
                numbers = numbers_at(view.document, channel, (frame,))
                for curve, (number,) in numbers.items():
                    actions += _draw_curve(view, curve, float(number))
    imgui.end_child()
    return actions


def _draw_channel(view: GraphView, channel: Channel[Any], *, is_shown: bool) -> list[Action]:
    em, palette = view.bands.look.em, view.bands.look.palette
    low, room = imgui.get_cursor_screen_pos(), imgui.get_content_region_avail().x
    identity = f"{channel.kind.name} {channel.layer} {channel.part}"
    clicked = imgui.selectable(f"###{identity}", is_shown)[0]
    draw_list = imgui.get_window_draw_list()
    icon = icon_glyph(channel.kind.icon)
    left = low.x + 0.8 * em - imgui.calc_text_size(icon).x / 2
    draw_list.add_text(ImVec2(left, low.y), colour_u32(palette.dim), icon)
    name = shorten_text(_name_channel(view, channel), room - 1.9 * em)
    draw_list.add_text(ImVec2(low.x + 1.7 * em, low.y), colour_u32(palette.text), name)
    hint = _("Click to show the channel alone, {gesture} to show it beside the others")
    draw_tooltip(hint.format(gesture=format_modified(CTRL, _("click"))))
    if not clicked:
        return []
    io = imgui.get_io()
    return [do(graph.show_channel, channel, adds=io.key_ctrl or io.key_shift)]


def _name_channel(view: GraphView, channel: Channel[Any]) -> str:
    """Return the name of a channel, with its layer unless that is the active one."""
    layer = None if channel.layer is None else view.document.find_layer(channel.layer)
    if layer is None or layer.id != view.bands.project.selection.active:
        return describe_channel(view.document, channel)
    return name_channel(layer, channel, track_in(view.document, channel))


def _draw_curve(view: GraphView, curve: ChannelCurve, number: float) -> list[Action]:
    """Draw the colour and name of a curve, and its number at the playhead."""
    em, palette = view.bands.look.em, view.bands.look.palette
    is_shown = curve in view.curves
    low, room = imgui.get_cursor_screen_pos(), imgui.get_content_region_avail().x
    identity = f"{curve.channel.kind.name} {curve.channel.layer} {curve.channel.part}"
    clicked = imgui.selectable(f"###{identity} {curve.field.name} {curve.part}", p_selected=False)[
        0
    ]
    draw_tooltip(_("Hide the curve") if is_shown else _("Show the curve"))
    draw_list, line = imgui.get_window_draw_list(), imgui.get_text_line_height()
    colour = colour_u32(view.colours[curve] if is_shown else palette.dim)
    draw_list.add_text(
        ImVec2(low.x + 1.0 * em, low.y),
        colour,
        icons.ICON_FA_CIRCLE if is_shown else icons.ICON_FA_CIRCLE_XMARK,
    )
    reading = "" if isnan(number) else format_number(round(number, 2), curve.unit)
    width = imgui.calc_text_size(reading).x
    name = shorten_text(curve.label, room - 2.6 * em - width - 0.4 * em)
    text = colour_u32(palette.text if is_shown else palette.dim)
    draw_list.add_text(ImVec2(low.x + 2.4 * em, low.y), text, name)
    if room - width > 2.3 * em + line:
        end = low.x + room - width - 0.3 * em
        draw_list.add_text(ImVec2(end, low.y), colour_u32(palette.dim), reading)
    return [do(graph.toggle_curve, curve)] if clicked else []
