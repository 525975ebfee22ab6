"""The export panel: settings, file, and progress."""

from dataclasses import replace

from imgui_bundle import icons_fontawesome_6 as icons, imgui

from app.document import ExportSettings, scene_commands
from app.editor import Action, Project, Session, do, pending_changes
from app.editor.actions import editing
from app.editor.actions.project_files import export_settings, exporting
from app.editor.actions.timing import keys
from app.errors import LIBRARIES, LissomError, display_name, install_hint
from app.export import find_shown_box, frame_view
from app.export_formats import EXPORT_FORMATS
from app.motion import bounding_box
from app.render import View
from app.texts import _, message_of
from app.ui.panels.export_settings.format_options import draw_format_options
from app.ui.panels.export_settings.frames import draw_frame_settings
from app.ui.panels.export_settings.preview import draw_export_preview
from app.ui.panels.export_settings.sizes import LARGEST, draw_side, side_width
from app.ui.panels.export_settings.sound import draw_sound_option
from app.ui.shortcuts.keys import shown_keys
from app.ui.style.theme import Look
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
    small_text,
    text_button,
)

BACKGROUNDS = (("transparent", _("Transparent")), ("colour", _("Colour")))
FRAMINGS = (("fit", _("All motion")), ("canvas", _("Canvas")))
PLAYS = (("once", _("Once")), ("for ever", _("For ever")))
CROSS = "×"
WHITE, USES = "#ffffff", 26.0  # the latter in em: width of the list of formats


def draw_export_panel(session: Session, look: Look, project: Project) -> list[Action]:
    """Draw the settings of the export with a preview of its frame, or its progress."""
    if project.layer_runtime.shown is None:
        return []
    settings = project.document.export
    motion = project.measured.extent.value or bounding_box(project.layer_runtime.shown.positions)
    view = frame_view(settings, project.document, motion)
    box = find_shown_box(view)
    # The camera's frame is always visible.
    actions = [] if project.document.camera else [do(export_settings.preview_export_frame, box)]
    heading(look, _("Output"))
    chosen = _format(look, settings)
    # Above the settings, so that a small window shows the button, too.
    actions += _output(session, look, project)
    heading(look, _("Picture"))
    if EXPORT_FORMATS[settings.format].has_frame:
        chosen = _picture(look, project, chosen)
        chosen, more = _size(session, look, chosen, view)
        actions += more
        if settings.framing == "canvas" or project.document.camera:
            actions += _canvas(look, project)
    chosen = draw_sound_option(look, project.document, _details(look, chosen))
    if not project.document.camera:
        draw_export_preview(look, project, settings, box, motion)
    heading(look, _("Frames"))
    if EXPORT_FORMATS[settings.format].is_still:
        now = project.timeline.playhead.frame_at(project.document, session.clock())
        text = _("Frame {frame}, at the playhead, with the pose as it is shown.")
        small_text(look, text.format(frame=now))
    else:
        if EXPORT_FORMATS[settings.format].plays_on:
            actions += _plays(look, project)
        chosen = draw_frame_settings(look, project, chosen)
    if chosen != settings:
        actions.append(do(editing.edit_document, scene_commands.set_export(chosen)))
    return actions


def _plays(look: Look, project: Project) -> list[Action]:
    """Draw whether the file plays once or for ever, as the timeline does."""
    label(look, _("Plays"))
    now = "for ever" if project.document.loop else "once"
    chosen = option_buttons(look, "plays", PLAYS, now)
    draw_tooltip(_("The timeline plays in the same way"), shown_keys(keys.toggle_loop))
    return [do(keys.toggle_loop)] if chosen else []


def _format(look: Look, settings: ExportSettings) -> ExportSettings:
    """Draw the formats in groups, each with its use."""
    label(look, _("Format"))
    now = EXPORT_FORMATS[settings.format]
    width = USES * look.em
    imgui.set_next_window_size_constraints((width, 0), (width, imgui.FLT_MAX))
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
        text = _("This format needs {library}: {remedy}")
        small_text(look, text.format(library=LIBRARIES[now.extra], remedy=remedy))
    return settings


