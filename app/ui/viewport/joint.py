"""The joint that is dragged from the anchor of one layer onto another."""

from collections.abc import Callable

from imgui_bundle import ImVec2, imgui

from app.editor import JointMark, Project
from app.motion import Shown
from app.ui.style import Look, ink, outlined
from app.ui.viewport.marks import find_anchor, moved_loops
from engine.arrays import Complexes


def is_on_anchor(project: Project, handle: int | None, place: complex, reach: float) -> bool:
    """Tell whether the pointer is on the anchor of the layer that is posed, in a scene of several.

    It is over a `handle`, or none, at a `place` of the layer by itself, and points `reach` far.
    """
    shown = project.puppet.shown
    if shown is None or len(project.document.figures) == 1 or project.playhead.since is not None:
        return False
    if handle is not None:
        figure = shown.clip.figure
        return figure.anchor == figure.handle(handle).position
    anchor = find_anchor(project, shown)
    return anchor is not None and abs(anchor - place) <= reach


def draw_joint(
    look: Look,
    mark: JointMark,
    point: Callable[[complex], ImVec2],
    points: Callable[[Complexes], list[ImVec2]],
    parent: Shown | None,
) -> None:
    """Draw the way from the anchor to the pointer, and the outline of the layer there.

    Where a place of the layer by itself is on the screen, `point` tells; `points`, where those of
    the scene are.
    """
    draw_list = imgui.get_window_draw_list()
    colour = look.palette.danger if mark.is_refused else look.palette.accent
    start, end = point(mark.start), point(mark.end)
    loops = [] if parent is None else [points(parent.placement.on(p)) for p in moved_loops(parent)]
    for tone, width in outlined(look, ink(colour), 0.16):
        for loop in loops:
            draw_list.add_polyline(list(loop), tone, width, imgui.ImDrawFlags_.closed)
        draw_list.add_line(start, end, tone, width)
        draw_list.add_circle(end, 0.45 * look.em, tone, thickness=width)
