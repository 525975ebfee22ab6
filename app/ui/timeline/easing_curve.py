"""Easing curves: drawing and editing."""

from imgui_bundle import ImVec2, imgui

from app.document import (
    MAX_REVOLUTIONS,
    PRESETS,
    Easing,
    Keyframe,
    KeysByChannel,
    pose_channel,
)
from app.editor import Action, Project, do
from app.editor.actions.timing import keys
from app.texts import _, ngettext
from app.ui.style.theme import SMALL, Look, colour_u32
from app.ui.style.widgets import (
    bold_text,
    draw_tooltip,
    is_hovered_or_held,
    label,
    push_text_size,
    small_text,
)

SIDE = 12.0  # em: side of the editor
TILE = 4.4  # em: width of a preset
LABELS = {
    "linear": _("Linear"),
    "in": _("In"),
    "out": _("Out"),
    "in-out": _("In-out"),
    "hold": _("Hold"),
}
DIGITS = 3  # decimals of a dragged control point


def draw_easing_curve(
    easing: Easing, corner: ImVec2, size: ImVec2, colour: int, thickness: float
) -> None:
    """Draw progress over time, from the lower left to the upper right."""
    draw_list = imgui.get_window_draw_list()
    if easing.curve is None:
        bottom, right = corner.y + size.y, corner.x + size.x - thickness / 2
        draw_list.path_line_to(ImVec2(corner.x, bottom))
        draw_list.path_line_to(ImVec2(right, bottom))
        draw_list.path_line_to(ImVec2(right, corner.y))
    else:
        _trace(easing.curve, corner, size)
    draw_list.path_stroke(colour, thickness)


def fill_easing_curve(
    easing: Easing, corner: ImVec2, size: ImVec2, below: float, colour: int
) -> None:
    """Fill the area under a curve, and a stripe `below` it."""
    if easing.curve is None or size.x < 1 or size.y < 1:
        return
    draw_list = imgui.get_window_draw_list()
    bottom = corner.y + size.y + below
    _trace(easing.curve, corner, size)
    draw_list.path_line_to(ImVec2(corner.x + size.x, bottom))
    draw_list.path_line_to(ImVec2(corner.x, bottom))
    draw_list.path_fill_concave(colour)


def _trace(curve: tuple[float, float, float, float], corner: ImVec2, size: ImVec2) -> None:
    draw_list = imgui.get_window_draw_list()
    first, second = (_point(curve[i], curve[i + 1], corner, size) for i in (0, 2))
    draw_list.path_line_to(_point(0, 0, corner, size))
    draw_list.path_bezier_cubic_curve_to(first, second, _point(1, 1, corner, size), 32)


def _point(x: float, y: float, corner: ImVec2, size: ImVec2) -> ImVec2:
    return ImVec2(corner.x + x * size.x, corner.y + (1 - y) * size.y)


def draw_easing_popup(name: str, look: Look, project: Project, key: Keyframe) -> list[Action]:
    """Draw the popup that edits the easing after a key, if the popup is open.

    If the key is selected, the change applies to all selected keys.
    """
    imgui.push_style_var(imgui.StyleVar_.window_padding, ImVec2(look.em, 0.8 * look.em))
    is_open = imgui.begin_popup(name)
    imgui.pop_style_var()
    if not is_open:
        return []
    taken = project.selection.keys_with(pose_channel(project.selection.active), key.frame)
    count = sum(map(len, taken.values()))
    bold_text(look, _("Easing"))
    imgui.same_line()
    imgui.text_disabled(
        ngettext("after frame {frame}", "after {count} keys", count).format(
            frame=key.frame, count=count
        )
    )
    actions: list[Action] = []
    chosen = _presets(look, key.easing)
    chosen = _editor(look, key.easing) or chosen
    chosen = _numbers(look, key.easing) or chosen
    if chosen is not None:
        actions.append(do(keys.set_easing, taken, chosen))
    actions += _draw_revolutions(look, key, taken)
    if imgui.button(_("Use for new keys")):
        actions.append(do(keys.set_default_easing, key.easing))
    draw_tooltip(_("New keys get this easing"))
    imgui.end_popup()
    return actions


def _presets(look: Look, easing: Easing) -> Easing | None:
    chosen = None
    gap = (SIDE * 1.9 * look.em - len(PRESETS) * TILE * look.em) / (len(PRESETS) - 1)
    for index, (name, preset) in enumerate(PRESETS.items()):
        if index:
            imgui.same_line(0, gap)
        if _tile(look, name, preset, current=preset == easing):
            chosen = preset
    return chosen


