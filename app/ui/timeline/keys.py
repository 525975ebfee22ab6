"""Pose keys of all layers, with their tangent marks, and the selection box."""

from typing import Any

from imgui_bundle import ImVec2, ImVec4, icons_fontawesome_6 as icons, imgui

from app.document import (
    Channel,
    Keyframe,
    KeysByChannel,
    TangentMode,
    pose_channel,
)
from app.editor import Action, KeyDrag, Project, TimeGesture, do
from app.editor.actions import editing
from app.editor.actions.timing import timeline_drag, tracks
from app.editor.layering.layer_selection import set_active_layer
from app.texts import _
from app.ui.shortcuts.keys import CTRL, format_modified
from app.ui.style.theme import colour_u32
from app.ui.style.widgets import begin_tooltip, is_hovered_or_held, is_pressed
from app.ui.timeline.layout import TimelineLayout, draw_time_tag, format_seconds
from app.ui.timeline.menus import TANGENT_MODES, draw_key_menu
from app.ui.timeline.row import LayerRow, find_least_gap

REACH, SMALLEST = 0.55, 0.26  # em: half a key's diagonal: normally, and if keys are dense
HOLLOW = 0.55  # size of the hole of a key that is not committed yet
SMALLER = 0.7  # size of other layers' keys, relative to the active layer's
KEY_GESTURES = _("Drag to move, {gesture} to copy, right-click for more")
GRIP = 1.45  # half the side of a key's hit box, relative to half its diagonal


def select_lane(channel: Channel[Any], keys: KeysByChannel) -> list[Action]:
    """Activate the channel's layer, and select the channel and the given keys."""
    activate = [] if channel.layer is None else [do(set_active_layer, channel.layer)]
    return [
        *activate,
        do(tracks.select_channel, channel),
        do(editing.select_channel_keys, keys),
    ]


def draw_keys(bands: TimelineLayout) -> list[Action]:
    actions: list[Action] = []
    bands.push_track_clip()
    for row in bands.rows:
        if bands.shows_row(row) and (not row.layer.still or row.is_active):
            # By layer, so that buttons stay the same when another layer becomes active.
            imgui.push_id(f"row {row.layer.id}")
            actions += _draw_row(bands, row)
            imgui.pop_id()
    imgui.pop_clip_rect()
    return actions


def _draw_row(bands: TimelineLayout, row: LayerRow) -> list[Action]:
    actions: list[Action] = []
    radius = _radius(bands, row)
    grip = GRIP * radius
    gesture, channel = bands.project.timeline.gesture, pose_channel(row.layer.id)
    for index in bands.in_view(row.layer.keys):
        key = row.layer.keys[index]
        x = bands.x(key.frame)
        box = ImVec2(x - grip, row.middle - grip), ImVec2(x + grip, row.middle + grip)
        origin = find_drag_origin(gesture, channel, key.frame)
        bands.button(f"key {origin}", *box, right=True)
        is_large = is_hovered_or_held() or is_key_dragged(gesture, channel, key.frame)
        _draw_key(bands, row, key, 1.15 * radius if is_large else radius)
        actions += begin_key_drag(bands, channel, key.frame)
        if gesture is None:
            _draw_key_tooltip(bands, row, key)
        actions += draw_key_menu(bands, channel, key)
    return actions


def _radius(bands: TimelineLayout, row: LayerRow) -> float:
    """Return the keys' radius in pixels: smaller if keys would overlap."""
    gap = find_least_gap(bands.project.document, pose_channel(row.layer.id))
    part = 1.0 if row.is_active else SMALLER
    return part * min(max(0.48 * gap * bands.time_view.scale, SMALLEST), REACH) * bands.look.em


def is_key_dragged(gesture: TimeGesture | None, channel: Channel[Any], frame: int) -> bool:
    return (
        isinstance(gesture, KeyDrag)
        and channel == gesture.channel
        and frame == gesture.pressed + gesture.by
    )


def find_drag_origin(gesture: TimeGesture | None, channel: Channel[Any], frame: int) -> int:
    """Return the key's frame before the drag, so that its button keeps its id."""
    if isinstance(gesture, KeyDrag) and not gesture.copies:
        before = frame - gesture.by
        return before if before in gesture.keys.get(channel, ()) else frame
    return frame


def begin_key_drag(
    bands: TimelineLayout, channel: Channel[Any], frame: int, alike: KeysByChannel | None = None
) -> list[Action]:
    """Handle the pointer on a channel's key, which is the last item.

    `alike` are the keys that the mark stands for, by default only that key.
    """
    own = {channel: frozenset({frame})} if alike is None else alike
    actions = _press(bands, channel, frame, own) if is_pressed() else []
    if imgui.is_item_clicked(imgui.MouseButton_.right):
        chosen = bands.project.selection.keys
        if not _is_chosen(bands, own):
            actions += select_lane(channel, own)
        elif channel != bands.project.channel:
            actions += select_lane(channel, chosen)
        imgui.open_popup(f"menu of key {frame}")
    return actions


def _is_chosen(bands: TimelineLayout, keys: KeysByChannel) -> bool:
    chosen = bands.project.selection.keys
    return all(frames <= chosen.get(channel, frozenset()) for channel, frames in keys.items())


