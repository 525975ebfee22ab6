"""The tab of sounds: the list, and the settings of the selected one."""

from imgui_bundle import ImVec2, icons_fontawesome_6 as icons, imgui

from app.document import VOLUME, Channel, Document, Sound, sound_commands, value_at
from app.editor import Action, Project, Session, do
from app.editor.actions import editing, playback
from app.editor.actions.timing import sounds
from app.editor.actions.timing.channel_keys import set_channel_value
from app.errors import display_name
from app.texts import _
from app.ui.panels.key_diamond import diamond_room, draw_key_diamond
from app.ui.panels.sound.mouths import draw_mouths
from app.ui.shortcuts.widgets import draw_action_button
from app.ui.style.sliders import Scale, number_field, slider
from app.ui.style.theme import Look
from app.ui.style.widgets import (
    FILL,
    align_right,
    draw_tooltip,
    heading,
    label,
    option_buttons,
    small_text,
    split_line,
    text_button,
)

PERCENT = Scale(left=0, right=100)
MOST_ROWS = 6  # of the list without scrolling
MONO, STEREO = _("mono"), _("stereo")


def draw_sound_panel(session: Session, look: Look, project: Project) -> list[Action]:
    heading(look, _("Sounds"), framed=True)
    align_right(1.15 * imgui.get_frame_height())
    actions = draw_action_button(session, look, sounds.ask_sound_to_add)
    document, sound = project.document, sounds.selected_sound(project)
    if sound is None:
        small_text(
            look,
            _("Add a WAV, FLAC, MP3 or OGG file, or drop it on the window. It begins here."),
        )
        return actions
    actions += _list(look, document, sound)
    imgui.push_id(sound.name)
    actions += _time(look, document, sound)
    actions += _volume(look, document, sound, playback.current_frame(session, project))
    actions += _file(look, sound)
    actions += draw_mouths(session, look, project, sound)
    imgui.pop_id()
    return actions


def _list(look: Look, document: Document, chosen: Sound) -> list[Action]:
    actions: list[Action] = []
    rows = min(len(document.sounds), MOST_ROWS)
    height = rows * imgui.get_text_line_height_with_spacing() + 0.5 * look.em
    if imgui.begin_list_box("##sounds", ImVec2(FILL, height)):
        for sound in document.sounds:
            icon = icons.ICON_FA_VOLUME_XMARK if sound.muted else icons.ICON_FA_VOLUME_HIGH
            text = f"{icon}  {display_name(sound.name)}###{sound.name}"
            if imgui.selectable(text, sound is chosen)[0]:
                actions.append(do(sounds.select_sound, sound.name))
            imgui.same_line(imgui.get_content_region_avail().x - 3.5 * look.em)
            imgui.text_disabled(f"{sound.length:.1f} s")
        imgui.end_list_box()
    return actions


def _time(look: Look, document: Document, sound: Sound) -> list[Action]:
    """Draw the beginning, in frames and seconds, and the cuts."""
    actions: list[Action] = []
    label(look, _("Name"))
    _entered, name = imgui.input_text("##name", sound.name)
    if imgui.is_item_deactivated_after_edit() and name.strip() not in {"", sound.name}:
        command = sound_commands.rename_sound(sound.name, name)
        actions += [do(editing.edit_document, command), do(sounds.select_sound, name.strip())]
    fps = document.fps
    label(look, _("Begins"))
    widths = split_line(2, imgui.get_style().item_inner_spacing.x)
    for (field, value, text, factor, hint), width in zip(
        (
            ("start", sound.start, _("frame") + " %.6g", 1.0, _("Frame at which it begins")),
            ("seconds", sound.start / fps, "%.3f s", fps, _("Time at which it begins")),
        ),
        widths,
        strict=True,
    ):
        imgui.set_next_item_width(width)
        entered = number_field(field, value, text)
        draw_tooltip(hint)
        if entered is not None:
            command = sound_commands.move_sound(sound.name, entered * factor)
            actions.append(do(editing.edit_document, command))
    label(look, _("Part"))
    widths = split_line(2, imgui.get_style().item_inner_spacing.x)
    ends = {"from": sound.skip, "to": sound.skip + sound.length}
    hints = {
        "from": _("Seconds of the file that are cut at the beginning"),
        "to": _("The end of the part that is heard, in seconds of the file"),
    }
    for field, width in zip(list(ends), widths, strict=True):
        imgui.set_next_item_width(width)
        entered = number_field(field, ends[field], "%.3f s")
        draw_tooltip(hints[field])
        if entered is not None:
            cut = {**ends, field: entered}
            command = sound_commands.cut_sound(sound.name, cut["from"], cut["to"] - cut["from"])
            actions.append(do(editing.edit_document, command))
    return actions


def _volume(look: Look, document: Document, sound: Sound, frame: int) -> list[Action]:
    actions: list[Action] = []
    channel = Channel(VOLUME, part=sound.name)
    label(look, _("Volume"))
    hint = (
        _("A change sets a key at this frame.")
        if sound.keys
        else _("It is the same in all frames until you set a key.")
    )
    shown = 100 * value_at(document, channel, frame)
    room = diamond_room(look)
    moved = slider(look, "volume", shown, PERCENT, text="%.0f %%", hint=hint, room=room)
    actions += draw_key_diamond(document, look, channel, frame)
    if moved is not None:
        value = min(max(moved.value / 100, 0.0), 1.0)
        actions.append(
            do(set_channel_value, channel, value)
            if sound.keys
            else do(editing.edit_document, sound_commands.set_volume(sound.name, value))
        )
    label(look, _("Heard"))
    options = (("on", _("On")), ("muted", _("Muted")))
    chosen = option_buttons(look, "muted", options, "muted" if sound.muted else "on")
    if chosen is not None:
        command = sound_commands.mute_sound(sound.name, muted=chosen == "muted")
        actions.append(do(editing.edit_document, command))
    return actions


def _file(look: Look, sound: Sound) -> list[Action]:
    file, actions = sound.file, list[Action]()
    channels = {1: MONO, 2: STEREO}.get(file.channels, _("{count} channels"))
    text = _("{name}: {seconds:.2f} s, {rate:g} kHz, {channels}. {size:,.0f} KB in the project.")
    small_text(
        look,
        text.format(
            name=file.name,
            seconds=file.seconds,
            rate=file.rate / 1000,
            channels=channels.format(count=file.channels),
            size=file.size / 1000,
        ),
    )
    if file.data is None:
        text = _("{name} is missing, and the sound is silent. Find the file again.")
        small_text(look, text.format(name=file.name), look.palette.danger)
    widths = split_line(2)
    hint = _("Find a missing file, or choose another")
    if text_button(f"{_('Find file…')}###find", next(widths), hint):
        actions.append(do(sounds.ask_sound_file, sound.name))
    if text_button(f"{_('Delete sound')}###delete", next(widths), _("Delete the sound")):
        actions.append(do(editing.edit_document, sound_commands.delete_sound(sound.name)))
    return actions
