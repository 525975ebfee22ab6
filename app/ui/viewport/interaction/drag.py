"""The active gesture in the viewport: its overlays, and its steps."""

from collections.abc import Iterable, Sequence

import shapely
from imgui_bundle import ImVec2, imgui

from app.editor import (
    Action,
    AttachOverlay,
    BoneOverlay,
    BoxOverlay,
    KnifeOverlay,
    Mark,
    NumericEntryOverlay,
    RotationOverlay,
    Session,
    StrokeOverlay,
    do,
)
from app.editor.tools import tool_pointer
from app.editor.tools.numeric_entry import ERASE
from app.ui.style.drawing import draw_tag, outline_strokes, tag_size
from app.ui.style.theme import Look, colour_u32
from app.ui.viewport.cutout_overlay import find_stroke_colour
from app.ui.viewport.marks import transform_loops
from app.ui.viewport.screen import ScreenMapping
from app.ui.viewport.stiffness_overlay import draw_bone
from engine.domain import CUT_WIDTH
from engine.geometry import box_diagonal

DIGITS = "0123456789.,-"
AXES = ((imgui.Key.x, "x"), (imgui.Key.y, "y"))
STROKE = 0.45  # opacity of a stroke that is not computed yet
HALF = 0.5  # pixels: tolerance of a drawn stroke


def follow_pointer(session: Session, look: Look, screen: ScreenMapping) -> list[Action]:
    """Continue the gesture at the pointer. End it when the button is released."""
    gesture = session.active_tool
    if gesture is None:
        return []
    if imgui.is_key_pressed(imgui.Key.escape) or imgui.is_mouse_clicked(imgui.MouseButton_.right):
        return [do(tool_pointer.cancel_tool)]
    draw_gesture_overlays(look, screen, gesture.tool_overlays)
    io, pointer = imgui.get_io(), screen.pointer
    actions: list[Action] = []
    # Only rotations snap to steps. A Ctrl released after Ctrl+Z must not drag again.
    is_turning = any(isinstance(mark, RotationOverlay) for mark in gesture.tool_overlays)
    is_stepped = is_turning and io.key_ctrl != session.is_snapping
    # A recording continues while the pointer rests.
    is_recorded = screen.project.recording is not None and not screen.project.recording.is_over
    if io.mouse_delta.x or io.mouse_delta.y or is_stepped or is_recorded:
        move = tool_pointer.move_pointer_in_steps if io.key_ctrl else tool_pointer.move_pointer
        actions.append(do(move, pointer))
    characters = _typed()
    if characters:
        actions.append(do(tool_pointer.type_in_tool, characters))
    is_entered = any(map(imgui.is_key_pressed, (imgui.Key.enter, imgui.Key.keypad_enter)))
    if is_entered or not imgui.is_mouse_down(imgui.MouseButton_.left):
        end = tool_pointer.release_pointer_forced if io.key_alt else tool_pointer.release_pointer
        actions.append(do(end, pointer))
    return actions


def draw_gesture_overlays(look: Look, screen: ScreenMapping, marks: Iterable[Mark]) -> None:
    for mark in marks:
        match mark:
            case BoxOverlay():
                low, high = screen.point(mark.corner), screen.point(mark.opposite)
                draw_list, accent = imgui.get_window_draw_list(), look.palette.accent
                draw_list.add_rect_filled(low, high, colour_u32(accent, 0.12))
                draw_list.add_rect(low, high, colour_u32(accent, 0.8))
            case StrokeOverlay():
                _draw_stroke(look, screen, mark)
            case KnifeOverlay():
                _draw_cut(look, screen, mark.points)
            case AttachOverlay():
                _draw_joint(look, screen, mark)
            case NumericEntryOverlay():
                _draw_entry(look, screen, mark)
            case BoneOverlay():
                colour = look.palette.danger if mark.is_refused else look.palette.accent
                draw_bone(look, screen.point(mark.start), screen.point(mark.end), colour)


