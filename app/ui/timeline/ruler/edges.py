"""The preview range above the ruler, and the animation's end on the tracks."""

from imgui_bundle import ImVec2, imgui

from app.editor import Action, Edge, EdgeDrag, do
from app.editor.actions.timing import keys, timeline_drag
from app.texts import _
from app.ui.shortcuts.keys import shown_keys
from app.ui.style.theme import colour_u32
from app.ui.style.widgets import draw_tooltip, is_hovered_or_held, is_pressed
from app.ui.timeline.layout import PREVIEW, TimelineLayout, draw_time_tag

GRIP, TALLEST = 0.55, 1.35  # em: half the hit width of an end, height of the last end
BEGINS_HERE = _("Playback begins here: drag, or double-click to play all frames")
ENDS_HERE = _("Playback ends here: drag, or double-click to play all frames")


def draw_range_edges(bands: TimelineLayout) -> list[Action]:
    """Draw the preview range and the animation's end. Both can be dragged."""
    return _preview_range(bands) + _animation_end(bands)


def _preview_range(bands: TimelineLayout) -> list[Action]:
    palette, draw_list, em = bands.look.palette, imgui.get_window_draw_list(), bands.look.em
    document = bands.project.document
    played, is_part = document.played_frames, document.preview is not None
    left, right = bands.x(played.first), bands.x(played.last)
    low, high = bands.top + 0.05 * em, bands.top + (PREVIEW - 0.15) * em
    draw_list.push_clip_rect(*bands.bounds, intersect_with_current_clip_rect=True)
    draw_list.add_rect_filled(
        ImVec2(bands.left, low), ImVec2(bands.right, high), colour_u32(palette.desk), 0.2 * em
    )
    actions = _edge(bands, "preview range", left, right, resizes=False) if is_part else []
    hot = is_part and is_hovered_or_held()
    colour = palette.accent if is_part else palette.dim
    alpha = 0.2 if not is_part else 0.6 if hot else 0.4
    draw_list.add_rect_filled(
        ImVec2(left, low), ImVec2(right, high), colour_u32(colour, alpha), 0.2 * em
    )
    grip = GRIP * em
    ends: tuple[tuple[Edge, float, int, str], ...]
    ends = ("preview start", left, 1, BEGINS_HERE), ("preview end", right, -1, ENDS_HERE)
    for edge, x, side, hint in ends:
        actions += _edge(bands, edge, x - grip, x + grip, resizes=True)
        inner, outer = sorted((x, x + side * 0.32 * em))
        tone = colour_u32(
            palette.accent if is_hovered_or_held() else colour,
            1.0 if is_part or is_hovered_or_held() else 0.7,
        )
        draw_list.add_rect_filled(ImVec2(inner, low), ImVec2(outer, high), tone, 0.1 * em)
        draw_tooltip(hint)
    draw_list.pop_clip_rect()
    return actions + (_clear(bands, left, right) if is_part else [])


def _clear(bands: TimelineLayout, left: float, right: float) -> list[Action]:
    """Draw a cross that clears the preview range, near the visible end of the range."""
    palette, draw_list, em = bands.look.palette, imgui.get_window_draw_list(), bands.look.em
    x = min(right, bands.right) - 3 * GRIP * em
    y, half = bands.top + (PREVIEW - 0.1) / 2 * em, 0.2 * em
    if x - max(left, bands.left) < 3 * GRIP * em or not bands.shows(x - GRIP * em, x + GRIP * em):
        return []
    low, high = ImVec2(x - GRIP * em, bands.top), ImVec2(x + GRIP * em, bands.ruler_top)
    clicked = bands.button("clear preview", low, high)
    colour = colour_u32(palette.text, 1.0 if is_hovered_or_held() else 0.7)
    for side in (-1, 1):
        start, end = ImVec2(x - half, y - side * half), ImVec2(x + half, y + side * half)
        draw_list.add_line(start, end, colour, 0.12 * em)
    draw_tooltip(
        _("Clear the preview range: play all frames"), shown_keys(keys.clear_preview_range)
    )
    return [do(keys.clear_preview_range)] if clicked else []


def _edge(
    bands: TimelineLayout, edge: Edge, left: float, right: float, *, resizes: bool
) -> list[Action]:
    actions: list[Action] = []
    top, bottom = bands.top, bands.ruler_top
    bands.button(edge, ImVec2(left, top), ImVec2(right, bottom))
    if is_hovered_or_held():
        cursor = imgui.MouseCursor_.resize_ew if resizes else imgui.MouseCursor_.hand
        imgui.set_mouse_cursor(cursor)
    if is_pressed():
        actions.append(begin_edge_drag(bands, edge))
    if imgui.is_item_hovered() and imgui.is_mouse_double_clicked(imgui.MouseButton_.left):
        actions.append(do(keys.clear_preview_range))
    return actions


def begin_edge_drag(bands: TimelineLayout, edge: Edge) -> Action:
    drag = EdgeDrag(edge=edge, start=bands.pointed)
    return do(timeline_drag.begin_timeline_drag, drag, bands.time_view)


def _animation_end(bands: TimelineLayout) -> list[Action]:
    palette, draw_list, em = bands.look.palette, imgui.get_window_draw_list(), bands.look.em
    last = bands.project.document.frames.last
    x = bands.x(last)
    if not bands.shows(x - em, x + 2 * em):
        return []
    low = ImVec2(x, bands.track_top)
    # In a low row it leaves room for the grips of repeats below.
    height = min(TALLEST * em, 0.3 * (bands.track_bottom - bands.track_top))
    high = ImVec2(x + 0.75 * em, bands.track_top + height)
    bands.button("animation end", ImVec2(x - 0.2 * em, low.y), ImVec2(x + 1.1 * em, high.y))
    hot = is_hovered_or_held()
    if hot:
        imgui.set_mouse_cursor(imgui.MouseCursor_.resize_ew)
    draw_tooltip(
        _("The animation ends at frame {frame}: drag to make it longer or shorter").format(
            frame=last
        )
    )
    actions = [begin_edge_drag(bands, "animation end")] if is_pressed() else []
    gesture = bands.project.timeline.gesture
    if isinstance(gesture, EdgeDrag) and gesture.edge == "animation end":
        draw_time_tag(bands, x, f"{last}")
    colour = colour_u32(palette.accent if hot else palette.dim, 1.0 if hot else 0.8)
    draw_list.push_clip_rect(*bands.bounds, intersect_with_current_clip_rect=True)
    draw_list.add_line(low, ImVec2(x, bands.track_bottom), colour, 1.5)
    draw_list.add_rect_filled(low, high, colour, 0.25 * em, imgui.ImDrawFlags_.round_right)
    for part in (0.28, 0.5):
        line = x + part * em
        draw_list.add_line(
            ImVec2(line, low.y + 0.3 * height),
            ImVec2(line, high.y - 0.3 * height),
            colour_u32(palette.desk),
        )
    draw_list.pop_clip_rect()
    return actions
