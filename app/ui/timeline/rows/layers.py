"""The rows of a scene's layers: names, hidden ranges, and keys of folded channels."""

from typing import Any

from imgui_bundle import ImVec2, icons_fontawesome_6 as icons, imgui

from app.document import (
    BaseKey,
    Channel,
    Layer,
    channels_of,
    describe_channel,
    display_frame,
    is_visible,
    layer_keys,
    parent_label,
    pose_channel,
    visibility_keys,
)
from app.editor import Action, do
from app.editor.layering.layer_list import rename_active_layer
from app.editor.layering.layer_selection import set_active_layer
from app.texts import _
from app.ui.bars.layer_menus import draw_layer_menu
from app.ui.style.theme import CHOSEN, SMALL, colour_u32
from app.ui.style.widgets import (
    begin_tooltip,
    is_hovered_or_held,
    push_text_size,
    shorten_text,
)
from app.ui.timeline.keys import (
    begin_key_drag,
    find_drag_origin,
    label_dragged_key,
    select_lane,
)
from app.ui.timeline.layout import TimelineLayout
from app.ui.timeline.menus import draw_key_menu
from app.ui.timeline.row import LayerRow, has_lanes
from app.ui.timeline.rows.groups import INDENT, draw_group_names, draw_group_rows
from app.ui.timeline.rows.lanes import (
    EXPANDER_WIDTH,
    draw_expander,
    draw_lane_backgrounds,
    draw_lane_names,
)

HATCH = 0.55  # em between the lines over a hidden range
CHANGE = 0.24  # em: half the size of a mark of folded channels
DEEPEST_INDENT = 5  # deeper rows have the same indent
LEAST_PARENT_ROOM = 1.8  # em: with less room after the name, only the tooltip names the parent


def draw_layer_rows(bands: TimelineLayout, frame: int) -> list[Action]:
    """Draw the backgrounds of all layers' rows. Handle clicks on names and folded keys."""
    actions: list[Action] = []
    if bands.has_names:
        actions += _draw_names(bands, frame)
    draw_lane_backgrounds(bands, [lane for lane in bands.lanes if lane.layer is None])
    bands.push_track_clip()
    actions += draw_group_rows(bands)
    for row in filter(bands.shows_row, bands.rows):
        if bands.has_names:
            _draw_ground(bands, row)
        for begin, end in _hidden(bands, row.layer):
            _hatch(bands, row, begin, end)
    draw_lane_backgrounds(bands, [lane for lane in bands.lanes if lane.layer is not None])
    for row in filter(bands.shows_row, bands.rows):
        imgui.push_id(f"row {row.layer.id}")
        actions += _draw_summary(bands, row)
        imgui.pop_id()
    imgui.pop_clip_rect()
    return actions


def _draw_ground(bands: TimelineLayout, row: LayerRow) -> None:
    """Separate a row from the next. The active layer's row is brighter."""
    palette, draw_list = bands.look.palette, imgui.get_window_draw_list()
    low, high = ImVec2(bands.left, row.top), ImVec2(bands.right, row.bottom)
    if row.is_active:
        draw_list.add_rect_filled(low, high, colour_u32(palette.accent, 0.08))
    draw_list.add_line(ImVec2(low.x, high.y), high, colour_u32(palette.line))


def _draw_names(bands: TimelineLayout, frame: int) -> list[Action]:
    actions: list[Action] = []
    document = bands.project.document
    palette, draw_list, em = bands.look.palette, imgui.get_window_draw_list(), bands.look.em
    low, high = ImVec2(bands.corner.x, bands.track_top), ImVec2(bands.left, bands.track_bottom)
    imgui.push_clip_rect(low, high, intersect_with_current_clip_rect=True)
    for row in filter(bands.shows_row, bands.rows):
        box = ImVec2(low.x, row.top), ImVec2(high.x - 0.3 * em, row.bottom)
        if bands.button(f"name {row.layer.id}", *box):
            actions += select_lane(pose_channel(row.layer.id), {})
        chosen, asks = draw_layer_menu(bands.project, row.row)
        actions += chosen
        if asks:
            actions += [do(set_active_layer, row.layer.id), rename_active_layer.action]
        if row.is_active or is_hovered_or_held():
            colour = (
                colour_u32(palette.accent, CHOSEN) if row.is_active else colour_u32(palette.hovered)
            )
            draw_list.add_rect_filled(*box, colour, 0.2 * em)
        parent = parent_label(document, row.layer, frame)
        if begin_tooltip():
            imgui.text_unformatted(row.layer.name)
            if parent:
                imgui.text_disabled(parent)
            imgui.end_tooltip()
        icon = icons.ICON_FA_IMAGE if row.layer.still else icons.ICON_FA_PERSON
        colour = colour_u32(palette.text if is_visible(document, row.layer, frame) else palette.dim)
        # Indents are those of groups; a sign and a label tell the parent.
        indent = low.x + INDENT * min(row.row.depth, DEEPEST_INDENT) * em
        with push_text_size(SMALL):
            left = indent + (1.8 + EXPANDER_WIDTH * has_lanes(row.layer)) * em
            room = box[1].x - left - 0.8 * em
            text = shorten_text(row.layer.name, room)
            top = row.middle - imgui.get_text_line_height() / 2
            draw_list.add_text(ImVec2(left - 1.4 * em, top), colour, icon)
            draw_list.add_text(ImVec2(left, top), colour, text)
            taken = imgui.calc_text_size(text).x + 0.5 * em
            if parent and room - taken > LEAST_PARENT_ROOM * em:
                link = icons.ICON_FA_LINK if row.layer.has_parent else ""
                label = shorten_text(f"{link} {parent}".strip(), room - taken)
                draw_list.add_text(ImVec2(left + taken, top), colour_u32(palette.dim), label)
        actions += draw_expander(bands, row, indent)
    actions += draw_group_names(bands, frame)
    actions += draw_lane_names(bands, [lane for lane in bands.lanes if lane.layer is not None])
    _draw_scrolled(bands)
    imgui.pop_clip_rect()
    return actions + draw_lane_names(bands, [lane for lane in bands.lanes if lane.layer is None])


