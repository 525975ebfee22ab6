"""The export panel: settings, file, and progress."""

from dataclasses import replace

from imgui_bundle import ImVec2, icons_fontawesome_6 as icons, imgui

from app.document import ExportSettings, FrameRange, export_frame_range, scene_commands
from app.editor import Action, Project, Session, do
from app.editor.actions import editing
from app.editor.actions.project_files import export_settings, exporting
from app.errors import LIBRARIES, LissomError, display_name, install_hint
from app.export import find_shown_box, frame_view
from app.export_formats import EXPORT_FORMATS
from app.motion import BoundingBox, bounding_box, extent_key
from app.render import View
from app.ui.panels.format_options import draw_format_options
from app.ui.panels.sizes import LARGEST, draw_size_fields
from app.ui.shortcuts.table import BINDINGS
from app.ui.style.theme import SMALL, Look, colour_u32, rgb
from app.ui.style.widgets import (
    FILL,
    colour_field,
    draw_tooltip,
    heading,
    icon_button,
    label,
    main_button,
    option_buttons,
    progress_bar,
    push_text_size,
    small_text,
    split_line,
    text_button,
)

BACKGROUNDS = (("transparent", "Transparent"), ("colour", "Colour"))
FRAMINGS = (("fit", "All motion"), ("canvas", "Canvas"))
RANGES = (("all", "All frames"), ("own", "From – to"))
WHITE = "#ffffff"
MEASURES = "Measuring where the motion reaches…"
LEAVES = "The motion leaves the frame; “All motion” shows all of it."
CAMERA_HINT = "Each frame is what the camera shows then."
KEEPS = "All of the motion is in the frame."
PREVIEW, LARGEST_PREVIEW = 3.2, 6.0  # em: smallest and largest height


def draw_export_panel(session: Session, look: Look, project: Project) -> list[Action]:
    """Draw the settings of the export with a preview of its frame, or its progress."""
    if project.layer_runtime.shown is None:
        return []
    settings = project.document.export
    motion = project.extent.value or bounding_box(project.layer_runtime.shown.positions)
    view = frame_view(settings, project.document, motion)
    box = find_shown_box(view)
    # The camera's frame is always visible.
    actions = [] if project.document.camera else [do(export_settings.preview_export_frame, box)]
    heading(look, "Picture")
    chosen = _format(look, settings)
    if EXPORT_FORMATS[settings.format].has_frame:
        chosen = _picture(look, project, chosen)
        chosen, more = _size(session, look, chosen, view)
        actions += more
        if settings.framing == "canvas" or project.document.camera:
            actions += _canvas(look, project)
    chosen = _details(look, chosen)
    if not project.document.camera:
        _preview(look, project, settings, box, motion)
    heading(look, "Frames")
    if EXPORT_FORMATS[settings.format].is_still:
        now = project.playhead.frame_at(project.document, session.clock())
        small_text(look, f"Frame {now}, where the playhead is, with its pose as it is shown.")
    else:
        chosen = _frames(look, project, chosen)
    if chosen != settings:
        actions.append(do(export_settings.set_export_settings, chosen))
    heading(look, "Output")
    return actions + _output(session, look, project)


def _format(look: Look, settings: ExportSettings) -> ExportSettings:
    """Draw the formats in groups, each with its use."""
    label(look, "Format")
    now = EXPORT_FORMATS[settings.format]
    if imgui.begin_combo("##format", now.label, imgui.ComboFlags_.height_largest):
        group = ""
        for name, format_ in EXPORT_FORMATS.items():
            if format_.group != group:
                group = format_.group
                imgui.separator_text(group)
            if imgui.selectable(format_.label, name == settings.format)[0]:
                settings = _with_format(settings, name)
            imgui.indent()
            small_text(look, format_.use)
            imgui.unindent()
        imgui.end_combo()
    look.note_place("format")
    draw_tooltip(now.use)
    if now.extra and (remedy := install_hint(now.extra)):
        small_text(look, f"It needs {LIBRARIES[now.extra]}: {remedy}")
    return settings


def _picture(look: Look, project: Project, settings: ExportSettings) -> ExportSettings:
    label(look, "Background")
    settings = _background(look, settings)
    if project.document.camera:
        small_text(look, CAMERA_HINT)
        return settings
    label(look, "Framing")
    match option_buttons(look, "framing", FRAMINGS, settings.framing):
        case "canvas" | "fit" as framing:
            settings = replace(settings, framing=framing)
    return settings


