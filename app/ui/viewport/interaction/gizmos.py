"""Gizmos over the drawing: the rotation ring, and the mirror axis."""

import math
from typing import NamedTuple

from imgui_bundle import ImVec2, icons_fontawesome_6 as icons, imgui

from app.editor import RotationOverlay, Session
from app.editor.poses import flipping
from app.texts import _
from app.ui.style.drawing import draw_centred_text, draw_knob, draw_tag, outline_strokes, tag_size
from app.ui.style.theme import Look, colour_u32
from app.ui.style.widgets import draw_tooltip, is_hovered_or_held, is_pressed
from app.ui.viewport.screen import ScreenMapping

RADIUS, BAND, KNOB = 2.2, 0.5, 0.3  # em: of the ring: radius, hit area, its knob's radius
LINE = 0.12  # em
AXIS_TOP, AXIS_RADIUS = 3.2, 0.85  # em: the axis' grip: distance from the top edge, radius
DASH, GAP, THIN = 0.6, 0.45, 0.1  # em: of the axis


class RotationGizmo(NamedTuple):
    """The ring around the selected handle, on the screen."""

    centre: ImVec2
    turn: float  # rotation of the shape at the handle, in radians
    is_dragged: bool  # whether the pointer is dragging the ring
    swept: float  # rotation of this drag, in radians

    def is_pointed(self, look: Look) -> bool:
        away = imgui.get_mouse_pos() - self.centre
        return abs(math.hypot(away.x, away.y) - RADIUS * look.em) < BAND * look.em


def find_rotation_gizmo(session: Session, screen: ScreenMapping) -> RotationGizmo | None:
    """Return the ring around the only selected handle, if the handle can be rotated."""
    project, gesture = screen.project, session.active_tool
    held = (
        next((m for m in gesture.tool_overlays if isinstance(m, RotationOverlay)), None)
        if gesture
        else None
    )
    is_posing = session.is_posing and not session.records and project.playhead.since is None
    if not (is_posing and session.overlays.handles):
        return None
    if any(project.layer.is_locked(handle) for handle in project.selected_handles):
        return None
    if len(project.selected_handles) != 1 or not (gesture is None or held is not None):
        return None
    shown = screen.shown
    found = zip(
        shown.clip.layer.handles, shown.handle_positions, shown.handle_rotations, strict=True
    )
    for handle, place, turn in found:
        if handle.id in project.selected_handles:
            centre = screen.point(complex(place))
            if held is not None:
                return RotationGizmo(centre, held.angle, is_dragged=True, swept=held.swept_angle)
            return RotationGizmo(centre, turn, is_dragged=False, swept=0.0)
    return None


def draw_rotation_gizmo(look: Look, ring: RotationGizmo, *, is_pointed: bool) -> None:
    """Draw the ring with a knob at the shape's up direction, and the angle during a drag."""
    draw_list, radius = imgui.get_window_draw_list(), RADIUS * look.em
    is_hot = is_pointed or ring.is_dragged
    colour = look.palette.accent if is_hot else look.palette.text
    for tone, width in outline_strokes(look, colour_u32(colour, 1.0 if is_hot else 0.55), LINE):
        draw_list.add_circle(ring.centre, radius, tone, 64, width)
    up = ring.turn + math.pi / 2
    knob = ring.centre + ImVec2(radius * math.cos(up), -radius * math.sin(up))
    if ring.is_dragged:
        draw_list.add_line(ring.centre, knob, colour_u32(colour), LINE * look.em)
    draw_knob(look, knob, KNOB, colour)
    if is_hot:
        imgui.set_mouse_cursor(imgui.MouseCursor_.hand)
    if ring.is_dragged:
        degrees = round(math.degrees(ring.swept))
        text = f"{degrees:+d}°".replace("-", "−") if degrees else "0°"
        above = ImVec2(tag_size(look, text).x / 2, (RADIUS + 2.2) * look.em)
        draw_tag(look, ring.centre - above, text)


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
    if is_hovered_or_held():
        imgui.set_mouse_cursor(imgui.MouseCursor_.resize_ew)
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