def draw_pending_strokes(look: Look, screen: ScreenMapping) -> None:
    """Draw brush strokes that the worker has not processed yet."""
    layer, known = screen.project.layer, screen.project.layer_runtime.cut.source
    done = () if known is None else known.strokes
    for stroke in layer.cut_out.strokes[len(done) :]:
        places = tuple(complex(place) for place in stroke.points + layer.corner)
        mark = StrokeOverlay(points=places, radius=stroke.radius, keeps=stroke.keeps)
        _draw_stroke(look, screen, mark)


def draw_cuts(look: Look, screen: ScreenMapping) -> None:
    """Draw the lines of finished cuts and of the active cut."""
    layer = screen.project.layer
    for slit in layer.cut_out.cut_lines:
        _draw_cut(look, screen, (slit.points + layer.corner).tolist())


def _draw_cut(look: Look, screen: ScreenMapping, places: Sequence[complex]) -> None:
    """Draw a cut line, as wide as the slit it makes."""
    width = CUT_WIDTH * box_diagonal(screen.project.layer.domain.outline) * screen.scale
    points = [screen.point(place) for place in places]
    draw_list = imgui.get_window_draw_list()
    for tone, breadth in outline_strokes(look, colour_u32(look.palette.accent), 0.1):
        draw_list.add_polyline(list(points), tone, max(breadth, width), 0)


def _typed() -> str:
    """Return the text typed for a drag in this frame, in order."""
    characters = [chr(code) for code in imgui.get_io().input_queue_characters]
    text = "".join(character for character in characters if character in DIGITS)
    # By keys, because characters repeat while a key is held, which would release the axis again.
    text += "".join(axis for key, axis in AXES if imgui.is_key_pressed(key, repeat=False))
    return text + (ERASE if imgui.is_key_pressed(imgui.Key.backspace) else "")


def _draw_entry(look: Look, screen: ScreenMapping, mark: NumericEntryOverlay) -> None:
    """Draw the locked axis of a drag, and the typed number beside the pointer."""
    corner, room = imgui.get_window_pos(), imgui.get_window_size()
    if mark.direction is not None:
        centre = screen.point(mark.place)
        low, high = ImVec2(corner.x, centre.y), ImVec2(corner.x + room.x, centre.y)
        if not mark.direction.real:
            low, high = ImVec2(centre.x, corner.y), ImVec2(centre.x, corner.y + room.y)
        for tone, width in outline_strokes(look, colour_u32(look.palette.accent), 0.12):
            imgui.get_window_draw_list().add_line(low, high, tone, width)
    mouse, last = imgui.get_mouse_pos(), corner + room - tag_size(look, mark.text)
    left = min(max(mouse.x + look.em, corner.x), last.x)
    top = min(max(mouse.y + look.em, corner.y), last.y)
    draw_tag(look, ImVec2(left, top), mark.text)


def _draw_stroke(look: Look, screen: ScreenMapping, mark: StrokeOverlay) -> None:
    colour = colour_u32(find_stroke_colour(look, keeps=mark.keeps), STROKE)
    points = [screen.point(place) for place in mark.points]
    draw_list = imgui.get_window_draw_list()
    # Anti-aliased edges would be visible between adjacent triangles.
    draw_list.push_draw_flag(imgui.ImDrawFlags_.aa_fill, False)  # noqa: FBT003 - enabled or not
    for corners in triangulate_stroke(points, mark.radius * screen.scale):
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


def _draw_joint(look: Look, screen: ScreenMapping, mark: AttachOverlay) -> None:
    """Draw the line from the anchor to the pointer, and the outline of the layer there."""
    draw_list = imgui.get_window_draw_list()
    colour = look.palette.danger if mark.is_refused else look.palette.accent
    start, end = screen.point(mark.start), screen.point(mark.end)
    parent = None if mark.parent is None else screen.project.layer_runtimes[mark.parent].shown
    loops = [] if parent is None else map(parent.placement.apply, transform_loops(parent))
    edges = [screen.points(loop) for loop in loops]
    for tone, width in outline_strokes(look, colour_u32(colour), 0.16):
        for edge in edges:
            draw_list.add_polyline(list(edge), tone, width, imgui.ImDrawFlags_.closed)
        draw_list.add_line(start, end, tone, width)
        draw_list.add_circle(end, 0.45 * look.em, tone, thickness=width)