def _draw_scrolled(bands: TimelineLayout) -> None:
    """Draw a scroll bar beside the names, if not all rows are visible."""
    if not bands.overflow:
        return
    height = bands.track_bottom - bands.track_top
    per_pixel = height / (height + bands.overflow)
    first = min([bands.rows[0].top, *(lane.top for lane in bands.group_rows[:1])])
    top = bands.track_top + per_pixel * (bands.track_top - first)
    width = 0.18 * bands.look.em
    imgui.get_window_draw_list().add_rect_filled(
        ImVec2(bands.left - width, top),
        ImVec2(bands.left, top + per_pixel * height),
        colour_u32(bands.look.palette.dim, 0.8),
        width / 2,
    )


def _hidden(bands: TimelineLayout, layer: Layer) -> list[tuple[int | None, int | None]]:
    """Return the ranges in view in which a layer is hidden; None is an open end."""
    switches = visibility_keys(bands.project.document, layer)
    if not switches:
        return []
    stretches: list[tuple[int | None, int | None]] = []
    shown = list(bands.in_view(switches, closest=HATCH))
    # A range that began before the view reaches into it.
    before = [shown[0] - 1] if shown and shown[0] else []
    if not shown:
        first = bands.frame(bands.left)
        before = [sum(switch.frame <= first for switch in switches) - 1]
    for index in [*before, *shown]:
        if index >= 0 and not switches[index].value:
            is_last = index + 1 == len(switches)
            end = None if is_last else switches[index + 1].frame
            stretches.append((switches[index].frame, end))
    if not switches[0].value:
        # Before its first key, a layer has that key's visibility.
        stretches.append((None, switches[0].frame))
    return stretches


def _hatch(bands: TimelineLayout, row: LayerRow, begin: int | None, end: int | None) -> None:
    palette, draw_list = bands.look.palette, imgui.get_window_draw_list()
    frames = bands.project.document.frames
    left = max(bands.x(frames.first if begin is None else begin), bands.left)
    right = min(bands.x(frames.last if end is None else end), bands.right)
    if right <= left:
        return
    low, high = ImVec2(left, row.top + 1), ImVec2(right, row.bottom - 1)
    height, gap = high.y - low.y, HATCH * bands.look.em
    draw_list.add_rect_filled(low, high, colour_u32(palette.desk, 0.7))
    imgui.push_clip_rect(low, high, intersect_with_current_clip_rect=True)
    # The lines move with time when the timeline is scrolled.
    first = bands.x(0)
    x = first + ((left - height - first) // gap) * gap
    while x < right:
        draw_list.add_line(
            ImVec2(x, high.y), ImVec2(x + height, low.y), colour_u32(palette.dim, 0.35)
        )
        x += gap
    imgui.pop_clip_rect()


def _draw_summary(bands: TimelineLayout, row: LayerRow) -> list[Action]:
    """Draw a mark at each frame where a channel without a lane of its own has a key.

    A mark stands for all of these keys: it selects and drags them together.
    """
    if row.layer.id in bands.project.timeline.expanded_layers:
        return []
    actions: list[Action] = []
    document, em, palette = bands.project.document, bands.look.em, bands.look.palette
    found: dict[int, dict[Channel[Any], BaseKey]] = {}
    for channel in [*channels_of(row.layer)][1:]:
        keys = layer_keys(row.layer, channel)
        for index in bands.in_view(keys):
            frame = display_frame(document, channel, keys[index].frame)
            found.setdefault(frame, {})[channel] = keys[index]
    gesture = bands.project.timeline.gesture
    for frame, marked in found.items():
        x, y, half = bands.x(frame), row.bottom - 1.2 * CHANGE * em, CHANGE * em
        keys_here = {each: frozenset({key.frame}) for each, key in marked.items()}
        # The menu offers what an interpolated key has, if there is one.
        channel = min(marked, key=lambda each: each.kind.is_held)
        pressed = marked[channel].frame
        origin = find_drag_origin(gesture, channel, pressed)
        box = ImVec2(x - 1.4 * half, y - 1.4 * half), ImVec2(x + 1.4 * half, y + 1.4 * half)
        bands.button(f"keys {origin}", *box, right=True)
        chosen = bands.project.selection.keys
        is_chosen = all(at <= chosen.get(each, frozenset()) for each, at in keys_here.items())
        colour = palette.text if is_hovered_or_held() else palette.anchor
        imgui.get_window_draw_list().add_ngon_filled(
            ImVec2(x, y), half, colour_u32(palette.accent if is_chosen else colour), 4
        )
        # Apart from the menu of a pose key at the same frame.
        imgui.push_id("channels")
        actions += begin_key_drag(bands, channel, pressed, keys_here)
        label_dragged_key(bands, channel, pressed, x)
        if gesture is None and begin_tooltip():
            names = ", ".join(describe_channel(document, each) for each in keys_here)
            text = _("Keys at frame {frame}: {channels}")
            imgui.text_unformatted(text.format(frame=frame, channels=names))
            imgui.text_disabled(_("Drag to move them. The triangle shows each channel."))
            imgui.end_tooltip()
        actions += draw_key_menu(bands, channel, marked[channel])
        imgui.pop_id()
    return actions
