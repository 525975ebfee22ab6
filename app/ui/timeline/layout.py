"""The timeline's layout: the mapping between frames and pixels, and the rows."""

from bisect import bisect_left, bisect_right
from collections.abc import Iterator, Sequence
from typing import Any, TypeVar

from imgui_bundle import ImVec2, imgui

from app.document import (
    CAMERA,
    MARKER,
    SWITCH,
    VOLUME,
    Channel,
    Layer,
    TreeRow,
    display_frame,
    pose_channel,
    track_in,
)
from app.editor import Project, Session, TimeRangeView
from app.texts import _
from app.ui.style.drawing import draw_tag, tag_size
from app.ui.style.theme import Look
from app.ui.timeline.row import ChannelLane, GroupRow, HasFrame, LayerRow, has_lanes

PREVIEW, RULER, OVERVIEW = 0.7, 1.55, 0.75  # em: heights of the bands above and below the tracks
MARKS, SMALL_MARKS = 1.25, 0.7  # em: height of the marker band, with names or without
BAR, BAR_SHARE = 3.6, 0.62  # em: largest height of segment bars, and as a share of the row's
CRAMPED, CRAMPED_SHARE = 4.0, 0.85  # em: below this height, bars are higher, without overview
ROUNDING = 0.4  # em
NAMES, NAMES_SHARE = 11.0, 0.25  # em: largest width of the names, and as a share of all
SOUND, SOUNDS_SHARE = 1.9, 0.4  # em: height of a sound's lane; all of them, as a share of all
THIN, TALL = 1.25, 2.8  # em: height of a track's row, and of the row of a single layer
LEAST_MARK_GAP = 0.4  # em between two marks of a row; closer marks are drawn once
# em: height of layers' rows: smallest if they do not fit, usual, and largest
DENSE, EVEN, ROOMY = 1.25, 2.0, 3.4


Mark = TypeVar("Mark", bound=HasFrame)