def _tile(look: Look, name: str, preset: Easing, *, current: bool) -> bool:
    palette, draw_list, em = look.palette, imgui.get_window_draw_list(), look.em
    low = imgui.get_cursor_screen_pos()
    clicked = imgui.invisible_button(name, ImVec2(TILE * em, 3.9 * em))
    high = imgui.get_item_rect_max()
    hovered = imgui.is_item_hovered()
    draw_list.add_rect_filled(
        low, high, colour_u32(palette.hovered if hovered else palette.raised), 0.4 * em
    )
    if current:
        draw_list.add_rect(low, high, colour_u32(palette.accent), 0.4 * em, 1.5)
    colour = palette.accent if current else palette.text
    corner, size = ImVec2(low.x + 0.9 * em, low.y + 0.6 * em), ImVec2((TILE - 1.8) * em, 1.6 * em)
    draw_easing_curve(preset, corner, size, colour_u32(colour), 0.12 * em)
    with push_text_size(SMALL):
        width = imgui.calc_text_size(LABELS[name]).x
        place = ImVec2((low.x + high.x - width) / 2, high.y - 1.25 * em)
        draw_list.add_text(
            place, colour_u32(palette.text if current else palette.dim), LABELS[name]
        )
    return clicked


def _editor(look: Look, easing: Easing) -> Easing | None:
    """Draw the curve large, with two draggable control points."""
    palette, draw_list, em = look.palette, imgui.get_window_draw_list(), look.em
    low = imgui.get_cursor_screen_pos()
    room = ImVec2(SIDE * 1.9 * em, SIDE * em)
    high = low + room
    draw_list.add_rect_filled(low, high, colour_u32(palette.desk), 0.4 * em)
    # A square, so that linear easing is at 45 degrees.
    pad = 1.0 * em
    side = room.y - 2 * pad
    corner, size = ImVec2(low.x + (room.x - side) / 2, low.y + pad), ImVec2(side, side)
    for part in range(5):
        x, y = corner.x + part / 4 * side, corner.y + part / 4 * side
        colour = colour_u32(palette.line, 1.0 if part in {0, 4} else 0.6)
        draw_list.add_line(ImVec2(x, corner.y), ImVec2(x, corner.y + side), colour)
        draw_list.add_line(ImVec2(corner.x, y), ImVec2(corner.x + side, y), colour)
    fill_easing_curve(easing, corner, size, 0.0, colour_u32(palette.accent, 0.12))
    draw_easing_curve(easing, corner, size, colour_u32(palette.accent), 0.16 * em)
    moved = None
    if easing.curve is not None:
        moved = _control_points(look, easing.curve, corner, size)
    imgui.set_cursor_screen_pos(low)
    imgui.dummy(room)
    return moved


def _control_points(
    look: Look, curve: tuple[float, float, float, float], corner: ImVec2, size: ImVec2
) -> Easing | None:
    palette, draw_list, em = look.palette, imgui.get_window_draw_list(), look.em
    moved = None
    radius = 0.7 * em
    for index, end in enumerate((_point(0, 0, corner, size), _point(1, 1, corner, size))):
        x, y = curve[2 * index : 2 * index + 2]
        centre = _point(x, y, corner, size)
        draw_list.add_line(end, centre, colour_u32(palette.dim), 1.5)
        imgui.set_cursor_screen_pos(ImVec2(centre.x - radius, centre.y - radius))
        imgui.set_next_item_allow_overlap()
        imgui.invisible_button(f"control {index + 1}", ImVec2(2 * radius, 2 * radius))
        hot = is_hovered_or_held()
        draw_tooltip(
            _("Drag the point. It stays inside the square, so that in-betweens keep their limits.")
        )
        draw_list.add_circle_filled(
            centre, 0.5 * em if hot else 0.42 * em, colour_u32(palette.desk)
        )
        draw_list.add_circle_filled(
            centre,
            0.4 * em if hot else 0.32 * em,
            colour_u32(palette.accent if hot else palette.text),
        )
        if imgui.is_item_active() and imgui.is_mouse_dragging(imgui.MouseButton_.left, 0):
            mouse = imgui.get_mouse_pos()
            values = list(curve)
            values[2 * index] = _unit((mouse.x - corner.x) / size.x)
            values[2 * index + 1] = _unit(1 - (mouse.y - corner.y) / size.y)
            moved = _curve(values, curve)
    return moved


def _numbers(look: Look, easing: Easing) -> Easing | None:
    if easing.curve is None:
        small_text(look, _("Holds the pose until the next key."))
        return None
    imgui.set_next_item_width(SIDE * 1.9 * look.em)
    changed, values = imgui.drag_float4("##numbers", list(easing.curve), 0.005, 0.0, 1.0, "%.2f")
    draw_tooltip(_("x and y of the first control point, then of the second"))
    return _curve([_unit(value) for value in values], easing.curve) if changed else None


def _draw_revolutions(look: Look, key: Keyframe, taken: KeysByChannel) -> list[Action]:
    label(look, _("Whole turns"))
    changed, turns = imgui.input_int("##turns", key.revolutions, 1, 1)
    draw_tooltip(
        _("Full turns to the next key, counter-clockwise; negative numbers turn clockwise")
    )
    turns = min(max(turns, -MAX_REVOLUTIONS), MAX_REVOLUTIONS)
    return [do(keys.set_revolutions, taken, turns)] if changed and turns != key.revolutions else []


def _curve(values: list[float], current: tuple[float, float, float, float]) -> Easing | None:
    x1, y1, x2, y2 = (round(value, DIGITS) for value in values)
    return Easing((x1, y1, x2, y2)) if (x1, y1, x2, y2) != current else None


def _unit(value: float) -> float:
    return min(max(value, 0.0), 1.0)
