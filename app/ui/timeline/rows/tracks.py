"""What only lanes of tracks show: active ranges, delays, and target errors."""

from collections.abc import Collection
from itertools import pairwise

from imgui_bundle import ImVec2, imgui

from app.document import Layer, Track
from app.ui.style.theme import colour_u32
from app.ui.timeline.layout import TimelineLayout
from app.ui.timeline.row import ChannelLane
from app.ui.timeline.rows.track_residuals import find_residuals

# em: heights of the line of a track's active range, and of its delay
SEGMENT_HEIGHT, DELAY_HEIGHT = 0.22, 0.1


def format_track_name(layer: Layer, track: Track) -> str:
    return ", ".join(layer.handle(identity).name for identity in track.handles)


def draw_track_range(bands: TimelineLayout, lane: ChannelLane, layer: Layer, track: Track) -> None:
    """Draw the active range of a track, its delay, and its target errors."""
    palette, draw_list, em = bands.look.palette, imgui.get_window_draw_list(), bands.look.em
    colour = colour_u32(palette.text if track.enabled else palette.dim, 0.35)
    for first, last in _active_ranges(bands, track):
        half = SEGMENT_HEIGHT / 2 * em
        draw_list.add_rect_filled(
            ImVec2(bands.x(first), lane.middle - half),
            ImVec2(bands.x(last), lane.middle + half),
            colour,
            half,
        )
    _draw_delay(bands, lane, track)
    for first, last in _runs(find_residuals(bands.project, layer, track)):
        draw_list.add_rect_filled(
            ImVec2(bands.x(first - 0.5), lane.top + 1),
            ImVec2(bands.x(last + 0.5), lane.bottom - 1),
            colour_u32(palette.danger, 0.55),
        )


def _active_ranges(bands: TimelineLayout, track: Track) -> list[tuple[int, int]]:
    """Return a track's active ranges. The end of a loop splits the range in two."""
    document = bands.project.document
    first, last = track.keys[0].frame + track.delay, track.keys[-1].frame + track.delay
    frames = document.frames
    period = frames.last - frames.first
    if not document.loop or last <= frames.last:
        return [(first, last)]
    if first > frames.last:
        return [(first - period, last - period)]
    return [(first, frames.last), (frames.first, last - period)]


def _draw_delay(bands: TimelineLayout, lane: ChannelLane, track: Track) -> None:
    """Draw the delay of a track as a line from its undelayed first key."""
    if not track.delay:
        return
    em, first = bands.look.em, track.keys[0].frame
    begin, end = bands.x(first), bands.x(first + track.delay)
    y, colour = lane.bottom - 0.22 * em, colour_u32(bands.look.palette.anchor, 0.9)
    draw_list = imgui.get_window_draw_list()
    draw_list.add_line(ImVec2(begin, y), ImVec2(end, y), colour, DELAY_HEIGHT * em)
    draw_list.add_line(
        ImVec2(begin, y - 0.15 * em), ImVec2(begin, y + 0.15 * em), colour, DELAY_HEIGHT * em
    )


def _runs(frames: Collection[int]) -> list[tuple[int, int]]:
    """Return the first and last frame of each run of consecutive frames."""
    ordered = sorted(frames)
    cuts = [index for index, (one, other) in enumerate(pairwise(ordered), 1) if other - one > 1]
    parts = pairwise([0, *cuts, len(ordered)]) if ordered else ()
    return [(ordered[begin], ordered[end - 1]) for begin, end in parts]
