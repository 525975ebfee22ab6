"""What the next export makes, and how far it is."""

from dataclasses import replace

from imgui_bundle import ImVec2, imgui
from imgui_bundle import icons_fontawesome_6 as icons

from app.actions import exporting
from app.actions.action import Action, do
from app.document.settings import EXPORT_FORMATS, ExportFormat, ExportSettings
from app.document.timeline import exported_frames
from app.export.framing import box_around, frame_view
from app.session import Project, Session
from app.ui.shortcuts import BINDINGS
from app.ui.theme import Look, ink
from app.ui.widgets import heading, label, main_button, segments, small, tip

FORMAT_NAMES: dict[ExportFormat, str] = {
    "png": "PNG frames",
    "apng": "Animated PNG",
    "gif": "GIF",
    "webp": "WebP",
    "spritesheet": "Sprite sheet",
    "mp4": "MP4 video",
}
FRAMINGS = (("canvas", "Canvas"), ("fit", "All motion"))
PREVIEW = 9.0  # em


def draw(session: Session, look: Look) -> list[Action]:
    """Draw the settings of the export, or its progress."""
    project = session.project
    if project is None:
        return []
    settings = project.document.export
    actions: list[Action] = []
    chosen = _settings(look, project, settings)
    if chosen != settings:
        actions.append(do(exporting.set_export, chosen))
    _preview(look, project, settings)
    frames = exported_frames(project.document)
    count = frames.last - frames.first + 1
    small(look, f"Frames {frames.first} to {frames.last}, {count} in all")
    imgui.dummy(ImVec2(0, 0.2 * look.em))
    if session.export is not None or exporting.PREPARING in session.jobs.kinds:
        return actions + _progress(session)
    if main_button(look, f"{icons.ICON_FA_FILE_EXPORT}  Export…", -1):
        actions.append(do(exporting.ask))
    tip("Choose where to, and export", BINDINGS["export"].keys_in_words)
    if project.exported_to is not None:
        if imgui.button(f"Again into {project.exported_to.name}", ImVec2(-1, 0)):
            actions.append(do(exporting.repeat))
        tip(str(project.exported_to), BINDINGS["export again"].keys_in_words)
    return actions


def _settings(look: Look, project: Project, settings: ExportSettings) -> ExportSettings:
    heading(look, "What")
    label(look, "Format")
    if imgui.begin_combo("##format", FORMAT_NAMES[settings.format]):
        for format_ in EXPORT_FORMATS:
            if imgui.selectable(FORMAT_NAMES[format_], format_ == settings.format)[0]:
                settings = replace(settings, format=format_)
        imgui.end_combo()
    label(look, "Background")
    is_clear = settings.background == "transparent"
    match segments(
        look,
        "background",
        (("transparent", "Clear"), ("colour", "Colour")),
        "transparent" if is_clear else "colour",
    ):
        case "transparent":
            settings = replace(settings, background="transparent")
        case "colour":
            settings = replace(settings, background="#ffffff")
    if settings.background != "transparent":
        settings = _colour(look, settings)
    label(look, "Framing")
    match segments(look, "framing", FRAMINGS, settings.framing):
        case "canvas" | "fit" as framing:
            settings = replace(settings, framing=framing)
    return _size(look, project, settings)


def _colour(look: Look, settings: ExportSettings) -> ExportSettings:
    label(look, "Colour")
    values = [level / 255 for level in bytes.fromhex(settings.background[1:])]
    changed, values = imgui.color_edit3("##colour", values)
    if not changed:
        return settings
    code = "".join(f"{round(255 * min(max(value, 0.0), 1.0)):02x}" for value in values[:3])
    return replace(settings, background=f"#{code}")


def _size(look: Look, project: Project, settings: ExportSettings) -> ExportSettings:
    label(look, "Size")
    own = settings.size is None
    match segments(
        look, "size", (("own", "As drawn"), ("other", "Other")), "own" if own else "other"
    ):
        case "own":
            return replace(settings, size=None)
        case "other":
            return replace(settings, size=project.picture.size)
    if settings.size is not None:
        label(look, "Pixels")
        changed, size = imgui.input_int2("##pixels", list(settings.size))
        if changed and min(size[:2]) >= 1 and max(size[:2]) <= 65_535:
            return replace(settings, size=(size[0], size[1]))
    return settings


def _preview(look: Look, project: Project, settings: ExportSettings) -> None:
    """Draw the export's frame around the picture and all that moves."""
    if project.shown is None:
        return
    reach = box_around(project.shown.positions)
    view = frame_view(settings, project.picture.size, reach)
    half = complex(*view.size) / (2 * view.scale)
    frame = (view.centre - half, view.centre + half)
    canvas = (0j, complex(*project.picture.size))
    boxes = [frame, canvas, (reach.lower, reach.upper)]
    low = complex(min(b[0].real for b in boxes), min(b[0].imag for b in boxes))
    high = complex(max(b[1].real for b in boxes), max(b[1].imag for b in boxes))
    width, height = imgui.get_content_region_avail().x, PREVIEW * look.em
    corner = imgui.get_cursor_screen_pos()
    extent = high - low
    scale = 0.9 * min(width / extent.real, height / extent.imag)
    middle = (low + high) / 2

    def place(point: complex) -> ImVec2:
        offset = (point - middle) * scale
        return ImVec2(corner.x + width / 2 + offset.real, corner.y + height / 2 - offset.imag)

    palette, draw_list = look.palette, imgui.get_window_draw_list()

    def box(ends: tuple[complex, complex], colour: int, *, fill: bool) -> None:
        upper_left = place(complex(ends[0].real, ends[1].imag))
        lower_right = place(complex(ends[1].real, ends[0].imag))
        paint = draw_list.add_rect_filled if fill else draw_list.add_rect
        paint(upper_left, lower_right, colour)

    box(frame, ink(palette.desk), fill=True)
    box(canvas, ink(palette.dim, 0.5), fill=False)
    outline = project.shown.positions[: len(project.shown.figure.domain.outline)]
    for point in outline:
        draw_list.path_line_to(place(complex(point)))
    draw_list.path_stroke(ink(palette.dim), 1.2, imgui.ImDrawFlags_.closed)
    box((reach.lower, reach.upper), ink(palette.warning, 0.7), fill=False)
    box(frame, ink(palette.accent), fill=False)
    imgui.dummy(ImVec2(width, height))
    tip("Blue: the frame. Grey: the picture's canvas. Orange: where the motion reaches.")
    small(look, f"{view.size[0]} × {view.size[1]} pixels")


def _progress(session: Session) -> list[Action]:
    run = session.export
    if run is None:
        imgui.progress_bar(-0.5 * imgui.get_time(), ImVec2(-1, 0), "Preparing…")
    else:
        total = len(run.plan.times)
        imgui.progress_bar(run.done / total, ImVec2(-1, 0), f"{run.done} of {total}")
    return [do(exporting.cancel)] if imgui.button("Cancel", ImVec2(-1, 0)) else []
