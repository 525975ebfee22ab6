"""The frames of an export: their range, how often they play, and how fast."""

from dataclasses import replace

from imgui_bundle import imgui

from app.document import (
    LARGEST_EXPORT_SPEED,
    MOST_EXPORT_REPEATS,
    ExportSettings,
    FrameRange,
    export_frame_range,
)
from app.editor import Project
from app.export import export_times
from app.export_formats import EXPORT_FORMATS
from app.texts import _, ngettext
from app.ui.style.theme import Look
from app.ui.style.widgets import (
    FILL,
    draw_tooltip,
    label,
    option_buttons,
    small_text,
    split_line,
)

RANGES = (("all", _("All frames")), ("own", _("From – to")))


def draw_frame_settings(look: Look, project: Project, settings: ExportSettings) -> ExportSettings:
    """Draw the range of the frames, how often they play, and how fast."""
    document = project.document
    frames = export_frame_range(document)
    label(look, _("Range"))
    match option_buttons(look, "range", RANGES, "all" if settings.frames is None else "own"):
        case "all":
            settings = replace(settings, frames=None)
        case "own":
            settings = replace(settings, frames=frames)
    label(look, _("First, last"))
    imgui.begin_disabled(settings.frames is None)
    ends = []
    widths = split_line(2, imgui.get_style().item_inner_spacing.x)
    both = zip(("first", "last"), (frames.first, frames.last), widths, strict=True)
    for name, frame, width in both:
        imgui.set_next_item_width(width)
        entered = imgui.input_int(f"##{name} frame", frame, 0)[1]
        done = imgui.is_item_deactivated_after_edit()
        ends.append(document.frames.clamp(entered) if done else frame)
    imgui.end_disabled()
    if settings.frames is not None and ends != [frames.first, frames.last]:
        first, last = sorted(ends)
        settings = replace(settings, frames=FrameRange(first, last))
    settings = _repeat_and_speed(look, settings)
    count, rate = len(export_times(document, settings)), document.fps
    is_drawn = EXPORT_FORMATS[settings.format].is_drawn
    seconds = count / rate if is_drawn else (frames.last - frames.first) / rate / settings.speed
    text = (
        ngettext(
            "{count} picture, {time:.1f} s at {rate:g} fps",
            "{count} pictures, {time:.1f} s at {rate:g} fps",
            count,
        )
        if is_drawn
        else _("{time:.1f} s, at every frame rate")
    )
    small_text(look, text.format(count=count, time=seconds, rate=rate))
    return settings


def _repeat_and_speed(look: Look, settings: ExportSettings) -> ExportSettings:
    """Draw how often the frames play, if they are pictures, and how fast."""
    label(look, _("Repeat"))
    is_drawn = EXPORT_FORMATS[settings.format].is_drawn
    imgui.begin_disabled(not is_drawn)
    imgui.set_next_item_width(FILL)
    repeat = imgui.input_int("##repeat", settings.repeat if is_drawn else 1, 0)[1]
    has_repeat = imgui.is_item_deactivated_after_edit()
    draw_tooltip(_("How often the frames play in the file"))
    imgui.end_disabled()
    label(look, _("Speed"))
    imgui.set_next_item_width(FILL)
    speed = imgui.input_float("##speed", 100 * settings.speed, 0.0, 0.0, "%.3g %%")[1] / 100
    has_speed = imgui.is_item_deactivated_after_edit()
    draw_tooltip(_("Speed of the motion. Slower motion has more pictures, and no sound."))
    if has_repeat:
        settings = replace(settings, repeat=min(max(repeat, 1), MOST_EXPORT_REPEATS))
    if has_speed:
        least = 1 / LARGEST_EXPORT_SPEED
        settings = replace(settings, speed=min(max(speed, least), LARGEST_EXPORT_SPEED))
    return settings
