"""The rows of groups, with the keys of their layers, and of switches, with their visible layer."""

from imgui_bundle import ImVec2, icons_fontawesome_6 as icons, imgui

from app.document import (
    SWITCH,
    Channel,
    Document,
    SwitchGroup,
    SwitchMember,
    channel_commands,
    pose_channel,
    source_frame,
    switch_group_commands,
    with_repeats,
)
from app.editor import Action, do
from app.editor.actions import editing, playback
from app.editor.layering.layer_selection import select_layers, set_active_layer, toggle_tree_row
from app.texts import _, ngettext
from app.ui.bars.layer_menus import draw_layer_menu
from app.ui.style.theme import SMALL, colour_u32
from app.ui.style.widgets import (
    begin_tooltip,
    is_hovered_or_held,
    menu_entry,
    push_text_size,
    shorten_text,
)
from app.ui.timeline.keys import (
    begin_key_drag,
    find_drag_origin,
    is_key_dragged,
    label_dragged_key,
)
from app.ui.timeline.layout import TimelineLayout
from app.ui.timeline.menus import draw_key_menu
from app.ui.timeline.row import GroupRow

INDENT = 0.7  # em of indent for each level
FOLD = 1.1  # em: width of the triangle that expands a row
EDGE = 0.35  # em: half the hit width of a switch key
DOT, GRIP = 0.25, 0.5  # em: half the size of a group's key, and half its hit box


def draw_group_names(bands: TimelineLayout, frame: int) -> list[Action]:
    """Draw the names of groups and switches, and the triangles that expand them."""
    actions: list[Action] = []
    document, palette, em = bands.project.document, bands.look.palette, bands.look.em
    draw_list = imgui.get_window_draw_list()
    for lane in bands.group_rows:
        row = lane.row
        low = ImVec2(bands.corner.x, lane.top)
        high = ImVec2(bands.left - 0.3 * em, lane.bottom)
        left = low.x + INDENT * row.depth * em
        imgui.push_id(row.key)
        if bands.button("name", low, high):
            actions.append(do(select_layers, *row.layers))
        actions += draw_layer_menu(bands.project, row, has_rename=False)[0]
        if is_hovered_or_held():
            draw_list.add_rect_filled(low, high, colour_u32(palette.hovered), 0.2 * em)
        if begin_tooltip():
            imgui.text_unformatted(_("Click to select all of its layers"))
            imgui.end_tooltip()
        if bands.button("fold", ImVec2(left, lane.top), ImVec2(left + FOLD * em, lane.bottom)):
            actions.append(do(toggle_tree_row, row.toggle))
        caret = icons.ICON_FA_CARET_DOWN if row.is_open else icons.ICON_FA_CARET_RIGHT
        icon = icons.ICON_FA_FOLDER if row.switch_group is None else icons.ICON_FA_MASKS_THEATER
        text = row.name
        if row.switch_group is not None:
            seen = with_repeats(document, row.switch_group).member_at(frame)
            text = f"{text}: {document.member_name(seen)}"
        with push_text_size(SMALL):
            top = lane.middle - imgui.get_text_line_height() / 2
            text = shorten_text(text, high.x - left - 3.0 * em)
            draw_list.add_text(ImVec2(left + 0.3 * em, top), colour_u32(palette.dim), caret)
            draw_list.add_text(ImVec2(left + FOLD * em, top), colour_u32(palette.text), icon)
            draw_list.add_text(
                ImVec2(left + (FOLD + 1.5) * em, top), colour_u32(palette.text), text
            )
        imgui.pop_id()
    return actions


def draw_group_rows(bands: TimelineLayout) -> list[Action]:
    """Draw the keys of groups and switches, and handle clicks and drags on them."""
    actions: list[Action] = []
    palette, draw_list = bands.look.palette, imgui.get_window_draw_list()
    for lane in bands.group_rows:
        low, high = ImVec2(bands.left, lane.top), ImVec2(bands.right, lane.bottom)
        draw_list.add_rect_filled(low, high, colour_u32(palette.desk, 0.35))
        draw_list.add_line(ImVec2(low.x, high.y), high, colour_u32(palette.line))
        imgui.push_id(lane.row.key)
        if lane.row.switch_group is not None:
            actions += _draw_switch_keys(bands, lane, lane.row.switch_group)
        else:
            actions += _keys(bands, lane)
        imgui.pop_id()
    return actions


def _keys(bands: TimelineLayout, lane: GroupRow) -> list[Action]:
    """Draw the keys of a group's layers. A click selects all keys at a frame."""
    actions: list[Action] = []
    document, em = bands.project.document, bands.look.em
    layers = [document.layer(identity) for identity in lane.row.layers]
    chosen_of = bands.project.selection.keys
    at: dict[int, list[int]] = {}
    for layer in layers:
        for index in bands.in_view(layer.keys):
            at.setdefault(layer.keys[index].frame, []).append(layer.id)
    for frame in sorted(at):
        x = bands.x(frame)
        keys = {pose_channel(each): frozenset({frame}) for each in at[frame]}
        box = ImVec2(GRIP * em, GRIP * em)
        middle = ImVec2(x, lane.middle)
        if bands.button(f"keys {frame}", middle - box, middle + box):
            actions += [do(editing.select_channel_keys, keys), do(playback.scrub, frame)]
        is_chosen = all(frame in chosen_of.get(each, ()) for each in keys)
        if begin_tooltip():
            text = ngettext(
                "A key at frame {frame}: click to select it",
                "{count} keys at frame {frame}: click to select them",
                len(keys),
            )
            imgui.text_unformatted(text.format(count=len(keys), frame=frame))
            imgui.end_tooltip()
        palette = bands.look.palette
        colour = (
            palette.accent if is_chosen else palette.text if is_hovered_or_held() else palette.dim
        )
        imgui.get_window_draw_list().add_circle_filled(middle, DOT * em, colour_u32(colour))
    return actions