class TimelineLayout:
    """The bands of the timeline, and the mapping between frames and pixels."""

    def __init__(self, session: Session, look: Look, project: Project) -> None:
        self.session = session
        self.look = look
        self.project = project
        self.corner = imgui.get_cursor_screen_pos()
        room = imgui.get_content_region_avail()
        layers = project.document.layers
        self.is_graph = project.graph.is_open
        self.has_names = self.is_graph or len(layers) > 1 or any(map(has_lanes, layers))
        self.has_names |= bool(project.document.camera or project.document.sounds)
        names = min(NAMES * look.em, NAMES_SHARE * room.x) if self.has_names else 0.0
        self.size = ImVec2(room.x - names, room.y)
        self.left, self.top = self.corner.x + names, self.corner.y
        self.right, self.bottom = self.left + self.size.x, self.top + self.size.y
        self.ruler_top = self.top + PREVIEW * look.em
        self.is_cramped = self.size.y < CRAMPED * look.em
        marks = SMALL_MARKS if self.is_cramped else MARKS
        self.markers_top = self.ruler_top + RULER * look.em
        self.camera_top = self.markers_top + bool(project.document.markers) * marks * look.em
        has_camera = bool(project.document.camera) and not self.is_graph
        self.sounds_top = self.camera_top + has_camera * THIN * look.em
        count = 0 if self.is_graph else len(project.document.sounds)
        all_sounds = min(SOUND * look.em * count, SOUNDS_SHARE * self.size.y)
        self.track_top = self.sounds_top + all_sounds
        is_whole = self.is_cramped or project.timeline.time_range is None
        self.track_bottom = self.bottom - (0 if is_whole else OVERVIEW * look.em)
        self.rows: list[LayerRow] = []
        self.lanes: list[ChannelLane] = []
        self.group_rows: list[GroupRow] = []
        self.overflow = self._lay_rows(project.tree)
        self.row = next(row for row in self.rows if row.is_active)
        self.middle = self.row.middle
        share = CRAMPED_SHARE if self.is_cramped else BAR_SHARE
        height = min(BAR * look.em, share * (self.row.bottom - self.row.top))
        self.bar_top, self.bar_bottom = self.middle - height / 2, self.middle + height / 2
        timing = project.timeline
        fitting = TimeRangeView.fitting(project.document.frames, self.width)
        self.time_view = timing.gesture_time_range or timing.time_range or fitting

    def _lay_rows(self, tree: Sequence[TreeRow]) -> float:
        """Lay a row for each group, switch and layer, and a lane for each channel below its layer.

        The active row has no influence, so no row moves under the pointer that selects it.
        Returns the height in pixels that does not fit.
        """
        em, room = self.look.em, self.track_bottom - self.track_top
        thin, project = THIN * em, self.project
        shown = [self._other_lanes(row.layer) for row in tree if row.layer]
        others = (len(tree) - len(shown) + sum(map(len, shown))) * thin
        least, most = (DENSE * em, ROOMY * em) if len(tree) > 1 else (min(TALL * em, room), room)
        tall = min(max((room - others) / len(shown), least), most)
        overflow = max(others + len(shown) * tall - room, 0.0)
        top = self.track_top - min(self.project.timeline.scrolled * em, overflow)
        if project.document.camera:
            self._lay_lane(Channel(CAMERA), None, self.camera_top, self.sounds_top)
        sounds = project.document.sounds
        height = (self.track_top - self.sounds_top) / max(len(sounds), 1)
        for index, sound in enumerate(sounds):
            low = self.sounds_top + index * height
            self._lay_lane(Channel(VOLUME, part=sound.name), None, low, low + height)
        for row in tree:
            layer = row.layer
            if layer is None:
                self.group_rows.append(GroupRow(row=row, top=top, bottom=top + thin))
                top += thin
                continue
            is_active = layer.id == self.project.selection.active
            self.rows.append(
                LayerRow(
                    layer=layer,
                    top=top,
                    bottom=top + tall,
                    is_active=is_active,
                    row=row,
                )
            )
            top += tall
            for channel in self._other_lanes(layer):
                self._lay_lane(channel, layer, top, top + thin)
                top += thin
        return overflow

    def _other_lanes(self, layer: Layer) -> Sequence[Channel[Any]]:
        """Return the channels of a layer that have lanes of their own, without its poses."""
        is_open = layer.id in self.project.timeline.expanded_layers
        return self.project.lanes_of(layer)[1:] if is_open else ()

    def _lay_lane(
        self, channel: Channel[Any], layer: Layer | None, top: float, bottom: float
    ) -> None:
        lane = ChannelLane(
            channel=channel,
            layer=layer,
            top=top,
            bottom=bottom,
            is_chosen=channel in (self.project.channel, self.project.selection.channel),
            track=track_in(self.project.document, channel),
        )
        self.lanes.append(lane)

    @property
    def sound_lanes(self) -> list[ChannelLane]:
        return [lane for lane in self.lanes if lane.channel.kind is VOLUME]

    @property
    def pointed_row(self) -> LayerRow | ChannelLane | GroupRow:
        """The row under the pointer, or the nearest visible row with keys."""
        y = min(imgui.get_mouse_pos().y, self.track_bottom - 1)
        all_rows: list[LayerRow | ChannelLane | GroupRow] = [*self.rows, *self.lanes]
        all_rows += [row for row in self.group_rows if row.row.switch_group is not None]
        shown = [row for row in all_rows if self.shows_row(row)] or all_rows
        rows = sorted(shown, key=lambda row: row.bottom)
        return next((row for row in rows if y < row.bottom), rows[-1])

    @property
    def pointed_channel(self) -> Channel[Any]:
        """The channel under the pointer, or the nearest visible one."""
        row = self.pointed_row
        has_markers = bool(self.project.document.markers)
        if has_markers and self.markers_top <= imgui.get_mouse_pos().y < self.camera_top:
            return Channel(MARKER)
        if isinstance(row, GroupRow):
            switch = row.row.switch_group
            return Channel(SWITCH, part="" if switch is None else switch.name)
        return row.channel if isinstance(row, ChannelLane) else pose_channel(row.layer.id)

    def push_track_clip(self) -> None:
        """Clip drawing and hit tests to the tracks, until the clip is popped."""
        low, high = ImVec2(self.left, self.track_top), ImVec2(self.right, self.track_bottom)
        imgui.push_clip_rect(low, high, intersect_with_current_clip_rect=True)

    @property
    def bounds(self) -> tuple[ImVec2, ImVec2]:
        """The corners of the timeline without the names."""
        return ImVec2(self.left, self.top), ImVec2(self.right, self.bottom)

    @property
    def width(self) -> float:
        """The width in em."""
        return self.size.x / self.look.em

    @property
    def is_usable(self) -> bool:
        """Whether there is room to draw anything."""
        height = self.bar_bottom - self.bar_top
        height = self.track_bottom - self.track_top if self.is_graph else height
        return self.width > 4 and height > (2.0 if self.is_graph else 0.5) * self.look.em

    def x(self, frame: float) -> float:
        """Return the x of a frame, in pixels of the window."""
        return self.left + self.time_view.place(frame) * self.look.em

    def frame(self, x: float) -> float:
        """Return the frame at an x of the window."""
        return self.time_view.frame((x - self.left) / self.look.em)

    def x_of(self, channel: Channel[Any], frame: int) -> float:
        """Return the x of a key. A track's keys are shifted by its delay."""
        return self.x(display_frame(self.project.document, channel, frame))

    @property
    def pointed(self) -> float:
        return self.frame(imgui.get_mouse_pos().x)

    def shows(self, low: float, high: float) -> bool:
        """Return whether a range of x overlaps the visible part."""
        return high > self.left and low < self.right

    def shows_row(self, row: LayerRow | ChannelLane | GroupRow) -> bool:
        """Return whether any of a row is visible."""
        is_fixed = isinstance(row, ChannelLane) and row.layer is None
        return is_fixed or (row.bottom > self.track_top and row.top < self.track_bottom)

    def in_view(
        self,
        marks: Sequence[Mark],
        *,
        room: float = 1.0,
        late: int = 0,
        closest: float = LEAST_MARK_GAP,
    ) -> Iterator[int]:
        """Yield the indices of the visible marks, in order of frames.

        The first mark stands for others closer than `closest`. The cost depends on the yielded
        marks, not on all marks.

        Parameters
        ----------
        room : float
            Half the width of a mark, in em.
        late : int
            Delay of the marks in frames.
        closest : float
            In em.
        """
        beyond = room * self.look.em
        index = bisect_left(marks, self.frame(self.left - beyond) - late, key=_frame)
        end = bisect_right(marks, self.frame(self.right + beyond) - late, key=_frame)
        while index < end:
            yield index
            apart = marks[index].frame + closest / self.time_view.scale
            index = bisect_left(marks, apart, index + 1, end, key=_frame)

    def button(self, name: str, low: ImVec2, high: ImVec2, *, right: bool = False) -> bool:
        """Lay an invisible button over a box. Return whether it was clicked.

        With `right`, the right mouse button counts as well.
        """
        imgui.set_cursor_screen_pos(low)
        imgui.set_next_item_allow_overlap()
        flags = imgui.ButtonFlags_.mouse_button_left
        if right:
            flags |= imgui.ButtonFlags_.mouse_button_right
        size = ImVec2(max(high.x - low.x, 1.0), max(high.y - low.y, 1.0))
        return imgui.invisible_button(name, size, flags)


def _frame(mark: HasFrame) -> int:
    return mark.frame


def draw_time_tag(bands: TimelineLayout, x: float, text: str) -> None:
    """Write a short text below the ruler, above a dragged item."""
    width = tag_size(bands.look, text).x
    left = min(max(x - width / 2, bands.left), bands.right - width)
    draw_tag(bands.look, ImVec2(left, bands.track_top + 0.15 * bands.look.em), text)


def was_dragged() -> bool:
    """Return whether the pointer was dragged since the press, even if it has returned."""
    io, left = imgui.get_io(), imgui.MouseButton_.left
    # Dear ImGui's drag distance lacks the last move before the button was released.
    last = imgui.get_mouse_drag_delta(left, 0.0)
    farthest = max(io.mouse_drag_max_distance_sqr[int(left)], last.x**2 + last.y**2)
    return bool(farthest >= io.mouse_drag_threshold**2)


def format_seconds(frame: float, fps: float) -> str:
    number = f"{frame / fps:.2f}".rstrip("0").rstrip(".")
    return _("{seconds} s").format(seconds=number)
