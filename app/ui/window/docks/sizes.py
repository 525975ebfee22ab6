"""The docks of panel and timeline: their sizes by themselves, and where they are."""

from collections.abc import Iterator, Sequence

from imgui_bundle import ImVec2, hello_imgui, imgui

from app.ui.panel import Panel

SIDE, LEAST_SIDE = 20.0, 17.4  # em: largest and smallest width of the panel by itself
SHARE = 0.235  # of the window's width, for the panel by itself
BOTTOM = 8.0  # em: the timeline of one layer
# Shares of the window's height up to which the timeline grows by itself: with rows, with curves.
GROWN, GROWN_GRAPH = 0.34, 0.44
BARS = (2.7, 4.4)  # em: width and height of the bars around the docks
MOST = (0.52, 0.45)  # largest share of the window's width and height for panel and timeline
SIDE_DOCK, BOTTOM_DOCK = "side", "bottom"


def usual_sizes(
    room: ImVec2, em: float, height: float, tabs: float, *, is_graph: bool
) -> dict[int | str, float]:
    """Return the panel's width and the timeline's height in pixels, if no person sets them.

    In em, the timeline wants `height`, and the tabs of the panel with their titles are `tabs` wide.
    """
    grown = GROWN_GRAPH if is_graph else GROWN
    side = min(max(SHARE * room.x, LEAST_SIDE * em), SIDE * em)
    side = min(max(side, tabs * em), MOST[0] * room.x)
    bottom = min(max(height, BOTTOM) * em, max(grown * room.y, BOTTOM * em))
    return {SIDE_DOCK: side, BOTTOM_DOCK: bottom}


def splits(
    room: ImVec2, sizes: dict[int | str, float], em: float
) -> list[hello_imgui.DockingSplit]:
    """Return the docks of timeline and panel, as shares of the window."""
    side = sizes[SIDE_DOCK] / max(room.x - BARS[0] * em, 1.0)
    bottom = min(sizes[BOTTOM_DOCK], MOST[1] * room.y) / max(room.y - BARS[1] * em, 1.0)
    return [
        hello_imgui.DockingSplit("MainDockSpace", BOTTOM_DOCK, imgui.Dir.down, bottom),
        hello_imgui.DockingSplit("MainDockSpace", SIDE_DOCK, imgui.Dir.right, side),
    ]


def sides(
    panels: Sequence[Panel], windows: Sequence[imgui.internal.Window | None]
) -> Iterator[tuple[int | str, imgui.internal.DockNode, int]]:
    """Yield the docks around the centre, outermost first, with the axis (0 or 1) of their size.

    The docks of panel and timeline have names, others their numbers.
    """
    seen: set[int] = set()
    for panel, window in zip(panels, windows, strict=True):
        node = None if window is None or not window.was_active else window.dock_node
        if node is None:
            continue
        inner = {
            part.id_ for part in _upwards(imgui.internal.dock_node_get_root_node(node).central_node)
        }
        line = list(_upwards(node))
        outer = [part for part in line if part.id_ not in inner]
        if outer and len(outer) < len(line) and outer[-1].id_ not in seen:
            seen.add(outer[-1].id_)
            axis = int(outer[-1].parent_node.split_axis)
            is_usual = (panel.place, axis) in {(SIDE_DOCK, 0), (BOTTOM_DOCK, 1)}
            yield panel.place if is_usual else outer[-1].id_, outer[-1], axis


def _upwards(node: imgui.internal.DockNode | None) -> Iterator[imgui.internal.DockNode]:
    while node is not None:
        yield node
        node = node.parent_node
