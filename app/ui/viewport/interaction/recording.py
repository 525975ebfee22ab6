"""Tracks in the viewport: keys on a path, and the bar after a recorded drag."""

from imgui_bundle import ImVec2, imgui, imgui_ctx

from app.editor import Action, Project, Session, do
from app.editor.actions.tracking.recording import (
    accept_recording,
    retry_recording,
    smooth_recording,
)
from app.texts import _, ngettext
from app.ui.style.theme import Look, colour_u32
from app.ui.style.widgets import draw_tooltip, is_hovered_or_held, is_pressed
from app.ui.viewport.paths import find_path_keys
from app.ui.viewport.screen import ScreenMapping

KEY_GRIP = 0.5  # em: radius within which a key on a path is grabbed
SLIDER, PADDING = 11.0, 0.6  # em


def add_track_key_gizmos(
    session: Session, look: Look, screen: ScreenMapping
) -> tuple[int | None, bool]:
    """Lay a button over each key on the path of the selected track.

    Returns
    -------
    frame : int or None
        The frame of the key under the pointer.
    pressed : bool
        Whether a key was pressed.
    """
    hovered, pressed = None, False
    if not session.tools.is_posing or screen.project.timeline.playhead.since is not None:
        return hovered, pressed
    radius = ImVec2(KEY_GRIP * look.em, KEY_GRIP * look.em)
    for frame, place in find_path_keys(screen.project):
        (centre,) = screen.points(place)
        imgui.set_cursor_screen_pos(centre - radius)
        imgui.invisible_button(f"key of track {frame}", radius * 2)
        if is_hovered_or_held():
            hovered = frame
        pressed = pressed or is_pressed()
    return hovered, pressed


def draw_recording_bar(look: Look, project: Project, corner: ImVec2) -> list[Action]:
    """Draw the bar of a recorded drag, until the person keeps or discards it."""
    take = project.timeline.recording
    if take is None or not take.is_over:
        return []
    actions: list[Action] = []
    draw_list, em = imgui.get_window_draw_list(), look.em
    name = project.layer.handle(take.handle).name
    track = project.layer.track_of(take.handle)
    count = 0 if track is None or not take.is_written else len(track.keys)
    text = ngettext("{handle}: {count} key", "{handle}: {count} keys", count)
    text = text.format(handle=name, count=count) if count else f"{name}…"
    imgui.set_cursor_screen_pos(corner + ImVec2(1.5 * em, 1.5 * em))
    draw_list.channels_split(2)
    draw_list.channels_set_current(1)
    with imgui_ctx.begin_group():
        imgui.align_text_to_frame_padding()
        imgui.text_unformatted(text)
        imgui.same_line()
        imgui.set_next_item_width(SLIDER * em)
        changed, percent = imgui.slider_int(
            "##smoothing", round(100 * take.smoothing), 0, 100, _("Smoothing") + " %d%%"
        )
        draw_tooltip(
            _("How far the motion may leave the recorded drag: more smoothing makes fewer keys")
        )
        if changed:
            actions.append(do(smooth_recording, min(max(percent, 0), 100) / 100))
        imgui.same_line()
        if imgui.button(_("Keep")):
            actions.append(do(accept_recording))
        draw_tooltip(_("Keep these keys. You can edit them like all other keys."))
        imgui.same_line()
        if imgui.button(_("Record again")):
            actions.append(do(retry_recording))
        draw_tooltip(_("Discard this recording and record the next drag"))
    padding = ImVec2(PADDING * em, PADDING * em)
    low, high = imgui.get_item_rect_min() - padding, imgui.get_item_rect_max() + padding
    draw_list.channels_set_current(0)
    draw_list.add_rect_filled(low, high, colour_u32(look.palette.panel, 0.94), PADDING * em)
    draw_list.add_rect(low, high, colour_u32(look.palette.line), PADDING * em)
    draw_list.channels_merge()
    return actions
