"""The docks around the viewport: their sizes, and the labels of their tabs."""

from collections.abc import Callable, Sequence
from functools import partial
from typing import NamedTuple

from imgui_bundle import ImVec2, hello_imgui, imgui

from app.editor import Session
from app.texts import _
from app.ui.panel import Panel, bring_to_front, is_in_front
from app.ui.style.theme import FONT_SIZE
from app.ui.window.docks.sizes import (
    BOTTOM_DOCK,
    MOST,
    SIDE_DOCK,
    sides,
    splits,
    usual_sizes,
)

# A saved layout with another number is ignored, because its panels have other names.
LAYOUT = 2
TAB_GAP = 0.2  # em: smallest distance of two tabs, and their smallest padding
FITTING = 5  # frames that docks take to follow the window, or a hand


class _SizeRequest(NamedTuple):
    """A size in pixels at scale 1, and the largest share of the window."""

    size: float
    most: float


class Docking:
    """Keeps the docks' sizes in em as the person set them, and tab labels as long as fits."""

    def __init__(self, panels: Sequence[Panel]) -> None:
        self._panels = panels
        self._names = [panel.label for panel in panels]
        self._tabs: tuple[object, ...] = ()
        # By dock: its present size in pixels, and the size that the person set.
        self._given: dict[int | str, float] = {}
        self._requests: dict[int | str, _SizeRequest] = {}
        self._scale = 1.0
        # What decides which tabs are shown, and the height in em that the timeline wants.
        self._shown: tuple[object, ...] = ()
        self._height = 0.0
        self._tabs_width = 0.0  # in em: of the panel's tabs with their titles
        self._is_folded = False
        self._frames_to_focus = 0
        self._front: list[Panel] = []  # the panels in front, also while they are folded
        # Padding and inner spacing of all widgets, and those of the tabs in this frame.
        self._usual: tuple[ImVec2, ImVec2] | None = None
        self._tab_spacing: tuple[float, float] | None = None
        # What sizes depend on, and the frames after a change in which docks are fitted.
        self._around: tuple[float, ...] = ()
        self._frames_to_fit = FITTING

    def layout(self, draw: Callable[[Panel], None]) -> hello_imgui.DockingParams:
        """Return the docks, and the windows in which `draw` draws the panels."""
        layout = hello_imgui.DockingParams()
        layout.layout_name = f"Layout {LAYOUT}"
        layout.main_dock_space_node_flags = imgui.DockNodeFlags_.auto_hide_tab_bar
        layout.dockable_windows = [_dockable(panel, draw) for panel in self._panels]
        return layout

    def begin_frame(self, scale: float, session: Session) -> None:
        """Show the tabs that are switched on. Fit sizes to the window and the interface scale."""
        layout = hello_imgui.get_runner_params().docking_params
        project, display = session.project, session.display
        opened = (
            None if project is None else (project.timeline.expanded_layers, project.graph.is_open)
        )
        revision = 0 if project is None else project.history.revision
        shown = (project, revision, opened, display.is_panel_folded, display.is_measuring)
        # Nothing moves under the pointer during a drag or a recording.
        is_held = imgui.is_any_mouse_down() or (
            project is not None
            and project.timeline.recording is not None
            and not project.timeline.recording.is_over
        )
        if shown != self._shown and not is_held:
            self._shown = shown
            self._show_tabs(session, layout)
        if self._frames_to_focus:
            self._focus_front(layout)
        room = imgui.get_io().display_size
        wanted = self._height, self._tabs_width
        around: tuple[float, ...] = (room.x, room.y, scale, *wanted, self._is_folded)
        if around != self._around or imgui.is_any_mouse_down() or layout.layout_reset:
            self._around, self._frames_to_fit = around, FITTING
        if not self._frames_to_fit:
            return
        self._frames_to_fit -= 1
        is_graph = project is not None and project.graph.is_open
        sizes = usual_sizes(room, scale * FONT_SIZE, *wanted, is_graph=is_graph)
        layout.docking_splits = splits(room, sizes, scale * FONT_SIZE)
        preferences = session.settings.preferences
        if layout.layout_reset:
            self._given.clear()
            self._requests.clear()
            session.settings.prefer(panel_width=None, timeline_height=None)
            return
        for name in (SIDE_DOCK, BOTTOM_DOCK):
            kept = preferences.panel_width if name == SIDE_DOCK else preferences.timeline_height
            if kept is not None and name not in self._requests:
                self._requests[name] = _SizeRequest(kept * FONT_SIZE, MOST[name == BOTTOM_DOCK])
        for dock, node, axis in sides(self._panels, self._windows()):
            moved = self._fit(dock, node, axis, room[axis], scale, sizes)
            if moved and dock == SIDE_DOCK:
                session.settings.prefer(panel_width=moved)
            elif moved and dock == BOTTOM_DOCK:
                session.settings.prefer(timeline_height=moved)
        self._scale = scale

    def bring_to_front(self, title: str) -> None:
        """Show a tab in the next frame, or as soon as the panel is unfolded."""
        bring_to_front(title)
        if self._is_folded or self._frames_to_focus:
            self._front = [panel for panel in self._panels if panel.title == title]

    def _show_tabs(self, session: Session, layout: hello_imgui.DockingParams) -> None:
        was_folded, self._is_folded = self._is_folded, session.display.is_panel_folded
        if not was_folded:
            self._front = [panel for panel in self._panels if is_in_front(panel.title)]
        for panel, tab in zip(self._panels, layout.dockable_windows, strict=True):
            tab.is_visible = panel.has_tab(session)
        self._frames_to_focus = FITTING * (was_folded and not self._is_folded)
        self._height = max((panel.height_of(session) for panel in self._panels), default=0.0)

    def _focus_front(self, layout: hello_imgui.DockingParams) -> None:
        """Bring the tab back that was in front, once the unfolded panel has all tabs."""
        self._frames_to_focus -= 1
        for panel, tab in zip(self._panels, layout.dockable_windows, strict=True):
            if panel.place == SIDE_DOCK and panel in self._front and not self._frames_to_focus:
                tab.focus_window_at_next_frame = True

    def draw_tabs(self) -> None:
        """Choose the labels of the next frame. A tab with only an icon has its title as tooltip."""
        shown = hello_imgui.get_runner_params().docking_params.dockable_windows
        windows = self._windows()
        nodes = [
            None if window is None or not tab.is_visible else window.dock_node
            for window, tab in zip(windows, shown, strict=True)
        ]
        places = [
            None if node is None else (node.id_, node.size.x, node.selected_tab_id)
            for node in nodes
        ]
        tabs = (imgui.get_font_size(), *places)
        if tabs != self._tabs:
            self._tabs = tabs
            self._tab_spacing = self._space_tabs(nodes)
            self._tabs_width = self._side_tabs_width(nodes)
            for panel, tab, node in zip(self._panels, shown, nodes, strict=True):
                tab.label = panel.label if node is None else self._label(panel, node, nodes)
        for panel, tab, window in zip(self._panels, shown, windows, strict=True):
            if window is None or tab.label != panel.labels[-1]:
                continue
            flags = window.dc.dock_tab_item_status_flags
            if flags & imgui.internal.ItemStatusFlags_.hovered_rect:
                imgui.set_tooltip(_(panel.title))

    def narrow_tabs(self) -> None:
        """Give tabs the padding with which their titles fit, while the docks are drawn."""
        style = imgui.get_style()
        padding, inner = style.frame_padding, style.item_inner_spacing
        # Copies: the style's own values change with it.
        self._usual = ImVec2(padding.x, padding.y), ImVec2(inner.x, inner.y)
        if self._tab_spacing is not None:
            style.frame_padding = ImVec2(self._tab_spacing[0], padding.y)
            style.item_inner_spacing = ImVec2(self._tab_spacing[1], inner.y)

    def restore_style(self) -> None:
        """Give all widgets their usual padding, once the docks are drawn."""
        if self._usual is not None:
            style = imgui.get_style()
            style.frame_padding, style.item_inner_spacing = self._usual

    def _windows(self) -> list[imgui.internal.Window | None]:
        return [imgui.internal.find_window_by_name(name) for name in self._names]

    def _fit(
        self,
        dock: int | str,
        node: imgui.internal.DockNode,
        axis: int,
        room: float,
        scale: float,
        usual: dict[int | str, float],
    ) -> float | None:
        """Give a dock its size in pixels. If a person moved its edge, return its size in em."""
        size, given, moved = node.size_ref[axis], self._given.get(dock), None
        is_new = given is None and dock not in usual
        if is_new or (given is not None and abs(size - given) > 1.0):
            # A person may exceed the largest share.
            before = scale if given is None else self._scale
            moved = size / before / FONT_SIZE
            self._requests[dock] = _SizeRequest(size / before, max(MOST[axis], size / room))
        request = self._requests.get(dock)
        wanted = min(request.size * scale, request.most * room) if request else usual[dock]
        if abs(wanted - size) > 1.0:
            sizes = [node.size_ref.x, node.size_ref.y]
            sizes[axis] = wanted
            imgui.internal.dock_builder_set_node_size(node.id_, ImVec2(*sizes))
        self._given[dock] = wanted
        return moved

    def _space_tabs(
        self, nodes: Sequence[imgui.internal.DockNode | None]
    ) -> tuple[float, float] | None:
        """Return padding and gap with which all titles fit the docks; None if the usual do."""
        style, chosen = imgui.get_style(), None
        usual, gap = style.frame_padding.x, style.item_inner_spacing.x
        tight = TAB_GAP * imgui.get_font_size()
        for node in {node.id_: node for node in nodes if node is not None}.values():
            texts = [panel.labels[1].split("###")[0] for panel in self._together(node, nodes)]
            count, width = len(texts), sum(imgui.calc_text_size(text).x for text in texts)
            if width + count * (2 * usual + 1 + gap) > node.size.x - 2 * usual + gap:
                free = node.size.x + tight - width - count * (1 + tight)
                padding = max(min(usual, free / (2 * count + 2)), tight)
                chosen = min(chosen or usual, float(int(padding)))
        return None if chosen is None else (chosen, tight)

    def _side_tabs_width(self, nodes: Sequence[imgui.internal.DockNode | None]) -> float:
        """Return the width in em that the tabs of the side dock need with their titles."""
        em = imgui.get_font_size()
        pairs = zip(self._panels, nodes, strict=True)
        titles = [_(panel.title) for panel, node in pairs if node and panel.place == SIDE_DOCK]
        words = sum(imgui.calc_text_size(title).x for title in titles) / em
        # Padding at both sides of each title, a gap, and pixels that are rounded.
        return words + (len(titles) + 1) * 3 * TAB_GAP + 0.5

    def _together(
        self,
        node: imgui.internal.DockNode,
        nodes: Sequence[imgui.internal.DockNode | None],
    ) -> list[Panel]:
        return [
            panel
            for panel, its in zip(self._panels, nodes, strict=True)
            if its is not None and its.id_ == node.id_
        ]

    def _label(
        self,
        panel: Panel,
        node: imgui.internal.DockNode,
        nodes: Sequence[imgui.internal.DockNode | None],
    ) -> str:
        """Return the longest label of the panel with which all tabs in its node fit.

        If not all titles fit, the front tab has its title, and others while there is room.
        """
        style = imgui.get_style()
        usual = style.frame_padding.x, style.item_inner_spacing.x
        padding, gap = self._tab_spacing or usual
        around = 2 * padding + 1 + gap
        room = node.size.x - 2 * padding + gap
        widths = {
            other: [imgui.calc_text_size(text.split("###")[0]).x for text in other.labels[1:]]
            for other in self._together(node, nodes)
        }
        left = room - sum(icon + around for _, icon in widths.values())
        # The front tab first, then the others in order.
        for other in sorted(widths, key=lambda each: is_in_front(each.title), reverse=True):
            title, icon = widths[other]
            left -= title - icon
            if other is panel or left < 0:
                break
        return panel.labels[1] if left >= 0 else panel.labels[-1]


def _dockable(panel: Panel, draw: Callable[[Panel], None]) -> hello_imgui.DockableWindow:
    window = hello_imgui.DockableWindow(panel.label, panel.place, partial(draw, panel))
    window.can_be_closed = False
    window.is_visible = panel.is_shown is None
    if not window.is_visible:
        # Its tab appears without hiding the one in front.
        window.imgui_window_flags = imgui.WindowFlags_.no_focus_on_appearing
    if panel.place == "MainDockSpace":
        window.imgui_window_flags = (
            imgui.WindowFlags_.no_scrollbar | imgui.WindowFlags_.no_scroll_with_mouse
        )
    return window
