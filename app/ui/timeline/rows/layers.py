"""The rows of a scene's layers: names, and visibility keys."""

from bisect import bisect_left
from collections.abc import Sequence

from imgui_bundle import ImVec2, icons_fontawesome_6 as icons, imgui

from app.document import (
    Layer,
    VisibilityKey,
    is_visible,
    layer_commands,
    parent_label,
    visibility_keys,
)
from app.editor import Action, SwitchDrag, do
from app.editor.actions import editing, playback
from app.editor.actions.timing import timeline_drag
from app.texts import _
from app.ui.style.theme import CHOSEN, SMALL, colour_u32
from app.ui.style.widgets import (
    begin_tooltip,
    is_hovered_or_held,
    is_pressed,
    push_text_size,
    shorten_text,
)
from app.ui.timeline.keys import select_row
from app.ui.timeline.layout import THIN, HasFrame, LayerRow, TimelineLayout, draw_time_tag
from app.ui.timeline.rows.groups import INDENT, draw_group_names, draw_group_rows
from app.ui.timeline.tracks import (
    EXPANDER_WIDTH,
    draw_expander,
    draw_track_names,
    draw_track_segments,
)

HATCH = 0.55  # em between the lines over a hidden range
EYE = 0.62  # em: half the width of a visibility key
CHANGE = 0.24  # em: half the size of a transform, opacity or order key
BESIDE = 0.35  # em: offset beside a pose key at the same frame
DEEPEST_INDENT = 5  # deeper rows have the same indent
LEAST_PARENT_ROOM = 1.8  # em: with less room after the name, only the tooltip names the parent


def draw_layer_rows(bands: TimelineLayout, frame: int) -> list[Action]:
    """Draw the backgrounds of all layers' rows. Handle clicks on names and visibility keys."""
    actions: list[Action] = []
    if bands.has_names:
        actions += _draw_names(bands, frame)
    bands.push_track_clip()
    actions += draw_group_rows(bands)
    for row in filter(bands.shows_row, bands.rows):
        if bands.has_names:
            _draw_ground(bands, row)
        for begin, end in _hidden(bands, row.layer):
            _hatch(bands, row, begin, end)
    draw_track_segments(bands)
    for row in filter(bands.shows_row, bands.rows):
        imgui.push_id(f"row {row.layer.id}")
        actions += _draw_changes(bands, row)
        for index in bands.in_view(row.layer.visibility_keys):
            actions += _draw_visibility_key(bands, row, row.layer.visibility_keys[index])
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
            actions += select_row(row.layer.id, {})
        if row.is_active or is_hovered_or_held():
            colour = (
                colour_u32(palette.accent, CHOSEN) if row.is_active else colour_u32(palette.hovered)
            )
            draw_list.add_rect_filled(*box, colour, 0.2 * em)
        depth, parent = parent_label(document, row.layer, frame)
        if begin_tooltip():
            imgui.text_unformatted(row.layer.name)
            if parent:
                imgui.text_disabled(parent)
            imgui.end_tooltip()
        icon = icons.ICON_FA_IMAGE if row.layer.still else icons.ICON_FA_PERSON
        colour = colour_u32(palette.text if is_visible(document, row.layer, frame) else palette.dim)
        indent = low.x + INDENT * min(row.depth + depth, DEEPEST_INDENT) * em
        with push_text_size(SMALL):
            left = indent + (1.8 + EXPANDER_WIDTH * bool(row.layer.tracks)) * em
            room = box[1].x - left - 0.8 * em
            text = shorten_text(row.layer.name, room)
            top = row.middle - imgui.get_text_line_height() / 2
            draw_list.add_text(ImVec2(left - 1.4 * em, top), colour, icon)
            draw_list.add_text(ImVec2(left, top), colour, text)
            taken = imgui.calc_text_size(text).x + 0.5 * em
            if parent and room - taken > LEAST_PARENT_ROOM * em:
                label = shorten_text(parent, room - taken)
                draw_list.add_text(ImVec2(left + taken, top), colour_u32(palette.dim), label)
        actions += draw_expander(bands, row, indent)
    actions += draw_group_names(bands, frame)
    actions += draw_track_names(bands)
    _draw_scrolled(bands)
    imgui.pop_clip_rect()
    return actions


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
        if index >= 0 and not switches[index].visible:
            is_last = index + 1 == len(switches)
            end = None if is_last else switches[index + 1].frame
            stretches.append((switches[index].frame, end))
    if not switches[0].visible:
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


