"""The ruler with frames and seconds, the playhead, and the overview below the track."""

from imgui_bundle import ImVec2, imgui

from app.editor import Action, Scrub, do
from app.editor.actions import timeline_pointing
from app.ui.style import SMALL, in_hand, ink, is_pressed, sized, write_in
from app.ui.timeline.track import Track, in_seconds

TICK_ROOM = 0.55  # em between small ticks at least
RULER_TAG = 1.2  # em: height of the playhead's number
LABEL_GAP = 2.4  # em between labels at least
MULTIPLES = (2, 5, 10, 30, 60, 120, 300, 600, 1800, 3600, 7200, 18000)


def draw_ruler(track: Track, frame: int) -> list[Action]:
    """Draw frame numbers and seconds; a press there takes the playhead along."""
    track.button("ruler", ImVec2(track.left, track.ruler_top), ImVec2(track.right, track.marks_top))
    actions: list[Action] = []
    if is_pressed():
        actions += [
            do(timeline_pointing.begin, Scrub(), track.strip),
            do(timeline_pointing.move, track.pointed, track.row.figure.id),
        ]
    if imgui.is_item_hovered():
        imgui.set_mouse_cursor(imgui.MouseCursor_.resize_ew)
    draw_list = imgui.get_window_draw_list()
    low, high = ImVec2(track.left, track.ruler_top), ImVec2(track.right, track.track_bottom)
    draw_list.push_clip_rect(low, high, intersect_with_current_clip_rect=True)
    with sized(SMALL):
        _draw_ticks(track, frame)
    draw_list.pop_clip_rect()
    return actions