def _details(look: Look, settings: ExportSettings) -> ExportSettings:
    """Draw the settings of single formats."""
    format_ = EXPORT_FORMATS[settings.format]
    if not format_.suffixes:
        settings = _names(look, settings)
    if format_.options:
        options = draw_format_options(look, settings.options()[format_.options])
        settings = replace(settings, **{format_.options: options})
    return settings


def _names(look: Look, settings: ExportSettings) -> ExportSettings:
    label(look, "File names")
    _, names = imgui.input_text("##names", settings.names)
    done = imgui.is_item_deactivated_after_edit()
    draw_tooltip("One # for each digit of a frame's number; {name} is the project's name")
    try:
        entered = replace(settings, names=names) if names else settings
    except LissomError as error:
        # The error is visible during typing. Afterwards the field shows the valid value again.
        small_text(look, str(error), look.palette.danger)
        return settings
    return entered if done else settings


def _with_format(settings: ExportSettings, name: str) -> ExportSettings:
    chosen = settings.in_format(name)
    lacks_one = chosen.background == "transparent" and not EXPORT_FORMATS[name].is_transparent
    return replace(chosen, background=WHITE) if lacks_one else chosen


def _background(look: Look, settings: ExportSettings) -> ExportSettings:
    is_clear = settings.background == "transparent"
    size = 0.0 if is_clear else imgui.get_frame_height() + imgui.get_style().item_inner_spacing.x
    format_ = EXPORT_FORMATS[settings.format]
    imgui.begin_disabled(not format_.is_transparent and not is_clear)
    chosen = option_buttons(
        look, "background", BACKGROUNDS, "transparent" if is_clear else "colour", room=size
    )
    imgui.end_disabled()
    if not format_.is_transparent:
        draw_tooltip(f"{format_.label} has no transparency")
    match chosen:
        case "transparent":
            return replace(settings, background="transparent")
        case "colour":
            return replace(settings, background=WHITE)
    if is_clear:
        return settings
    imgui.same_line(0, imgui.get_style().item_inner_spacing.x)
    colour = colour_field("colour", settings.background, imgui.ColorEditFlags_.no_inputs)
    return replace(settings, background=colour or settings.background)


def _size(
    session: Session, look: Look, settings: ExportSettings, view: View
) -> tuple[ExportSettings, list[Action]]:
    """Draw width and height, a lock of their ratio, and a reset to the drawing's size."""
    actions: list[Action] = []
    label(look, "Size")
    gap = imgui.get_style().item_inner_spacing.x
    room = 2 * (1.15 * imgui.get_frame_height() + gap)
    entered = draw_size_fields("", view.size, room)
    imgui.same_line(0, gap)
    keeps = session.is_aspect_locked
    icon = icons.ICON_FA_LOCK if keeps else icons.ICON_FA_LOCK_OPEN
    if icon_button(look, icon, "keep ratio", "Keep the ratio of width and height", active=keeps):
        actions.append(do(export_settings.set_aspect_locked, not keeps))
    imgui.same_line(0, gap)
    if icon_button(
        look,
        icons.ICON_FA_ARROW_ROTATE_LEFT,
        "own size",
        "Back to the size of the drawing",
        enabled=settings.size is not None,
    ):
        return replace(settings, size=None), actions
    if entered is None or entered.size == view.size:
        return settings, actions
    (wide, high), (width, height) = entered.size, view.size
    if keeps and entered.by_width:
        high = min(max(round(wide * height / width), 1), LARGEST)
    elif keeps:
        wide = min(max(round(high * width / height), 1), LARGEST)
    return replace(settings, size=(wide, high)), actions


def _canvas(look: Look, project: Project) -> list[Action]:
    """Draw the size of the canvas, whose origin is fixed, and a reset to the picture's size."""
    document = project.document
    label(look, "Canvas")
    gap = imgui.get_style().item_inner_spacing.x
    entered = draw_size_fields("canvas ", document.canvas, 1.15 * imgui.get_frame_height() + gap)
    imgui.same_line(0, gap)
    hint = "Back to the size of the picture behind all others"
    is_own = document.canvas != document.layers[0].picture.size
    if icon_button(look, icons.ICON_FA_ARROW_ROTATE_LEFT, "canvas size", hint, enabled=is_own):
        return [
            do(editing.edit_document, scene_commands.set_canvas(document.layers[0].picture.size))
        ]
    if entered is None or entered.size == document.canvas:
        return []
    return [do(editing.edit_document, scene_commands.set_canvas(entered.size))]


