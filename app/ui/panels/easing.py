"""Easing curves: how they look, and how they are changed."""

from imgui_bundle import ImVec2, imgui

from app.actions import timing
from app.actions.action import Action, do
from app.document.easing import HOLD, PRESETS, Easing
from app.ui.theme import Look, ink
from app.ui.widgets import segments

SIDE = 12.0  # em of the editor's square
SAMPLES = 24


def draw_curve(easing: Easing, corner: ImVec2, size: ImVec2, colour: int, thickness: float) -> None:
    """Draw how much of the way is done over time, from the lower left to the upper right."""
    draw_list = imgui.get_window_draw_list()
    bottom = corner.y + size.y
    if easing == HOLD:
        draw_list.path_line_to(ImVec2(corner.x, bottom))
        draw_list.path_line_to(ImVec2(corner.x + size.x, bottom))
        draw_list.path_line_to(ImVec2(corner.x + size.x, corner.y))
    else:
        for index in range(SAMPLES + 1):
            time = index / SAMPLES
            draw_list.path_line_to(ImVec2(corner.x + time * size.x, bottom - easing(time) * size.y))
    draw_list.path_stroke(colour, thickness)


def edit_easing(look: Look, easing: Easing) -> list[Action]:
    """Draw the presets and the curve, whose two grips can be dragged."""
    actions: list[Action] = []
    imgui.dummy(ImVec2(SIDE * 1.6 * look.em, 0))
    names = [(name, name.capitalize()) for name in PRESETS]
    chosen = segments(look, "presets", names, easing.name)
    if chosen is not None:
        actions.append(do(timing.set_easing, PRESETS[chosen]))
    side = ImVec2(SIDE * 1.6 * look.em, SIDE * look.em)
    corner = imgui.get_cursor_screen_pos()
    palette, draw_list = look.palette, imgui.get_window_draw_list()
    far = ImVec2(corner.x + side.x, corner.y + side.y)
    draw_list.add_rect_filled(corner, far, ink(palette.desk), 0.4 * look.em)
    draw_curve(easing, corner, side, ink(palette.accent), 2.0)
    if easing.curve is not None:
        actions += _grips(look, easing.curve, corner, side)
    imgui.set_cursor_screen_pos(corner)
    imgui.dummy(side)
    return actions


def _grips(
    look: Look, curve: tuple[float, float, float, float], corner: ImVec2, side: ImVec2
) -> list[Action]:
    actions: list[Action] = []
    draw_list = imgui.get_window_draw_list()
    reach = 0.5 * look.em
    ends = ((0.0, 0.0), (1.0, 1.0))
    for index, end in enumerate(ends):
        x, y = curve[2 * index : 2 * index + 2]
        grip = ImVec2(corner.x + x * side.x, corner.y + (1 - y) * side.y)
        root = ImVec2(corner.x + end[0] * side.x, corner.y + (1 - end[1]) * side.y)
        draw_list.add_line(root, grip, ink(look.palette.dim), 1.0)
        imgui.set_cursor_screen_pos(ImVec2(grip.x - reach, grip.y - reach))
        imgui.invisible_button(f"grip {index + 1}", ImVec2(2 * reach, 2 * reach))
        hot = imgui.is_item_hovered() or imgui.is_item_active()
        colour = look.palette.accent if hot else look.palette.text
        draw_list.add_circle_filled(grip, 0.35 * look.em, ink(colour))
        if imgui.is_item_active():
            mouse = imgui.get_mouse_pos()
            moved = list(curve)
            moved[2 * index] = min(max((mouse.x - corner.x) / side.x, 0.0), 1.0)
            moved[2 * index + 1] = min(max(1 - (mouse.y - corner.y) / side.y, 0.0), 1.0)
            x1, y1, x2, y2 = (round(value, 3) for value in moved)
            if (x1, y1, x2, y2) != curve:
                actions.append(do(timing.set_easing, Easing((x1, y1, x2, y2))))
    return actions
