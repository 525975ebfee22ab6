"""The footage of a layer: its file, and how it plays from the present frame on."""

from dataclasses import replace

from imgui_bundle import imgui

from app.document import (
    FOOTAGE_TIME,
    MAX_FOOTAGE_SPEED,
    Channel,
    Layer,
    value_at,
)
from app.editor import Action, Project, do
from app.editor.actions.timing.channel_keys import set_channel_value
from app.editor.layering.footage import ask_footage_files, reload_footage
from app.texts import _, ngettext
from app.ui.panels.key_diamond import diamond_room, draw_key_diamond
from app.ui.style.sliders import number_field
from app.ui.style.theme import Look
from app.ui.style.widgets import FILL, draw_tooltip, label, small_text, text_button


def draw_footage(project: Project, look: Look, layer: Layer, frame: int) -> list[Action]:
    """Draw what a layer with footage shows at a frame. A change makes a key there."""
    footage = layer.footage
    if footage is None:
        return []
    actions: list[Action] = []
    channel = Channel(FOOTAGE_TIME, layer.id)
    time = value_at(project.document, channel, frame)
    gap, room = imgui.get_style().item_inner_spacing.x, diamond_room(look)
    label(look, _("Footage"))
    width = (imgui.get_content_region_avail().x - room - gap) / 2
    imgui.set_next_item_width(width)
    shown = footage.picture_of(time.start)
    start = number_field("footage frame", time.start, "%.5g")
    draw_tooltip(_("Frame of the footage that shows here, from 0. A change sets a key."))
    imgui.same_line(0, gap)
    imgui.set_next_item_width(width)
    speed = number_field("footage speed", 100 * time.speed, "%.4g %%")
    draw_tooltip(_("Speed from here on. 0 % holds the frame, −100 % plays backwards."))
    actions += draw_key_diamond(project.document, look, channel, frame)
    label(look, "")
    changed, loops = imgui.checkbox(_("Loop"), time.loops)
    draw_tooltip(_("Begin again at the end. Otherwise the last frame holds."))
    new = time
    if start is not None:
        new = replace(new, start=min(max(start, 0.0), footage.frame_count - 1.0))
    if speed is not None:
        new = replace(new, speed=min(max(speed / 100, -MAX_FOOTAGE_SPEED), MAX_FOOTAGE_SPEED))
    if changed:
        new = replace(new, loops=loops)
    if new != time:
        actions.append(do(set_channel_value, channel, new))
    text = ngettext(
        "{name}: {count:,} picture, {fps:.4g} frames a second. Picture {shown:,} shows.",
        "{name}: {count:,} pictures, {fps:.4g} frames a second. Picture {shown:,} shows.",
        footage.picture_count,
    )
    known = {"name": footage.name, "count": footage.picture_count, "fps": footage.fps}
    small_text(look, text.format(**known, shown=shown + 1))
    error = project.footage.errors.get(footage)
    if error is not None:
        small_text(look, str(error))
        if text_button(_("Find footage…"), FILL, _("Choose the file, or one of the pictures")):
            actions.append(do(ask_footage_files, layer.id))
    if text_button(_("Reload footage"), FILL, _("Read the files again, and look for new pictures")):
        actions.append(do(reload_footage, layer.id))
    return actions