def _draw_changes(bands: TimelineLayout, row: LayerRow) -> list[Action]:
    actions: list[Action] = []
    layer, em, palette = row.layer, bands.look.em, bands.look.palette
    changes: dict[int, list[str]] = {}
    rows: dict[str, Sequence[HasFrame]] = {
        _("Transform"): layer.transform_keys,
        _("Opacity"): layer.opacity_keys,
        _("Draw order"): layer.draw_order_keys,
    }
    for what, row_of_keys in rows.items():
        for index in bands.in_view(row_of_keys):
            changes.setdefault(row_of_keys[index].frame, []).append(what)
    for frame, channels in changes.items():
        x, y, half = bands.x(frame), row.bottom - 1.2 * CHANGE * em, CHANGE * em
        box = ImVec2(x - half, y - half), ImVec2(x + half, y + half)
        if bands.button(f"change {frame}", *box):
            actions.append(do(playback.scrub, frame))
        imgui.get_window_draw_list().add_ngon_filled(
            ImVec2(x, y),
            half,
            colour_u32(palette.text if is_hovered_or_held() else palette.anchor),
            4,
        )
        if begin_tooltip():
            imgui.text_unformatted(
                _("Keys at frame {frame}: {channels}").format(
                    frame=frame, channels=", ".join(channels)
                )
            )
            imgui.text_disabled(_("Click to go there. Change it in the Layers tab."))
            imgui.end_tooltip()
    return actions


def _draw_visibility_key(
    bands: TimelineLayout, row: LayerRow, switch: VisibilityKey
) -> list[Action]:
    """Draw a visibility key: an eye, or a struck eye if the layer becomes hidden."""
    frame, half = switch.frame, EYE * bands.look.em
    x = bands.x(frame)
    left = _left_of_eye(bands, row, frame)
    drag = bands.project.timeline.gesture
    if not isinstance(drag, SwitchDrag) or (drag.layer, drag.at) != (row.layer.id, frame):
        drag = None
    # By its frame before the drag, so that its button keeps its id.
    origin = frame if drag is None else drag.switch
    box = left - ImVec2(0, half), left + ImVec2(2 * half, half)
    bands.button(f"switch {origin}", *box, right=True)
    _draw_eye(bands, row, switch, left, is_hot=is_hovered_or_held() or drag is not None)
    if origin != frame:
        draw_time_tag(bands, x, f"{frame}  ({frame - origin:+d})")
    return _point(bands, row, switch) + _menu(row, frame)


def _left_of_eye(bands: TimelineLayout, row: LayerRow, frame: int) -> ImVec2:
    """Return the left of an eye: below pose keys of the active layer, beside those of others."""
    em, x = bands.look.em, bands.x(frame)
    if row.is_active and row.bottom - row.top > 2 * THIN * em:
        return ImVec2(x, row.bottom - (0.1 + THIN / 2) * em)
    at = bisect_left(row.layer.keys, frame, key=lambda key: key.frame)
    is_at_key = at < len(row.layer.keys) and row.layer.keys[at].frame == frame
    return ImVec2(x + (BESIDE * em if is_at_key else 0.0), row.middle)


def _draw_eye(
    bands: TimelineLayout, row: LayerRow, switch: VisibilityKey, left: ImVec2, *, is_hot: bool
) -> None:
    draw_list, x = imgui.get_window_draw_list(), bands.x(switch.frame)
    colour = colour_u32(bands.look.palette.text if is_hot else bands.look.palette.anchor)
    draw_list.add_line(ImVec2(x, row.top + 2), ImVec2(x, row.bottom - 2), colour, 1.5)
    icon = icons.ICON_FA_EYE if switch.visible else icons.ICON_FA_EYE_SLASH
    with push_text_size(SMALL * SMALL):
        top = left.y - imgui.get_text_line_height() / 2
        draw_list.add_text(ImVec2(left.x + 0.15 * bands.look.em, top), colour, icon)


def _point(bands: TimelineLayout, row: LayerRow, switch: VisibilityKey) -> list[Action]:
    """Handle the pointer on an eye, which is the last item, and show its tooltip."""
    frame, document = switch.frame, bands.project.document
    if is_hovered_or_held():
        imgui.set_mouse_cursor(imgui.MouseCursor_.resize_ew)
    if imgui.is_item_clicked(imgui.MouseButton_.right):
        imgui.open_popup(f"menu of switch {frame}")
    elif is_pressed():
        drag = SwitchDrag(
            layer=row.layer.id,
            switch=frame,
            at=frame,
            start=bands.pointed,
            before=document,
            after=document,
        )
        return [do(timeline_drag.begin_timeline_drag, drag, bands.time_view)]
    if bands.project.timeline.gesture is None and begin_tooltip():
        text = (
            _("Shown from frame {frame} on")
            if switch.visible
            else _("Hidden from frame {frame} on")
        )
        imgui.text_unformatted(text.format(frame=frame))
        imgui.text_disabled(_("Click to go there, drag to move it, right-click to delete it"))
        imgui.end_tooltip()
    return []


def _menu(row: LayerRow, frame: int) -> list[Action]:
    actions: list[Action] = []
    if imgui.begin_popup(f"menu of switch {frame}"):
        if imgui.menu_item_simple(_("Delete")):
            command = layer_commands.key_visibility(row.layer.id, frame, visible=None)
            actions.append(do(editing.edit_document, command))
        imgui.end_popup()
    return actions
