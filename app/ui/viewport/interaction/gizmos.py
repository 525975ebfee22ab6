"""The mirror axis over the drawing, with its grip."""

from typing import NamedTuple

from imgui_bundle import ImVec2, icons_fontawesome_6 as icons, imgui

from app.editor import Session
from app.editor.poses import flipping
from app.texts import _
from app.ui.style.drawing import draw_centred_text, draw_knob, outline_strokes
from app.ui.style.theme import Look, colour_u32
from app.ui.style.widgets import draw_tooltip, is_hovered_or_held, is_pressed
from app.ui.viewport.screen import ScreenMapping

AXIS_TOP, AXIS_RADIUS = 3.2, 0.85  # em: the axis' grip: distance from the top edge, radius
DASH, GAP, THIN = 0.6, 0.45, 0.1  # em: of the axis


class MirrorAxisGizmo(NamedTuple):
    """The axis at which poses are flipped: its place on the screen and its grip, if visible."""

    x: float | None = None
    is_hot: bool = False
    is_pressed: bool = False


def add_mirror_axis_gizmo(session: Session, look: Look, screen: ScreenMapping) -> MirrorAxisGizmo:
    """Lay a button over the grip of the axis, if it is visible."""
    if not flipping.is_mirror_axis_shown(session, screen.project):
        return MirrorAxisGizmo()
    x, radius = screen.point(complex(screen.project.layer.axis)).x, AXIS_RADIUS * look.em
    imgui.set_cursor_screen_pos(_grip(look, x) - ImVec2(radius, radius))
    imgui.invisible_button("mirror axis", ImVec2(2 * radius, 2 * radius))
    draw_tooltip(_("Poses are flipped at this axis: drag it to the middle of the drawing"))
    return MirrorAxisGizmo(x, is_hovered_or_held(), is_pressed())


def draw_mirror_axis(look: Look, axis: MirrorAxisGizmo) -> None:
    if axis.x is None:
        return
    palette, y = look.palette, imgui.get_window_pos().y
    bottom = y + imgui.get_window_size().y
    colour = colour_u32(palette.accent if axis.is_hot else palette.text, 0.8)
    while y < bottom:
        end = min(y + DASH * look.em, bottom)
        for tone, width in outline_strokes(look, colour, THIN):
            imgui.get_window_draw_list().add_line(
                ImVec2(axis.x, y), ImVec2(axis.x, end), tone, width
            )
        y += (DASH + GAP) * look.em
    centre = _grip(look, axis.x)
    draw_knob(look, centre, AXIS_RADIUS, palette.accent)
    draw_centred_text(
        centre, centre, icons.ICON_FA_ARROWS_LEFT_RIGHT, colour_u32(palette.on_accent)
    )


def _grip(look: Look, x: float) -> ImVec2:
    return ImVec2(x, imgui.get_window_pos().y + AXIS_TOP * look.em)
