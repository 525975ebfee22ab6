"""The preview of an export: its frame, the canvas, and the whole motion."""

from imgui_bundle import ImVec2, imgui

from app.document import ExportSettings
from app.editor import Project
from app.motion import BoundingBox, extent_key
from app.texts import _
from app.ui.style.theme import SMALL, Look, colour_u32, rgb
from app.ui.style.widgets import draw_tooltip, push_text_size, small_text

MEASURES = _("Measuring where the motion reaches…")
LEAVES = _("The motion leaves the frame. “All motion” shows all of it.")
KEEPS = _("The whole motion fits the frame.")
PREVIEW, LARGEST_PREVIEW = 3.2, 6.0  # em: smallest and largest height


def draw_export_preview(
    look: Look, project: Project, settings: ExportSettings, frame: BoundingBox, motion: BoundingBox
) -> None:
    """Draw the export's frame around the drawing and the whole motion."""
    canvas = BoundingBox(0j, complex(*project.document.canvas))
    around = frame.joined(canvas).joined(motion)
    width, height = imgui.get_content_region_avail().x, _preview_height(look)
    corner = imgui.get_cursor_screen_pos()
    extent = around.upper - around.lower
    scale = min((width - look.em) / extent.real, (height - look.em) / extent.imag)
    middle = (around.lower + around.upper) / 2

    def place(point: complex) -> ImVec2:
        offset = (point - middle) * scale
        return ImVec2(corner.x + width / 2 + offset.real, corner.y + height / 2 - offset.imag)

    def ends(box: BoundingBox) -> tuple[ImVec2, ImVec2]:
        upper_left = complex(box.lower.real, box.upper.imag)
        return place(upper_left), place(complex(box.upper.real, box.lower.imag))

    palette, draw_list = look.palette, imgui.get_window_draw_list()
    opposite = corner + ImVec2(width, height)
    draw_list.add_rect_filled(corner, opposite, colour_u32(palette.desk), 0.4 * look.em)
    is_clear = settings.background == "transparent"
    colour = palette.raised if is_clear else rgb(settings.background)
    draw_list.add_rect_filled(*ends(frame), colour_u32(colour))
    if project.layer_runtime.shown is not None:
        count = len(project.layer_runtime.shown.mesh.domain.outline)
        for point in project.layer_runtime.shown.positions[:count]:
            draw_list.path_line_to(place(complex(point)))
        draw_list.path_stroke(colour_u32(palette.dim), 1.3, imgui.ImDrawFlags_.closed)
    draw_list.add_rect(*ends(canvas), colour_u32(palette.dim, 0.6))
    draw_list.add_rect(*ends(motion), colour_u32(palette.warning, 0.8))
    draw_list.add_rect(*ends(frame), colour_u32(palette.accent), 0.0, 1.6)
    imgui.dummy(ImVec2(width, height))
    draw_tooltip(
        _(
            "Blue: what the export shows, as in the viewport. Grey: the picture's canvas.\n"
            "Orange: where the motion reaches."
        )
    )
    is_known = project.measured.extent.follows(extent_key(project.document))
    if not is_known and not project.measured.extent.has_failed(extent_key(project.document)):
        note = MEASURES
    else:
        note = LEAVES if not frame.contains(motion, slack=1.0) else KEEPS
    _draw_note(look, note)


def _preview_height(look: Look) -> float:
    """Return the height of the preview with which the button below fits the panel."""
    spacing, line = imgui.get_style().item_spacing.y, imgui.get_text_line_height()
    below = 4 * imgui.get_frame_height() + 3 * line + 0.6 * look.em + 10 * spacing
    room = imgui.get_content_region_avail().y - below
    return min(max(room, PREVIEW * look.em), LARGEST_PREVIEW * look.em)


def _draw_note(look: Look, text: str) -> None:
    """Write a note, with the height of the longest note."""
    width, notes = imgui.get_content_region_avail().x, (MEASURES, LEAVES, KEEPS)
    with push_text_size(SMALL):
        room = max(imgui.calc_text_size(note, wrap_width=width).y for note in notes)
    top = imgui.get_cursor_pos_y()
    small_text(look, text)
    imgui.set_cursor_pos_y(top + room + imgui.get_style().item_spacing.y)
    imgui.dummy(ImVec2(0, 0))
