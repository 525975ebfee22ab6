"""The preview range above the ruler, and the animation's end on the track."""

from imgui_bundle import ImVec2, imgui

from app.editor import Action, Edge, EdgeDrag, do
from app.editor.actions import keys, timeline_pointing
from app.ui.shortcuts import BINDINGS
from app.ui.style import in_hand, ink, is_pressed, tip
from app.ui.timeline.track import PREVIEW, Track, tag

GRIP = 0.55  # em: half the width in which the pointer takes an end


def draw_edges(track: Track) -> list[Action]:
    """Draw what plays and where the animation ends; both are changed by dragging."""
    return _preview_range(track) + _animation_end(track)


def _preview_range(track: Track) -> list[Action]:
    palette, draw_list, em = track.look.palette, imgui.get_window_draw_list(), track.look.em
    document = track.project.document
    played, is_part = document.played, document.preview is not None
    left, right = track.x(played.first), track.x(played.last)
    low, high = track.top + 0.05 * em, track.top + (PREVIEW - 0.15) * em
    draw_list.push_clip_rect(*track.bounds, intersect_with_current_clip_rect=True)
    draw_list.add_rect_filled(
        ImVec2(track.left, low), ImVec2(track.right, high), ink(palette.desk), 0.2 * em
    )
    actions = _edge(track, "preview range", left, right, resizes=False) if is_part else []
    hot = is_part and in_hand()
    colour = palette.accent if is_part else palette.dim
    alpha = 0.2 if not is_part else 0.6 if hot else 0.4
    draw_list.add_rect_filled(ImVec2(left, low), ImVec2(right, high), ink(colour, alpha), 0.2 * em)
    grip = GRIP * em
    ends: tuple[tuple[Edge, float, int], ...]
    ends = ("preview start", left, 1), ("preview end", right, -1)
    for edge, x, side in ends:
        actions += _edge(track, edge, x - grip, x + grip, resizes=True)
        inner, outer = sorted((x, x + side * 0.32 * em))
        tone = ink(palette.accent if in_hand() else colour, 1.0 if is_part or in_hand() else 0.7)
        draw_list.add_rect_filled(ImVec2(inner, low), ImVec2(outer, high), tone, 0.1 * em)
        where = "begins" if side > 0 else "ends"
        tip(f"Playback {where} here: drag, or double-click to play all frames")
    draw_list.pop_clip_rect()
    return actions + (_clear(track, left, right) if is_part else [])


def _clear(track: Track, left: float, right: float) -> list[Action]:
    """Draw a cross that clears the preview range, near the end of what is seen of it."""
    palette, draw_list, em = track.look.palette, imgui.get_window_draw_list(), track.look.em
    x = min(right, track.right) - 3 * GRIP * em
    y, half = track.top + (PREVIEW - 0.1) / 2 * em, 0.2 * em
    if x - max(left, track.left) < 3 * GRIP * em or not track.shows(x - GRIP * em, x + GRIP * em):
        return []
    low, high = ImVec2(x - GRIP * em, track.top), ImVec2(x + GRIP * em, track.ruler_top)
    clicked = track.button("clear preview", low, high)
    colour = ink(palette.text, 1.0 if in_hand() else 0.7)
    for side in (-1, 1):
        start, end = ImVec2(x - half, y - side * half), ImVec2(x + half, y + side * half)
        draw_list.add_line(start, end, colour, 0.12 * em)
    tip("Clear the preview range: play all frames", BINDINGS["preview none"].keys_in_words)
    return [do(keys.play_all)] if clicked else []


def _edge(track: Track, edge: Edge, left: float, right: float, *, resizes: bool) -> list[Action]:
    actions: list[Action] = []
    top, bottom = track.top, track.ruler_top
    track.button(edge, ImVec2(left, top), ImVec2(right, bottom))
    if in_hand():
        cursor = imgui.MouseCursor_.resize_ew if resizes else imgui.MouseCursor_.hand
        imgui.set_mouse_cursor(cursor)
    if is_pressed():
        actions.append(begin_drag(track, edge))
    if imgui.is_item_hovered() and imgui.is_mouse_double_clicked(imgui.MouseButton_.left):
        actions.append(do(keys.play_all))
    return actions


def begin_drag(track: Track, edge: Edge) -> Action:
    """Begin to drag an end."""
    document = track.project.document
    drag = EdgeDrag(edge=edge, start=track.pointed, before=document, after=document)
    return do(timeline_pointing.begin, drag, track.strip)


def _animation_end(track: Track) -> list[Action]:
    palette, draw_list, em = track.look.palette, imgui.get_window_draw_list(), track.look.em
    last = track.project.document.frames.last
    x = track.x(last)
    if not track.shows(x - em, x + 2 * em):
        return []
    low = ImVec2(x, track.track_top)
    high = ImVec2(x + 0.75 * em, track.track_top + 1.35 * em)
    track.button("animation end", ImVec2(x - 0.2 * em, low.y), ImVec2(x + 1.1 * em, high.y))
    hot = in_hand()
    if hot:
        imgui.set_mouse_cursor(imgui.MouseCursor_.resize_ew)
    tip(f"The animation ends at frame {last}: drag to make it longer or shorter")
    actions = [begin_drag(track, "animation end")] if is_pressed() else []
    gesture = track.project.timing.gesture
    if isinstance(gesture, EdgeDrag) and gesture.edge == "animation end":
        tag(track, x, f"{last}")
    colour = ink(palette.accent if hot else palette.dim, 1.0 if hot else 0.8)
    draw_list.push_clip_rect(*track.bounds, intersect_with_current_clip_rect=True)
    draw_list.add_line(low, ImVec2(x, track.track_bottom), colour, 1.5)
    draw_list.add_rect_filled(low, high, colour, 0.25 * em, imgui.ImDrawFlags_.round_right)
    for part in (0.28, 0.5):
        line = x + part * em
        draw_list.add_line(
            ImVec2(line, low.y + 0.4 * em), ImVec2(line, high.y - 0.4 * em), ink(palette.desk)
        )
    draw_list.pop_clip_rect()
    return actions