def _frames(look: Look, project: Project, settings: ExportSettings) -> ExportSettings:
    document = project.document
    frames = export_frame_range(document)
    label(look, "Range")
    match option_buttons(look, "range", RANGES, "all" if settings.frames is None else "own"):
        case "all":
            settings = replace(settings, frames=None)
        case "own":
            settings = replace(settings, frames=frames)
    label(look, "First, last")
    imgui.begin_disabled(settings.frames is None)
    ends = []
    widths = split_line(2, imgui.get_style().item_inner_spacing.x)
    both = zip(("first", "last"), (frames.first, frames.last), widths, strict=True)
    for name, frame, width in both:
        imgui.set_next_item_width(width)
        _, entered = imgui.input_int(f"##{name} frame", frame, 0)
        done = imgui.is_item_deactivated_after_edit()
        ends.append(document.frames.clamp(entered) if done else frame)
    imgui.end_disabled()
    if settings.frames is not None and ends != [frames.first, frames.last]:
        first, last = sorted(ends)
        settings = replace(settings, frames=FrameRange(first, last))
    count = frames.last - frames.first + 1
    text = "1 picture" if count == 1 else f"{count} pictures"
    if EXPORT_FORMATS[settings.format].is_drawn:
        small_text(look, f"{text}, {count / document.fps:.1f} s at {document.fps:g} fps")
    else:
        small_text(look, f"{count / document.fps:.1f} s, at any rate")
    return settings


def _output(session: Session, look: Look, project: Project) -> list[Action]:
    actions: list[Action] = []
    out = export_settings.export_destination(project)
    label(look, "File" if EXPORT_FORMATS[project.document.export.format].suffixes else "Folder")
    button = 1.15 * imgui.get_frame_height()
    gap = imgui.get_style().item_inner_spacing.x
    imgui.set_next_item_width(imgui.get_content_region_avail().x - button - gap)
    imgui.begin_disabled(True)  # noqa: FBT003 - chosen by the button beside it
    imgui.input_text("##out", display_name(out.name) if out else "not chosen yet")
    imgui.end_disabled()
    draw_tooltip(display_name(out) if out else "Choose where to")
    imgui.same_line(0, gap)
    if icon_button(look, icons.ICON_FA_FOLDER_OPEN, "choose output", "Choose where to…"):
        actions.append(do(export_settings.ask_export_destination))
    run = session.export
    if exporting.is_export_under_way(session):
        # A negative share animates the bar without a value.
        share, text = -0.5 * imgui.get_time(), "Preparing…"
        if run is not None:
            total = len(run.plan.times)
            share = run.done / total
            text = f"{run.done} of {total}" if run.done < total else "Finishing…"
        return [*actions, do(exporting.cancel_export)] if progress_bar(share, text) else actions
    if main_button(look, f"{icons.ICON_FA_FILE_EXPORT}  Export###start", FILL):
        actions.append(do(export_settings.repeat_export))
    look.note_place("start export")
    draw_tooltip("Export now", BINDINGS["export again"].shown_keys)
    if EXPORT_FORMATS[project.document.export.format].is_still:
        text, hint = f"{icons.ICON_FA_COPY}  Copy###copy", "Put the picture on the clipboard"
        if text_button(text, FILL, hint, BINDINGS["copy picture"].shown_keys):
            actions.append(do(exporting.copy_picture))
    return actions


def _preview_height(look: Look) -> float:
    """Return the height of the preview with which the button below fits the panel."""
    spacing, line = imgui.get_style().item_spacing.y, imgui.get_text_line_height()
    below = 4 * imgui.get_frame_height() + 3 * line + 0.6 * look.em + 10 * spacing
    room = imgui.get_content_region_avail().y - below
    return min(max(room, PREVIEW * look.em), LARGEST_PREVIEW * look.em)


def _preview(
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
        "Blue: what the export shows, as in the viewport. Grey: the picture's canvas.\n"
        "Orange: where the motion reaches."
    )
    is_known = project.extent.follows(extent_key(project.document))
    if not is_known and not project.extent.has_failed(extent_key(project.document)):
        note = MEASURES
    else:
        note = LEAVES if not frame.contains(motion, slack=1.0) else KEEPS
    _note(look, note)


def _note(look: Look, text: str) -> None:
    """Write a note, with the height of the longest note."""
    width, notes = imgui.get_content_region_avail().x, (MEASURES, LEAVES, KEEPS)
    with push_text_size(SMALL):
        room = max(imgui.calc_text_size(note, wrap_width=width).y for note in notes)
    top = imgui.get_cursor_pos_y()
    small_text(look, text)
    imgui.set_cursor_pos_y(top + room + imgui.get_style().item_spacing.y)
    imgui.dummy(ImVec2(0, 0))