def _draw_switch_keys(bands: TimelineLayout, lane: GroupRow, switch: SwitchGroup) -> list[Action]:
    """Draw the ranges in which each layer of a switch is visible."""
    actions: list[Action] = []
    document, em = bands.project.document, bands.look.em
    palette, draw_list = bands.look.palette, imgui.get_window_draw_list()
    own, switch = switch, with_repeats(document, switch)
    starts = _starts(bands, switch)
    for start, end in zip(starts, [*starts[1:], document.frames.last], strict=True):
        left, right = max(bands.x(start), bands.left), min(bands.x(max(end, start)), bands.right)
        if right <= left:
            continue
        low, high = ImVec2(left + 1, lane.top + 1), ImVec2(right, lane.bottom - 1)
        seen = switch.member_at(start)
        bands.button(f"turn {start}", low, high, right=True)
        if imgui.is_item_clicked(imgui.MouseButton_.right):
            imgui.open_popup(f"menu of turn {start}")
        elif imgui.is_item_clicked():
            actions.append(_choose_member(document, seen))
        number = switch.count_keys_until(start)
        strength = 0.34 if is_hovered_or_held() else 0.24 - 0.08 * (number % 2)
        draw_list.add_rect_filled(low, high, colour_u32(palette.accent, strength), 0.2 * em)
        with push_text_size(SMALL):
            top = lane.middle - imgui.get_text_line_height() / 2
            text = shorten_text(document.member_name(seen), right - left - 0.9 * em)
            draw_list.add_text(ImVec2(left + 0.45 * em, top), colour_u32(palette.text), text)
        if begin_tooltip():
            imgui.text_unformatted(
                _("{layer} from frame {frame} on").format(
                    layer=document.member_name(seen), frame=start
                )
            )
            imgui.text_disabled(_("Right-click to show another layer, drag the start to move it"))
            imgui.end_tooltip()
        actions += _menu(bands, switch, start)
    for start in starts[1:]:
        # Repeated switch keys move with their cycle.
        if own.count_keys_until(start) > own.count_keys_until(start - 1):
            actions += _edge(bands, lane, switch, start)
    return actions


def _choose_member(document: Document, member: SwitchMember) -> Action:
    """Return the action that selects a member of a switch: a layer, or the layers of a group."""
    if isinstance(member, str):
        return do(select_layers, *(layer.id for layer in document.member_layers(member)))
    return do(set_active_layer, member)


def _starts(bands: TimelineLayout, switch: SwitchGroup) -> list[int]:
    """Return the frames of switch keys in view, and of the last key before the view."""
    first = bands.project.document.frames.first
    seen = list(bands.in_view(switch.keys))
    before = seen[0] if seen else switch.count_keys_until(bands.frame(bands.left))
    reaching = switch.keys[before - 1].frame if before else first
    return sorted({max(reaching, first), *(max(switch.keys[i].frame, first) for i in seen)})


def _menu(bands: TimelineLayout, switch: SwitchGroup, start: int) -> list[Action]:
    """Draw the menu of a switch key: its layer, and whether the key can be deleted."""
    actions: list[Action] = []
    if not imgui.begin_popup(f"menu of turn {start}"):
        return actions
    for member in switch.members:
        name = bands.project.document.member_name(member)
        is_seen = switch.member_at(start) == member
        if imgui.menu_item(f"{name}###show {member}", "", is_seen)[0] and not is_seen:
            actions.append(
                do(editing.edit_document, switch_group_commands.choose_at(member, start))
            )
    imgui.separator()
    channel = Channel(SWITCH, part=switch.name)
    keyed = source_frame(bands.project.document, channel, start)
    is_change = any(key.frame == keyed for key in switch.keys[1:])
    reason = None if is_change else _("The first key of a switch cannot be deleted.")
    if menu_entry(_("Delete"), reason=reason) and keyed is not None:
        command = channel_commands.delete_keys({channel: frozenset({keyed})})
        actions.append(do(editing.edit_document, command))
    imgui.end_popup()
    return actions


def _edge(bands: TimelineLayout, lane: GroupRow, switch: SwitchGroup, start: int) -> list[Action]:
    em, x = bands.look.em, bands.x(start)
    if not bands.shows(x - EDGE * em, x + EDGE * em):
        return []
    channel, gesture = Channel(SWITCH, part=switch.name), bands.project.timeline.gesture
    origin = find_drag_origin(gesture, channel, start)
    box = ImVec2(x - EDGE * em, lane.top), ImVec2(x + EDGE * em, lane.bottom)
    bands.button(f"edge {origin}", *box, right=True)
    palette = bands.look.palette
    is_chosen = start in bands.project.selection.keys.get(channel, ())
    is_hot = is_hovered_or_held() or is_key_dragged(gesture, channel, start)
    colour = palette.accent if is_chosen else palette.text if is_hot else palette.anchor
    top, bottom = ImVec2(x, lane.top + 2), ImVec2(x, lane.bottom - 2)
    width = 2.5 if is_chosen else 1.5
    imgui.get_window_draw_list().add_line(top, bottom, colour_u32(colour), width)
    label_dragged_key(bands, channel, start, x)
    if is_hovered_or_held():
        imgui.set_mouse_cursor(imgui.MouseCursor_.resize_ew)
    key = switch.keys[switch.count_keys_until(start) - 1]
    return begin_key_drag(bands, channel, start) + draw_key_menu(bands, channel, key)
