"""The docks around the viewport: their sizes, and the labels of their tabs."""

from collections.abc import Callable, Iterator, Sequence
from functools import partial
from typing import NamedTuple

from imgui_bundle import ImVec2, hello_imgui, imgui

from app.editor import Project
from app.texts import _
from app.ui.panel import Panel, is_in_front
from app.ui.style.theme import FONT_SIZE

# A saved layout with another number is ignored, because its panels have other names.
LAYOUT = 1
SIDE, BOTTOM = 30.2, 12.2  # em: initial size of the tabs at the side, and of the timeline
BARS = (2.7, 4.4)  # em: width and height of the bars around the docks
FITTING = 5  # frames that docks take to follow the window, or a hand
MOST = (0.52, 0.45)  # largest share of the window's width and height for tabs and timeline


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
        # By node: its present size in pixels, and its requested size.
        self._given: dict[int, float] = {}
        self._requests: dict[int, _SizeRequest] = {}
        self._scale = 1.0
        # Size and scale of the window, and the frames after a change in which docks are fitted.
        self._around = (0.0, 0.0, 0.0)
        self._frames_to_fit = FITTING
        # The project whose tabs are shown, with the revision of its document.
        self._tabs_of: tuple[Project | None, int] = (None, -1)

    def layout(self, draw: Callable[[Panel], None]) -> hello_imgui.DockingParams:
        """Return the docks, and the windows in which `draw` draws the panels."""
        layout = hello_imgui.DockingParams()
        layout.layout_name = f"Layout {LAYOUT}"
        layout.main_dock_space_node_flags = imgui.DockNodeFlags_.auto_hide_tab_bar
        layout.dockable_windows = [_dockable(panel, draw) for panel in self._panels]
        return layout

    def begin_frame(self, scale: float, project: Project | None) -> None:
        """Show the tabs of a project. Fit sizes to the window and the interface scale."""
        layout = hello_imgui.get_runner_params().docking_params
        source = (project, 0 if project is None else project.history.revision)
        if source != self._tabs_of:
            self._tabs_of = source
            for panel, tab in zip(self._panels, layout.dockable_windows, strict=True):
                tab.is_visible = panel.has_tab(project)
        room = imgui.get_io().display_size
        around = (room.x, room.y, scale)
        if around != self._around or imgui.is_any_mouse_down() or layout.layout_reset:
            self._around, self._frames_to_fit = around, FITTING
        if not self._frames_to_fit:
            return
        self._frames_to_fit -= 1
        layout.docking_splits = _splits(room, scale * FONT_SIZE)
        if layout.layout_reset:
            self._given.clear()
            return
        for node, axis in _sides(self._windows()):
            self._fit(node, axis, room[axis], scale)
        self._scale = scale

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
            for panel, tab, node in zip(self._panels, shown, nodes, strict=True):
                tab.label = panel.label if node is None else self._label(panel, node, nodes)
        for panel, tab, window in zip(self._panels, shown, windows, strict=True):
            if window is None or tab.label != panel.labels[-1]:
                continue
            flags = window.dc.dock_tab_item_status_flags
            if flags & imgui.internal.ItemStatusFlags_.hovered_rect:
                imgui.set_tooltip(_(panel.title))

    def _windows(self) -> list[imgui.internal.Window | None]:
        return [imgui.internal.find_window_by_name(name) for name in self._names]

    def _fit(self, node: imgui.internal.DockNode, axis: int, room: float, scale: float) -> None:
        size = node.size_ref[axis]
        if abs(size - self._given.get(node.id_, -1.0)) > 1.0:
            # The node is new, or a person moved its edge. A person may exceed the largest share.
            before = self._scale if node.id_ in self._given else scale
            self._requests[node.id_] = _SizeRequest(size / before, max(MOST[axis], size / room))
        request = self._requests[node.id_]
        wanted = min(request.size * scale, request.most * room)
        if abs(wanted - size) > 1.0:
            sizes = [node.size_ref.x, node.size_ref.y]
            sizes[axis] = wanted
            imgui.internal.dock_builder_set_node_size(node.id_, ImVec2(*sizes))
        self._given[node.id_] = wanted

    def _label(
        self,
        panel: Panel,
        node: imgui.internal.DockNode,
        nodes: Sequence[imgui.internal.DockNode | None],
    ) -> str:
        """Return the longest label of the panel with which all tabs in its node fit.

        If not all titles fit, the front tab has its title, and others while there is room.
        """
        together = [
            other
            for other, its in zip(self._panels, nodes, strict=True)
            if its is not None and its.id_ == node.id_
        ]
        style = imgui.get_style()
        gap = style.item_inner_spacing.x
        around = 2 * style.frame_padding.x + 1 + gap
        room = node.size.x - 2 * style.frame_padding.x + gap
        for number in range(len(panel.labels) - 1):
            texts = [other.labels[number].split("###")[0] for other in together]
            if sum(imgui.calc_text_size(text).x + around for text in texts) <= room:
                return panel.labels[number]
        widths = {
            other: [imgui.calc_text_size(text.split("###")[0]).x for text in other.labels[1:]]
            for other in together
        }
        left = room - sum(icon + around for _, icon in widths.values())
        # The front tab first, then the others in order.
        for other in sorted(together, key=lambda each: is_in_front(each.title), reverse=True):
            title, icon = widths[other]
            left -= title - icon
            if other is panel or left < 0:
                break
        return panel.labels[1] if left >= 0 else panel.labels[-1]


def _dockable(panel: Panel, draw: Callable[[Panel], None]) -> hello_imgui.DockableWindow:
    window = hello_imgui.DockableWindow(panel.label, panel.place, partial(draw, panel))
    window.can_be_closed = False
    window.is_visible = panel.has_tab(None)
    if not window.is_visible:
        # Its tab appears without hiding the one in front.
        window.imgui_window_flags = imgui.WindowFlags_.no_focus_on_appearing
    if panel.place == "MainDockSpace":
        window.imgui_window_flags = (
            imgui.WindowFlags_.no_scrollbar | imgui.WindowFlags_.no_scroll_with_mouse
        )
    return window


def _splits(room: ImVec2, em: float) -> list[hello_imgui.DockingSplit]:
    side = min(SIDE * em, MOST[0] * room.x) / max(room.x - BARS[0] * em, 1.0)
    bottom = min(BOTTOM * em, MOST[1] * room.y) / max(room.y - BARS[1] * em, 1.0)
    return [
        hello_imgui.DockingSplit("MainDockSpace", "bottom", imgui.Dir.down, bottom),
        hello_imgui.DockingSplit("MainDockSpace", "side", imgui.Dir.right, side),
    ]


def _sides(
    windows: Sequence[imgui.internal.Window | None],
) -> Iterator[tuple[imgui.internal.DockNode, int]]:
    """Yield the nodes around the centre, outermost first, and the axis (0 or 1) of their size."""
    seen: set[int] = set()
    for window in windows:
        node = None if window is None else window.dock_node
        if node is None:
            continue
        inner = {
            part.id_ for part in _upwards(imgui.internal.dock_node_get_root_node(node).central_node)
        }
        line = list(_upwards(node))
        outer = [part for part in line if part.id_ not in inner]
        if outer and len(outer) < len(line) and outer[-1].id_ not in seen:
            seen.add(outer[-1].id_)
            yield outer[-1], int(outer[-1].parent_node.split_axis)


def _upwards(node: imgui.internal.DockNode | None) -> Iterator[imgui.internal.DockNode]:
    while node is not None:
        yield node
        node = node.parent_node