def _picture(look: Look, project: Project, settings: ExportSettings) -> ExportSettings:
    label(look, _("Background"))
    settings = _background(look, settings)
    if project.document.camera:
        small_text(look, _("Each frame shows the camera's view."))
        return settings
    label(look, _("Framing"))
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
    label(look, _("File names"))
    names = imgui.input_text("##names", settings.names)[1]
    done = imgui.is_item_deactivated_after_edit()
    draw_tooltip(_("One # for each digit of a frame's number; {name} is the project's name"))
    try:
        entered = replace(settings, names=names) if names else settings
    except LissomError as error:
        # The error is visible during typing. Afterwards the field shows the valid value again.
        small_text(look, message_of(error), look.palette.danger)
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
        draw_tooltip(_("{format} has no transparency").format(format=format_.label))
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
    label(look, _("Size"))
    gap, room = imgui.get_style().item_inner_spacing.x, 1.15 * imgui.get_frame_height()
    keeps, each = session.export.is_aspect_locked, side_width(room, room + gap)
    width, height = view.size
    wide, by_width = draw_side("width", width, each)
    imgui.same_line(0, gap)
    icon = icons.ICON_FA_LOCK if keeps else icons.ICON_FA_LOCK_OPEN
    if icon_button(look, icon, "keep ratio", _("Keep proportions"), active=keeps):
        actions.append(do(export_settings.set_aspect_locked, not keeps))
    imgui.same_line(0, gap)
    high, by_height = draw_side("height", height, each)
    imgui.same_line(0, gap)
    if icon_button(
        look,
        icons.ICON_FA_ARROW_ROTATE_LEFT,
        "own size",
        _("Reset to the size of the drawing"),
        reason=_("It already has the size of the drawing.") if settings.size is None else None,
    ):
        return replace(settings, size=None), actions
    if not (by_width or by_height) or (wide, high) == view.size:
        return settings, actions
    if keeps and by_width:
        high = min(max(round(wide * height / width), 1), LARGEST)
    elif keeps:
        wide = min(max(round(high * width / height), 1), LARGEST)
    return replace(settings, size=(wide, high)), actions


def _canvas(look: Look, project: Project) -> list[Action]:
    """Draw the size of the canvas, whose origin is fixed, and a reset to the picture's size."""
    document = project.document
    label(look, _("Canvas"))
    gap, (width, height) = imgui.get_style().item_inner_spacing.x, document.canvas
    room = 1.15 * imgui.get_frame_height() + gap
    each = side_width(imgui.calc_text_size(CROSS).x, room)
    wide, by_width = draw_side("width", width, each, name="canvas ")
    imgui.same_line(0, gap)
    imgui.text_disabled(CROSS)
    imgui.same_line(0, gap)
    high, by_height = draw_side("height", height, each, name="canvas ")
    imgui.same_line(0, gap)
    hint = _("Reset to the size of the backmost picture")
    is_own = document.canvas != document.layers[0].picture.size
    reason = None if is_own else _("It already has the size of that picture.")
    if icon_button(look, icons.ICON_FA_ARROW_ROTATE_LEFT, "canvas size", hint, reason=reason):
        return [
            do(editing.edit_document, scene_commands.set_canvas(document.layers[0].picture.size))
        ]
    if not (by_width or by_height) or (wide, high) == document.canvas:
        return []
    return [do(editing.edit_document, scene_commands.set_canvas((wide, high)))]


def _preparing(session: Session, project: Project) -> tuple[float, str]:
    """Return how far an export is prepared, or what it waits for, with a share for the bar."""
    share = session.jobs.share_of(exporting.PREPARING)
    waiting = pending_changes.pending_label(project)
    if share is not None:
        return share, _("Preparing… {share:.0%}").format(share=share)
    # A negative share animates the bar without a value.
    return -0.5 * imgui.get_time(), _("{job}…").format(job=waiting) if waiting else _("Preparing…")


def _output(session: Session, look: Look, project: Project) -> list[Action]:
    actions: list[Action] = []
    out = export_settings.export_destination(project)
    label(
        look, _("File") if EXPORT_FORMATS[project.document.export.format].suffixes else _("Folder")
    )
    button = 1.15 * imgui.get_frame_height()
    gap = imgui.get_style().item_inner_spacing.x
    imgui.set_next_item_width(imgui.get_content_region_avail().x - button - gap)
    imgui.begin_disabled(True)  # noqa: FBT003 - chosen by the button beside it
    imgui.input_text("##out", display_name(out.name) if out else _("not chosen yet"))
    imgui.end_disabled()
    draw_tooltip(display_name(out) if out else _("Choose the output"))
    imgui.same_line(0, gap)
    if icon_button(look, icons.ICON_FA_FOLDER_OPEN, "choose output", _("Choose the output…")):
        actions.append(do(export_settings.ask_export_destination))
    run = session.export.run
    if exporting.is_export_under_way(session):
        share, text = _preparing(session, project)
        if run is not None:
            total = len(run.plan.times)
            share = run.done / total
            text = (
                _("{done} of {total}").format(done=run.done, total=total)
                if run.done < total
                else _("Finishing…")
            )
        return [*actions, do(exporting.cancel_export)] if progress_bar(share, text) else actions
    if main_button(look, f"{icons.ICON_FA_FILE_EXPORT}  {_('Export')}###start", FILL):
        actions.append(do(export_settings.repeat_export))
    look.note_place("start export")
    draw_tooltip(_("Export with these settings"), shown_keys(export_settings.repeat_export))
    if EXPORT_FORMATS[project.document.export.format].is_still:
        text, hint = (
            f"{icons.ICON_FA_COPY}  {_('Copy')}###copy",
            _("Copy the picture to the clipboard"),
        )
        if text_button(text, FILL, hint, shown_keys(exporting.copy_picture)):
            actions.append(do(exporting.copy_picture))
    return actions