def _press(
    bands: TimelineLayout, channel: Channel[Any], frame: int, own: KeysByChannel
) -> list[Action]:
    chosen, io = bands.project.selection.keys, imgui.get_io()
    if io.key_shift:
        toggled = {each: chosen.get(each, frozenset()) ^ frames for each, frames in own.items()}
        return [do(editing.select_channel_keys, {**chosen, **toggled})]
    if not _is_chosen(bands, own):
        chosen = own
    drag = KeyDrag(
        keys=chosen,
        channel=channel,
        pressed=frame,
        mark=own,
        start=bands.pointed,
        copies=io.key_ctrl,
    )
    return [
        *select_lane(channel, chosen),
        do(timeline_drag.begin_timeline_drag, drag, bands.time_view),
    ]


def _draw_key(bands: TimelineLayout, row: LayerRow, key: Keyframe, radius: float) -> None:
    palette, draw_list, em = bands.look.palette, imgui.get_window_draw_list(), bands.look.em
    x, y = bands.x(key.frame), row.middle
    chosen = key.frame in bands.project.selection.keys.get(pose_channel(row.layer.id), ())
    warns = _warning(bands, row, key)
    fill = palette.accent if chosen else warns or (palette.text if row.is_active else palette.dim)
    tangent, centre = key.shown_tangent_mode, ImVec2(x, y)
    if chosen:
        draw_key_mark(tangent, centre, radius + 0.24 * em, colour_u32(palette.accent, 0.35))
    draw_key_mark(tangent, centre, radius + 0.12 * em, colour_u32(palette.desk))
    draw_key_mark(tangent, centre, radius, colour_u32(fill))
    drag = bands.project.drag
    if drag is not None and (drag.layer, drag.frame) == (row.layer.id, key.frame):
        # Until the pose rests, the key is hollow.
        draw_key_mark(tangent, centre, HOLLOW * radius, colour_u32(palette.desk))
    label_dragged_key(bands, pose_channel(row.layer.id), key.frame, x)
    if warns and chosen:
        draw_key_mark(tangent, centre, 0.45 * radius, colour_u32(warns))
    if warns and row.is_active:
        draw_list.add_circle_filled(
            ImVec2(x, bands.bar_top - 0.1 * em), 0.2 * em, colour_u32(warns)
        )


def _warning(bands: TimelineLayout, row: LayerRow, key: Keyframe) -> ImVec4 | None:
    palette = bands.look.palette
    if not key.pose.certificate.is_certified:
        return palette.danger
    return palette.warning if row.is_active and describe_target_errors(bands.project, key) else None


def label_dragged_key(bands: TimelineLayout, channel: Channel[Any], frame: int, x: float) -> None:
    """Write the new frame beside a key that is being dragged."""
    gesture = bands.project.timeline.gesture
    if isinstance(gesture, KeyDrag) and gesture.by and is_key_dragged(gesture, channel, frame):
        draw_time_tag(bands, x, f"{frame}  ({gesture.by:+d})")


def draw_key_mark(tangent: TangentMode, centre: ImVec2, radius: float, colour: int) -> None:
    """Draw a key's mark by tangent mode: round, pointed, pinched, or square for a hold."""
    draw_list, x, y = imgui.get_window_draw_list(), centre.x, centre.y
    across = radius / 2**0.5
    match tangent:
        case TangentMode.SMOOTH:
            draw_list.add_circle_filled(centre, 0.86 * radius, colour)
        case TangentMode.HOLD:
            half = 1.06 * across
            draw_list.add_rect_filled(
                ImVec2(x - half, y - half), ImVec2(x + half, y + half), colour
            )
        case TangentMode.STOP:
            half, waist = 1.1 * across, 0.3 * across
            for side in (-1, 1):
                draw_list.add_quad_filled(
                    ImVec2(x - half, y + side * half),
                    ImVec2(x + half, y + side * half),
                    ImVec2(x + waist, y),
                    ImVec2(x - waist, y),
                    colour,
                )
        case _:
            draw_list.add_quad_filled(
                ImVec2(x, y - radius),
                ImVec2(x + radius, y),
                ImVec2(x, y + radius),
                ImVec2(x - radius, y),
                colour,
            )


def describe_target_errors(project: Project, key: Keyframe) -> list[str]:
    """Describe the handles that miss their targets in a key of the active layer."""
    short = project.timeline.target_errors.value.get(key.pose, {})
    names = {handle.id: handle.name for handle in project.layer.handles}
    return [
        _("{handle} is {error:.0f} px short of its target").format(
            handle=names[identity], error=lag
        )
        for identity, lag in short.items()
        if identity in names
    ]


def _draw_key_tooltip(bands: TimelineLayout, row: LayerRow, key: Keyframe) -> None:
    if not begin_tooltip():
        return
    palette, document = bands.look.palette, bands.project.document
    imgui.text_unformatted(_("Key at frame {frame}").format(frame=key.frame))
    imgui.same_line()
    imgui.text_disabled(format_seconds(key.frame, document.fps))
    name, hint = TANGENT_MODES[key.shown_tangent_mode]
    imgui.text_unformatted(name)
    imgui.text_disabled(hint)
    if not key.pose.certificate.is_certified:
        imgui.text_colored(
            palette.danger,
            f"{icons.ICON_FA_TRIANGLE_EXCLAMATION}  "
            + _("Beyond the limits: in-betweens may fold here"),
        )
    for text in describe_target_errors(bands.project, key) if row.is_active else ():
        imgui.text_colored(palette.warning, f"{icons.ICON_FA_TRIANGLE_EXCLAMATION}  {text}")
    imgui.text_disabled(KEY_GESTURES.format(gesture=format_modified(CTRL, _("drag"))))
    imgui.end_tooltip()
