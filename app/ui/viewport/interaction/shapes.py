"""The shapes of tools, drawn over the picture."""

from collections.abc import Iterable, Sequence

import shapely
from imgui_bundle import ImVec2, ImVec4, imgui

from app.editor.overlay_shapes import (
    AreaShape,
    CircleShape,
    ColourRole,
    KnobShape,
    LineShape,
    OverlayShape,
    StrokeShape,
    TagShape,
)
from app.ui.style.drawing import draw_knob, draw_tag, outline_strokes, tag_size
from app.ui.style.theme import Look, colour_u32
from app.ui.viewport.screen import ScreenMapping

STROKE = 0.45  # opacity of a brush stroke
HALF = 0.5  # pixels: tolerance of a drawn stroke


def draw_shapes(look: Look, screen: ScreenMapping, shapes: Iterable[OverlayShape]) -> None:
    draw_list = imgui.get_window_draw_list()
    for shape in shapes:
        match shape:
            case LineShape():
                points = [screen.point(place) for place in shape.points]
                flags = imgui.ImDrawFlags_.closed if shape.closed else 0
                colour = colour_u32(role_colour(look, shape.role), shape.opacity)
                for tone, width in outline_strokes(look, colour, shape.width):
                    thickness = max(width, shape.breadth * screen.scale)
                    draw_list.add_polyline(list(points), tone, thickness, flags)
            case AreaShape():
                points = [screen.point(place) for place in shape.points]
                colour = colour_u32(role_colour(look, shape.role), shape.opacity)
                draw_list.add_convex_poly_filled(list(points), colour)
            case CircleShape():
                centre, radius = screen.point(shape.centre), shape.radius * screen.scale
                colour = colour_u32(role_colour(look, shape.role), shape.opacity)
                for tone, width in outline_strokes(look, colour, shape.width):
                    draw_list.add_circle(centre, radius, tone, 64, width)
            case KnobShape():
                radius = shape.radius * screen.scale / look.em
                draw_knob(look, screen.point(shape.centre), radius, role_colour(look, shape.role))
            case StrokeShape():
                _draw_stroke(look, screen, shape)
            case TagShape():
                draw_tag(look, _tag_corner(look, screen, shape), shape.text)


def role_colour(look: Look, role: ColourRole) -> ImVec4:
    colour: ImVec4 = getattr(look.palette, role)
    return colour


def _tag_corner(look: Look, screen: ScreenMapping, tag: TagShape) -> ImVec2:
    """Return the upper left corner of a tag, which stays within the window beside the pointer."""
    size = tag_size(look, tag.text)
    if tag.place is not None:
        return screen.point(tag.place) - ImVec2(size.x / 2, size.y)
    mouse, corner = imgui.get_mouse_pos(), imgui.get_window_pos()
    last = corner + imgui.get_window_size() - size
    left = min(max(mouse.x + look.em, corner.x), last.x)
    return ImVec2(left, min(max(mouse.y + look.em, corner.y), last.y))


def _draw_stroke(look: Look, screen: ScreenMapping, stroke: StrokeShape) -> None:
    colour = colour_u32(role_colour(look, stroke.role), STROKE)
    points = [screen.point(place) for place in stroke.points]
    draw_list = imgui.get_window_draw_list()
    # Anti-aliased edges would be visible between adjacent triangles.
    draw_list.push_draw_flag(imgui.ImDrawFlags_.aa_fill, False)  # noqa: FBT003 - enabled or not
    for corners in triangulate_stroke(points, stroke.radius * screen.scale):
        draw_list.add_triangle_filled(*corners, colour)
    draw_list.pop_draw_flag()


def triangulate_stroke(way: Sequence[ImVec2], radius: float) -> list[tuple[ImVec2, ImVec2, ImVec2]]:
    """Return triangles that cover a stroke of this radius once, to half a pixel."""
    points = [(point.x, point.y) for point in way]
    line = shapely.LineString(points) if len(points) > 1 else shapely.Point(points[0])
    # Per frame: with all points of a mouse this would take up to 0.1 s.
    line = line.simplify(HALF)
    parts = shapely.get_parts(shapely.constrained_delaunay_triangles(line.buffer(radius)))
    rings = shapely.get_coordinates(parts).reshape(-1, 4, 2).tolist()
    return [(ImVec2(*one), ImVec2(*two), ImVec2(*three)) for one, two, three, _ in rings]