def _draw_ticks(track: Track, present: int) -> None:
    """Draw ticks, and their labels where the playhead does not cover them."""
    palette, draw_list, em = track.look.palette, imgui.get_window_draw_list(), track.look.em
    document = track.project.document
    per_frame = track.strip.scale * em
    last = max(int(track.frame(track.right)) + 1, 0)
    widest = imgui.calc_text_size(f"{last}  {in_seconds(last, document.fps)}").x
    steps = _steps(document.fps)
    large = next((s for s in steps if s * per_frame > widest + LABEL_GAP * em), steps[-1])
    small = next(
        s for s in steps if large % s == 0 and (s == large or s * per_frame >= TICK_ROOM * em)
    )
    begin = max(int(track.frame(track.left)) // large * large, 0)
    text, dim, faint = ink(palette.text, 0.85), ink(palette.dim), ink(palette.dim, 0.5)
    grid = ink(palette.line, 0.55)
    bottom = track.marks_top - 0.2 * em
    tag = _tag_width(track, present) / 2 + 0.2 * em
    covered = track.x(present) - tag, track.x(present) + tag
    for frame in range(begin, last + 1, small):
        x = track.x(frame)
        if frame % large:
            draw_list.add_line(ImVec2(x, bottom - 0.35 * em), ImVec2(x, bottom), faint)
            continue
        draw_list.add_line(ImVec2(x, track.ruler_top + 0.15 * em), ImVec2(x, bottom), dim)
        draw_list.add_line(ImVec2(x, track.track_top), ImVec2(x, track.track_bottom), grid)
        number, top = f"{frame}", track.ruler_top + 0.1 * em
        seconds = in_seconds(frame, document.fps)
        wide = 0.7 * em + imgui.calc_text_size(number).x + imgui.calc_text_size(seconds).x
        if x < covered[1] and x + wide > covered[0]:
            continue
        draw_list.add_text(ImVec2(x + 0.3 * em, top), text, number)
        beside = x + 0.7 * em + imgui.calc_text_size(number).x
        draw_list.add_text(ImVec2(beside, top), dim, seconds)


def _steps(fps: float) -> list[int]:
    """Return distances of ticks that divide seconds, or are made of whole ones."""
    second = max(1, round(fps))
    parts = [part for part in range(1, second + 1) if second % part == 0]
    return parts + [second * multiple for multiple in MULTIPLES]


def draw_playhead(track: Track, frame: int) -> list[Action]:
    """Draw a line at the present frame, and its number on the ruler, to be dragged."""
    palette, draw_list, em = track.look.palette, imgui.get_window_draw_list(), track.look.em
    x = track.x(frame)
    with sized(SMALL, track.look.bold):
        width = _tag_width(track, frame)
    low = ImVec2(x - width / 2, track.ruler_top + 0.05 * em)
    high = low + ImVec2(width, RULER_TAG * em)
    actions: list[Action] = []
    if track.shows(low.x, high.x):
        track.button("playhead", low, high)
        if is_pressed():
            scrub = Scrub(offset=frame - track.pointed)
            actions.append(do(timeline_pointing.begin, scrub, track.strip))
        colour = palette.warning if track.project.unkeyed is not None else palette.accent
        if in_hand():
            imgui.set_mouse_cursor(imgui.MouseCursor_.resize_ew)
        draw_list.push_clip_rect(*track.bounds, intersect_with_current_clip_rect=True)
        draw_list.add_line(
            ImVec2(x, high.y), ImVec2(x, track.track_bottom), ink(colour), max(1.5, 0.1 * em)
        )
        draw_list.add_rect_filled(low, high, ink(colour), 0.35 * em)
        half = 0.32 * em
        draw_list.add_triangle_filled(
            ImVec2(x - half, high.y - 0.5),
            ImVec2(x + half, high.y - 0.5),
            ImVec2(x, high.y + half),
            ink(colour),
        )
        with sized(SMALL, track.look.bold):
            write_in(low, high, f"{frame}", ink(palette.on_accent))
        draw_list.pop_clip_rect()
    return actions


def _tag_width(track: Track, frame: int) -> float:
    """Return the width of the playhead's number with its margins."""
    return max(imgui.calc_text_size(f"{frame}").x + 0.9 * track.look.em, 1.9 * track.look.em)


def draw_overview(track: Track, frame: int) -> list[Action]:
    """Draw below what part of all frames is on the screen; dragging it scrolls."""
    strip, frames, em = track.strip, track.project.document.frames, track.look.em
    end = strip.frame(track.width)
    low, high = min(frames.first, strip.start), max(frames.last, end)
    if track.is_cramped or track.project.timing.strip is None or high - low <= end - strip.start:
        return []
    palette, draw_list = track.look.palette, imgui.get_window_draw_list()
    top, bottom = track.bottom - 0.5 * em, track.bottom
    per_frame = track.size.x / (high - low)
    left, right = (track.left + (at - low) * per_frame for at in (strip.start, end))
    track.button("overview", ImVec2(left, top), ImVec2(right, bottom))
    rounding = (bottom - top) / 2
    draw_list.add_rect_filled(
        ImVec2(track.left, top), ImVec2(track.right, bottom), ink(palette.desk), rounding
    )
    bar = ink(palette.dim if in_hand() else palette.pressed)
    draw_list.add_rect_filled(ImVec2(left, top), ImVec2(right, bottom), bar, rounding)
    middle = (top + bottom) / 2
    # Each frame once, however many figures have a key there; those of the active one over them.
    own = track.project.figure.key_frames
    others = {
        key.frame for row in track.rows if not row.figure.still for key in row.figure.keys
    } - own
    for frames_of, radius, colour in (
        (others, 0.09 * em, ink(palette.dim)),
        (own, 0.11 * em, ink(palette.text, 0.8)),
    ):
        for at in frames_of:
            x = track.left + (at - low) * per_frame
            draw_list.add_circle_filled(ImVec2(x, middle), radius, colour, 8)
    x = track.left + (frame - low) * per_frame
    draw_list.add_line(ImVec2(x, top), ImVec2(x, bottom), ink(palette.accent), 1.5)
    delta = imgui.get_io().mouse_delta.x
    if imgui.is_item_active() and delta:
        moved = strip.panned(delta / per_frame * strip.scale)
        return [do(timeline_pointing.look_at, moved.kept_near(frames, track.width))]
    return []
