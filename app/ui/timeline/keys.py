"""Pose keys of all layers, with their tangent marks, and the selection box."""

from imgui_bundle import ImVec2, ImVec4, icons_fontawesome_6 as icons, imgui

from app.document import Keyframe, TangentMode
from app.editor import (
    Action,
    KeyDrag,
    KeyRow,
    KeysByRow,
    Project,
    TimeGesture,
    TrackRow,
    do,
    layer_of,
)
from app.editor.actions import editing
from app.editor.actions.timing import timeline_drag, tracks
from app.editor.layering.layer_selection import set_active_layer
from app.texts import _
from app.ui.shortcuts.keys import CTRL, format_modified
from app.ui.style.theme import colour_u32
from app.ui.style.widgets import begin_tooltip, is_hovered_or_held, is_pressed
from app.ui.timeline.layout import (
    LayerRow,
    TimelineLayout,
    draw_time_tag,
    find_least_gap,
    format_seconds,
)
from app.ui.timeline.menus import TANGENT_MODES, draw_key_menu

REACH, SMALLEST = 0.55, 0.26  # em: half a key's diagonal: normally, and if keys are dense
SMALLER = 0.7  # size of other layers' keys, relative to the active layer's
KEY_GESTURES = _("Drag to move, {gesture} to copy, right-click for more")
GRIP = 1.45  # half the side of a key's hit box, relative to half its diagonal


def select_row(row: KeyRow, chosen_of: KeysByRow) -> list[Action]:
    """Activate the row's layer, and select the row and the given keys."""
    return [
        do(set_active_layer, layer_of(row)),
        do(tracks.select_track, row.handle if isinstance(row, TrackRow) else None),
        do(editing.select_keys_in_rows, chosen_of),
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
    gesture, identity = bands.project.timeline.gesture, row.layer.id
    for index in bands.in_view(row.layer.keys):
        key = row.layer.keys[index]
        x = bands.x(key.frame)
        box = ImVec2(x - grip, row.middle - grip), ImVec2(x + grip, row.middle + grip)
        origin = find_drag_origin(gesture, identity, key.frame)
        bands.button(f"key {origin}", *box, right=True)
        is_large = is_hovered_or_held() or is_key_dragged(gesture, identity, key.frame)
        _draw_key(bands, row, key, 1.15 * radius if is_large else radius)
        actions += begin_key_drag(bands, identity, key.frame)
        if gesture is None:
            _draw_key_tooltip(bands, row, key)
        actions += draw_key_menu(bands, identity, key)
    return actions


def _radius(bands: TimelineLayout, row: LayerRow) -> float:
    """Return the keys' radius in pixels: smaller if keys would overlap."""
    gap = find_least_gap(row.layer, None)
    part = 1.0 if row.is_active else SMALLER
    return part * min(max(0.48 * gap * bands.time_view.scale, SMALLEST), REACH) * bands.look.em


def is_key_dragged(gesture: TimeGesture | None, row: KeyRow, frame: int) -> bool:
    return (
        isinstance(gesture, KeyDrag)
        and row == gesture.row
        and frame == gesture.pressed + gesture.by
    )


def find_drag_origin(gesture: TimeGesture | None, row: KeyRow, frame: int) -> int:
    """Return the key's frame before the drag, so that its button keeps its id."""
    if isinstance(gesture, KeyDrag) and not gesture.copies:
        before = frame - gesture.by
        return before if before in gesture.keys.get(row, ()) else frame
    return frame


def begin_key_drag(bands: TimelineLayout, row: KeyRow, frame: int) -> list[Action]:
    """Handle the pointer on a row's key, which is the last item."""
    actions = _press(bands, row, frame) if is_pressed() else []
    if imgui.is_item_clicked(imgui.MouseButton_.right):
        chosen_of = bands.project.selected_keys
        if frame not in chosen_of.get(row, ()):
            actions += select_row(row, {row: frozenset({frame})})
        elif row != bands.project.row:
            actions += select_row(row, chosen_of)
        imgui.open_popup(f"menu of key {frame}")
    return actions


def _press(bands: TimelineLayout, row: KeyRow, frame: int) -> list[Action]:
    chosen_of, io = bands.project.selected_keys, imgui.get_io()
    chosen = chosen_of.get(row, frozenset())
    if io.key_shift:
        return [do(editing.select_keys_in_rows, {**chosen_of, row: chosen ^ {frame}})]
    if frame not in chosen:
        chosen_of = {row: frozenset({frame})}
    drag = KeyDrag(
        keys=chosen_of,
        row=row,
        pressed=frame,
        start=bands.pointed,
        copies=io.key_ctrl,
        before=bands.project.document,
        after=bands.project.document,
    )
    return [
        *select_row(row, chosen_of),
        do(timeline_drag.begin_timeline_drag, drag, bands.time_view),
    ]


def _draw_key(bands: TimelineLayout, row: LayerRow, key: Keyframe, radius: float) -> None:
    palette, draw_list, em = bands.look.palette, imgui.get_window_draw_list(), bands.look.em
    x, y = bands.x(key.frame), row.middle
    chosen = key.frame in bands.project.selected_keys.get(row.layer.id, ())
    warns = _warning(bands, row, key)
    fill = palette.accent if chosen else warns or (palette.text if row.is_active else palette.dim)
    tangent, centre = key.shown_tangent_mode, ImVec2(x, y)
    if chosen:
        draw_key_mark(tangent, centre, radius + 0.24 * em, colour_u32(palette.accent, 0.35))
    draw_key_mark(tangent, centre, radius + 0.12 * em, colour_u32(palette.desk))
    draw_key_mark(tangent, centre, radius, colour_u32(fill))
    label_dragged_key(bands, row.layer.id, key.frame, x)
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


def label_dragged_key(bands: TimelineLayout, row: KeyRow, frame: int, x: float) -> None:
    """Write the new frame beside a key that is being dragged."""
    gesture = bands.project.timeline.gesture
    if isinstance(gesture, KeyDrag) and gesture.by and is_key_dragged(gesture, row, frame):
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
